"""Plans that wait for a person's yes, in one SQLite file, so that a killed process does not lose them."""

from __future__ import annotations

import sqlite3
from pathlib import Path
from types import TracebackType
from typing import Final, Self

from pydantic import BaseModel, ConfigDict

from parley.clock import Clock
from parley.memory.database import Database
from parley.messages.status import PlanProposal, PoseInfo

__all__ = ["KeptProposal", "ProposalStore"]

_SCHEMA: Final = """
    CREATE TABLE IF NOT EXISTS proposal (
        number INTEGER PRIMARY KEY AUTOINCREMENT, id TEXT NOT NULL UNIQUE, record TEXT NOT NULL
    );
"""


class KeptProposal(BaseModel):
    """A proposal and what has to be known to go on with it in another process."""

    model_config = ConfigDict(frozen=True)

    proposal: PlanProposal
    agreed: str = ""
    """What the robot says when it begins."""
    repairs: str = ""
    """Name of the action that failed, in whose place it would be done; empty if it is no repair."""
    unix_ms: int = 0
    """When it was proposed."""
    place: PoseInfo | None = None
    """Where the robot was then."""


class ProposalStore:
    """Made by `open`; all methods raise `parley.errors.StoreError` when the file cannot be used."""

    def __init__(self, database: Database) -> None:
        self._database = database

    @classmethod
    async def open(cls, path: Path | str, clock: Clock) -> Self:
        """Open or create the file; use as ``async with await ProposalStore.open(...)``.

        A damaged file is put aside and a new one begun.

        Args:
            path: The file, or ``:memory:`` for proposals that end with the process.
            clock: For the name of a damaged file.

        Raises:
            StoreError: The file cannot be created, read or written.
        """
        database = await Database.open(path, prepare=_prepare, unix_ms=clock.unix_ms(), what="proposals")
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

    async def keep(self, kept: KeptProposal) -> None:
        """Keep a proposal; when this returns, it is durable."""
        row = (kept.proposal.id, kept.model_dump_json())
        await self._database.run(
            lambda db: db.execute("INSERT OR REPLACE INTO proposal (id, record) VALUES (?, ?)", row)
        )

    async def drop(self, identity: str) -> None:
        """Forget a proposal that was decided about."""
        await self._database.run(lambda db: db.execute("DELETE FROM proposal WHERE id = ?", (identity,)))

    async def waiting(self) -> tuple[KeptProposal, ...]:
        """What waits, oldest first."""
        rows = await self._database.run(
            lambda db: db.execute("SELECT record FROM proposal ORDER BY number").fetchall()
        )
        return tuple(KeptProposal.model_validate_json(record) for (record,) in rows)


def _prepare(db: sqlite3.Connection) -> None:
    db.executescript(_SCHEMA)
