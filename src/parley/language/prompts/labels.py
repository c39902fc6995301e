"""Short names by which a model speaks of steps and memories: fixed when it is asked, whatever changes later.

The names themselves never change, so that a form made of them can be kept by whoever caches it.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Final

from parley.memory.limits import MOST_MEMORIES
from parley.messages.memory import MemoryEntry

__all__ = ["MEMORIES", "STEPS", "memory_label", "memory_of", "step_label", "step_of"]

MOST_STEPS: Final = 20


def step_label(index: int) -> str:
    """The name of a step of the queue."""
    return f"s{index + 1}"


def memory_label(index: int) -> str:
    """The name of a memory that is shown."""
    return f"m{index + 1}"


STEPS: Final = tuple(map(step_label, range(MOST_STEPS)))
"""All names that steps can have."""
MEMORIES: Final = tuple(map(memory_label, range(MOST_MEMORIES)))
"""All names that memories can have."""


def step_of(label: str, count: int) -> int | None:
    """The place of a step among `count`, if there is one of that name."""
    place = _place(label, "s")
    return place if place is not None and place < count else None


def memory_of(label: str, shown: Sequence[MemoryEntry]) -> MemoryEntry | None:
    """The memory that a label, or else a whole name, stands for."""
    place = _place(label, "m")
    if place is not None and place < len(shown):
        return shown[place]
    return next((entry for entry in shown if entry.name == label), None)


def _place(label: str, kind: str) -> int | None:
    read = re.fullmatch(rf"{kind}([1-9][0-9]{{0,2}})", label.strip())
    return int(read[1]) - 1 if read else None
