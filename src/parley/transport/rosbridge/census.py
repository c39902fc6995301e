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
    SERVICE_TYPE,
    SERVICES,
    SUBSCRIBERS,
    TOPICS,
    ActionServersRequest,
    NodeDetailsRequest,
    NodesRequest,
    PublishersRequest,
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
"""Within so many looks, who else is on each topic with an end of this process is asked."""

_PARTS: Final = ("send_goal", "cancel_goal", "get_result")
_OTHER_SIDE: Final = {"publisher": "subscription", "subscription": "publisher"}


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
        self._held: dict[str, dict[str, set[str]]] = {"publisher": {}, "subscription": {}}
        """By role and topic: which nodes have it."""
        self._nobodys: set[str] = set()
        """Topics of which `rosapi` names nobody: hidden nodes have them."""
        self._turn = 0
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
        await self._ask_about_topics(types.keys(), own, ask)
        ends = _ends(services, self._service_types, "server")
        for role, held in self._held.items():
            ends |= _ends((topic for topic, nodes in held.items() if nodes), types, role)
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
                self._asked.add(node)

    def _note(self, node: str, role: str, topics: Iterable[str]) -> None:
        held = self._held[role]
        for nodes in held.values():
            nodes.discard(node)
        for topic in topics:
            held.setdefault(topic, set()).add(node)

    async def _ask_about_topics(self, topics: Set[str], own: Iterable[Endpoint], ask: Ask) -> None:
        for role, held in self._held.items():
            self._held[role] = {topic: nodes for topic, nodes in held.items() if topic in topics}
        self._nobodys &= topics
        for topic, role in self._in_turn(topics, own):
            await self._ask_about_topic(topic, role, ask)
        if not self.is_settled:
            return
        known = {topic for held in self._held.values() for topic, nodes in held.items() if nodes}
        for topic in sorted(topics - known - self._nobodys):  # a node opened it after it was asked about
            for role in self._held:
                await self._ask_about_topic(topic, role, ask)
            if not any(held[topic] for held in self._held.values()):
                self._nobodys.add(topic)

    def _in_turn(self, topics: Set[str], own: Iterable[Endpoint]) -> Iterable[tuple[str, str]]:
        """Of own topics, the next ones: each with the role at its other side."""
        sides = sorted(
            {
                (end.name, _OTHER_SIDE[end.role])
                for end in own
                if end.role in _OTHER_SIDE and end.name in topics
            }
        )
        start, count = self._turn, -(-len(sides) // ROUND_LOOKS)
        self._turn = (start + count) % max(1, len(sides))
        return (sides[at % len(sides)] for at in range(start, start + count))

    async def _ask_about_topic(self, topic: str, role: str, ask: Ask) -> None:
        if role == "publisher":
            nodes = (await ask(PUBLISHERS, PublishersRequest(topic))).publishers
        else:
            nodes = (await ask(SUBSCRIBERS, SubscribersRequest(topic))).subscribers
        self._held[role][topic] = set(nodes)

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


def _ends(names: Iterable[str], types: dict[str, str], role: str) -> set[Endpoint]:
    return {Endpoint(name, types.get(name, ""), role, True) for name in names}


def _long(ros_type: str, kind: str) -> str:
    """A type's name as ROS 2 has it: `std_msgs/String` is `std_msgs/msg/String`."""
    package, _, name = ros_type.partition("/")
    return ros_type if "/" in name or not name else f"{package}/{kind}/{name}"
