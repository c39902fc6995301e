"""The terminal's end of the topics: what it hears goes into the view, what the operator decides goes out."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Sequence
from typing import Final, Self, TypeVar

import structlog
from pydantic import BaseModel

from parley.clock import Clock
from parley.errors import InvalidMessageError
from parley.latest import Latest
from parley.messages import topics
from parley.messages.chat import ChatFeedback, ChatInput, ChatRead, ReplyDraft
from parley.messages.memory import RETURN_ALL, GetMemory, MemoryEntry, MemoryReply
from parley.messages.principal import person
from parley.messages.ros import ChatRequest, String
from parley.messages.status import (
    ActorStatus,
    GraphEvent,
    PlanDecision,
    Rejection,
    StopCommand,
    StopReport,
)
from parley.messages.topics import Topic
from parley.messages.wire import decode, decode_plan, encode, to_string
from parley.terminal.lines import Line
from parley.terminal.view import OperatorView
from parley.transport.base import Publisher, Transport
from parley.transport.desk import Desk

__all__ = ["Link"]

log = structlog.get_logger(__name__)

P = TypeVar("P", bound=BaseModel)

OPERATOR: Final = person(device="terminal")
"""Whoever sits at the terminal."""
_MEMORY_TIMEOUT_S = 10.0


class Link:
    """Connects an `OperatorView` to a transport. Use as ``async with``.

    Args:
        transport: Opened by the caller; only what is opened here is closed here.
        view: Gets every message.
        on_lines: Gets what each message adds to the conversation, often nothing.
        clock: For the time at which heartbeats come.
    """

    def __init__(
        self,
        transport: Transport,
        view: OperatorView,
        on_lines: Callable[[Sequence[Line]], None],
        clock: Clock,
    ) -> None:
        self._transport, self._view, self._on_lines, self._clock = transport, view, on_lines, clock
        self._stack = contextlib.AsyncExitStack()
        self._publishers: dict[type[BaseModel], Publisher[String]] = {}
        self.read: Latest[str, bool] = Latest()
        """Messages that got to who reads them, by id."""
        self._untaken: dict[str, StopCommand] = {}
        """Stops that robots have not confirmed."""

    async def __aenter__(self) -> Self:
        """Open the topics."""
        for kind, topic in _SENT.items():
            publisher = self._transport.publisher(topic)
            self._stack.callback(publisher.close)
            self._publishers[kind] = publisher
        view = self._view
        await self._listen(topics.CHAT_FEEDBACK, _reader(ChatFeedback), view.on_feedback)
        await self._listen(topics.REPLY_DRAFT, _reader(ReplyDraft), view.on_draft)
        await self._listen(topics.PLAN, decode_plan, view.on_plan)
        await self._listen(topics.GRAPH_EVENTS, _reader(GraphEvent), view.on_event)
        await self._listen(topics.ACTOR_STATUS, _reader(ActorStatus), self._on_status)
        await self._listen(topics.CHAT_READ, _reader(ChatRead), self._on_read)
        await self._listen(topics.STOP_REPORT, _reader(StopReport), self._on_stop_report)
        await self._listen(topics.REJECTION, _reader(Rejection), view.on_rejection)
        await self._stack.enter_async_context(Desk(self._transport, lambda: tuple(self._untaken.values())))
        return self

    async def __aexit__(self, *exc: object) -> None:
        """Close them."""
        await self._stack.aclose()

    def send(self, message: ChatInput | PlanDecision | StopCommand) -> None:
        """Publish what the operator said or decided on the topic of its kind, as theirs."""
        theirs = message.model_copy(update={"by": OPERATOR})
        if isinstance(theirs, StopCommand):
            for name in theirs.targets or [robot.name for robot in self._view.here]:
                self._untaken.pop(name, None)
                if theirs.command == "stop":
                    self._untaken[name] = theirs.model_copy(update={"targets": (name,)})
        self._publishers[type(message)].publish(to_string(theirs))

    async def memories(self) -> list[MemoryEntry]:
        """Everything that is remembered, oldest first.

        Raises:
            TransportError: The memory does not answer.
            InvalidMessageError: Its answer cannot be read.
        """
        request = ChatRequest(encode(GetMemory(request=RETURN_ALL, pictures=False)))
        reply = await self._transport.call(topics.GET_MEMORY, request, timeout_s=_MEMORY_TIMEOUT_S)
        return decode(MemoryReply, reply.response).entries()

    async def _listen(
        self, topic: Topic[String], read: Callable[[str], P], handle: Callable[[P], list[Line]]
    ) -> None:
        def receive(message: String) -> None:
            try:
                payload = read(message.data)
            except InvalidMessageError as error:
                log.warning("unreadable message", topic=topic.name, error=str(error))
                return
            self._on_lines(handle(payload))

        subscription = await self._transport.subscribe(topic, receive)
        self._stack.push_async_callback(subscription.close)

    def _on_read(self, read: ChatRead) -> list[Line]:
        self.read[read.id] = True
        return []

    def _on_stop_report(self, report: StopReport) -> list[Line]:
        self._untaken.pop(report.actor, None)
        return self._view.on_stop_report(report)

    def _on_status(self, status: ActorStatus) -> list[Line]:
        return self._view.on_status(status, self._clock.wall_s())


_SENT: dict[type[BaseModel], Topic[String]] = {
    ChatInput: topics.CHAT_INPUT,
    PlanDecision: topics.PLAN_DECISION,
    StopCommand: topics.STOP,
}


def _reader(kind: type[P]) -> Callable[[str], P]:
    return lambda text: decode(kind, text)
