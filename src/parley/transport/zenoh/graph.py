"""Who is there, by the tokens that all show."""

from __future__ import annotations

from collections.abc import Iterable

import structlog

from parley.transport.base import Endpoint
from parley.transport.graph import EndpointGraph
from parley.transport.zenoh.keys import endpoint_of

__all__ = ["Graph"]

log = structlog.get_logger(__name__)


class Graph(EndpointGraph):
    """Own ends at once, those of others as their tokens come and go. Used on the loop only."""

    def __init__(self) -> None:
        super().__init__()
        self._ends: dict[str, Endpoint] = {}
        self._own: set[str] = set()
        self._told: set[str] = set()

    def ends(self) -> Iterable[Endpoint]:
        """See `EndpointGraph.ends`."""
        return self._ends.values()

    def add_own(self, token: str, endpoint: Endpoint) -> None:
        """An end of this process is open; its token counts no more than this word."""
        self._own.add(token)
        self._ends[token] = endpoint
        self.changed()

    def remove_own(self, token: str) -> None:
        """An end of this process is closed. Its token may be seen a while yet, and does not count."""
        if self._ends.pop(token, None) is not None:
            self.changed()

    def seen(self, token: str, *, is_there: bool) -> None:
        """A token came or went."""
        if token in self._own:
            if not is_there:
                self._own.discard(token)
            return
        endpoint = endpoint_of(token)
        if endpoint is None or (token in self._ends) == is_there:
            return
        if is_there:
            self._tell_mismatch(endpoint)
            self._ends[token] = endpoint
        else:
            del self._ends[token]
        self.changed()

    def _tell_mismatch(self, new: Endpoint) -> None:
        """Two who use a name with different types hear nothing of each other, and nobody would know why."""
        other = self.other_type(new.name, new.ros_type, service=new.role == "server")
        if other is not None and new.name not in self._told:
            self._told.add(new.name)
            log.warning(
                "one name is in use with two types", name=new.name, types=sorted({other, new.ros_type})
            )
