"""Who is there behind a bridge, as far as its `rosapi` tells."""

from __future__ import annotations

from collections.abc import Iterable

import structlog

from parley.errors import TransportError, UnavailableError
from parley.transport.base import Endpoint
from parley.transport.graph import EndpointGraph
from parley.transport.rosbridge.census import Ask, Census

__all__ = ["Graph"]

log = structlog.get_logger(__name__)


class Graph(EndpointGraph):
    """Own ends at once, those of others whenever `look` was at the bridge. Used on the loop only."""

    def __init__(self) -> None:
        super().__init__()
        self._own: list[Endpoint] = []
        self._seen: frozenset[Endpoint] = frozenset()
        self._census = Census()
        self._changes = 0
        self.known = False
        """Whether the bridge tells who is there; not without `rosapi`, which the log says once."""
        self._is_told = False

    @property
    def is_settled(self) -> bool:
        """See `Census.is_settled`."""
        return self._census.is_settled

    def ends(self) -> Iterable[Endpoint]:
        """See `EndpointGraph.ends`; an end that others have as well counts as ours: no bridge tells."""
        return frozenset(self._own).union(self._seen)

    def add_own(self, end: Endpoint) -> None:
        """An end of this process is open."""
        self._own.append(end)
        self.changed()

    def remove_own(self, end: Endpoint) -> None:
        """An end of this process is closed; if others have the same, the next look shows it."""
        self._own.remove(end)
        self._changes += 1
        if end not in self._own:
            self._seen -= {end}
        self.changed()

    def lost(self) -> None:
        """The bridge is gone, and with it everybody else."""
        self.known, self._is_told, self._changes = False, False, self._changes + 1
        self._census = Census()
        self._see(frozenset())

    async def look(self, ask: Ask) -> None:
        """Ask the bridge who is there."""
        changes = self._changes
        try:
            found = await self._census.take(ask, frozenset(self._own))
        except UnavailableError:
            if not self._is_told:
                log.info("the bridge does not tell who is there: its rosapi node does not run")
            self.known, self._is_told, found = False, True, frozenset()
            self._census = Census()
        except TransportError as error:  # it was asked too much, or went: the next look is soon
            log.info("the bridge did not tell who is there", why=str(error))
            return
        else:
            self.known, self._is_told = True, False
        if changes == self._changes:
            self._see(found)

    def _see(self, seen: frozenset[Endpoint]) -> None:
        if seen != self._seen:
            self._seen = seen
            self.changed()
