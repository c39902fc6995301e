"""The node that calls people for robots that wait."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Sequence
from typing import ClassVar, Final

from parley.agents.base import Node
from parley.agents.calls.post import Note, Send, sender
from parley.agents.calls.waits import Due, Waits
from parley.clock import Clock
from parley.config import CallSettings
from parley.errors import UnavailableError
from parley.messages import topics
from parley.messages.chat import ChatFeedback, ChatInput
from parley.sentences import sentence, together
from parley.transport.base import Transport

__all__ = ["Calls"]

_LOOK_S: Final = 1.0
_TRIES: Final = 3
_MINUTE_S: Final = 60


class Calls(Node):
    """Tells people outside of robots that wait for a yes or an answer.

    Args:
        transport: Where the topics are.
        clock: Wall time.
        settings: Whom to call, and after what time; a later one is who is called when nobody came.
        tell: Gets what operators have to know: that nobody can be called.
        again_s: Wait before a call is tried again that did not get through.

    Raises:
        ConfigError: A file with a secret cannot be read.
    """

    name: ClassVar[str] = "calls"

    def __init__(
        self,
        transport: Transport,
        clock: Clock,
        settings: Sequence[CallSettings],
        *,
        tell: Callable[[str], None],
        again_s: float = 10.0,
    ) -> None:
        super().__init__(transport)
        self._clock, self._tell, self._again_s = clock, tell, again_s
        self._senders: list[Send] = [sender(one) for one in settings]
        self._links = [one.link for one in settings]
        self._waits = Waits([one.after_s for one in settings])

    async def open(self) -> None:
        """See `Node.open`."""
        if not self._senders:
            return
        await self.subscribe(topics.CHAT_FEEDBACK, ChatFeedback, self._waits.on_feedback)
        await self.subscribe(topics.CHAT_INPUT, ChatInput, self._waits.on_input)
        await self.subscribe_plans(self._waits.on_plan)
        self.spawn(self._watch(), name="watch")

    def look(self) -> None:
        """Call whom the waiting calls by now."""
        for due in self._waits.due(self._clock.wall_s()):
            self.spawn(self._call(due), name=f"call for {due.robot}")

    async def _watch(self) -> None:
        while True:
            self.look()
            await asyncio.sleep(_LOOK_S)

    async def _call(self, due: Due) -> None:
        minutes = int(due.waited_s // _MINUTE_S)
        since = sentence("Waiting for {minutes} min.", minutes=minutes) if minutes else ""
        text = self.spoken(together(due.text, since))
        note = Note(text, due.robot, int(due.waited_s), self._links[due.stage])
        problem = ""
        for tried in range(_TRIES):
            if tried:
                await asyncio.sleep(self._again_s)
            try:
                await asyncio.to_thread(self._senders[due.stage], note)
            except UnavailableError as error:
                problem = str(error)
                self.log.warning("nobody is called", robot=due.robot, problem=problem)
            else:
                return
        self._tell(self.spoken(sentence("I wait, and cannot call anybody: {problem}.", problem=problem)))
