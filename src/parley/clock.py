"""Time is injected: one clock object per system, wall or simulated.

Time-outs and waits of actions count **robot time** (`now_s`, `sleep`, `timeout`); deadlines of stopping count
**wall time** (`wall_s`). In simulation robot time is what the simulator says; a headless story therefore
runs as fast as the machine can.
"""

from __future__ import annotations

import asyncio
import heapq
import itertools
import time
from collections.abc import AsyncIterator, Iterator
from contextlib import (
    AbstractAsyncContextManager,
    AbstractContextManager,
    asynccontextmanager,
    contextmanager,
)
from typing import Protocol

__all__ = ["Clock", "SimClock", "WallClock"]


class Clock(Protocol):
    """What everything that waits is given instead of the time module."""

    def now_s(self) -> float:
        """Robot time in seconds from an arbitrary start; never goes back."""
        ...

    def wall_s(self) -> float:
        """Monotonic wall time in seconds, for deadlines that protect people."""
        ...

    def unix_ms(self) -> int:
        """Wall clock in milliseconds since the Unix epoch, for time stamps people read."""
        ...

    async def sleep(self, seconds: float) -> None:
        """Wait for `seconds` of robot time."""
        ...

    def timeout(self, seconds: float) -> AbstractAsyncContextManager[None]:
        """``async with clock.timeout(s):`` raises `TimeoutError` after `seconds` of robot time."""
        ...

    def hold(self) -> AbstractContextManager[None]:
        """``with clock.hold():`` robot time does not advance meanwhile (simulation only).

        For short computing that a real robot would do in no time worth mentioning. Never around anything that
        can hang: it would stop every robot of the simulation.
        """
        ...


class WallClock:
    """Robot time is wall time."""

    def now_s(self) -> float:
        """See `Clock.now_s`."""
        return time.monotonic()

    def wall_s(self) -> float:
        """See `Clock.wall_s`."""
        return time.monotonic()

    def unix_ms(self) -> int:
        """See `Clock.unix_ms`."""
        return time.time_ns() // 1_000_000

    async def sleep(self, seconds: float) -> None:
        """See `Clock.sleep`."""
        await asyncio.sleep(seconds)

    @asynccontextmanager
    async def timeout(self, seconds: float) -> AsyncIterator[None]:
        """See `Clock.timeout`."""
        async with asyncio.timeout(seconds):
            yield

    @contextmanager
    def hold(self) -> Iterator[None]:
        """See `Clock.hold`; wall time cannot be held, so this does nothing."""
        yield


class SimClock(WallClock):
    """Robot time moves only when the simulator calls `advance`."""

    def __init__(self, start_s: float = 0.0) -> None:
        self._now_s = start_s
        self._sleepers: list[tuple[float, int, asyncio.Future[None]]] = []
        self._order = itertools.count()
        self._holds = 0
        self._wanted = asyncio.Event()

    def now_s(self) -> float:
        """See `Clock.now_s`."""
        return self._now_s

    @property
    def held(self) -> bool:
        """Whether somebody asked for robot time to stand still."""
        return self._holds > 0

    @property
    def has_sleepers(self) -> bool:
        """Whether anybody waits for robot time to pass."""
        return any(not future.done() for _, _, future in self._sleepers)

    @property
    def wanted(self) -> asyncio.Event:
        """Set whenever somebody starts to wait; the simulator clears it before it pauses for lack of work."""
        return self._wanted

    async def sleep(self, seconds: float) -> None:
        """See `Clock.sleep`."""
        if seconds <= 0:
            await asyncio.sleep(0)
            return
        future: asyncio.Future[None] = asyncio.get_running_loop().create_future()
        heapq.heappush(self._sleepers, (self._now_s + seconds, next(self._order), future))
        self._wanted.set()
        await future

    @asynccontextmanager
    async def timeout(self, seconds: float) -> AsyncIterator[None]:
        """See `Clock.timeout`."""
        async with asyncio.timeout(None) as scope:

            async def expire() -> None:
                await self.sleep(seconds)
                scope.reschedule(0.0)

            watcher = asyncio.create_task(expire(), name="clock-timeout")
            try:
                yield
            finally:
                watcher.cancel()

    @contextmanager
    def hold(self) -> Iterator[None]:
        """See `Clock.hold`."""
        self._holds += 1
        try:
            yield
        finally:
            self._holds -= 1
            self._wanted.set()

    def advance(self, seconds: float) -> None:
        """Let robot time pass and wake who waited long enough (called by the simulator, on the loop)."""
        self._now_s += seconds
        while self._sleepers and self._sleepers[0][0] <= self._now_s + 1e-9:
            _, _, future = heapq.heappop(self._sleepers)
            if not future.done():
                future.set_result(None)
