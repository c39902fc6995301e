"""How a memory stands in its table."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, Final

from parley.messages.memory import MemoryEntry

__all__ = ["COLUMNS", "read_entry"]

COLUMNS: Final = "name, scope, type, data, info, source, created_unix_ms, updated_unix_ms"
"""What `read_entry` wants selected, in this order."""


def read_entry(row: Iterable[Any]) -> MemoryEntry:
    """The memory in a row of `COLUMNS`."""
    return MemoryEntry(**dict(zip(COLUMNS.split(", "), row, strict=True)))
