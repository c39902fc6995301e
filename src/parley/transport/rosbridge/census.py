"""Who is there behind a bridge, asked of its `rosapi` so that `rosapi` lives on."""

from __future__ import annotations

from collections.abc import Awaitable, Callable, Iterable, Set
from typing import Any, Final

from parley.errors import UnavailableError
from parley.messages.topics import Service
from parley.transport.base import Endpoint
from parley.transport.rosbridge.rosapi import (
    ACTION_SERVERS,
    NODE_DETAILS,
    NODES,
    PUBLISHERS,
    SERVICE_NODE,
    SERVICE_TYPE,
    SERVICES,
    SUBSCRIBERS,
    TOPICS,
    ActionServersRequest,
    NodeDetailsRequest,
    NodesRequest,
    PublishersRequest,
    ServiceNodeRequest,
    ServicesRequest,
    ServiceTypeRequest,
    SubscribersRequest,
    TopicsRequest,
)

__all__ = ["BRIDGE", "Ask", "Census"]

Ask = Callable[[Service[Any, Any], Any], Awaitable[Any]]

BRIDGE: Final = "/rosbridge_websocket"
"""The node of a bridge, in which the ends of all its clients are. It may be asked about always: as it
goes, so does the connection."""

ROUND_LOOKS: Final = 5
"""Within so many looks, who is at the other side of each end of this process is asked."""

_PARTS: Final = ("send_goal", "cancel_goal", "get_result")
_OTHER_SIDE: Final = {"publisher": "subscription", "subscription": "publisher"}
_ROSAPI: Final = "/rosapi/"
_OF_A_NODE: Final = frozenset({
    "describe_parameters", "get_loggers", "get_logger_levels", "get_parameter_types", "get_parameters",
    "get_type_description", "list_parameters", "set_logger_level", "set_logger_levels", "set_parameters",
    "set_parameters_atomically",
})  # fmt: skip
"""How services are called that a node of ROS has as long as it lives."""


