"""Who is there behind a bridge, asked of its `rosapi` so that `rosapi` lives on."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable, Iterable, Sequence, Set
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
"""The node of a bridge, in which the ends of all its clients are. It alone is asked what it has: as it goes,
so does the connection."""

ROUND_LOOKS: Final = 5
"""Within so many looks, who is at the other side of each end of this process is asked again."""
AT_MOST: Final = 64
"""So many names are asked about in one look."""
SIDE_BY_SIDE: Final = 4

_PARTS: Final = ("send_goal", "cancel_goal", "get_result")
_OTHER_SIDE: Final = {"publisher": "subscription", "subscription": "publisher"}
_ROSAPI: Final = "/rosapi/"
_OF_A_NODE: Final = frozenset({
    "describe_parameters", "get_loggers", "get_logger_levels", "get_parameter_types", "get_parameters",
    "get_type_description", "list_parameters", "set_logger_level", "set_logger_levels", "set_parameters",
    "set_parameters_atomically",
})  # fmt: skip
"""How services are called that a node of ROS has as long as it lives; these are there if they are listed."""

Side = tuple[str, str]
"""Name of a topic or service, and the role of who has it."""


class Census:
    """Asks at each look what exists, and by name who has it.

    `rosapi` of ROS 2 ends as a whole when it is asked for the details of a node that has gone since it was
    listed (rosbridge_suite, issue 865). For a topic or service it looks through the nodes itself, at once.
    """

    def __init__(self) -> None:
        self._nodes: Set[str] = frozenset()
        self._held: dict[Side, Set[str]] = {}
        """Which nodes beside the bridge are there, as was told last; who left since is taken out."""
        self._owed: Set[Side] = frozenset()
        self._looks = 0
        self._service_types: dict[str, str] = {}

    @property
    def is_settled(self) -> bool:
        """Whether all was asked since somebody came; if not, the next look should be soon."""
        return not self._owed

    async def take(self, ask: Ask, own: Iterable[Endpoint] = ()) -> frozenset[Endpoint]:
        """Look once; `own` are the ends of this process.

        Raises:
            TransportError: `rosapi` did not answer; `UnavailableError` if it is not there.
        """
        told = await ask(TOPICS, TopicsRequest())
        types = {
            name: _long(ros_type, "msg") for name, ros_type in zip(told.topics, told.types, strict=False)
        }
        services = await self._services(ask)
        lasting = {(name, "server") for name in services if _lives_with_its_node(name)}
        closable = {(name, "server") for name in services} - lasting
        sides = {(name, role) for name in types for role in _OTHER_SIDE} | closable
        self._compare(frozenset((await ask(NODES, NodesRequest())).nodes), sides)
        mine = {(end.name, _OTHER_SIDE[end.role]) for end in own if end.role in _OTHER_SIDE} & sides
        await self._ask_about(self._due(sorted(mine), sorted(closable)), ask)
        self._looks += 1
        there = {side for side, nodes in self._held.items() if nodes} | await self._bridged(ask) | lasting
        ends = {
            Endpoint(name, (services if role == "server" else types).get(name, ""), role, True)
            for name, role in there
        }
        actions = await _actions(ask)
        return frozenset(
            ends
            | {Endpoint(f"{name}/_action/{part}", "", "server", True) for name in actions for part in _PARTS}
        )

    def _compare(self, nodes: Set[str], sides: Set[Side]) -> None:
        """Forget what went; whoever came may have opened anything."""
        self._held = {side: who & nodes for side, who in self._held.items() if side in sides}
        self._owed = (self._owed & sides) | (sides - self._held.keys()) if nodes <= self._nodes else sides
        self._nodes = nodes

    def _due(self, mine: Sequence[Side], closable: Sequence[Side]) -> Sequence[Side]:
        """What to ask about now: what is owed, some of the other sides of own ends, and a service."""
        owed = [*(side for side in mine if side in self._owed), *sorted(self._owed)]
        turn = [*mine[self._looks % ROUND_LOOKS :: ROUND_LOOKS]]
        if closable:
            turn.append(closable[self._looks % len(closable)])
        return list(dict.fromkeys([*owed, *turn]))[:AT_MOST]

    async def _ask_about(self, sides: Sequence[Side], ask: Ask) -> None:
        for at in range(0, len(sides), SIDE_BY_SIDE):
            some = sides[at : at + SIDE_BY_SIDE]
            answers = await asyncio.gather(*(_who(name, role, ask) for name, role in some))
            self._held |= zip(some, answers, strict=True)
            self._owed -= set(some)

    async def _bridged(self, ask: Ask) -> set[Side]:
        """What the bridge has for its clients."""
        sides = set[Side]()
        for node in self._nodes:
            if node.startswith(BRIDGE):
                has = await ask(NODE_DETAILS, NodeDetailsRequest(node))
                sides |= {(name, "publisher") for name in has.publishing}
                sides |= {(name, "subscription") for name in has.subscribing}
                sides |= {(name, "server") for name in has.services}
        return sides

    async def _services(self, ask: Ask) -> dict[str, str]:
        """The type of each that is listed: somebody answers it, or only calls it."""
        listed = (await ask(SERVICES, ServicesRequest())).services
        for name in listed:
            if name not in self._service_types:
                told = (await ask(SERVICE_TYPE, ServiceTypeRequest(name))).type
                self._service_types[name] = _long(told, "srv")
        self._service_types = {name: self._service_types[name] for name in listed}
        return self._service_types


async def _who(name: str, role: str, ask: Ask) -> Set[str]:
    """Which nodes beside the bridge have it."""
    if role == "publisher":
        nodes = (await ask(PUBLISHERS, PublishersRequest(name))).publishers
    elif role == "subscription":
        nodes = (await ask(SUBSCRIBERS, SubscribersRequest(name))).subscribers
    else:
        nodes = ((await ask(SERVICE_NODE, ServiceNodeRequest(name))).node,)
    return {node for node in nodes if node and not node.startswith(BRIDGE)}


def _lives_with_its_node(service: str) -> bool:
    return service.startswith(_ROSAPI) or service.rpartition("/")[2] in _OF_A_NODE


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
