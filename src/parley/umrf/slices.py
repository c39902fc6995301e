"""Doing something for many without keeping the loop from everything else."""

from __future__ import annotations

import asyncio
import itertools
from collections.abc import Callable, Iterable
from typing import Final, TypeVar

__all__ = ["SLICE", "in_slices"]

T = TypeVar("T")

SLICE: Final = 250
"""So many are done in one turn of the loop."""


def in_slices(items: Iterable[T], do: Callable[[T], None]) -> None:
    """Do it for the first `SLICE` now, for the others in the next turns."""
    left = iter(items)
    for item in itertools.islice(left, SLICE):
        do(item)
    following = next(left, None)
    if following is not None:
        asyncio.get_running_loop().call_soon(in_slices, itertools.chain([following], left), do)
