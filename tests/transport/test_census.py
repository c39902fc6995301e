"""Who is behind a bridge, asked so that its `rosapi` lives on: it ends when asked about one that is gone."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from parley.errors import UnavailableError
from parley.transport.base import Endpoint
from parley.transport.rosbridge import rosapi
from parley.transport.rosbridge.census import BRIDGE, ROUND_LOOKS, Census

BASE, LASER = "/base", "/laser"
ROBOT = {
    BASE: rosapi.NodeDetailsResponse(("/cmd_vel",), ("/odom",), ("/base/reset",)),
    LASER: rosapi.NodeDetailsResponse(publishing=("/scan",)),
}
HEARS = Endpoint("/cmd_vel", "std_msgs/msg/String", "subscription")
RESETS = Endpoint("/base/reset", "std_srvs/srv/Empty", "server")
SCANS = Endpoint("/scan", "std_msgs/msg/String", "publisher")


class Rosapi:
    """That of ROS 2, as long as it lives."""

    def __init__(self, nodes: dict[str, rosapi.NodeDetailsResponse], *topics: str) -> None:
        self.nodes, self.hidden, self.alive = dict(nodes), set(topics), True
        self.called: tuple[str, ...] = ()
        """Services that somebody calls, and perhaps nobody answers."""
        self.details: list[str] = []
        self.topics: list[str] = []
        """What was asked about."""
        self._answers: dict[Any, Callable[[Any], Any]] = {
            rosapi.TOPICS: self._topics,
            rosapi.SERVICES: lambda _: rosapi.ServicesResponse(
                (*self.called, *(name for has in self.nodes.values() for name in has.services))
            ),
            rosapi.SERVICE_NODE: lambda request: rosapi.ServiceNodeResponse(
                next((node for node, has in self.nodes.items() if request.service in has.services), "")
            ),
            rosapi.SERVICE_TYPE: lambda _: rosapi.ServiceTypeResponse("std_srvs/Empty"),
            rosapi.NODES: lambda _: rosapi.NodesResponse(tuple(self.nodes)),
            rosapi.NODE_DETAILS: self._details,
            rosapi.PUBLISHERS: lambda request: rosapi.PublishersResponse(
                tuple(node for node, has in self.nodes.items() if request.topic in has.publishing)
            ),
            rosapi.SUBSCRIBERS: lambda request: rosapi.SubscribersResponse(
                tuple(node for node, has in self.nodes.items() if request.topic in has.subscribing)
            ),
        }

    async def answer(self, service: Any, request: Any) -> Any:
        if not self.alive or service not in self._answers:
            raise UnavailableError("nobody answers")
        if hasattr(request, "topic"):
            self.topics.append(request.topic)
        return self._answers[service](request)

    def _topics(self, _: Any) -> rosapi.TopicsResponse:
        ends = [name for has in self.nodes.values() for name in (*has.publishing, *has.subscribing)]
        topics = tuple({*ends, *self.hidden})
        return rosapi.TopicsResponse(topics, ("std_msgs/String",) * len(topics))

    def _details(self, request: rosapi.NodeDetailsRequest) -> rosapi.NodeDetailsResponse:
        self.details.append(request.node)
        self.alive = request.node in self.nodes
        if not self.alive:
            raise UnavailableError("rosapi ended")
        return self.nodes[request.node]


async def test_a_node_is_asked_about_once_when_it_stays_and_forgotten_as_it_goes() -> None:
    bridge, census = Rosapi(ROBOT, "/cmd_vel"), Census()
    assert not {HEARS, SCANS} & await census.take(bridge.answer)
    assert not bridge.details
    assert not census.is_settled
    for _ in range(3):
        assert {HEARS, SCANS, RESETS} < await census.take(bridge.answer)
    assert census.is_settled
    assert bridge.details == [BASE, LASER]
    del bridge.nodes[BASE]  # its topic stays: others talk on it
    found = await census.take(bridge.answer)
    assert not {HEARS, RESETS} & found
    assert SCANS in found


async def test_a_service_that_is_only_called_has_no_server_and_a_closed_one_loses_it() -> None:
    bridge, census = Rosapi(ROBOT), Census()
    bridge.called = ("/base/reset", "/lamp/on")
    for _ in range(2):
        found = await census.take(bridge.answer)
    assert [end.name for end in found if end.role == "server"] == ["/base/reset"]
    bridge.nodes[BASE] = rosapi.NodeDetailsResponse()
    for _ in bridge.called:
        found = await census.take(bridge.answer)
    assert RESETS not in found


async def test_a_node_that_comes_and_goes_is_never_asked_about() -> None:
    bridge, census = Rosapi({}), Census()
    for look in range(4):
        bridge.nodes = {f"/short_{look}": rosapi.NodeDetailsResponse(publishing=("/scan",))}
        await census.take(bridge.answer)
    assert not bridge.details


async def test_what_a_known_node_opens_later_is_found_by_its_topic() -> None:
    bridge, census = Rosapi({BASE: rosapi.NodeDetailsResponse()}), Census()
    for _ in range(2):
        await census.take(bridge.answer)
    bridge.nodes[BASE] = ROBOT[BASE]
    assert HEARS in await census.take(bridge.answer)


async def test_a_topic_of_hidden_nodes_is_asked_about_once() -> None:
    bridge, census = Rosapi({}, "/echoed"), Census()
    for _ in range(3):
        await census.take(bridge.answer)
    assert bridge.topics == ["/echoed", "/echoed"]  # publishers, subscribers


async def test_who_comes_to_or_leaves_an_own_topic_is_found_within_a_round() -> None:
    nobody = rosapi.NodeDetailsResponse()
    bridge, census = (
        Rosapi({BASE: nobody, LASER: nobody}, "/cmd_vel", "/scan", "/a", "/b", "/c", "/d"),
        Census(),
    )
    own = [Endpoint(name, "", "publisher") for name in ("/a", "/b", "/c", "/d", "/cmd_vel")]
    own.append(Endpoint("/scan", "", "subscription"))
    for _ in range(2):
        await census.take(bridge.answer, own)
    for nodes, there in ((ROBOT, True), ({BASE: nobody, LASER: nobody}, False)):
        bridge.nodes = dict(nodes)
        for _ in range(ROUND_LOOKS):
            found = await census.take(bridge.answer, own)
        assert (HEARS in found, SCANS in found) == (there, there)


async def test_the_node_of_the_bridge_is_asked_about_at_each_look() -> None:
    bridge, census = Rosapi({BRIDGE: rosapi.NodeDetailsResponse()}, "/scan"), Census()
    await census.take(bridge.answer)
    bridge.nodes[BRIDGE] = rosapi.NodeDetailsResponse(publishing=("/scan",))
    assert SCANS in await census.take(bridge.answer)
