"""The ends of topics and services that a node has."""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import Callable
from contextlib import suppress
from typing import Any, Final, Generic, Protocol, TypeVar

import structlog
from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy

from parley.messages.topics import QoS, Topic
from parley.transport import remote
from parley.transport.base import Endpoint
from parley.transport.refusals import check_message
from parley.transport.remote import RemoteServer, RemoteSubscription

__all__ = ["Holder", "RosClient", "RosPublisher", "RosServer", "RosSubscription", "profile"]

M = TypeVar("M")

AHEAD: Final = 100
"""So many messages may be on their way at least, whatever the depth says: it is counted where they wait."""
MEET_S: Final = 1.0
"""How long a new publisher waits for those who listen already."""
LOOK_S: Final = 0.01
AGAIN_S: Final = 0.05

log = structlog.get_logger(__name__)


class Holder(remote.Holder, Protocol):
    """What ends ask of the transport that opened them."""

    @property
    def node(self) -> Any:
        """The node of ROS."""

    def closed(self, end: Any) -> None:
        """An end is closed."""


def profile(qos: QoS, *, publishes: bool) -> QoSProfile:
    """The words of ROS for this."""
    depth = qos.depth if qos.latched and publishes else max(qos.depth, AHEAD)
    return QoSProfile(
        history=HistoryPolicy.KEEP_ALL if qos.keep_all else HistoryPolicy.KEEP_LAST,
        depth=depth,
        reliability=ReliabilityPolicy.RELIABLE if qos.reliable else ReliabilityPolicy.BEST_EFFORT,
        durability=DurabilityPolicy.TRANSIENT_LOCAL if qos.latched else DurabilityPolicy.VOLATILE,
    )


class RosPublisher(Generic[M]):
    """See `parley.transport.base.Publisher`.

    What is sent before those who listen already are met would be lost to them: it waits that long.
    """

    def __init__(
        self, transport: Holder, topic: Topic[M], codec: remote.Codec[M], made: Any, endpoint: Endpoint
    ) -> None:
        self._transport, self._topic, self._codec, self._made = transport, topic, codec, made
        self.endpoint = endpoint
        self._waiting: deque[Any] = deque(
            maxlen=None if topic.qos.keep_all else profile(topic.qos, publishes=True).depth
        )
        self._open = True
        self._loop = asyncio.get_running_loop()
        self._again: asyncio.TimerHandle | None = None
        self._met = topic.qos.latched or self.meets_all()
        if not self._met:
            transport.keep(asyncio.create_task(self._meet(), name=f"meet {topic.name}"))

    def publish(self, message: M) -> None:
        """See `Publisher.publish`."""
        check_message(self._topic, message)
        made = self._codec.encode(message)
        if self._open:
            self._waiting.append(made)
            if self._met:
                self._send()

    def close(self) -> None:
        """See `Publisher.close`."""
        if self._open:
            self._met = True
            self._send()
            self._open = False
            if self._again is not None:
                self._again.cancel()
            self._transport.closed(self)
            self._transport.node.destroy_publisher(self._made)

    def meets_all(self) -> bool:
        """Whether it has found everybody who listens, as far as ROS knows them."""
        there = self._transport.node.count_subscribers(self._made.topic_name)
        return bool(self._made.get_subscription_count() >= there)

    async def _meet(self) -> None:
        with suppress(TimeoutError):
            async with asyncio.timeout(MEET_S):
                while self._open and not self.meets_all():  # noqa: ASYNC110 - ROS tells nobody when
                    await asyncio.sleep(LOOK_S)
        if self._open:
            self._met = True
            self._send()

    def _send(self) -> None:
        if self._again is not None:
            self._again.cancel()
            self._again = None
        while self._waiting:
            try:
                self._made.publish(self._waiting[0])
            except RuntimeError as error:  # the network takes no more at the moment
                if self._topic.qos.keep_all:
                    self._again = self._loop.call_later(AGAIN_S, self._send)
                    return
                log.warning("a message was not taken", topic=self._topic.name, why=str(error))
            self._waiting.popleft()


