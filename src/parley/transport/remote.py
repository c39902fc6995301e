"""What the transports between processes do alike: hearing, answering and calling.

How that goes over the wire is theirs: an end that opens, a request that is sent. See
`parley.transport.base.Transport` for the contract.
"""

from __future__ import annotations

import asyncio
from abc import ABC, abstractmethod
from collections.abc import Awaitable, Callable
from typing import Any, Generic, Protocol, TypeVar

import structlog

from parley.errors import TypeMismatchError
from parley.messages.actions import Action
from parley.messages.topics import Service, Topic
from parley.transport.actions import CallingActionClient
from parley.transport.base import (
    ActionClient,
    Endpoint,
    Handler,
    Publisher,
    Subscription,
    Transport,
    absolute,
)
from parley.transport.failures import failure_in
from parley.transport.graph import EndpointGraph
from parley.transport.inbox import Inbox
from parley.transport.refusals import answered_already, check_request, failed, nobody_answers, too_late

__all__ = ["Answer", "Codec", "Holder", "RemoteServer", "RemoteSubscription", "RemoteTransport"]

M = TypeVar("M")
Req = TypeVar("Req")
Res = TypeVar("Res")
Goal = TypeVar("Goal")
Result = TypeVar("Result")
Feedback = TypeVar("Feedback")
G = TypeVar("G", bound=EndpointGraph)

Answer = Callable[[Any], Awaitable[Any]]
"""From what came of a request to what is sent of its answer."""

log = structlog.get_logger(__name__)


class Codec(Protocol[M]):
    """Turns the messages of one type into what the wire carries, and back."""

    def encode(self, message: M) -> Any:
        """What is sent; raises `TypeMismatchError` if a value is none that its field can carry."""

    def decode(self, value: Any) -> M:
        """What came; raises `TypeMismatchError` if it is of another type."""
        ...


class Holder(Protocol):
    """What ends ask of the transport that opened them."""

    def keep(self, task: asyncio.Task[Any]) -> None:
        """Something goes on; it ends with the transport at the latest."""

    def count_failure(self) -> None:
        """A handler raised."""


class RemoteSubscription(Inbox[M]):
    """See `parley.transport.base.Subscription`."""

    def __init__(
        self, holder: Holder, topic: Topic[M], codec: Codec[M], endpoint: Endpoint, inbox: dict[str, Any]
    ) -> None:
        super().__init__(topic, on_failure=holder.count_failure, **inbox)
        self._holder, self._codec, self.endpoint = holder, codec, endpoint

    def take(self, value: Any) -> None:
        """A message came; from any thread."""
        try:
            message = self._codec.decode(value)
        except TypeMismatchError as error:
            log.warning("a message cannot be read", topic=self._topic.name, why=str(error))
        else:
            self.put(message)


class RemoteServer(ABC):
    """See `parley.transport.base.Server`. What is being answered when it closes is answered yet.

    Args:
        holder: Who opened it.
        endpoint: What it is.
        answer: How requests are answered.
    """

    def __init__(self, holder: Holder, endpoint: Endpoint, answer: Answer) -> None:
        self._holder, self.endpoint, self._answer = holder, endpoint, answer
        self.working: set[asyncio.Task[None]] = set()
        """Calls that are being answered."""
        self._open = True

    def begin(self, call: Any, request: Any) -> None:
        """Answer a call; on the loop."""
        task = asyncio.create_task(self._work(call, request), name=f"call of {self.endpoint.name}")
        self.working.add(task)
        task.add_done_callback(self.working.discard)
        self._holder.keep(task)

    async def _work(self, call: Any, request: Any) -> None:
        try:
            answer = await self._answer(request)
        except asyncio.CancelledError:
            self.drop(call)
            raise
        except Exception as failed:  # noqa: BLE001 - the border of whoever serves: the caller is told
            self.refuse(call, str(failed) or type(failed).__name__)
        else:
            self.reply(call, answer)

    @abstractmethod
    def reply(self, call: Any, answer: Any) -> None:
        """Tell who called."""

    @abstractmethod
    def refuse(self, call: Any, why: str) -> None:
        """Tell who called that there is no answer."""

    def drop(self, call: Any) -> None:  # noqa: B027 - most wires have no word for it
        """The call is not answered any more."""

    @abstractmethod
    async def close(self) -> None:
        """See `Server.close`."""


