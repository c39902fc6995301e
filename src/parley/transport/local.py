"""Everything in one process: messages are handed over as the objects they are."""

from __future__ import annotations

import asyncio
import inspect
from collections import deque
from collections.abc import Awaitable, Callable
from types import TracebackType
from typing import Any, Generic, Self, TypeVar

import structlog

from parley.errors import TransportError, TransportTimeoutError, TypeMismatchError, UnavailableError
from parley.messages.actions import Action
from parley.messages.topics import Service, Topic
from parley.transport.actions import CallingActionClient
from parley.transport.base import Endpoint, Handler, Subscription

__all__ = ["LocalTransport"]

M = TypeVar("M")
Req = TypeVar("Req")
Res = TypeVar("Res")
Goal = TypeVar("Goal")
Result = TypeVar("Result")
Feedback = TypeVar("Feedback")

log = structlog.get_logger(__name__)


class _LocalPublisher(Generic[M]):
    def __init__(self, transport: LocalTransport, topic: Topic[M]) -> None:
        self._transport, self._topic, self._open = transport, topic, True

    def publish(self, message: M) -> None:
        if not isinstance(message, self._topic.type):
            raise TypeMismatchError(
                f"{self._topic.name} carries {self._topic.ros_type}; got a {type(message).__name__}"
            )
        if self._open:
            self._transport._deliver(self._topic, message)

    def close(self) -> None:
        if self._open:
            self._open = False
            self._transport._forget(self)


class _Line:
    """Subscriptions whose messages are handled as they came, one after the other, and the task for it."""

    def __init__(self, name: str) -> None:
        self.turns: deque[_LocalSubscription[Any]] = deque()
        self.users = 0
        self._name = name
        self._arrived = asyncio.Event()
        self._handling: _LocalSubscription[Any] | None = None
        self._work()

    def _work(self) -> None:
        self._task = asyncio.create_task(self._run(), name=f"sub {self._name}")

    def add(self, subscription: _LocalSubscription[Any]) -> None:
        """The newest message of `subscription` is the last in the line."""
        self.turns.append(subscription)
        self._arrived.set()

    async def _run(self) -> None:
        while True:
            while self.turns:
                self._handling = self.turns.popleft()
                await self._handling.take()
                self._handling = None
            self._arrived.clear()
            await self._arrived.wait()

    async def leave(self, subscription: _LocalSubscription[Any]) -> None:
        """A subscription is closed: its handler is cancelled if it runs, the others go on."""
        self.users -= 1
        if self.users and self._handling is not subscription:
            return
        task = self._task
        task.cancel()
        if task is not asyncio.current_task():
            await asyncio.gather(task, return_exceptions=True)
        if self.users:
            self._work()


class _LocalSubscription(Generic[M]):
    """A bounded queue, and the line in which its messages wait for the handler."""

    def __init__(
        self,
        transport: LocalTransport,
        topic: Topic[M],
        handler: Handler[M],
        depth: int,
        line: _Line | None,
    ) -> None:
        self._transport, self._topic, self._handler = transport, topic, handler
        self._queue: deque[M] = deque(maxlen=None if topic.qos.keep_all else depth)
        self._dropped = 0
        self._open = True
        self.line = line or _Line(topic.name)
        self.line.users += 1

    @property
    def dropped(self) -> int:
        return self._dropped

    def put(self, message: M) -> None:
        if len(self._queue) == self._queue.maxlen:
            self._dropped += 1
            if self._dropped.bit_count() == 1:  # 1, 2, 4, 8, ...: a flood does not flood the log
                log.warning(
                    "messages dropped: more came at once than a subscriber takes",
                    topic=self._topic.name,
                    dropped=self._dropped,
                    depth=self._queue.maxlen,
                )
            self.line.turns.remove(self)
        self._queue.append(message)
        self.line.add(self)

    async def take(self) -> None:
        """Handle the message that waits longest; after a closing there is none."""
        if self._queue:
            await self._handle(self._queue.popleft())

    async def _handle(self, message: M) -> None:
        try:
            answer = self._handler(message)
            if answer is not None and inspect.isawaitable(answer):
                await answer
        except asyncio.CancelledError:
            if _being_cancelled():
                raise
            # The handler waited for something that was cancelled; the topic must not fall silent for that.
            log.info("handler was cancelled", topic=self._topic.name)
        except Exception:
            # The border of every node: a defect in one handler must not silence the topic, but must be seen.
            self._transport.handler_failures += 1
            log.exception("handler failed", topic=self._topic.name)

    async def close(self) -> None:
        if self._open:
            self._open = False
            self._queue.clear()
            self._transport._forget(self)
            await self.line.leave(self)


class _LocalServer:
    def __init__(self, transport: LocalTransport, name: str) -> None:
        self._transport, self._name = transport, name

    async def close(self) -> None:
        self._transport._unserve(self._name, self)


