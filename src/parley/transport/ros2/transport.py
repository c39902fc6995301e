"""The backend itself. See `parley.transport.base.Transport` for the contract."""

from __future__ import annotations

import asyncio
import re
from collections.abc import Awaitable, Callable, Sequence
from contextlib import suppress
from types import TracebackType
from typing import Any, Final, Self, TypeVar

import structlog
from rclpy.callback_groups import ReentrantCallbackGroup

from parley.errors import UnavailableError
from parley.messages.actions import Action
from parley.messages.topics import Service, Topic
from parley.transport.actions import CallingActionClient
from parley.transport.base import Endpoint, Handler, Subscription, absolute
from parley.transport.failures import failure_in
from parley.transport.refusals import (
    answered_already,
    check_request,
    failed,
    nobody_answers,
    too_late,
    went_away,
)
from parley.transport.ros2.ends import RosClient, RosPublisher, RosServer, RosSubscription, profile
from parley.transport.ros2.graph import Graph
from parley.transport.ros2.rosout import log_to_ros
from parley.transport.ros2.spinner import Spinner
from parley.transport.ros2.types import Codec, ros_class

__all__ = ["Ros2Transport"]

M = TypeVar("M")
Req = TypeVar("Req")
Res = TypeVar("Res")
Goal = TypeVar("Goal")
Result = TypeVar("Result")
Feedback = TypeVar("Feedback")
_End = RosPublisher[Any] | RosSubscription[Any] | RosServer[Any, Any]

LOOK_S: Final = 0.5

log = structlog.get_logger(__name__)