class RemoteTransport(Transport, Generic[G]):
    """One end of a network.

    Args:
        graph: Who is there, and who of this process.
    """

    def __init__(self, graph: G) -> None:
        self._graph = graph
        self._codecs: dict[tuple[type[Any], str], Codec[Any]] = {}
        self._ends: list[Any] = []
        self._tasks: set[asyncio.Task[Any]] = set()
        self.handler_failures = 0
        """How many times a handler raised; tests assert that it stays 0."""

    def publisher(self, topic: Topic[M]) -> Publisher[M]:
        """See `Transport.publisher`."""
        endpoint = self._endpoint(topic.name, topic.ros_type, "publisher")
        return self._open_publisher(topic, self._codec(topic.type, topic.ros_type), endpoint)

    async def subscribe(
        self,
        topic: Topic[M],
        handler: Handler[M],
        *,
        depth: int | None = None,
        along: Subscription | None = None,
        late: bool = False,
    ) -> RemoteSubscription[M]:
        """See `Transport.subscribe`."""
        endpoint = self._endpoint(topic.name, topic.ros_type, "subscription")
        codec = self._codec(topic.type, topic.ros_type)
        inbox = {"handler": handler, "depth": depth, "along": along}
        return await self._open_subscription(topic, codec, endpoint, inbox, late=late)

    async def serve(
        self, service: Service[Req, Res], handler: Callable[[Req], Awaitable[Res]]
    ) -> RemoteServer:
        """See `Transport.serve`."""
        endpoint = self._endpoint(service.name, service.ros_type, "server")
        if self._graph.serves(service.name):
            raise answered_already(service.name)
        requests, responses = self._codecs_of(service)

        async def answer(request: Any) -> Any:
            return responses.encode(await handler(requests.decode(request)))

        return await self._open_server(service, endpoint, answer)

    async def call(self, service: Service[Req, Res], request: Req, *, timeout_s: float) -> Res:
        """See `Transport.call`."""
        self._endpoint(service.name, service.ros_type, "server")
        await self._look_for(service.name)
        return await self._call(service, request, timeout_s)

    async def action_client(
        self, action: Action[Goal, Result, Feedback]
    ) -> ActionClient[Goal, Result, Feedback]:
        """See `Transport.action_client`."""
        client = CallingActionClient(self, action)
        await client.open()
        return client

    def named(self, name: str) -> Transport:
        """See `Transport.named`."""
        return self

    def endpoints(self) -> tuple[Endpoint, ...]:
        """See `Transport.endpoints`."""
        return self._graph.endpoints()

    def on_endpoints_changed(self, handler: Callable[[], Any]) -> Callable[[], None]:
        """See `Transport.on_endpoints_changed`."""
        return self._graph.on_changed(handler)

    def keep(self, task: asyncio.Task[Any]) -> None:
        """See `Holder.keep`."""
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)

    def count_failure(self) -> None:
        """See `Holder.count_failure`."""
        self.handler_failures += 1

    # What each does in its own way

    @abstractmethod
    def _make_codec(self, python_type: type[M], ros_type: str) -> Codec[M]:
        """What reads and writes a type."""

    @abstractmethod
    def _open_publisher(self, topic: Topic[M], codec: Codec[M], endpoint: Endpoint) -> Publisher[M]:
        """Open what sends."""

    @abstractmethod
    async def _open_subscription(
        self, topic: Topic[M], codec: Codec[M], endpoint: Endpoint, inbox: dict[str, Any], *, late: bool
    ) -> RemoteSubscription[M]:
        """Open what hears; `inbox` holds what `Inbox` is told."""

    @abstractmethod
    async def _open_server(
        self, service: Service[Any, Any], endpoint: Endpoint, answer: Answer
    ) -> RemoteServer:
        """Open what answers."""

    @abstractmethod
    async def _request(self, service: Service[Any, Any], request: Any, timeout_s: float) -> Any:
        """Send a request and wait for its answer; the time is kept by whoever calls this.

        Raises:
            UnavailableError: Who answers is not there, or went away.
            TransportError: It says that it failed.
        """

    async def _look_for(self, service: str) -> None:
        """Raises `UnavailableError` if nobody answers a service."""
        if not self._graph.serves(service):
            raise nobody_answers(service)

    # What they share

    def _endpoint(self, name: str, ros_type: str, role: str) -> Endpoint:
        """An end that may be used so; raises `TypeMismatchError` if the name has another type."""
        self._graph.check(name, ros_type, service=role == "server")
        return Endpoint(absolute(name), ros_type, role)

    async def _call(self, service: Service[Req, Res], request: Req, timeout_s: float) -> Res:
        check_request(service, request)
        requests, responses = self._codecs_of(service)
        try:
            async with asyncio.timeout(timeout_s):
                answer = await self._request(service, requests.encode(request), timeout_s)
        except TimeoutError as error:
            raise too_late(service.name, timeout_s) from error
        told = responses.decode(answer)
        if why := failure_in(told):
            raise failed(service.name, why)
        return told

    def _codec(self, python_type: type[M], ros_type: str) -> Codec[M]:
        known = self._codecs.get((python_type, ros_type))
        if known is None:
            known = self._codecs[python_type, ros_type] = self._make_codec(python_type, ros_type)
        return known

    def _codecs_of(self, service: Service[Req, Res]) -> tuple[Codec[Req], Codec[Res]]:
        return (
            self._codec(service.request, f"{service.ros_type}_Request"),
            self._codec(service.response, f"{service.ros_type}_Response"),
        )

    async def _close_ends(self) -> None:
        """Close what is still open."""
        for end in list(self._ends):
            closing = end.close()
            if closing is not None:  # that of a publisher is at once
                await closing

    async def _end_tasks(self) -> None:
        """End what is kept."""
        for task in list(self._tasks):
            task.cancel()
        await asyncio.gather(*self._tasks, return_exceptions=True)
