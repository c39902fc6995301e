"""The records of failures, in one SQLite file: what happened, what was tried, how it ended."""

from __future__ import annotations

import sqlite3
from pathlib import Path
from types import TracebackType
from typing import Final, Self

from parley.clock import Clock
from parley.memory.database import Database
from parley.messages.incident import Incident

__all__ = ["KEPT", "IncidentStore"]

KEPT: Final = 1000
"""Older records are dropped."""

_SCHEMA: Final = """
    CREATE TABLE IF NOT EXISTS incident (
        number INTEGER PRIMARY KEY AUTOINCREMENT, id TEXT NOT NULL UNIQUE, robot TEXT NOT NULL,
        ending TEXT NOT NULL, record TEXT NOT NULL
    );
    CREATE INDEX IF NOT EXISTS incident_robot ON incident (robot);
    CREATE INDEX IF NOT EXISTS incident_open ON incident (id) WHERE ending = 'open';
"""


class IncidentStore:
    """Made by `open`; all methods raise `parley.errors.StoreError` when the file cannot be used."""

    def __init__(self, database: Database) -> None:
        self._database = database

    @classmethod
    async def open(cls, path: Path | str, clock: Clock) -> Self:
        """Open or create the file; use as ``async with await IncidentStore.open(...)``.

        A damaged file is put aside and a new one begun.

        Args:
            path: The file, or ``:memory:`` for records that end with the process.
            clock: For the name of a damaged file.

        Raises:
            StoreError: The file cannot be created, read or written.
        """
        database = await Database.open(path, prepare=_prepare, unix_ms=clock.unix_ms(), what="incidents")
        return cls(database)

    async def __aenter__(self) -> Self:
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        await self.close()

    async def close(self) -> None:
        """Close the file. Idempotent."""
        await self._database.close()

    async def save(self, incident: Incident) -> None:
        """Keep `incident` in place of its earlier form; when this returns, it is durable."""
        await self._database.run(lambda db: _save(db, incident))

    async def newest(self, robot: str = "", limit: int = 100) -> tuple[Incident, ...]:
        """The newest records first; of one robot (whatever its capitals), or of all if `robot` is empty."""
        return await self._database.run(
            lambda db: _read(
                db,
                "WHERE :robot = '' OR robot = :robot COLLATE NOCASE ORDER BY number DESC LIMIT :limit",
                robot=robot,
                limit=limit,
            )
        )

    async def still_open(self) -> tuple[Incident, ...]:
        """Records that no end was written to, oldest first."""
        return await self._database.run(lambda db: _read(db, "WHERE ending = 'open' ORDER BY number"))


def _prepare(db: sqlite3.Connection) -> None:
    db.executescript(_SCHEMA)


def _save(db: sqlite3.Connection, incident: Incident) -> None:
    db.execute("BEGIN IMMEDIATE")
    try:
        db.execute(
            """
            INSERT INTO incident (id, robot, ending, record) VALUES (?, ?, ?, ?)
            ON CONFLICT (id) DO UPDATE SET ending = excluded.ending, record = excluded.record
            """,
            (incident.id, incident.robot, incident.ending, incident.model_dump_json()),
        )
        db.execute(
            """
            DELETE FROM incident WHERE number <= (
                SELECT number FROM incident ORDER BY number DESC LIMIT 1 OFFSET ?
            )
            """,
            (KEPT,),
        )
        db.execute("COMMIT")
    except BaseException:
        db.execute("ROLLBACK")
        raise


def _read(db: sqlite3.Connection, where: str, **values: str | int) -> tuple[Incident, ...]:
    rows = db.execute(f"SELECT record FROM incident {where}", values)
    return tuple(Incident.model_validate_json(record) for (record,) in rows)
