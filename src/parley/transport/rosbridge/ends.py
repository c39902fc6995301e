"""The ends of topics and services that this process has at a bridge."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable
from typing import Any, Final, Generic, Protocol, TypeVar

import structlog

from parley.errors import TypeMismatchError
from parley.messages.topics import Topic
from parley.transport.base import Endpoint, absolute
from parley.transport.inbox import Inbox
from parley.transport.refusals import check_message
from parley.transport.rosbridge.frames import Frame
from parley.transport.rosbridge.line import Outbox
from parley.transport.rosbridge.values import Codec

__all__ = ["End", "Holder", "RosbridgePublisher", "RosbridgeServerEnd", "RosbridgeSubscription"]

M = TypeVar("M")

CALLS: Final = 100
"""So many calls of one service are answered at once; more are refused."""

log = structlog.get_logger(__name__)


class Holder(Protocol):
    """What ends ask of the transport that opened them."""

    def send(self, frame: Frame, outbox: Outbox | None = None) -> None:
        """Send soon."""

    def spelt(self, ros_type: str) -> str:
        """A type's name as the bridge knows it."""
        ...

    def pace(self, ros_type: str) -> Frame:
        """How often the bridge is to send messages of a type."""
        ...

    def has(self, endpoint: Endpoint) -> bool:
        """Whether an end of this process is open there."""
        ...

    def closed(self, end: End) -> None:
        """An end is closed."""

    def count_failure(self) -> None:
        """A handler raised."""


class RosbridgePublisher(Generic[M]):
    """See `parley.transport.base.Publisher`."""

    def __init__(self, transport: Holder, topic: Topic[M], codec: Codec[M]) -> None:
        self._transport, self._topic, self._codec = transport, topic, codec
        self.endpoint = Endpoint(absolute(topic.name), topic.ros_type, "publisher")
        qos = topic.qos
        self._outbox = Outbox(topic.name, None if qos.keep_all else qos.depth, urgent=qos.keep_all)
        self._last: Frame | None = None
        self._open = True

    def publish(self, message: M) -> None:
        """See `Publisher.publish`."""
        check_message(self._topic, message)
        if not self._open:
            return
        latch = self._topic.qos.latched
        frame: Frame = {"op": "publish", "topic": self.endpoint.name, "msg": self._codec.encode(message)}
        if latch:
            frame["latch"] = True
            self._last = frame
        self._transport.send(frame, self._outbox)

    def close(self) -> None:
        """See `Publisher.close`."""
        if self._open:
            self._open = False
            self._transport.closed(self)
            if not self._transport.has(self.endpoint):
                self._transport.send({"op": "unadvertise", "topic": self.endpoint.name})

    def tell(self) -> None:
        """Let the bridge know of it; once more after each new connection."""
        qos = self._topic.qos
        self._transport.send(
            {
                "op": "advertise",
                "topic": self.endpoint.name,
                "type": self._transport.spelt(self._topic.ros_type),
                "latch": qos.latched,
                "queue_size": qos.depth,
            },
        )
        if self._last is not None:
            self._transport.send(self._last, self._outbox)


class RosbridgeSubscription(Inbox[M]):
    """See `parley.transport.base.Subscription`."""

    def __init__(self, transport: Holder, topic: Topic[M], codec: Codec[M], inbox: dict[str, Any]) -> None:
        super().__init__(topic, on_failure=transport.count_failure, **inbox)
        self._transport, self._codec = transport, codec
        self.endpoint = Endpoint(absolute(topic.name), topic.ros_type, "subscription")
        self.latched = topic.qos.latched

    def take(self, value: Any) -> None:
        """A message came."""
        try:
            message = self._codec.decode(value)
        except TypeMismatchError as error:
            log.warning("a message cannot be read", topic=self._topic.name, why=str(error))
            return
        self.put(message)

    async def close(self) -> None:
        """See `Subscription.close`."""
        if self._open:
            self._transport.closed(self)
            if not self._transport.has(self.endpoint):
                self._transport.send({"op": "unsubscribe", "topic": self.endpoint.name})
        await super().close()

    def tell(self) -> None:
        """Let the bridge know of it; once more after each new connection."""
        frame = {
            "op": "subscribe",
            "topic": self.endpoint.name,
            "type": self._transport.spelt(self._topic.ros_type),
        }
        self._transport.send(frame | self._transport.pace(self._topic.ros_type))


class RosbridgeServerEnd:
    """See `parley.transport.base.Server`.

    Args:
        transport: Where it is.
        endpoint: What it is.
        answer: From the JSON of a request to that of its answer.
    """

    def __init__(
        self,
        transport: Holder,
        endpoint: Endpoint,
        answer: Callable[[Any], Awaitable[Frame]],
    ) -> None:
        self._transport, self.endpoint, self._answer = transport, endpoint, answer
        self._tasks: set[asyncio.Task[None]] = set()
        self._open = True

    def take(self, frame: Frame) -> None:
        """A call came."""
        if len(self._tasks) >= CALLS:
            self._reply(frame, f"{CALLS} calls wait already", result=False)
            return
        task = asyncio.create_task(self._handle(frame), name=f"call of {self.endpoint.name}")
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)

    async def close(self) -> None:
        """See `Server.close`."""
        if self._open:
            self._open = False
            self._transport.closed(self)
            self._transport.send({"op": "unadvertise_service", "service": self.endpoint.name})

    async def end(self) -> None:
        """The transport closes: what is still being answered is not answered any more."""
        for task in self._tasks:
            task.cancel()
        await asyncio.gather(*self._tasks, return_exceptions=True)

    def tell(self) -> None:
        """Let the bridge know of it; once more after each new connection."""
        self._transport.send(
            {
                "op": "advertise_service",
                "service": self.endpoint.name,
                "type": self._transport.spelt(self.endpoint.ros_type),
            }
        )

    async def _handle(self, frame: Frame) -> None:
        try:
            values = await self._answer(frame.get("args", {}))
        except asyncio.CancelledError:
            raise
        except Exception as failed:  # noqa: BLE001 - the border of whoever serves: the caller is told
            self._reply(frame, str(failed) or type(failed).__name__, result=False)
        else:
            self._reply(frame, values, result=True)

    def _reply(self, frame: Frame, values: Any, *, result: bool) -> None:
        self._transport.send(
            {
                "op": "service_response",
                "id": frame.get("id"),
                "service": self.endpoint.name,
                "values": values,
                "result": result,
            }
        )


End = RosbridgePublisher[Any] | RosbridgeSubscription[Any] | RosbridgeServerEnd
