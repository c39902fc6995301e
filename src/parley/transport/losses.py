"""How many messages subscribers lost, told as it becomes worse: a flood makes no flood of words."""

from __future__ import annotations

from collections.abc import Callable

from parley.transport.base import Subscription

__all__ = ["Losses"]


class Losses:
    """Of one subscriber or several.

    Args:
        tell: Gets how many were lost by now: at 1, 2, 4, 8 and so on.
    """

    def __init__(self, tell: Callable[[int], None]) -> None:
        self._tell = tell
        self._ends: list[Subscription] = []
        self._told = 0

    def watch(self, end: Subscription) -> None:
        """Count what this one loses."""
        self._ends.append(end)

    def look(self) -> None:
        """Tell if more was lost; called with each message that gets through."""
        lost = sum(end.dropped for end in self._ends)
        if lost.bit_length() > self._told.bit_length():
            self._told = lost
            self._tell(lost)