class LocalTransport:
    """The default backend. See `parley.transport.base.Transport` for the contract."""

    def __init__(self) -> None:
        self._types: dict[str, str] = {}
        self._subscriptions: dict[str, list[_LocalSubscription[Any]]] = {}
        self._publishers: list[_LocalPublisher[Any]] = []
        self._latched: dict[str, Any] = {}
        self._servers: dict[str, tuple[_LocalServer, str, Callable[[Any], Awaitable[Any]]]] = {}
        self._watchers: list[Callable[[], Any]] = []
        self._calls: set[asyncio.Task[Any]] = set()
        self.handler_failures = 0
        """How many times a handler raised; tests assert that it stays 0."""

    async def __aenter__(self) -> Self:
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        for subscription in [item for items in self._subscriptions.values() for item in items]:
            await subscription.close()
        for publisher in list(self._publishers):
            publisher.close()
        for server, _, _ in list(self._servers.values()):
            await server.close()
        for task in list(self._calls):
            task.cancel()
        await asyncio.gather(*self._calls, return_exceptions=True)
        self._latched.clear()
        self._types.clear()

    def publisher(self, topic: Topic[M]) -> _LocalPublisher[M]:
        """See `Transport.publisher`."""
        self._check_type(topic.name, topic.ros_type)
        publisher = _LocalPublisher(self, topic)
        self._publishers.append(publisher)
        self._changed()
        return publisher

    async def subscribe(
        self,
        topic: Topic[M],
        handler: Handler[M],
        *,
        depth: int | None = None,
        along: Subscription | None = None,
    ) -> _LocalSubscription[M]:
        """See `Transport.subscribe`."""
        self._check_type(topic.name, topic.ros_type)
        line = along.line if isinstance(along, _LocalSubscription) else None
        subscription = _LocalSubscription(self, topic, handler, depth or topic.qos.depth, line)
        self._subscriptions.setdefault(_absolute(topic.name), []).append(subscription)
        if topic.qos.latched and _absolute(topic.name) in self._latched:
            subscription.put(self._latched[_absolute(topic.name)])
        self._changed()
        return subscription

    async def serve(
        self, service: Service[Req, Res], handler: Callable[[Req], Awaitable[Res]]
    ) -> _LocalServer:
        """See `Transport.serve`."""
        name = _absolute(service.name)
        self._check_type(service.name, service.ros_type)
        if name in self._servers:
            raise UnavailableError(f"service {service.name} is answered already; stop the other one first")
        server = _LocalServer(self, name)
        self._servers[name] = (server, service.ros_type, handler)
        self._changed()
        return server

    async def call(self, service: Service[Req, Res], request: Req, *, timeout_s: float) -> Res:
        """See `Transport.call`."""
        entry = self._servers.get(_absolute(service.name))
        if entry is None:
            raise UnavailableError(f"nobody answers service {service.name}; is its node running?")
        self._check_type(service.name, service.ros_type)
        if not isinstance(request, service.request):
            raise TypeMismatchError(
                f"{service.name} takes {service.ros_type}; got a {type(request).__name__}"
            )
        task: asyncio.Task[Res] = asyncio.ensure_future(entry[2](request))
        self._calls.add(task)
        task.add_done_callback(self._calls.discard)
        limit = asyncio.timeout(timeout_s)
        try:
            async with limit:
                return await task
        except asyncio.CancelledError:
            if _being_cancelled():
                raise
            raise UnavailableError(f"service {service.name} went away before it answered") from None
        except Exception as error:
            if limit.expired():
                raise TransportTimeoutError(
                    f"service {service.name} did not answer within {timeout_s} s"
                ) from error
            raise TransportError(f"service {service.name} failed: {error}") from error

    async def action_client(
        self, action: Action[Goal, Result, Feedback]
    ) -> CallingActionClient[Goal, Result, Feedback]:
        """See `Transport.action_client`."""
        client = CallingActionClient(self, action)
        await client.open()
        return client

    def endpoints(self) -> tuple[Endpoint, ...]:
        """See `Transport.endpoints`."""
        found = [Endpoint(_absolute(p._topic.name), p._topic.ros_type, "publisher") for p in self._publishers]
        for name, items in self._subscriptions.items():
            found += [Endpoint(name, item._topic.ros_type, "subscription") for item in items]
        found += [Endpoint(name, ros_type, "server") for name, (_, ros_type, _) in self._servers.items()]
        return tuple(found)

    def on_endpoints_changed(self, handler: Callable[[], Any]) -> Callable[[], None]:
        """See `Transport.on_endpoints_changed`."""
        self._watchers.append(handler)
        return lambda: self._watchers.remove(handler) if handler in self._watchers else None

    def _check_type(self, name: str, ros_type: str) -> None:
        known = self._types.setdefault(_absolute(name), ros_type)
        if known != ros_type:
            raise TypeMismatchError(
                f"{name} is in use as {known}, not {ros_type}; use the same type on both sides"
            )

    def _deliver(self, topic: Topic[M], message: M) -> None:
        name = _absolute(topic.name)
        if topic.qos.latched:
            self._latched[name] = message
        for subscription in self._subscriptions.get(name, ()):
            subscription.put(message)

    def _forget(self, end: _LocalPublisher[Any] | _LocalSubscription[Any]) -> None:
        if isinstance(end, _LocalPublisher):
            self._publishers.remove(end)
        else:
            items = self._subscriptions.get(_absolute(end._topic.name), [])
            if end in items:
                items.remove(end)
        self._changed()

    def _unserve(self, name: str, server: _LocalServer) -> None:
        if name in self._servers and self._servers[name][0] is server:
            del self._servers[name]
            self._changed()

    def _changed(self) -> None:
        for watcher in list(self._watchers):
            watcher()


def _being_cancelled() -> bool:
    """Whether a CancelledError is meant for the current task, not for something it waited for."""
    task = asyncio.current_task()
    return task is not None and task.cancelling() > 0


def _absolute(name: str) -> str:
    """Relative names live in the root namespace here."""
    return name if name.startswith("/") else f"/{name}"
