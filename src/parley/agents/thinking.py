"""How long understanding a message may take: told after a while, given up in time or at a stop."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from dataclasses import dataclass
from typing import Final

__all__ = ["PATIENCE_S", "DroppedError", "Thinking"]

PATIENCE_S: Final = 5.0
"""Wall time after which the operator is told that understanding takes long."""


class DroppedError(TimeoutError):
    """The operator does not want the answer any more."""


@dataclass(slots=True)
class _Thought:
    limit: asyncio.Timeout
    patient_until_s: float
    message: str
    dropped: bool = False


class Thinking:
    """At most one message per robot is being understood; the next waits until it is done.

    Args:
        limit_s: Wall time after which it is given up.
        patience_s: Wall time after which the operator is told that it takes long.
    """

    def __init__(self, limit_s: float, patience_s: float) -> None:
        self._limit_s, self._patience_s = limit_s, patience_s
        self._running: dict[str, _Thought] = {}

    @asynccontextmanager
    async def about(self, robot: str, tell: Callable[[], None], message: str = "") -> AsyncIterator[None]:
        """Around the work on a message.

        Args:
            robot: Who is spoken to.
            tell: Called if it takes long.
            message: What is thought about.

        Raises:
            DroppedError: The operator does not want it any more.
            TimeoutError: It was given up.
        """
        loop = asyncio.get_running_loop()
        patient_until = loop.time() + self._patience_s
        slow = loop.call_at(patient_until, tell)
        try:
            async with asyncio.timeout(self._limit_s) as limit:
                thought = self._running[robot] = _Thought(limit, patient_until, message)
                yield
        except TimeoutError as error:
            if thought.dropped:
                raise DroppedError from error
            raise
        finally:
            slow.cancel()
            self._running.pop(robot, None)

    def give_up(self, robot: str) -> None:
        """The robot was stopped: what takes long already, or will, is not waited for."""
        running = self._running.get(robot)
        if running is None:
            return
        self._end(running.limit, max(running.patient_until_s, asyncio.get_running_loop().time()))

    def slow_message(self, robot: str) -> str:
        """What a robot has been thinking about for long already; empty if there is nothing like that."""
        running = self._running.get(robot)
        slow = running is not None and asyncio.get_running_loop().time() >= running.patient_until_s
        return running.message if running is not None and slow else ""

    def is_at_work(self, robot: str) -> bool:
        """Whether a robot thinks about something that somebody may want to let go of."""
        running = self._running.get(robot)
        return running is not None and running.message != ""

    def drop(self, robot: str) -> bool:
        """Let go of what a robot thinks about, at once; whether there was anything."""
        running = self._running.get(robot)
        if running is None or not running.message:
            return False
        running.dropped = True
        self._end(running.limit, asyncio.get_running_loop().time())
        return True

    @staticmethod
    def _end(limit: asyncio.Timeout, at_s: float) -> None:
        planned = limit.when()
        if planned is not None and not limit.expired():
            limit.reschedule(min(planned, at_s))
