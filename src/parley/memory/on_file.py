"""What all stores in a SQLite file of their own have in common: opening, closing, `async with`."""

from __future__ import annotations

import sqlite3
from pathlib import Path
from types import TracebackType
from typing import ClassVar, Self

from parley.clock import Clock
from parley.memory.database import Database

__all__ = ["OnFile", "RecordStore"]


class OnFile:
    """Closes its file at the end of ``async with``."""

    def __init__(self, database: Database) -> None:
        self._database = database

    @property
    def notice(self) -> str:
        """What people should know about the file, in plain words; usually empty."""
        return self._database.notice

    async def __aenter__(self) -> Self:
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        await self.close()

    async def close(self) -> None:
        """Close the file. Idempotent."""
        await self._database.close()


class RecordStore(OnFile):
    """One table of records, made by `open`.

    All methods raise `parley.errors.StoreError` when the file cannot be used.
    """

    SCHEMA: ClassVar[str]
    """Makes the table if it is missing."""
    WHAT: ClassVar[str]
    """What is kept, in plain words."""

    @classmethod
    async def open(cls, path: Path | str, clock: Clock) -> Self:
        """Open or create the file; use as ``async with await RecordStore.open(...)``.

        Of a damaged file what can be read is kept; see `notice`.

        Args:
            path: The file, or ``:memory:`` for records that end with the process.
            clock: For the name of a damaged file.

        Raises:
            StoreError: The file cannot be created, read or written.
        """

        def prepare(db: sqlite3.Connection) -> None:
            db.executescript(cls.SCHEMA)

        return cls(await Database.open(path, prepare=prepare, unix_ms=clock.unix_ms(), what=cls.WHAT))
