"""How much of the memory one answer may hold: the data of pictures goes first, then what is oldest."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from parley.messages.memory import MemoryEntry
from parley.messages.wire import MAX_MESSAGE_CHARS

__all__ = ["LEFT_OUT", "MAX_ANSWER_CHARS", "fitting", "without_pictures"]

MAX_ANSWER_CHARS: Final = MAX_MESSAGE_CHARS // 2
"""Of texts and pictures as they are; in JSON some characters take two."""
LEFT_OUT: Final = "(the picture itself is left out here: together they are too large; ask for it by its name)"
_BODY_CHARS: Final = 300
"""Of one memory besides its texts: keys, times, marks."""


def fitting(
    entries: Sequence[MemoryEntry], most_chars: int = MAX_ANSWER_CHARS
) -> tuple[list[MemoryEntry], int]:
    """What one answer can hold, in the same order, and how many memories it cannot.

    Args:
        entries: Oldest first.
        most_chars: How long it may be.
    """
    shown = list(entries)
    if sum(map(_chars, shown)) > most_chars:
        shown = without_pictures(shown)
    free, kept = most_chars, 0
    for entry in reversed(shown):
        free -= _chars(entry)
        if free < 0:
            break
        kept += 1
    return shown[len(shown) - kept :], len(shown) - kept


def without_pictures(entries: Sequence[MemoryEntry]) -> list[MemoryEntry]:
    """Pictures without their data, which is said in their info."""
    return [
        entry.model_copy(update={"data": "", "info": f"{entry.info} {LEFT_OUT}".strip()})
        if entry.type == "image"
        else entry
        for entry in entries
    ]


def _chars(entry: MemoryEntry) -> int:
    return _BODY_CHARS + 2 * len(entry.name) + len(entry.data) + len(entry.info) + len(entry.source)
