"""Plans that wait for a person's yes, in one SQLite file, so that a killed process does not lose them."""

from __future__ import annotations

from typing import Final

from pydantic import BaseModel, ConfigDict

from parley.memory.on_file import RecordStore
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
    repairs: str = ""
    """Name of the action that failed, in whose place it would be done; empty if it is no repair."""
    unix_ms: int = 0
    """When it was proposed."""
    place: PoseInfo | None = None
    """Where the robot was then."""


class ProposalStore(RecordStore):
    """Made by `open`."""

    SCHEMA = _SCHEMA
    WHAT = "proposals"

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