class Ros2Transport:
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
        self._name, self._namespace, self._look_s = node, namespace, look_s
        self._arguments, self._domain = tuple(arguments), domain
        self._graph = Graph()
        self._named: dict[str, Ros2Transport] = {}
        self._group = ReentrantCallbackGroup()
        self._codecs: dict[tuple[type[Any], str], Codec[Any]] = {}
        self._clients: dict[str, RosClient[Any, Any]] = {}
        self._ends: list[_End] = []
        self._tasks: set[asyncio.Task[Any]] = set()
        self.handler_failures = 0
        """How many times a handler raised; tests assert that it stays 0."""

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
        for end in list(self._ends):
            if isinstance(end, RosPublisher):
                end.close()
            else:
                await end.close()
        for client in self._clients.values():
            client.lost()
        for task in list(self._tasks):
            task.cancel()
        await asyncio.gather(*self._tasks, return_exceptions=True)
        self._spinner.remove(self._node)

    def publisher(self, topic: Topic[M]) -> RosPublisher[M]:
        """See `Transport.publisher`."""
        self._check(topic.name, topic.ros_type, service=False)
        made = ros_class(topic.ros_type)
        codec = self._codec(topic.type, topic.ros_type, made)
        end = self._node.create_publisher(
            made, topic.name, profile(topic.qos, publishes=True), callback_group=self._group
        )
        endpoint = Endpoint(absolute(topic.name), topic.ros_type, "publisher")
        publisher = RosPublisher(self, topic, codec, end, endpoint)
        self._opened(publisher)
        return publisher

    async def subscribe(
        self,
        topic: Topic[M],
        handler: Handler[M],
        *,
        depth: int | None = None,
        along: Subscription | None = None,
    ) -> RosSubscription[M]:
        """See `Transport.subscribe`."""
        self._check(topic.name, topic.ros_type, service=False)
        made = ros_class(topic.ros_type)
        codec = self._codec(topic.type, topic.ros_type, made)
        endpoint = Endpoint(absolute(topic.name), topic.ros_type, "subscription")
        inbox = {"handler": handler, "depth": depth, "along": along}
        subscription = RosSubscription(self, topic, codec, endpoint, inbox)
        self._opened(subscription)
        subscription.made = self._node.create_subscription(
            made, topic.name, subscription.on_message, profile(topic.qos, publishes=False),
            callback_group=self._group,
        )  # fmt: skip
        return subscription

    async def serve(
        self, service: Service[Req, Res], handler: Callable[[Req], Awaitable[Res]]
    ) -> RosServer[Req, Res]:
        """See `Transport.serve`."""
        self._check(service.name, service.ros_type, service=True)
        if self._graph.serves(service.name):
            raise answered_already(service.name)
        made = ros_class(service.ros_type)
        endpoint = Endpoint(absolute(service.name), service.ros_type, "server")
        server = RosServer(self, endpoint, self._codecs_of(service, made), handler, service.response)
        self._opened(server)
        server.serves(
            self._node.create_service(made, service.name, server.on_request, callback_group=self._group)
        )
        return server

    async def call(self, service: Service[Req, Res], request: Req, *, timeout_s: float) -> Res:
        """See `Transport.call`."""
        self._check(service.name, service.ros_type, service=True)
        if not self._graph.serves(service.name):
            await self._graph.look(self._node, self._spinner.nodes)
            if not self._graph.serves(service.name):
                raise nobody_answers(service.name)
        check_request(service, request)
        try:
            async with asyncio.timeout(timeout_s):
                answer: Res | None = await self._client(service).call(request)
        except TimeoutError as error:
            raise too_late(service.name, timeout_s) from error
        if answer is None:
            raise went_away(service.name)
        if why := failure_in(answer):
            raise failed(service.name, why)
        return answer

    async def action_client(
        self, action: Action[Goal, Result, Feedback]
    ) -> CallingActionClient[Goal, Result, Feedback]:
        """See `Transport.action_client`."""
        client = CallingActionClient(self, action)
        await client.open()
        return client

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

    def endpoints(self) -> tuple[Endpoint, ...]:
        """See `Transport.endpoints`."""
        return self._graph.endpoints()

    def on_endpoints_changed(self, handler: Callable[[], Any]) -> Callable[[], None]:
        """See `Transport.on_endpoints_changed`."""
        return self._graph.on_changed(handler)

    def meets_all(self) -> bool:
        """Whether all that is published is heard by everybody who listens, as far as ROS knows them."""
        return all(end.meets_all() for end in self._ends if isinstance(end, RosPublisher))

    @property
    def node(self) -> Any:
        """The node of ROS."""
        return self._node

    # `Holder`: what its ends ask of it

    def keep(self, task: asyncio.Task[Any]) -> None:
        """See `Holder.keep`."""
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)

    def count_failure(self) -> None:
        """See `Holder.count_failure`."""
        self.handler_failures += 1

    def closed(self, end: _End) -> None:
        """See `Holder.closed`."""
        self._ends.remove(end)
        self._graph.remove_own(end.endpoint)

    # Inside

    def _check(self, name: str, ros_type: str, *, service: bool) -> None:
        resolve = self._node.resolve_service_name if service else self._node.resolve_topic_name
        self._graph.calls(resolve(name), absolute(name))
        self._graph.check(name, ros_type, service=service)

    def _opened(self, end: _End) -> None:
        self._ends.append(end)
        self._graph.add_own(end.endpoint)

    def _client(self, service: Service[Req, Res]) -> RosClient[Req, Res]:
        known = self._clients.get(service.name)
        if known is None:
            made = ros_class(service.ros_type)
            codecs = self._codecs_of(service, made)
            end = self._node.create_client(made, service.name, callback_group=self._group)
            known = self._clients[service.name] = RosClient(end, codecs)
        return known

    def _codec(self, python_type: type[M], ros_type: str, made: Any) -> Codec[M]:
        known = self._codecs.get((python_type, ros_type))
        if known is None:
            known = self._codecs[python_type, ros_type] = Codec(python_type, made)
        return known

    def _codecs_of(self, service: Service[Req, Res], made: Any) -> tuple[Codec[Req], Codec[Res]]:
        return (
            self._codec(service.request, f"{service.ros_type}_Request", made.Request),
            self._codec(service.response, f"{service.ros_type}_Response", made.Response),
        )

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
