"""The backend itself. See `parley.transport.base.Transport` for the contract."""

from __future__ import annotations

import asyncio
import re
from collections.abc import Sequence
from contextlib import suppress
from types import TracebackType
from typing import Any, Final, Self, TypeVar

import structlog
from rclpy.callback_groups import ReentrantCallbackGroup

from parley.errors import UnavailableError
from parley.messages.topics import Service, Topic
from parley.transport import remote
from parley.transport.base import Endpoint, absolute
from parley.transport.failures import failure_of
from parley.transport.refusals import went_away
from parley.transport.remote import RemoteTransport
from parley.transport.ros2.ends import RosClient, RosPublisher, RosServer, RosSubscription, profile
from parley.transport.ros2.graph import Graph
from parley.transport.ros2.rosout import log_to_ros
from parley.transport.ros2.spinner import Spinner
from parley.transport.ros2.types import Codec, ros_class

__all__ = ["Ros2Transport"]

M = TypeVar("M")
_End = RosPublisher[Any] | RosSubscription[Any] | RosServer

LOOK_S: Final = 0.5

log = structlog.get_logger(__name__)


class Ros2Transport(RemoteTransport[Graph]):
    """One node in the ROS 2 that is sourced: ``async with Ros2Transport(node="parley"):``.

    Relative names are those of its namespace; names may be remapped, as with any node.

    Args:
        node: What it is called, unless `arguments` say otherwise.
        arguments: What a user of ROS writes on the command line: `--ros-args -r __ns:=/ward`.
        namespace: Of its relative names, unless `arguments` say otherwise.
        domain: Which of ROS's domains; None: as ROS_DOMAIN_ID says.
        look_s: How often it looks who is there.
    """

    def __init__(
        self,
        *,
        node: str = "parley",
        arguments: Sequence[str] = (),
        namespace: str = "",
        domain: int | None = None,
        look_s: float = LOOK_S,
    ) -> None:
        super().__init__(Graph())
        self._name, self._namespace, self._look_s = node, namespace, look_s
        self._arguments, self._domain = tuple(arguments), domain
        self._named: dict[str, Ros2Transport] = {}
        self._group = ReentrantCallbackGroup()
        self._clients: dict[str, RosClient] = {}

    async def __aenter__(self) -> Self:
        self._spinner = await asyncio.to_thread(Spinner, self._arguments, self._domain)
        try:
            self._begin()
        except UnavailableError:
            await self._spinner.close()
            raise
        self._log_as_before = log_to_ros(self._node)
        self.keep(asyncio.create_task(self._look(), name="ros2 look"))
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        for other in self._named.values():
            await other._end()
        self._log_as_before()
        await self._end()
        await self._spinner.close()

    def _begin(self) -> None:
        self._node = self._spinner.add(self._name, self._namespace)
        self._graph.on_changed(self._end_calls)

    async def _end(self) -> None:
        await self._close_ends()
        for client in self._clients.values():
            client.lost()
        await self._end_tasks()
        self._spinner.remove(self._node)

    def _make_codec(self, python_type: type[M], ros_type: str) -> Codec[M]:
        return Codec(python_type, ros_class(ros_type))

    def _open_publisher(self, topic: Topic[M], codec: remote.Codec[M], endpoint: Endpoint) -> RosPublisher[M]:
        end = self._node.create_publisher(
            ros_class(topic.ros_type), topic.name, profile(topic.qos, publishes=True),
            callback_group=self._group,
        )  # fmt: skip
        publisher = RosPublisher(self, topic, codec, end, endpoint)
        self._opened(publisher)
        return publisher

    async def _open_subscription(
        self, topic: Topic[M], codec: remote.Codec[M], endpoint: Endpoint, inbox: dict[str, Any],
        *, late: bool,
    ) -> RosSubscription[M]:  # fmt: skip
        subscription = RosSubscription(self, topic, codec, endpoint, inbox)
        self._opened(subscription)
        subscription.made = self._node.create_subscription(
            ros_class(topic.ros_type), topic.name, subscription.take, profile(topic.qos, publishes=False),
            callback_group=self._group,
        )  # fmt: skip
        return subscription

    async def _open_server(
        self, service: Service[Any, Any], endpoint: Endpoint, answer: remote.Answer
    ) -> RosServer:
        made = ros_class(service.ros_type)
        _, responses = self._codecs_of(service)

        def failure(why: str) -> Any:
            told = failure_of(service.response, why)
            return None if told is None else responses.encode(told)

        server = RosServer(self, endpoint, answer, failure)
        self._opened(server)
        server.serves(
            self._node.create_service(made, service.name, server.on_request, callback_group=self._group)
        )
        return server

    async def _look_for(self, service: str) -> None:
        if not self._graph.serves(service):
            await self._graph.look(self._node, self._spinner.nodes)
        await super()._look_for(service)

    async def _request(self, service: Service[Any, Any], request: Any, timeout_s: float) -> Any:
        known = self._clients.get(service.name)
        if known is None:
            made = ros_class(service.ros_type)
            end = self._node.create_client(made, service.name, callback_group=self._group)
            known = self._clients[service.name] = RosClient(end)
        answer = await known.call(request)
        if answer is None:
            raise went_away(service.name)
        return answer

    def named(self, name: str) -> Ros2Transport:
        """See `Transport.named`: a node of its own, in the same thread."""
        spelt = re.sub(r"\W", "_", name, flags=re.ASCII)
        known = self if spelt == self._name else self._named.get(spelt)
        if known is None:
            known = Ros2Transport(node=spelt, namespace=self._namespace)
            known._named, known._graph, known._spinner = self._named, self._graph, self._spinner
            known._begin()
            self._named[spelt] = known
        return known

    def meets_all(self) -> bool:
        """Whether all that is published is heard by everybody who listens, as far as ROS knows them."""
        return all(end.meets_all() for end in self._ends if isinstance(end, RosPublisher))

    @property
    def node(self) -> Any:
        """The node of ROS."""
        return self._node

    # `Holder`: what its ends ask of it

    def closed(self, end: _End) -> None:
        """See `Holder.closed`."""
        self._ends.remove(end)
        self._graph.remove_own(end.endpoint)

    # Inside

    def _endpoint(self, name: str, ros_type: str, role: str) -> Endpoint:
        service = role == "server"
        resolve = self._node.resolve_service_name if service else self._node.resolve_topic_name
        self._graph.calls(resolve(name), absolute(name))
        return super()._endpoint(name, ros_type, role)

    def _opened(self, end: _End) -> None:
        self._ends.append(end)
        self._graph.add_own(end.endpoint)

    def _end_calls(self) -> None:
        """Nobody waits for who went away."""
        for name, client in self._clients.items():
            if not self._graph.serves(name):
                client.lost()

    async def _look(self) -> None:
        while True:
            with suppress(RuntimeError):  # ROS ends
                await self._graph.look(self._node, self._spinner.nodes)
            await asyncio.sleep(self._look_s)
