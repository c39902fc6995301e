"""The backend itself. See `parley.transport.base.Transport` for the contract."""

from __future__ import annotations

import asyncio
import atexit
import contextlib
import itertools
import threading
from collections.abc import Callable
from pathlib import Path
from types import TracebackType
from typing import Any, Final, Self, TypeVar

import structlog
import zenoh
from zenoh import ext
from zenoh.handlers import Callback

from parley.clock import Clock, WallClock
from parley.config import NetworkSettings
from parley.errors import UnavailableError
from parley.messages.topics import QoS, Service, Topic
from parley.transport import remote
from parley.transport.base import Endpoint
from parley.transport.refusals import failed, went_away
from parley.transport.remote import RemoteTransport
from parley.transport.zenoh.cdr import Codec
from parley.transport.zenoh.definitions import Definitions
from parley.transport.zenoh.ends import Declared, ZenohPublisher, ZenohServer, ZenohSubscription
from parley.transport.zenoh.graph import Graph
from parley.transport.zenoh.keys import Attachment, Node, all_tokens, gid_of, key
from parley.transport.zenoh.lane import Lane
from parley.transport.zenoh.session import config, reason

__all__ = ["ZenohTransport"]

M = TypeVar("M")
T = TypeVar("T")
_End = ZenohPublisher[Any] | ZenohSubscription[Any] | ZenohServer

CLOSING_S: Final = 5.0
"""How long closing waits for the library; then the process goes on without."""
SERVICE_QOS: Final = QoS(depth=10)
UNTOLD: Final = ext.MissDetectionConfig(heartbeat=None, sporadic_heartbeat=None)
"""A sender tells its newest number with each message alone: told besides, those who came later would hear all
that it keeps, as if they had missed it. And closing what tells it holds all of Python up, up to 10 s."""
_BLOCK: Final = zenoh.CongestionControl.BLOCK

log = structlog.get_logger(__name__)


