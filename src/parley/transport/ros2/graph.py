"""Who is there in ROS, as far as its nodes tell."""

from __future__ import annotations

import asyncio
from collections.abc import Collection, Iterable, Iterator
from typing import Any

from parley.transport.base import Endpoint
from parley.transport.graph import EndpointGraph

__all__ = ["Graph"]


class Graph(EndpointGraph):
    """Own ends at once, those of other nodes whenever `look` was there. Used on the loop only."""

    def __init__(self) -> None:
        super().__init__()
        self._own: list[Endpoint] = []
        self._seen: list[Endpoint] = []
        self._names: dict[str, str] = {}
        self._looks = self._newest = 0

    def ends(self) -> Iterable[Endpoint]:
        """See `EndpointGraph.ends`."""
        return (*self._seen, *self._own)

    def calls(self, resolved: str, name: str) -> None:
        """What ROS calls `resolved` is `name` here: its user may have changed it."""
        self._names[resolved] = name

    def add_own(self, end: Endpoint) -> None:
        """An end of this node is open."""
        self._own.append(end)
        self.changed()

    def remove_own(self, end: Endpoint) -> None:
        """An end of this node is closed."""
        self._own.remove(end)
        self.changed()

    async def look(self, node: Any, ours: Collection[Name]) -> None:
        """See which ends nodes of others have.

        Args:
            node: One of ours.
            ours: Names of all of ours.
        """
        self._looks += 1
        number = self._looks
        found = await asyncio.to_thread(lambda: sorted(_ends_of_others(node, ours)))
        if number > self._newest:
            self._newest = number
            seen = [
                Endpoint(self._names.get(name, name), ros_type, role, elsewhere=True)
                for name, ros_type, role in found
            ]
            if seen != self._seen:
                self._seen = seen
                self.changed()


Name = tuple[str, str]
"""Of a node: its own, and its namespace."""


def _ends_of_others(node: Any, ours: Collection[Name]) -> Iterator[tuple[str, str, str]]:
    """Name, type and role of each end."""
    ways = (
        (node.get_publisher_names_and_types_by_node, "publisher"),
        (node.get_subscriber_names_and_types_by_node, "subscription"),
        (node.get_service_names_and_types_by_node, "server"),
    )
    for other in set(node.get_node_names_and_namespaces()).difference(ours):
        for ask, role in ways:
            try:
                told = ask(*other)
            except RuntimeError:  # it went meanwhile
                break
            yield from ((name, ros_type, role) for name, types in told for ros_type in types)
