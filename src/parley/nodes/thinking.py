"""How long understanding a message may take: told after a while, given up in time or at a stop."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from typing import Final

__all__ = ["PATIENCE_S", "Thinking"]

PATIENCE_S: Final = 5.0
"""Wall time after which the operator is told that understanding takes long."""


class Thinking:
    """At most one message per robot is being understood; the next waits until it is done.

    Args:
        limit_s: Wall time after which it is given up.
        patience_s: Wall time after which the operator is told that it takes long.
    """

    def __init__(self, limit_s: float, patience_s: float) -> None:
        self._limit_s, self._patience_s = limit_s, patience_s
        self._running: dict[str, tuple[asyncio.Timeout, float]] = {}

    @asynccontextmanager
    async def about(self, robot: str, tell: Callable[[], None]) -> AsyncIterator[None]:
        """Around the work on a message.

        Args:
            robot: Who is spoken to.
            tell: Called if it takes long.

        Raises:
            TimeoutError: It was given up.
        """
        loop = asyncio.get_running_loop()
        patient_until = loop.time() + self._patience_s
        slow = loop.call_at(patient_until, tell)
        try:
            async with asyncio.timeout(self._limit_s) as limit:
                self._running[robot] = (limit, patient_until)
                yield
        finally:
            slow.cancel()
            self._running.pop(robot, None)

    def give_up(self, robot: str) -> None:
        """The robot was stopped: what takes long already, or will, is not waited for."""
        running = self._running.get(robot)
        if running is None:
            return
        limit, patient_until = running
        planned = limit.when()
        if planned is not None and not limit.expired():
            limit.reschedule(min(planned, max(patient_until, asyncio.get_running_loop().time())))