class Census:
    """Asks at each look for what exists, and as little as possible for who has it.

    `rosapi` of ROS 2 ends as a whole when it is asked for the details of a node that has just gone
    (rosbridge_suite, issue 865). The lists of topics, services and nodes name no node, so that nothing
    happens to it. Each node is asked about once, after two looks that found it; what it opens later is
    found by asking about topics: for these `rosapi` looks through the nodes itself, in one go.
    """

    def __init__(self) -> None:
        self._nodes: frozenset[str] = frozenset()
        self._asked: set[str] = set()
        self._held: dict[str, dict[str, set[str]]] = {"publisher": {}, "subscription": {}, "server": {}}
        """By role, and name of topic or service: which nodes have it."""
        self._nobodys: dict[str, Set[str]] = {"topic": set(), "service": set()}
        """Names for which `rosapi` names nobody: of hidden nodes, or services that are only called."""
        self._looks = 0
        self._service_types: dict[str, str] = {}

    @property
    def is_settled(self) -> bool:
        """Whether every node was asked about; if not, the next look should be soon."""
        return self._nodes <= self._asked

    async def take(self, ask: Ask, own: Iterable[Endpoint] = ()) -> frozenset[Endpoint]:
        """Look once; `own` are the ends of this process.

        Raises:
            TransportError: `rosapi` did not answer; `UnavailableError` if it is not there.
        """
        told = await ask(TOPICS, TopicsRequest())
        types = {
            name: _long(ros_type, "msg") for name, ros_type in zip(told.topics, told.types, strict=False)
        }
        services = frozenset((await ask(SERVICES, ServicesRequest())).services)
        actions = await _actions(ask)
        await self._learn_types(services, ask)
        await self._ask_about_nodes(ask)
        self._forget_all_but(types.keys(), services)
        for name, role in self._in_turn(services, own):
            await self._ask_who(name, role, ask)
        if self.is_settled:  # what still is nobody's, a node opened after it was asked about
            await self._ask_whose("topic", types.keys(), ask)
            await self._ask_whose("service", services, ask)
        self._looks += 1
        types |= self._service_types
        ends = {
            Endpoint(name, types.get(name, ""), role, True)
            for role, held in self._held.items()
            for name, nodes in held.items()
            if nodes
        }
        ends |= {
            Endpoint(f"{name}/_action/{part}", "", "server", True) for name in actions for part in _PARTS
        }
        return frozenset(ends)

    async def _ask_about_nodes(self, ask: Ask) -> None:
        before, self._nodes = self._nodes, frozenset((await ask(NODES, NodesRequest())).nodes)
        self._asked &= self._nodes
        for held in self._held.values():
            for nodes in held.values():
                nodes &= self._nodes
        for node in sorted(self._nodes):
            if node.startswith(BRIDGE) or node in before - self._asked:
                has = await ask(NODE_DETAILS, NodeDetailsRequest(node))
                self._note(node, "publisher", has.publishing)
                self._note(node, "subscription", has.subscribing)
                self._note(node, "server", has.services)
                self._asked.add(node)

    def _note(self, node: str, role: str, names: Iterable[str]) -> None:
        held = self._held[role]
        for nodes in held.values():
            nodes.discard(node)
        for name in names:
            held.setdefault(name, set()).add(node)

    def _forget_all_but(self, topics: Set[str], services: Set[str]) -> None:
        for role, held in self._held.items():
            there = services if role == "server" else topics
            self._held[role] = {name: nodes for name, nodes in held.items() if name in there}
        self._nobodys = {
            "topic": self._nobodys["topic"] & topics,
            "service": self._nobodys["service"] & services,
        }

    def _in_turn(self, services: Set[str], own: Iterable[Endpoint]) -> Iterable[tuple[str, str]]:
        """Names with the role of whom to ask for: some at the other side of own ends, and a service."""
        sides = sorted({(end.name, _OTHER_SIDE[end.role]) for end in own if end.role in _OTHER_SIDE})
        yield from sides[self._looks % ROUND_LOOKS :: ROUND_LOOKS]
        closable = sorted(
            name
            for name in services
            if name.rpartition("/")[2] not in _OF_A_NODE and not name.startswith(_ROSAPI)
        )
        if closable:
            yield closable[self._looks % len(closable)], "server"

    async def _ask_whose(self, kind: str, names: Set[str], ask: Ask) -> None:
        roles = ("server",) if kind == "service" else ("publisher", "subscription")
        known = {name for role in roles for name, nodes in self._held[role].items() if nodes}
        for name in sorted(names - known - self._nobodys[kind]):
            if not any([await self._ask_who(name, role, ask) for role in roles]):
                self._nobodys[kind] |= {name}

    async def _ask_who(self, name: str, role: str, ask: Ask) -> bool:
        """Whether somebody has it."""
        if role == "publisher":
            nodes = set((await ask(PUBLISHERS, PublishersRequest(name))).publishers)
        elif role == "subscription":
            nodes = set((await ask(SUBSCRIBERS, SubscribersRequest(name))).subscribers)
        else:
            nodes = {(await ask(SERVICE_NODE, ServiceNodeRequest(name))).node} - {""}
        self._held[role][name] = nodes
        return bool(nodes)

    async def _learn_types(self, services: frozenset[str], ask: Ask) -> None:
        self._service_types = {
            name: ros_type for name, ros_type in self._service_types.items() if name in services
        }
        for name in services - self._service_types.keys():
            told = (await ask(SERVICE_TYPE, ServiceTypeRequest(name))).type
            self._service_types[name] = _long(told, "srv")


async def _actions(ask: Ask) -> tuple[str, ...]:
    try:
        told: tuple[str, ...] = (await ask(ACTION_SERVERS, ActionServersRequest())).action_servers
    except UnavailableError:  # ROS 1 has none
        return ()
    return told


def _long(ros_type: str, kind: str) -> str:
    """A type's name as ROS 2 has it: `std_msgs/String` is `std_msgs/msg/String`."""
    package, _, name = ros_type.partition("/")
    return ros_type if "/" in name or not name else f"{package}/{kind}/{name}"