class RosSubscription(RemoteSubscription[M]):
    """See `parley.transport.base.Subscription`; ROS hands messages over on its thread."""

    _holder: Holder
    made: Any = None

    async def close(self) -> None:
        """See `Subscription.close`."""
        made, self.made = self.made, None
        if made is not None:
            self._holder.closed(self)
            self._holder.node.destroy_subscription(made)
        await super().close()


class RosServer(RemoteServer):
    """See `RemoteServer`. If a call fails, its answer says so if it has a place for that."""

    _holder: Holder

    def __init__(
        self,
        transport: Holder,
        endpoint: Endpoint,
        answer: remote.Answer,
        failure: Callable[[str], Any],
    ) -> None:
        super().__init__(transport, endpoint, answer)
        self._failure = failure
        self._loop = asyncio.get_running_loop()
        self._made: Any = None
        self._respond: Callable[[Any, Any], None]

    def serves(self, made: Any) -> None:
        """ROS has opened it.

        The executor hands what `on_request` returned, and whose call it is, to `send_response`; that is put
        off until there is an answer.
        """
        self._made, self._respond = made, made.send_response
        made.send_response = self._asked

    def on_request(self, request: Any, _: Any) -> Any:
        """A call came, on the thread of ROS."""
        return request

    def _asked(self, request: Any, header: Any) -> None:
        with suppress(RuntimeError):  # the loop has ended; nobody answers
            self._loop.call_soon_threadsafe(self._take, request, header)

    def _take(self, request: Any, header: Any) -> None:
        if self._made is not None:
            self.begin(header, request)

    def reply(self, call: Any, answer: Any) -> None:
        """See `RemoteServer.reply`."""
        if self._made is not None:
            try:
                self._respond(answer, call)
            except RuntimeError as error:
                log.warning("an answer was not taken", service=self.endpoint.name, why=str(error))

    def refuse(self, call: Any, why: str) -> None:
        """See `RemoteServer.refuse`: not every answer of ROS can tell the caller, so the log does."""
        log.exception("a service failed", service=self.endpoint.name, why=why)
        if (answer := self._failure(why)) is not None:
            self.reply(call, answer)

    async def close(self) -> None:
        """See `Server.close`."""
        made, self._made = self._made, None
        if made is None:
            return
        self._holder.closed(self)
        self._holder.node.destroy_service(made)
        others = self.working - {asyncio.current_task()}
        for task in others:
            task.cancel()
        await asyncio.gather(*others, return_exceptions=True)


class RosClient:
    """The asking end of a service; it stays open, as ROS takes a moment to bring both ends together."""

    def __init__(self, made: Any) -> None:
        self._made = made
        self._loop = asyncio.get_running_loop()
        self._waiting: set[asyncio.Future[Any]] = set()

    async def call(self, asked: Any) -> Any:
        """The answer; None: whoever answers went away. Whoever calls this sets a limit."""
        waiting: asyncio.Future[Any] = self._loop.create_future()
        self._waiting.add(waiting)
        future: Any = None
        try:
            while not (waiting.done() or self._made.service_is_ready()):  # noqa: ASYNC110 - as above
                await asyncio.sleep(LOOK_S)
            if not waiting.done():
                future = self._made.call_async(asked)
                future.add_done_callback(lambda done: self._soon(waiting, done.result()))
            return await waiting
        finally:
            self._waiting.discard(waiting)
            if future is not None:
                self._made.remove_pending_request(future)

    def lost(self) -> None:
        """Whoever answers went away."""
        for waiting in self._waiting:
            _settle(waiting, None)

    def _soon(self, waiting: asyncio.Future[Any], answer: Any) -> None:
        with suppress(RuntimeError):  # the loop has ended, and nobody waits
            self._loop.call_soon_threadsafe(_settle, waiting, answer)


def _settle(waiting: asyncio.Future[Any], answer: Any) -> None:
    if not waiting.done():
        waiting.set_result(answer)
