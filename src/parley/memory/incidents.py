"""The records of failures, in one SQLite file: what happened, what was tried, how it ended."""

from __future__ import annotations

import sqlite3
from typing import Final

from parley.memory.on_file import RecordStore
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


class IncidentStore(RecordStore):
    """Made by `open`."""

    SCHEMA = _SCHEMA
    WHAT = "incidents"

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
