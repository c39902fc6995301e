"""The ends of topics and services in this process."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable
from typing import Any, Final, Generic, Protocol, TypeVar

import structlog
import zenoh
from zenoh.ext import AdvancedPublisher, AdvancedSubscriber

from parley.errors import TypeMismatchError
from parley.messages.topics import Topic
from parley.transport.inbox import Inbox
from parley.transport.refusals import check_message
from parley.transport.zenoh.cdr import Codec
from parley.transport.zenoh.keys import Attachment
from parley.transport.zenoh.lane import Lane, Outbox

__all__ = ["Declared", "Holder", "ZenohPublisher", "ZenohServer", "ZenohSubscription"]

M = TypeVar("M")
T = TypeVar("T")

log = structlog.get_logger(__name__)

SENDERS_KNOWN: Final = 256
"""Of how many publishers a subscription knows what number comes next; of more the oldest are forgotten."""


class Declared(Protocol):
    """What others see until it is taken away."""

    def undeclare(self) -> None:
        """Take it away."""


class Holder(Protocol):
    """What ends ask of the transport that opened them."""

    async def ask(self, job: Callable[[], T]) -> T:
        """Have something done that may wait for the network."""
        ...

    def send(self, job: Callable[[], object]) -> None:
        """Have an answer sent."""

    def keep(self, task: asyncio.Task[Any]) -> None:
        """A call is being answered; it ends with the transport at the latest."""

    def count_failure(self) -> None:
        """A handler raised."""

    def stamps(self, whose: str) -> Callable[[], bytes]:
        """What goes with each message of one end, numbered from 1."""
        ...

    def closed(self, token: str) -> None:
        """An end is closed for this process; `take_away` tells others."""

    def take_away(self, token: str, end: Declared) -> None:
        """Tell others that an end is closed. Not on the loop."""


class ZenohPublisher(Generic[M]):
    """See `parley.transport.base.Publisher`."""

    def __init__(
        self,
        transport: Holder,
        topic: Topic[M],
        codec: Codec[M],
        lane: Lane,
        declare: Callable[[], zenoh.Publisher | AdvancedPublisher],
        token: str,
    ) -> None:
        self._transport, self._topic, self._codec, self._lane, self.token = (
            transport, topic, codec, lane, token,
        )  # fmt: skip
        self._outbox = Outbox(None if topic.qos.keep_all else topic.qos.depth)
        self._stamp = transport.stamps(token)
        self._open = True
        self._declare = declare
        self._publisher: zenoh.Publisher | AdvancedPublisher | None = None
        lane.do(self._begin)

    def publish(self, message: M) -> None:
        """See `Publisher.publish`."""
        check_message(self._topic, message)
        if not self._open:
            return
        if self._outbox.put(self._codec.encode(message), self._stamp()):
            count = self._outbox.dropped
            if count.bit_count() == 1:
                log.warning(
                    "messages dropped: the network takes less than is sent",
                    topic=self._topic.name,
                    dropped=count,
                )
        self._lane.do(self._send)

    def close(self) -> None:
        """See `Publisher.close`."""
        if self._open:
            self._open = False
            self._transport.closed(self.token)
            self._lane.do(self._end)

    def _begin(self) -> None:
        self._publisher = self._declare()

    def _send(self) -> None:
        waiting = self._outbox.take()
        if waiting is not None and self._publisher is not None:
            self._publisher.put(waiting[0], attachment=waiting[1])

    def _end(self) -> None:
        if self._publisher is not None:
            self._transport.take_away(self.token, self._publisher)
            self._publisher = None


class ZenohSubscription(Inbox[M]):
    """See `parley.transport.base.Subscription`."""

    def __init__(
        self, transport: Holder, topic: Topic[M], codec: Codec[M], token: str, inbox: dict[str, Any]
    ) -> None:
        super().__init__(topic, on_failure=transport.count_failure, **inbox)
        self._transport, self._codec, self.token = transport, codec, token
        self._numbers: dict[bytes, int] = {}
        self.end: zenoh.Subscriber[None] | AdvancedSubscriber[None] | None = None

    def on_sample(self, sample: zenoh.Sample) -> None:
        """A message came, on a thread of the library."""
        try:
            message = self._codec.decode(sample.payload.to_bytes())
        except TypeMismatchError as error:
            log.warning("a message cannot be read", topic=self._topic.name, why=str(error))
            return
        attached = sample.attachment and Attachment.from_bytes(sample.attachment.to_bytes())
        if attached and not self._topic.qos.latched:  # what was latched comes out of turn
            self._count_lost(attached)
        self.put(message)

    def _count_lost(self, attached: Attachment) -> None:
        before = self._numbers.pop(attached.gid, attached.number - 1)
        self._numbers[attached.gid] = attached.number
        if len(self._numbers) > SENDERS_KNOWN:
            del self._numbers[next(iter(self._numbers))]
        if attached.number > before + 1:
            self.lose(attached.number - before - 1)

    async def close(self) -> None:
        """See `Subscription.close`."""
        end, self.end = self.end, None
        if end is not None:
            self._transport.closed(self.token)
        await super().close()
        if end is not None:
            await self._transport.ask(lambda: self._transport.take_away(self.token, end))


class ZenohServer:
    """See `parley.transport.base.Server`. What is being answered when it closes is answered yet.

    Args:
        transport: Where it is.
        name: Of the service.
        answer: From the bytes of a request to those of its answer.
        key: Under which calls come, and answers go.
        token: What shows that it is there.
    """

    def __init__(
        self,
        transport: Holder,
        name: str,
        answer: Callable[[bytes], Awaitable[bytes]],
        key: str,
        token: str,
    ) -> None:
        self._transport, self._name, self._answer, self._key, self.token = transport, name, answer, key, token
        self._loop = asyncio.get_running_loop()
        self._open = True
        self.end: zenoh.Queryable[None] | None = None

    def on_query(self, query: zenoh.Query) -> None:
        """A call came, on a thread of the library."""
        try:
            self._loop.call_soon_threadsafe(self._begin, query)
        except RuntimeError:  # the loop has ended; who called is told so
            query.drop()

    def _begin(self, query: zenoh.Query) -> None:
        if not self._open:
            query.drop()
        else:
            self._transport.keep(asyncio.create_task(self._handle(query), name=f"call of {self._name}"))

    async def _handle(self, query: zenoh.Query) -> None:
        error = ""
        answer = b""
        try:
            answer = await self._answer(query.payload.to_bytes() if query.payload else b"")
        except asyncio.CancelledError:
            query.drop()
            raise
        except Exception as failed:  # noqa: BLE001 - the border of whoever serves: the caller is told
            error = str(failed) or type(failed).__name__
        attachment = query.attachment.to_bytes() if query.attachment else b""

        def reply() -> None:
            with query:
                if error:
                    query.reply_err(error)
                else:
                    query.reply(self._key, answer, attachment=attachment)

        self._transport.send(reply)

    async def close(self) -> None:
        """See `Server.close`."""
        self._open = False
        end, self.end = self.end, None
        if end is not None:
            self._transport.closed(self.token)
            await self._transport.ask(lambda: self._transport.take_away(self.token, end))
