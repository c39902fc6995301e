"""The ends of topics and services in this process."""

from __future__ import annotations

import asyncio
import itertools
from collections.abc import Callable
from typing import Any, Final, Generic, Protocol, TypeVar

import structlog
import zenoh
from zenoh.ext import AdvancedPublisher, AdvancedSubscriber

from parley.latest import Latest
from parley.messages.topics import Topic
from parley.transport import remote
from parley.transport.base import Endpoint
from parley.transport.refusals import check_message
from parley.transport.remote import RemoteServer, RemoteSubscription
from parley.transport.zenoh.keys import Attachment
from parley.transport.zenoh.lane import Lane, Outbox

__all__ = ["Declared", "Holder", "ZenohPublisher", "ZenohServer", "ZenohSubscription"]

M = TypeVar("M")
T = TypeVar("T")

log = structlog.get_logger(__name__)

WORDS_KNOWN: Final = 64
LONGEST_WORDS: Final = 4096
"""Bytes. So many of its newest messages of no more than that a publisher knows when they are said again,
of topics on which that happens."""
BELIEVED: Final = 1_000_000
"""Who is further on than that counts no messages, or not as we do: nothing is lost."""
SENDERS_KNOWN: Final = 256
"""Of how many publishers a subscription knows what number comes next; of more the oldest are forgotten."""


class Declared(Protocol):
    """What others see until it is taken away."""

    def undeclare(self) -> None:
        """Take it away."""


class Holder(remote.Holder, Protocol):
    """What ends ask of the transport that opened them."""

    async def ask(self, job: Callable[[], T]) -> T:
        """Have something done that may wait for the network."""
        ...

    def send(self, job: Callable[[], object]) -> None:
        """Have an answer sent."""

    def stamps(self, whose: str) -> Callable[[int], bytes]:
        """What goes with each message of one end, from its number."""
        ...

    def closed(self, end: Any) -> None:
        """An end is closed for this process; `take_away` tells others."""

    def take_away(self, token: str, end: Declared) -> None:
        """Tell others that an end is closed. Not on the loop."""


class ZenohPublisher(Generic[M]):
    """See `parley.transport.base.Publisher`."""

    def __init__(
        self,
        transport: Holder,
        topic: Topic[M],
        codec: remote.Codec[M],
        lane: Lane,
        declare: Callable[[], zenoh.Publisher | AdvancedPublisher],
        token: str,
    ) -> None:
        self._transport, self._topic, self._codec, self._lane, self.token = (
            transport, topic, codec, lane, token,
        )  # fmt: skip
        self._outbox = Outbox(None if topic.qos.keep_all else topic.qos.depth)
        self._stamp = transport.stamps(token)
        self._numbers, self._said = itertools.count(1), Latest[int, int](WORDS_KNOWN)
        self._open = True
        self._declare = declare
        self._publisher: zenoh.Publisher | AdvancedPublisher | None = None
        lane.do(self._begin)

    def publish(self, message: M) -> None:
        """See `Publisher.publish`."""
        check_message(self._topic, message)
        if not self._open:
            return
        data = self._codec.encode(message)
        if self._outbox.put(data, self._stamp(self._number(data))):
            count = self._outbox.dropped
            if count.bit_count() == 1:
                log.warning(
                    "messages dropped: the network takes less than is sent",
                    topic=self._topic.name,
                    dropped=count,
                )
        self._lane.do(self._send)

    def _number(self, data: bytes | bytearray) -> int:
        """What is said again until somebody takes it keeps its number, so that it is no loss each time."""
        if not self._topic.qos.repeats or len(data) > LONGEST_WORDS:
            return next(self._numbers)
        key = hash(bytes(data))
        number = self._said[key] = self._said.get(key) or next(self._numbers)
        return number

    def close(self) -> None:
        """See `Publisher.close`."""
        if self._open:
            self._open = False
            self._transport.closed(self)
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


class ZenohSubscription(RemoteSubscription[M]):
    """See `parley.transport.base.Subscription`."""

    _holder: Holder

    def __init__(self, token: str, *heard: Any) -> None:
        super().__init__(*heard)
        self.token = token
        self._numbers: dict[bytes, int] = {}
        self.end: zenoh.Subscriber[None] | AdvancedSubscriber[None] | None = None

    def on_sample(self, sample: zenoh.Sample) -> None:
        """A message came, on a thread of the library."""
        attached = sample.attachment and Attachment.from_bytes(sample.attachment.to_bytes())
        if attached and not self._topic.qos.latched:  # what was latched comes out of turn
            self._count_lost(attached)
        self.take(sample.payload.to_bytes())

    def _count_lost(self, attached: Attachment) -> None:
        before = self._numbers.pop(attached.gid, attached.number - 1)
        number = attached.number if attached.number - before <= BELIEVED else before
        self._numbers[attached.gid] = max(before, number)  # less: it was said again
        if len(self._numbers) > SENDERS_KNOWN:
            del self._numbers[next(iter(self._numbers))]
        if number > before + 1:
            self.lose(number - before - 1)

    async def close(self) -> None:
        """See `Subscription.close`."""
        end, self.end = self.end, None
        if end is not None:
            self._holder.closed(self)
        await super().close()
        if end is not None:
            await self._holder.ask(lambda: self._holder.take_away(self.token, end))


class ZenohServer(RemoteServer):
    """See `RemoteServer`.

    Args:
        transport: Where it is.
        endpoint: What it is.
        answer: From the bytes of a request to those of its answer.
        key: Under which calls come, and answers go.
        token: What shows that it is there.
    """

    _holder: Holder

    def __init__(
        self, transport: Holder, endpoint: Endpoint, answer: remote.Answer, key: str, token: str
    ) -> None:
        super().__init__(transport, endpoint, answer)
        self._key, self.token = key, token
        self._loop = asyncio.get_running_loop()
        self.end: zenoh.Queryable[None] | None = None

    def on_query(self, query: zenoh.Query) -> None:
        """A call came, on a thread of the library."""
        try:
            self._loop.call_soon_threadsafe(self._asked, query)
        except RuntimeError:  # the loop has ended; who called is told so
            query.drop()

    def _asked(self, query: zenoh.Query) -> None:
        if self._open:
            self.begin(query, query.payload.to_bytes() if query.payload else b"")
        else:
            self.drop(query)

    def drop(self, call: zenoh.Query) -> None:
        """See `RemoteServer.drop`."""
        call.drop()

    def reply(self, call: zenoh.Query, answer: bytes) -> None:
        """See `RemoteServer.reply`."""
        attachment = call.attachment.to_bytes() if call.attachment else b""
        self._send(call, lambda: call.reply(self._key, answer, attachment=attachment))

    def refuse(self, call: zenoh.Query, why: str) -> None:
        """See `RemoteServer.refuse`."""
        self._send(call, lambda: call.reply_err(why))

    def _send(self, call: zenoh.Query, send: Callable[[], object]) -> None:
        def work() -> None:
            with call:
                send()

        self._holder.send(work)

    async def close(self) -> None:
        """See `Server.close`."""
        self._open = False
        end, self.end = self.end, None
        if end is not None:
            self._holder.closed(self)
            await self._holder.ask(lambda: self._holder.take_away(self.token, end))
