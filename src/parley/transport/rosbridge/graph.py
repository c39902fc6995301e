"""Who is there behind a bridge, as far as its `rosapi` tells."""

from __future__ import annotations

from collections.abc import Awaitable, Callable, Iterable
from typing import Any, Final

import structlog

from parley.errors import TransportError, UnavailableError
from parley.messages.topics import Service
from parley.transport.base import Endpoint
from parley.transport.graph import EndpointGraph
from parley.transport.rosbridge.rosapi import (
    ACTION_SERVERS,
    NODE_DETAILS,
    NODES,
    SERVICE_TYPE,
    TOPICS,
    ActionServersRequest,
    NodeDetailsRequest,
    NodesRequest,
    ServiceTypeRequest,
    TopicsRequest,
)

__all__ = ["Graph"]

Ask = Callable[[Service[Any, Any], Any], Awaitable[Any]]

_PARTS: Final = ("send_goal", "cancel_goal", "get_result")

log = structlog.get_logger(__name__)


class Graph(EndpointGraph):
    """Own ends at once, those of others whenever `look` was at the bridge. Used on the loop only."""

    def __init__(self) -> None:
        super().__init__()
        self._own: list[Endpoint] = []
        self._seen: frozenset[Endpoint] = frozenset()
        self._service_types: dict[str, str] = {}
        self._changes = 0
        self.known = False
        """Whether the bridge tells who is there; not without `rosapi`, which the log says once."""
        self._is_told = False

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
        self._service_types.clear()
        self._see(frozenset())

    async def look(self, ask: Ask) -> None:
        """Ask the bridge who is there."""
        changes = self._changes
        try:
            found = await self._find(ask)
        except UnavailableError:
            if not self._is_told:
                log.info("the bridge does not tell who is there: its rosapi node does not run")
            self.known, self._is_told, found = False, True, frozenset()
        except TransportError as error:  # it was asked too much, or went: the next look is soon
            log.info("the bridge did not tell who is there", why=str(error))
            return
        else:
            self.known, self._is_told = True, False
        if changes == self._changes:
            self._see(found)

    async def _find(self, ask: Ask) -> frozenset[Endpoint]:
        told = await ask(TOPICS, TopicsRequest())
        types = {
            name: _long(ros_type, "msg") for name, ros_type in zip(told.topics, told.types, strict=False)
        }
        ends: set[Endpoint] = set()
        for node in (await ask(NODES, NodesRequest())).nodes:
            has = await ask(NODE_DETAILS, NodeDetailsRequest(node))
            ends.update(_ends(has.publishing, types, "publisher"))
            ends.update(_ends(has.subscribing, types, "subscription"))
            for service in has.services:
                if service not in self._service_types:
                    told_type = (await ask(SERVICE_TYPE, ServiceTypeRequest(service))).type
                    self._service_types[service] = _long(told_type, "srv")
            ends.update(_ends(has.services, self._service_types, "server"))
        try:
            actions = (await ask(ACTION_SERVERS, ActionServersRequest())).action_servers
        except UnavailableError:  # ROS 1 has none
            actions = ()
        ends.update(
            Endpoint(f"{name}/_action/{part}", "", "server", True) for name in actions for part in _PARTS
        )
        gone = self._service_types.keys() - {end.name for end in ends if end.role == "server"}
        for name in gone:
            del self._service_types[name]
        return frozenset(ends)

    def _see(self, seen: frozenset[Endpoint]) -> None:
        if seen != self._seen:
            self._seen = seen
            self.changed()


def _ends(names: Iterable[str], types: dict[str, str], role: str) -> set[Endpoint]:
    return {Endpoint(name, types.get(name, ""), role, True) for name in names}


def _long(ros_type: str, kind: str) -> str:
    """A type's name as ROS 2 has it: `std_msgs/String` is `std_msgs/msg/String`."""
    package, _, name = ros_type.partition("/")
    return ros_type if "/" in name or not name else f"{package}/{kind}/{name}"
