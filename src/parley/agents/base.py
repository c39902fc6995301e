"""What every node shares: opening and closing, decoding at the border, ordered work per robot.

A node is born quiet and opened on purpose::

    class Echo(Node):
        name = "echo"

        async def open(self) -> None:
            await self.subscribe(topics.CHAT_INPUT, ChatInput, self._on_input)

        def _on_input(self, said: ChatInput) -> None:
            self.publish(topics.CHAT_FEEDBACK, ChatFeedback(message=said.message))

    async with Echo(transport):
        ...
"""

from __future__ import annotations

import asyncio
import inspect
from collections import deque
from collections.abc import Awaitable, Callable, Coroutine, Hashable
from contextlib import AsyncExitStack
from types import TracebackType
from typing import Any, ClassVar, Generic, Self, TypeVar

import structlog
from pydantic import BaseModel

from parley.errors import InvalidMessageError
from parley.messages import topics
from parley.messages.chat import ChatFeedback
from parley.messages.ros import String
from parley.messages.status import PlanProposal, PlanUpdate, Rejection, RejectionProblem
from parley.messages.topics import Topic
from parley.messages.wire import decode, decode_plan, to_string
from parley.sentences import SpokenLanguage, in_language, sentence
from parley.transport.base import Handler, Publisher, Subscription, Transport
from parley.transport.inbox import Turn
from parley.transport.losses import Losses

__all__ = ["Mailboxes", "Node"]

M = TypeVar("M")
P = TypeVar("P", bound=BaseModel)
K = TypeVar("K", bound=Hashable)

log = structlog.get_logger(__name__)


class Node:
    """Base of the nodes: use as ``async with``; what it opened is closed in reverse order.

    Subclasses set `name` and override `open`.
    """

    name: ClassVar[str] = "node"
    """Who speaks, in rejections and logs."""
    apart: ClassVar[bool] = False
    """Whether others know it by that name: a network that has names for nodes shows it as one."""
    speaks: SpokenLanguage = "en"
    """The language of the sentences it says of its own accord; set before it is opened."""

    def __init__(self, transport: Transport) -> None:
        self.transport = transport
        self.log = log.bind(node=self.name)
        self.opened = AsyncExitStack()
        """Closed with the node; enter here whatever the node needs while it is open."""
        self._publishers: dict[str, Publisher[Any]] = {}
        self._tasks: set[asyncio.Task[Any]] = set()
        self._closed = False

    async def __aenter__(self) -> Self:
        self._closed = False
        if self.apart:
            self.transport = self.transport.named(self.name)
        self.opened.push_async_callback(self._close_ends)
        try:
            await self.open()
        except BaseException:
            await self.opened.aclose()
            raise
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        await self.opened.aclose()

    async def open(self) -> None:
        """Subscribe, serve and start what the node needs; override."""

    async def subscribe(
        self,
        topic: Topic[String],
        kind: type[P],
        handler: Handler[P],
        *,
        depth: int | None = None,
        in_charge: bool = False,
    ) -> Subscription:
        """Hand every payload of `topic` to `handler`, typed.

        A message that does not fit is answered with a `Rejection`; it never reaches the handler and disturbs
        nothing else.

        Args:
            topic: The topic.
            kind: What it carries.
            handler: Gets it.
            depth: How many may wait; of more the oldest are lost.
            in_charge: Whether a person would miss what is lost here: then it is said.
        """
        losses = Losses(self._tell_lost)

        async def receive(message: String) -> None:
            losses.look()
            try:
                payload = decode(kind, message.data)
            except InvalidMessageError as error:
                self.refuse(topic.name, error)
                return
            answer = handler(payload)
            if inspect.isawaitable(answer):
                await answer

        subscription = await self.subscribe_raw(topic, receive, depth=depth)
        if in_charge:
            losses.watch(subscription)
        return subscription

    def _tell_lost(self, count: int) -> None:
        text = sentence(
            "Messages that I lost, as so much came at once or the connection was away: {count}. Look whether "
            "all is as you want it, and say again what is missing.",
            count=count,
        )
        self.publish(topics.CHAT_FEEDBACK, ChatFeedback(message=self.spoken(text), type="error"))

    async def subscribe_raw(
        self, topic: Topic[M], handler: Handler[M], *, depth: int | None = None, late: bool = False
    ) -> Subscription:
        """Subscribe to a topic whose messages need no decoding; closed with the node."""
        subscription = await self.transport.subscribe(topic, handler, depth=depth, late=late)
        self.opened.push_async_callback(subscription.close)
        return subscription

    async def subscribe_plans(self, handler: Callable[[PlanUpdate | PlanProposal], None]) -> Subscription:
        """Hand every plan and proposal that is published to `handler`; see `subscribe`."""

        def receive(message: String) -> None:
            try:
                told = decode_plan(message.data)
            except InvalidMessageError as error:
                self.refuse(topics.PLAN.name, error)
                return
            handler(told)

        return await self.subscribe_raw(topics.PLAN, receive)

    def publish(self, topic: Topic[String], payload: BaseModel) -> None:
        """Publish a JSON payload."""
        self.send(topic, to_string(payload))

    def announce(self, topic: Topic[M]) -> None:
        """Open the sending end of a topic before there is anything to say, for those who look who speaks."""
        if topic.name not in self._publishers:
            self._publishers[topic.name] = self.transport.publisher(topic)

    def send(self, topic: Topic[M], message: M) -> None:
        """Publish a message as it is. The sending end is opened at its first use.

        After the node is closed nothing is sent: work that comes to its end then has nobody to tell.
        """
        if self._closed:
            self.log.debug("not sent: the node is closed", topic=topic.name)
            return
        self.announce(topic)
        self._publishers[topic.name].publish(message)

    def spoken(self, text: str) -> str:
        """One of our own sentences as it is said to operators."""
        return in_language(text, self.speaks)

    def refuse(self, what: str, error: InvalidMessageError, *, target: str = "") -> None:
        """Tell everybody that a message was refused, and why.

        Args:
            what: The topic or service it came by.
            error: Why.
            target: The robot it concerned, if known.
        """
        self.log.warning("message refused", what=what, path=error.path, problem=error.problem)
        problem = RejectionProblem(path=error.path, message=str(error), code="invalid_message")
        self.publish(
            topics.REJECTION, Rejection(source=self.name, target=target, what=what, problems=(problem,))
        )

    def spawn(self, work: Coroutine[Any, Any, object], *, name: str = "") -> asyncio.Task[Any]:
        """Run `work` beside everything else; a failure is logged, closing the node cancels it."""
        task: asyncio.Task[Any] = asyncio.create_task(work, name=f"{self.name} {name}".rstrip())
        self._tasks.add(task)
        task.add_done_callback(self._finished)
        return task

    def _finished(self, task: asyncio.Task[Any]) -> None:
        self._tasks.discard(task)
        if not task.cancelled() and (error := task.exception()) is not None:
            self.log.error("background work failed", task=task.get_name(), exc_info=error)

    async def _close_ends(self) -> None:
        await _cancel(self._tasks)
        self._closed = True
        for publisher in self._publishers.values():
            publisher.close()
        self._publishers.clear()


