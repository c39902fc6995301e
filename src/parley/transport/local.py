"""Everything in one process: messages are handed over as the objects they are."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable
from types import TracebackType
from typing import Any, Generic, Self, TypeVar

from parley.messages.actions import Action
from parley.messages.topics import Service, Topic
from parley.transport.actions import CallingActionClient
from parley.transport.base import Endpoint, Handler, Publisher, Subscription, absolute
from parley.transport.inbox import Inbox, being_cancelled
from parley.transport.refusals import (
    answered_already,
    check_message,
    check_request,
    failed,
    nobody_answers,
    too_late,
    types_differ,
    went_away,
)

__all__ = ["LocalTransport"]

M = TypeVar("M")
Req = TypeVar("Req")
Res = TypeVar("Res")
Goal = TypeVar("Goal")
Result = TypeVar("Result")
Feedback = TypeVar("Feedback")


class _LocalPublisher(Generic[M]):
    def __init__(self, transport: LocalTransport, topic: Topic[M]) -> None:
        self._transport, self._topic, self._open = transport, topic, True

    def publish(self, message: M) -> None:
        check_message(self._topic, message)
        if self._open:
            self._transport._deliver(self._topic, message)

    def close(self) -> None:
        if self._open:
            self._open = False
            self._transport._forget(self)


class _LocalSubscription(Inbox[M]):
    def __init__(self, transport: LocalTransport, topic: Topic[M], handler: Handler[M], **inbox: Any) -> None:
        super().__init__(topic, handler, on_failure=transport._count_failure, **inbox)
        self._transport = transport

    async def close(self) -> None:
        self._transport._forget(self)
        await super().close()


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

    def publisher(self, topic: Topic[M]) -> Publisher[M]:
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
        late: bool = False,
    ) -> _LocalSubscription[M]:
        """See `Transport.subscribe`."""
        self._check_type(topic.name, topic.ros_type)
        subscription = _LocalSubscription(self, topic, handler, depth=depth, along=along)
        self._subscriptions.setdefault(absolute(topic.name), []).append(subscription)
        if topic.qos.latched and absolute(topic.name) in self._latched:
            subscription.put(self._latched[absolute(topic.name)])
        self._changed()
        return subscription

    async def serve(
        self, service: Service[Req, Res], handler: Callable[[Req], Awaitable[Res]]
    ) -> _LocalServer:
        """See `Transport.serve`."""
        name = absolute(service.name)
        self._check_type(service.name, service.ros_type)
        if name in self._servers:
            raise answered_already(service.name)
        server = _LocalServer(self, name)
        self._servers[name] = (server, service.ros_type, handler)
        self._changed()
        return server

    async def call(self, service: Service[Req, Res], request: Req, *, timeout_s: float) -> Res:
        """See `Transport.call`."""
        entry = self._servers.get(absolute(service.name))
        if entry is None:
            raise nobody_answers(service.name)
        self._check_type(service.name, service.ros_type)
        check_request(service, request)
        task: asyncio.Task[Res] = asyncio.ensure_future(entry[2](request))
        self._calls.add(task)
        task.add_done_callback(self._calls.discard)
        limit = asyncio.timeout(timeout_s)
        try:
            async with limit:
                return await task
        except asyncio.CancelledError:
            if being_cancelled():
                raise
            raise went_away(service.name) from None
        except Exception as error:
            if limit.expired():
                raise too_late(service.name, timeout_s) from error
            raise failed(service.name, error) from error

    async def action_client(
        self, action: Action[Goal, Result, Feedback]
    ) -> CallingActionClient[Goal, Result, Feedback]:
        """See `Transport.action_client`."""
        client = CallingActionClient(self, action)
        await client.open()
        return client

    def named(self, name: str) -> Self:
        """See `Transport.named`."""
        return self

    def endpoints(self) -> tuple[Endpoint, ...]:
        """See `Transport.endpoints`."""
        found = [Endpoint(absolute(p._topic.name), p._topic.ros_type, "publisher") for p in self._publishers]
        for name, items in self._subscriptions.items():
            found += [Endpoint(name, item._topic.ros_type, "subscription") for item in items]
        found += [Endpoint(name, ros_type, "server") for name, (_, ros_type, _) in self._servers.items()]
        return tuple(found)

    def on_endpoints_changed(self, handler: Callable[[], Any]) -> Callable[[], None]:
        """See `Transport.on_endpoints_changed`."""
        self._watchers.append(handler)
        return lambda: self._watchers.remove(handler) if handler in self._watchers else None

    def _check_type(self, name: str, ros_type: str) -> None:
        known = self._types.setdefault(absolute(name), ros_type)
        if known != ros_type:
            raise types_differ(name, known, ros_type)

    def _deliver(self, topic: Topic[M], message: M) -> None:
        name = absolute(topic.name)
        if topic.qos.latched:
            self._latched[name] = message
        for subscription in self._subscriptions.get(name, ()):
            subscription.put(message)

    def _forget(self, end: _LocalPublisher[Any] | _LocalSubscription[Any]) -> None:
        if isinstance(end, _LocalPublisher):
            self._publishers.remove(end)
        else:
            items = self._subscriptions.get(absolute(end._topic.name), [])
            if end not in items:
                return
            items.remove(end)
        self._changed()

    def _unserve(self, name: str, server: _LocalServer) -> None:
        if name in self._servers and self._servers[name][0] is server:
            del self._servers[name]
            self._changed()

    def _count_failure(self) -> None:
        self.handler_failures += 1

    def _changed(self) -> None:
        for watcher in list(self._watchers):
            watcher()
