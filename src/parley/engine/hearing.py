"""Holds robots while nobody is heard who could stop them, though somebody was."""

from __future__ import annotations

import asyncio
import uuid
from collections.abc import Callable, Sequence
from contextlib import AsyncExitStack
from typing import Final

from parley.clock import Clock
from parley.errors import InvalidMessageError
from parley.gate.notes import note
from parley.gate.stop_line import StopLine
from parley.messages import ros, topics
from parley.messages.principal import Principal
from parley.messages.status import Pulse
from parley.messages.wire import decode
from parley.sentences import Sentence, sentence
from parley.transport.base import Transport

__all__ = ["Desks", "Hearing"]

SILENT_S: Final = 0.6
"""Wall time without a pulse of any page or terminal after which robots stand."""
BACK_S: Final = 1.0
"""For so long somebody must be heard again before they go on: stops of meanwhile come first."""
TELL_S: Final = 1.0
"""Only a silence that is longer is told: a busy machine may hesitate."""
PAST_S: Final = 15.0
"""Who is silent for so long, while others are heard, is past."""
LOOK_S: Final = 0.1

_BY: Final = Principal(kind="program", name="hearing")
_ALONE: Final = sentence("I heard no page and no terminal any more, so I stand still until one is back.")


class Desks:
    """Pages and terminals from which robots can be stopped. Pure: wall time is handed in."""

    def __init__(self) -> None:
        self._heard_s: dict[str, float] = {}

    def heard(self, pulse: Pulse, now_s: float) -> None:
        """One says that it is there, or that it ends."""
        if pulse.leaving:
            self._heard_s.pop(pulse.server, None)
        else:
            self._heard_s[pulse.server] = now_s

    def silent_s(self, now_s: float, *, late_s: float = 0.0) -> float:
        """For how long none was heard; 0: none is missing.

        Args:
            now_s: Wall time.
            late_s: How much later than it wanted the caller comes: so long nobody was heard here.
        """
        if not self._heard_s:
            return 0.0
        for server, at_s in self._heard_s.items():
            self._heard_s[server] = min(now_s, at_s + max(0.0, late_s))
        newest_s = max(self._heard_s.values())
        self._heard_s = {server: at_s for server, at_s in self._heard_s.items() if newest_s - at_s < PAST_S}
        return now_s - newest_s


class Hearing:
    """Watches on the loop on which it is opened, until it is closed.

    Args:
        line: Where the robots are held.
        robots: Who is held.
        transport: Where pages and terminals are.
        clock: For the wall time.
        tell: Says something to operators, as soon as they hear it.
    """

    def __init__(
        self,
        line: StopLine,
        robots: Sequence[str],
        transport: Transport,
        clock: Clock,
        tell: Callable[[str], None],
    ) -> None:
        self._line, self._robots, self._transport = line, tuple(robots), transport
        self._clock, self._tell = clock, tell
        self._desks, self._stack = Desks(), AsyncExitStack()
        self._hold = ""
        """The id of the hold in force."""
        self._since_s = self._back_s = 0.0
        self._told = False

    async def open(self) -> None:
        """Listen, and watch."""
        heard = await self._transport.subscribe(topics.PULSE, self._on_pulse)
        self._stack.push_async_callback(heard.close)
        watching = asyncio.create_task(self._watch(), name="hearing")
        self._stack.callback(watching.cancel)

    async def close(self) -> None:
        """Watch no longer. Idempotent."""
        await self._stack.aclose()

    def _on_pulse(self, message: ros.String) -> None:
        try:
            self._desks.heard(decode(Pulse, message.data), self._clock.wall_s())
        except InvalidMessageError as error:
            note("unreadable pulse", reason=str(error))

    async def _watch(self) -> None:
        while True:
            due_s = self._clock.wall_s() + LOOK_S
            await asyncio.sleep(LOOK_S)
            now_s = self._clock.wall_s()
            self._look(now_s, self._desks.silent_s(now_s, late_s=now_s - due_s))

    def _look(self, now_s: float, silent_s: float) -> None:
        if silent_s > SILENT_S:
            self._back_s = now_s
            self._stand(now_s - silent_s)
            if silent_s > TELL_S and not self._told:
                self._told = True
                note("no page is heard", robots=self._robots)
                self._tell(_ALONE)
        elif self._hold and now_s - self._back_s > BACK_S:
            hold, self._hold = self._hold, ""
            self._line.go_on(hold)
            if self._told:
                self._tell(_back(self._back_s - self._since_s))

    def _stand(self, since_s: float) -> None:
        if not self._hold:
            self._since_s, self._told = since_s, False
        elif all(self._hold in self._line.held_by(robot) for robot in self._robots):
            return
        self._hold = uuid.uuid4().hex  # a person let go the one before, and is not heard any more
        self._line.hold(self._robots, id=self._hold, by=_BY)


def _back(alone_s: float) -> Sentence:
    return sentence(
        "I heard no page and no terminal for {seconds} seconds. That does not hold me any more.",
        seconds=f"{alone_s:.1f}",
    )
