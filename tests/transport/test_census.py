"""Who is behind a bridge, asked so that its `rosapi` lives on: it ends when asked about one that is gone."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from parley.errors import UnavailableError
from parley.transport.base import Endpoint
from parley.transport.rosbridge import rosapi
from parley.transport.rosbridge.census import AT_MOST, BRIDGE, ROUND_LOOKS, Census

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
        """Nodes that were asked about."""
        self.asked: list[str] = []
        """Topics and services that were."""
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
        name = getattr(request, "topic", getattr(request, "service", ""))
        if name and service is not rosapi.SERVICE_TYPE:
            self.asked.append(name)
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


async def test_a_node_is_never_asked_about_and_forgotten_as_it_goes() -> None:
    bridge, census = Rosapi(ROBOT, "/cmd_vel"), Census()
    for _ in range(3):
        assert {HEARS, SCANS, RESETS} < await census.take(bridge.answer)
    del bridge.nodes[BASE]  # its topic stays: others talk on it
    found = await census.take(bridge.answer)
    assert not {HEARS, RESETS} & found
    assert SCANS in found
    assert not bridge.details


async def test_a_service_that_is_only_called_has_no_server_and_a_closed_one_loses_it() -> None:
    bridge, census = Rosapi(ROBOT), Census()
    bridge.called = ("/base/reset", "/lamp/on")
    found = await census.take(bridge.answer)
    assert [end.name for end in found if end.role == "server"] == ["/base/reset"]
    bridge.nodes[BASE] = rosapi.NodeDetailsResponse()
    for _ in bridge.called:
        found = await census.take(bridge.answer)
    assert RESETS not in found


async def test_what_a_known_node_opens_later_is_found_by_its_topic() -> None:
    bridge, census = Rosapi({BASE: rosapi.NodeDetailsResponse()}), Census()
    await census.take(bridge.answer)
    bridge.nodes[BASE] = ROBOT[BASE]
    assert HEARS in await census.take(bridge.answer)


async def test_who_comes_to_a_topic_that_was_there_is_found_at_once() -> None:
    bridge, census = Rosapi({}, "/scan"), Census()
    await census.take(bridge.answer)
    bridge.nodes |= ROBOT
    assert SCANS in await census.take(bridge.answer)


async def test_while_nobody_comes_nothing_is_asked_again_of_topics_of_others() -> None:
    bridge, census = Rosapi(ROBOT, "/hidden"), Census()
    await census.take(bridge.answer)
    bridge.asked.clear()
    await census.take(bridge.answer)
    assert bridge.asked == ["/base/reset"]  # services in turn


async def test_a_large_robot_is_learned_look_by_look_with_own_topics_first() -> None:
    others = [f"/a_{number}" for number in range(AT_MOST)]
    bridge, census = Rosapi({LASER: rosapi.NodeDetailsResponse((), ("/scan", *others))}), Census()
    own = [Endpoint("/scan", SCANS.ros_type, "subscription")]
    assert SCANS in await census.take(bridge.answer, own)
    looks = 1
    while not census.is_settled:
        found = await census.take(bridge.answer, own)
        looks += 1
    assert {end.name for end in found} == {"/scan", *others}
    assert looks == 3


async def test_who_opens_or_closes_an_end_on_an_own_topic_is_found_within_a_round() -> None:
    nobody = rosapi.NodeDetailsResponse()
    still = {BASE: nobody, LASER: nobody}
    bridge, census = Rosapi(still, "/cmd_vel", "/scan", "/a", "/b", "/c", "/d"), Census()
    own = [Endpoint(name, "", "publisher") for name in ("/a", "/b", "/c", "/d", "/cmd_vel")]
    own.append(Endpoint("/scan", "", "subscription"))
    await census.take(bridge.answer, own)
    for nodes, there in ((ROBOT, True), (still, False)):
        bridge.nodes = dict(nodes)
        for _ in range(ROUND_LOOKS):
            found = await census.take(bridge.answer, own)
        assert (HEARS in found, SCANS in found) == (there, there)


async def test_the_node_of_the_bridge_is_asked_about_at_each_look() -> None:
    bridge, census = Rosapi({BRIDGE: rosapi.NodeDetailsResponse()}, "/scan"), Census()
    await census.take(bridge.answer)
    bridge.nodes[BRIDGE] = rosapi.NodeDetailsResponse(publishing=("/scan",))
    assert SCANS in await census.take(bridge.answer)
