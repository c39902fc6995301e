"""What the chat interface asks of the memory and lets it keep, on whose word, and whether that was kept."""

from __future__ import annotations

import asyncio
import re
from collections.abc import Sequence
from typing import Final

from parley.language.base import Situation, Turn
from parley.memory.sayings import keeping_action
from parley.messages.chat import ActionCall, ChatAction
from parley.messages.memory import MemoryEvent
from parley.sentences import sentence

__all__ = ["Confirmations", "keeping_order", "memory_query"]

_WITHIN_S: Final = 5.0
"""Wall time in which the memory must have confirmed what the reply promises."""
_RECALLED_TURNS: Final = 6
"""How many turns back what is asked or meant may lie ("bring it to him")."""
_RECALLED_CHARS: Final = 300


class Confirmations:
    """Waits until memories are durable."""

    def __init__(self) -> None:
        self._waits: list[tuple[str, asyncio.Future[MemoryEvent]]] = []
        """With the name of the entry, in the order in which the memory is told; several may have one name."""

    def wait_for(self, name: str) -> asyncio.Future[MemoryEvent]:
        """What the memory will say about the entry of that name; begin before it is told of it."""
        wait: asyncio.Future[MemoryEvent] = asyncio.get_running_loop().create_future()
        self._waits.append((name, wait))
        return wait

    def on_event(self, event: MemoryEvent) -> None:
        """The memory says what became of an entry."""
        waits = (wait for name, wait in self._waits if name == event.name and not wait.done())
        if (wait := next(waits, None)) is not None:
            wait.set_result(event)

    async def confirmed(self, waits: Sequence[asyncio.Future[MemoryEvent]]) -> str:
        """Wait until what the reply promises is stored; the plain reason if it is not."""
        if not waits:
            return ""
        try:
            async with asyncio.timeout(_WITHIN_S):
                events = await asyncio.gather(*waits)
        except TimeoutError:
            return "I could not store that: the memory does not answer. Please tell me again later."
        finally:
            self._waits = [(name, wait) for name, wait in self._waits if wait not in waits]
        failed = next((event for event in events if event.kind == "failed"), None)
        return sentence("I could not store that: {why}", why=failed.message) if failed else ""


def keeping_order(situation: Situation) -> ChatAction | None:
    """The order to remember what the robot sees, if the message says that and nothing else."""
    name = keeping_action(situation.message, situation.catalogue)
    if not name:
        return None
    call = ActionCall(name=name, reason="remember what I see")
    return ChatAction(message_response="I will keep what I see now.", queue=(call,))


def memory_query(message: str, turns: Sequence[Turn], speaker: str = "") -> str:
    """What to look up: the message, what it may refer back to, and who speaks of themselves in it."""
    recent = [turn.content[:_RECALLED_CHARS] for turn in turns[-_RECALLED_TURNS:]]
    oneself = [f"{speaker or 'operator'} location"] if _ONESELF.search(message) else []
    return "\n".join([message, *oneself, *reversed(recent)])


_ONESELF: Final = re.compile(r"\b(?:i|me|my|us|we|here)\b", re.IGNORECASE)
