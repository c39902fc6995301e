"""What is remembered by key, and must not grow with the length of a run or with what strangers send."""

from __future__ import annotations

from collections import OrderedDict
from typing import Final, TypeVar

__all__ = ["KEPT", "Latest"]

K = TypeVar("K")
V = TypeVar("V")

KEPT: Final = 500


class Latest(OrderedDict[K, V]):
    """A dictionary of the entries that were written last; beyond `kept` the oldest is forgotten.

    Nothing stands in one whose loss would let something move: a stop, a hold, a yes that is bound.

    Args:
        kept: How many.
    """

    def __init__(self, kept: int = KEPT) -> None:
        super().__init__()
        self._most = kept

    def __setitem__(self, key: K, value: V) -> None:
        super().__setitem__(key, value)
        self.move_to_end(key)
        while len(self) > self._most:
            self.popitem(last=False)