class Mailboxes(Generic[K]):
    """Work in order per key, different keys side by side, without locks.

    Use as ``async with`` (or call `close`). A mailbox exists only while it has work.

    Args:
        on_failure: Gets the key and the exception of an item that failed, once it is logged; must not raise.
    """

    def __init__(self, on_failure: Callable[[K, Exception], None] | None = None) -> None:
        self._on_failure = on_failure
        self._waiting: dict[K, deque[Callable[[], Awaitable[None]]]] = {}
        self._tasks: set[asyncio.Task[None]] = set()
        self._closed = False

    async def __aenter__(self) -> Self:
        self._closed = False
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        await self.close()

    def post(self, key: K, work: Callable[[], Awaitable[None]]) -> None:
        """Run `work` after everything that was posted for `key` before; returns at once.

        After `close` it is dropped: whoever closes wants nothing to happen any more.
        """
        if self._closed:
            log.debug("posted to closed mailboxes", key=key)
            return
        waiting = self._waiting.get(key)
        if waiting is not None:
            waiting.append(work)
            return
        self._waiting[key] = deque([work])
        task = asyncio.create_task(self._run(key), name=f"mailbox {key}")
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)

    @property
    def busy(self) -> frozenset[K]:
        """Keys with work that waits or runs."""
        return frozenset(self._waiting)

    async def close(self) -> None:
        """Cancel what runs, forget what waits. May be called by an item itself. Idempotent."""
        self._closed = True
        for waiting in self._waiting.values():
            waiting.clear()
        await _cancel(self._tasks)

    async def _run(self, key: K) -> None:
        waiting, turn = self._waiting[key], Turn()
        try:
            while waiting:
                await self._do(key, waiting.popleft())
                await turn.pause()
        finally:
            del self._waiting[key]

    async def _do(self, key: K, work: Callable[[], Awaitable[None]]) -> None:
        try:
            await work()
        except asyncio.CancelledError:
            task = asyncio.current_task()
            if task is None or task.cancelling():
                raise
            # Not us: the item waited for something that was cancelled. The next one must still run.
            log.info("mailbox item was cancelled", key=key)
        except Exception as error:
            # Logged and reported; one defect must not silence a robot's mailbox.
            log.error("mailbox item failed", key=key, exc_info=error)
            if self._on_failure is not None:
                self._on_failure(key, error)


async def _cancel(tasks: set[asyncio.Task[Any]]) -> None:
    """Cancel tasks and wait until they are gone; the calling task, if among them, ends by itself."""
    others = [task for task in tasks if task is not asyncio.current_task()]
    for task in others:
        task.cancel()
    await asyncio.gather(*others, return_exceptions=True)
