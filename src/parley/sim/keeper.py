"""Keeps a simulated world going while something blocks the event loop."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Callable
from typing import Final

from parley.clock import Clock

__all__ = ["Keeper"]

LOOK_S: Final = 0.05
LATE_S: Final = 0.15
"""Wall time without a sign of the loop after which the world is stepped without it."""


class Keeper:
    """A thread that steps a world in motion at its pace for as long as the loop gives no sign.

    Args:
        clock: For the wall time.
        pace_s: Wall time of one step.
        moving: Whether anything in the world moves; thread-safe.
        step: Steps it once; called in this thread only while the loop is blocked.
    """

    def __init__(
        self, clock: Clock, pace_s: float, moving: Callable[[], bool], step: Callable[[], None]
    ) -> None:
        self._clock, self._pace_s, self._moving, self._step = clock, pace_s, moving, step
        self._closed, self._answered = threading.Event(), threading.Event()
        self._loop: asyncio.AbstractEventLoop | None = None
        self._thread = threading.Thread(target=self._watch, name="simulator keeper", daemon=True)

    def open(self) -> None:
        """Begin; on the loop that is watched."""
        self._loop = asyncio.get_running_loop()
        self._thread.start()

    async def close(self) -> None:
        """End."""
        self._closed.set()
        await asyncio.to_thread(self._thread.join)

    def _watch(self) -> None:
        assert self._loop is not None
        while not self._closed.wait(LOOK_S):
            if not self._moving():
                continue
            asked_s = self._clock.wall_s()
            self._answered.clear()
            try:
                self._loop.call_soon_threadsafe(self._answered.set)
            except RuntimeError:  # the loop is closed
                return
            if not self._answered.wait(LATE_S):
                self._go_on(asked_s)

    def _go_on(self, since_s: float) -> None:
        """Step at the world's pace, counted from `since_s`, until the loop is back or all is at rest."""
        while not (self._answered.is_set() or self._closed.is_set()) and self._moving():
            if since_s <= self._clock.wall_s():
                self._step()
                since_s += self._pace_s
            else:
                self._answered.wait(self._pace_s)
