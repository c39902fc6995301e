"""Orders to teams that were followed last, in one SQLite file: a killed process does not lose them."""

from __future__ import annotations

from typing import Final

from parley.memory.on_file import RecordStore
from parley.messages.team import MissionList

__all__ = ["MissionStore"]

_SCHEMA: Final = """
    CREATE TABLE IF NOT EXISTS missions (only INTEGER PRIMARY KEY CHECK (only = 1), record TEXT NOT NULL);
"""


class MissionStore(RecordStore):
    """Made by `open`."""

    SCHEMA = _SCHEMA
    WHAT = "missions"

    async def keep(self, missions: MissionList) -> None:
        """Keep them in the place of those that were kept; when this returns, it is durable."""
        row = (missions.model_dump_json(),)
        await self._database.run(
            lambda db: db.execute("INSERT OR REPLACE INTO missions (only, record) VALUES (1, ?)", row)
        )

    async def kept(self) -> MissionList:
        """What was kept last."""
        rows = await self._database.run(lambda db: db.execute("SELECT record FROM missions").fetchall())
        return MissionList.model_validate_json(rows[0][0]) if rows else MissionList()
