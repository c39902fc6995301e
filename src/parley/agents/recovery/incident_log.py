"""Incidents on their way to the file: each change is announced at once and written soon after, in order."""

from __future__ import annotations

import asyncio

import structlog

from parley.clock import Clock
from parley.errors import StoreError
from parley.memory.incidents import IncidentStore
from parley.messages.incident import Incident, IncidentList

__all__ = ["UNSETTLED", "IncidentLog"]

log = structlog.get_logger(__name__)

UNSETTLED = "The program was ended before this was settled."


class IncidentLog:
    """Writes behind what happens; a newer form of a record takes the place of one that still waits.

    A full disk is logged, and no reason to leave a robot without help.

    Args:
        store: The open file; its owner closes it.
        clock: For the time at which left-over records are closed.
    """

    def __init__(self, store: IncidentStore, clock: Clock) -> None:
        self._store, self._clock = store, clock
        self._waiting: dict[str, Incident] = {}
        self._writer: asyncio.Task[None] | None = None

    async def settle_left_over(self) -> list[Incident]:
        """Close what an earlier process left open, and return it: nobody works on it any more."""
        settled: list[Incident] = []
        try:
            for incident in await self._store.still_open():
                changes = {
                    "ending": "cancelled", "closed_unix_ms": self._clock.unix_ms(), "note": UNSETTLED,
                }  # fmt: skip
                await self._store.save(incident.model_copy(update=changes))
                settled.append(incident)
        except StoreError as error:
            log.error("incidents not settled", problem=str(error))
        return settled

    def write(self, incident: Incident) -> None:
        """Keep `incident` in place of its earlier form."""
        self._waiting[incident.id] = incident
        if self._writer is None or self._writer.done():
            self._writer = asyncio.create_task(self._write(), name="incidents")

    async def newest(self, robot: str, limit: int) -> IncidentList:
        """The newest records, what still waits to be written included.

        Raises:
            StoreError: The file cannot be read.
        """
        await self.flush()
        return IncidentList(incidents=await self._store.newest(robot, limit))

    async def flush(self) -> None:
        """Wait until everything is written."""
        if self._writer is not None:
            await asyncio.shield(self._writer)

    async def _write(self) -> None:
        while self._waiting:
            incident = self._waiting.pop(next(iter(self._waiting)))
            try:
                await self._store.save(incident)
            except StoreError as error:
                log.error("incident not written", id=incident.id, problem=str(error))
