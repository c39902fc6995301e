"""Doing something for many without keeping the loop from everything else."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Sequence
from typing import Final, TypeVar

__all__ = ["SLICE", "in_slices"]

T = TypeVar("T")

SLICE: Final = 250
"""So many are done in one turn of the loop."""


def in_slices(items: Sequence[T], do: Callable[[T], None]) -> None:
    """Do it for the first `SLICE` now, for the others in the next turns."""
    for item in items[:SLICE]:
        do(item)
    if left := items[SLICE:]:
        asyncio.get_running_loop().call_soon(in_slices, left, do)
