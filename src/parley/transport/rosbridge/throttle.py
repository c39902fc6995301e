"""How a bridge holds back what comes faster than a client wants it, as rosbridge_suite does."""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import Callable
from typing import Any

__all__ = ["Throttle"]


class Throttle:
    """Hands messages on, at most one in a time.

    Args:
        every_s: The shortest time between two; 0: all at once.
        length: How many wait meanwhile, of more the oldest go; 0: what comes too early is dropped.
        hand_on: Gets them.
    """

    def __init__(self, every_s: float, length: int, hand_on: Callable[[Any], None]) -> None:
        self._every_s, self._hand_on = every_s, hand_on
        self._waiting: deque[Any] = deque(maxlen=length)
        self._holding: asyncio.TimerHandle | None = None

    def put(self, message: Any) -> None:
        """A message came."""
        if not self._every_s:
            self._hand_on(message)
        elif self._holding is None:
            self._hand_on(message)
            self._hold()
        else:
            self._waiting.append(message)

    def close(self) -> None:
        """Hand on nothing more."""
        self._waiting.clear()
        if self._holding is not None:
            self._holding.cancel()

    def _hold(self) -> None:
        self._holding = asyncio.get_running_loop().call_later(self._every_s, self._next)

    def _next(self) -> None:
        self._holding = None
        if self._waiting:
            self._hand_on(self._waiting.popleft())
            self._hold()