class ZenohTransport(RemoteTransport[Graph]):
    """Messages between processes and machines: ``async with ZenohTransport(...):``.

    Stops, calls and everything else go each their own way, so that none waits for the other.

    Args:
        network: Which network, and how to reach it.
        node: How this process is called there; letters, digits and underscores.
        definitions: Folders with the definitions of types that are not ours: `<package>/msg/<Name>.msg`.
        clock: For the stamps of messages.
    """

    def __init__(
        self,
        network: NetworkSettings | None = None,
        *,
        node: str = "parley",
        definitions: tuple[Path, ...] = (),
        clock: Clock | None = None,
    ) -> None:
        super().__init__(Graph())
        self._network, self._node_name = network or NetworkSettings(), node
        self._clock: Clock = clock or WallClock()
        self._definitions = Definitions(*definitions)
        self._numbers = itertools.count(1)
        self._tokens: dict[str, zenoh.LivelinessToken] = {}
        self._waiting: set[asyncio.Future[Any]] = set()

    async def __aenter__(self) -> Self:
        self._loop = asyncio.get_running_loop()
        self._stops, self._calls, self._data = Lane("stops"), Lane("calls"), Lane("messages")
        try:
            await self.ask(self._open_session)
            self._node = Node(self._network.domain, str(self._session.zid()), self._node_name)
            self._stamp_call, self._calls_made = self.stamps(self._node.token()), itertools.count(1)
            await self.ask(self._begin)
        except zenoh.ZError as error:
            self._abandon()
            raise UnavailableError(
                f"the network cannot be reached: {reason(error, self._network)}"
            ) from error
        except BaseException:
            self._abandon()
            raise
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        try:
            async with asyncio.timeout(CLOSING_S):
                await self._close_ends()
                for waiting in self._waiting:
                    if not waiting.done():
                        waiting.set_result(None)
                await self._end_tasks()
                for lane in (self._stops, self._data, self._calls):  # what was published before is sent yet
                    await lane.ask(lambda: None)
                await self.ask(self._session.close)
                atexit.unregister(self._end_session)
        except TimeoutError:
            log.warning("the network did not close in time; going on without")
        finally:
            self._end_lanes()

    def _make_codec(self, python_type: type[M], ros_type: str) -> Codec[M]:
        return Codec(self._definitions, python_type, ros_type)

    def _open_publisher(
        self, topic: Topic[M], codec: remote.Codec[M], endpoint: Endpoint
    ) -> ZenohPublisher[M]:
        place, token = self._place(endpoint, topic.qos)
        urgent = topic.qos.keep_all or topic.qos.urgent
        options: dict[str, Any] = {
            "congestion_control": _BLOCK if topic.qos.reliable else zenoh.CongestionControl.DROP,
            "priority": zenoh.Priority.REAL_TIME if urgent else zenoh.Priority.DATA,
            "express": urgent,
        }

        def declare() -> zenoh.Publisher | ext.AdvancedPublisher:
            made: zenoh.Publisher | ext.AdvancedPublisher
            if topic.qos.latched:
                cache = ext.CacheConfig(topic.qos.depth)
                made = ext.declare_advanced_publisher(
                    self._session, place, cache=cache, publisher_detection=True, **options
                )
            elif topic.qos.kept:
                cache = ext.CacheConfig(topic.qos.kept)
                made = ext.declare_advanced_publisher(
                    self._session, place, cache=cache, sample_miss_detection=UNTOLD, **options
                )
            else:
                made = self._session.declare_publisher(place, **options)
            self._show(token)
            return made

        lane = self._stops if urgent else self._data
        publisher = ZenohPublisher(self, topic, codec, lane, declare, token)
        self._opened(publisher, endpoint)
        return publisher

    async def _open_subscription(
        self, topic: Topic[M], codec: remote.Codec[M], endpoint: Endpoint, inbox: dict[str, Any],
        *, late: bool,
    ) -> ZenohSubscription[M]:  # fmt: skip
        place, token = self._place(endpoint, topic.qos)
        subscription: ZenohSubscription[M] = ZenohSubscription(token, self, topic, codec, endpoint, inbox)
        receive = Callback(subscription.on_sample, indirect=False)

        def declare() -> None:
            if topic.qos.latched:
                history = ext.HistoryConfig(detect_late_publishers=True, max_samples=topic.qos.depth)
                subscription.end = ext.declare_advanced_subscriber(
                    self._session, place, receive, history=history
                )
            elif late and topic.qos.kept:
                recovery = ext.RecoveryConfig(heartbeat=True, periodic_queries=None)
                subscription.end = ext.declare_advanced_subscriber(
                    self._session, place, receive, recovery=recovery
                )
            else:
                subscription.end = self._session.declare_subscriber(place, receive)
            self._show(token)

        self._opened(subscription, endpoint)
        await self.ask(declare)
        return subscription

    async def _open_server(
        self, service: Service[Any, Any], endpoint: Endpoint, answer: remote.Answer
    ) -> ZenohServer:
        place, token = self._place(endpoint, SERVICE_QOS)
        server = ZenohServer(self, endpoint, answer, place, token)
        receive = Callback(server.on_query, indirect=False)

        def declare() -> None:
            server.end = self._session.declare_queryable(place, receive, complete=True)
            self._show(token)

        self._opened(server, endpoint)
        await self.ask(declare)
        return server

    # `Holder`: what its ends ask of it

    async def ask(self, job: Callable[[], T]) -> T:
        """See `Holder.ask`."""
        return await self._calls.ask(job)

    def send(self, job: Callable[[], object]) -> None:
        """See `Holder.send`."""
        self._calls.do(job)

    def stamps(self, whose: str) -> Callable[[int], bytes]:
        """See `Holder.stamps`."""
        gid = gid_of(whose)
        return lambda number: Attachment(number, self._clock.unix_ms() * 1_000_000, gid).to_bytes()

    def closed(self, end: _End) -> None:
        """See `Holder.closed`."""
        self._ends.remove(end)
        self._graph.remove_own(end.token)

    def take_away(self, token: str, end: Declared) -> None:
        """See `Holder.take_away`."""
        shown = self._tokens.pop(token, None)
        if shown is not None:
            shown.undeclare()
        end.undeclare()

    # Inside

    def _open_session(self) -> None:
        self._session = zenoh.open(config(self._network))
        atexit.register(self._end_session)  # threads of the library that call Python at its end crash it

    def _abandon(self) -> None:
        """It did not come to be open, or nobody waits for it any more; what there is of it is closed."""

        def close() -> None:
            if hasattr(self, "_session"):
                atexit.unregister(self._end_session)
                self._session.close()

        self._calls.do(close)
        self._end_lanes()

    def _begin(self) -> None:
        self._show(self._node.token())
        self._session.liveliness().declare_subscriber(
            all_tokens(self._network.domain), Callback(self._on_token, indirect=False), history=True
        )

    def _on_token(self, sample: zenoh.Sample) -> None:
        """Somebody came or went; on a thread of the library."""
        is_there = sample.kind == zenoh.SampleKind.PUT
        with contextlib.suppress(RuntimeError):  # the loop has ended, and nobody looks
            self._loop.call_soon_threadsafe(lambda: self._graph.seen(str(sample.key_expr), is_there=is_there))

    def _place(self, endpoint: Endpoint, qos: QoS) -> tuple[str, str]:
        """Key and token of an end that is to be opened."""
        type_hash = self._definitions.hash(endpoint.ros_type)
        token = self._node.end_token(next(self._numbers), endpoint, type_hash, qos)
        return key(self._node.domain, endpoint.name, endpoint.ros_type, type_hash), token

    def _opened(self, end: _End, endpoint: Endpoint) -> None:
        self._ends.append(end)
        self._graph.add_own(end.token, endpoint)

    def _show(self, token: str) -> None:
        """Let others see that an end is there. Not on the loop."""
        self._tokens[token] = self._session.liveliness().declare_token(token)

    async def _request(self, service: Service[Any, Any], request: bytes, timeout_s: float) -> bytes:
        waiting: asyncio.Future[bytes | str | None] = self._loop.create_future()
        self._waiting.add(waiting)
        given_up = zenoh.CancellationToken()

        def settle(answer: bytes | str | None) -> None:
            if not waiting.done():
                waiting.set_result(answer)

        def on_reply(reply: zenoh.Reply) -> None:
            if reply.ok is not None:
                settle_soon(reply.ok.payload.to_bytes())
            elif reply.err is not None:
                settle_soon(reply.err.payload.to_string())

        def settle_soon(answer: bytes | str | None) -> None:
            with contextlib.suppress(RuntimeError):  # the loop has ended, and nobody waits
                self._loop.call_soon_threadsafe(settle, answer)

        def get() -> None:
            if not waiting.done():
                self._session.get(
                    key(self._node.domain, service.name, service.ros_type, type_hash),
                    Callback(on_reply, drop=lambda: settle_soon(None), indirect=False),
                    target=zenoh.QueryTarget.ALL_COMPLETE,
                    consolidation=zenoh.ConsolidationMode.NONE,
                    timeout=timeout_s + 1.0,  # ours comes first
                    congestion_control=_BLOCK,
                    priority=zenoh.Priority.INTERACTIVE_HIGH,
                    payload=request,
                    attachment=self._stamp_call(next(self._calls_made)),
                    cancellation_token=given_up,
                )

        type_hash = self._definitions.hash(service.ros_type)
        self._calls.do(get)
        try:
            answer = await waiting
        finally:
            self._waiting.discard(waiting)
            self._calls.do(given_up.cancel)
        if answer is None:
            raise went_away(service.name)
        if isinstance(answer, str):
            raise failed(service.name, answer)
        return answer

    def _end_session(self) -> None:
        """The process ends: close, but not at any price."""
        closing = threading.Thread(target=self._session.close, name="zenoh close", daemon=True)
        closing.start()
        closing.join(CLOSING_S)

    def _end_lanes(self) -> None:
        for lane in (self._stops, self._calls, self._data):
            lane.close()
