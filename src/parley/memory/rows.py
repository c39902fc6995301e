"""How a memory stands in its table."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, Final

from parley.messages.memory import MemoryEntry

__all__ = ["COLUMNS", "COLUMNS_WITHOUT_PICTURES", "read_entry"]

COLUMNS: Final = (
    "name, scope, type, data, info, source, created_unix_ms, updated_unix_ms, ended_unix_ms, used_unix_ms,"
    " used_count, way, words"
)
"""What `read_entry` wants selected, in this order."""

COLUMNS_WITHOUT_PICTURES: Final = COLUMNS.replace(" data,", " CASE type WHEN 'image' THEN '' ELSE data END,")
"""The same with nothing for the data of pictures, which is long to read."""

_NAMES: Final = tuple(COLUMNS.replace(",", "").split())


def read_entry(row: Iterable[Any]) -> MemoryEntry:
    """The memory in a row of `COLUMNS`; a memory that holds has no time of its end."""
    values = dict(zip(_NAMES, row, strict=True))
    values["ended_unix_ms"] = values["ended_unix_ms"] or 0
    # The file was checked when it was written; a list of thousands is read many times faster this way.
    return MemoryEntry.model_construct(**values)
