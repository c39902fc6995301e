"""The ends of topics and services that this process has at a bridge."""

from __future__ import annotations

from typing import Any, Final, Generic, Protocol, TypeVar

from parley.messages.topics import Topic
from parley.transport import remote
from parley.transport.base import Endpoint
from parley.transport.refusals import check_message
from parley.transport.remote import RemoteServer, RemoteSubscription
from parley.transport.rosbridge.frames import Frame
from parley.transport.rosbridge.line import Outbox

__all__ = ["End", "Holder", "RosbridgePublisher", "RosbridgeServerEnd", "RosbridgeSubscription"]

M = TypeVar("M")

AHEAD: Final = 100
"""So many messages a bridge may be behind with at least, whatever the depth says: it is counted where they
wait. Of one that keeps all, ten times as many: ROS drops what is more."""
CALLS: Final = 100
"""So many calls of one service are answered at once; more are refused."""


class Holder(remote.Holder, Protocol):
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


class RosbridgePublisher(Generic[M]):
    """See `parley.transport.base.Publisher`."""

    def __init__(
        self, transport: Holder, topic: Topic[M], codec: remote.Codec[M], endpoint: Endpoint
    ) -> None:
        self._transport, self._topic, self._codec, self.endpoint = transport, topic, codec, endpoint
        qos = topic.qos
        urgent = qos.keep_all or qos.urgent
        self._outbox = Outbox(topic.name, None if qos.keep_all else qos.depth, urgent=urgent)
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
        ahead = 0 if qos.latched else 10 * AHEAD if qos.keep_all else AHEAD
        self._transport.send(
            {
                "op": "advertise",
                "topic": self.endpoint.name,
                "type": self._transport.spelt(self._topic.ros_type),
                "latch": qos.latched,
                "queue_size": max(qos.depth, ahead),
            },
        )
        if self._last is not None:
            self._transport.send(self._last, self._outbox)


class RosbridgeSubscription(RemoteSubscription[M]):
    """See `parley.transport.base.Subscription`."""

    _holder: Holder

    @property
    def latched(self) -> bool:
        """Whether the last message is kept for who comes later."""
        return self._topic.qos.latched

    async def close(self) -> None:
        """See `Subscription.close`."""
        if self._open:
            self._holder.closed(self)
            if not self._holder.has(self.endpoint):
                self._holder.send({"op": "unsubscribe", "topic": self.endpoint.name})
        await super().close()

    def tell(self) -> None:
        """Let the bridge know of it; once more after each new connection."""
        frame = {
            "op": "subscribe",
            "topic": self.endpoint.name,
            "type": self._holder.spelt(self._topic.ros_type),
        }
        self._holder.send(frame | self._holder.pace(self._topic.ros_type))


class RosbridgeServerEnd(RemoteServer):
    """See `RemoteServer`; requests and answers are JSON."""

    _holder: Holder

    def take(self, frame: Frame) -> None:
        """A call came."""
        if len(self.working) >= CALLS:
            self.refuse(frame, f"{CALLS} calls wait already")
        else:
            self.begin(frame, frame.get("args", {}))

    async def close(self) -> None:
        """See `Server.close`."""
        if self._open:
            self._open = False
            self._holder.closed(self)
            self._holder.send({"op": "unadvertise_service", "service": self.endpoint.name})

    def tell(self) -> None:
        """Let the bridge know of it; once more after each new connection."""
        self._holder.send(
            {
                "op": "advertise_service",
                "service": self.endpoint.name,
                "type": self._holder.spelt(self.endpoint.ros_type),
            }
        )

    def reply(self, call: Frame, answer: Frame) -> None:
        """See `RemoteServer.reply`."""
        self._reply(call, answer, result=True)

    def refuse(self, call: Frame, why: str) -> None:
        """See `RemoteServer.refuse`."""
        self._reply(call, why, result=False)

    def _reply(self, frame: Frame, values: Any, *, result: bool) -> None:
        self._holder.send(
            {
                "op": "service_response",
                "id": frame.get("id"),
                "service": self.endpoint.name,
                "values": values,
                "result": result,
            }
        )


End = RosbridgePublisher[Any] | RosbridgeSubscription[Any] | RosbridgeServerEnd
