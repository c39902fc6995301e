"""The audit log's node: hears who wants what and what becomes of it, writes it down, answers questions.

It writes behind: whoever stops a robot or gives an order never waits for the file. What cannot be written now
(the disk is full, the file is locked) waits in a bounded queue; if that overflows, an entry says how many are
missing, as soon as there is room.
"""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import Callable, Sequence
from typing import ClassVar, Final, TypeVar

from pydantic import BaseModel

from parley.agents.base import Node
from parley.clock import Clock
from parley.errors import InvalidMessageError, StoreError
from parley.gate.audit import PRUNE
from parley.gate.audit_store import AuditStore
from parley.gate.heard import Heard
from parley.gate.table import Effect
from parley.messages import topics
from parley.messages.audit import AuditEntry, AuditEvent, AuditList, GetAudit
from parley.messages.chat import ChatAction, ChatInput
from parley.messages.memory import AddToMemory, MemoryEvent
from parley.messages.ros import ChatRequest, ChatResponse, String
from parley.messages.status import ActorStatus, GraphEvent, PlanDecision, Rejection, StopCommand, StopReport
from parley.messages.topics import Topic
from parley.messages.wire import decode, decode_plan, encode
from parley.sentences import sentence
from parley.transport.base import Subscription, Transport

__all__ = ["AuditLog"]

P = TypeVar("P", bound=BaseModel)

_WAITING: Final = 10_000
_BATCH: Final = 200
_RETRY_S: Final = 2.0
_RECALLED: Final = 300
"""So many entries of a kind are read at the start."""
_MONTH_MS: Final = 31 * 24 * 3600 * 1000


class AuditLog(Node):
    """Writes down what it hears; serves `/parley/get_audit`.

    Args:
        transport: Where the topics are.
        store: The open log; its owner closes it.
        clock: Wall time.
        months: How long entries are kept; None: for good.
        tell: Gets a sentence for people when the log cannot be written, and when it can again.
        waiting: How many entries wait while the file cannot be written.
        retry_s: Wall time between two tries.
    """

    name: ClassVar[str] = "audit_log"

    def __init__(
        self,
        transport: Transport,
        store: AuditStore,
        clock: Clock,
        *,
        months: int | None = None,
        tell: Callable[[str], None] = lambda _: None,
        waiting: int = _WAITING,
        retry_s: float = _RETRY_S,
    ) -> None:
        super().__init__(transport)
        self._store, self._clock, self._months, self._tell = store, clock, months, tell
        self._max, self._retry_s = waiting, retry_s
        self._heard = Heard()
        self._waiting: deque[AuditEvent] = deque()
        self._dropped, self._dropped_since = 0, 0
        self._ends: list[Subscription] = []
        self._missed = 0
        """Messages that came faster than they were heard, or could not be heard late."""
        self._writer: asyncio.Task[None] | None = None
        self.problem = ""
        """Why what waits is not written, in plain words; empty: it is."""

    async def open(self) -> None:
        """See `Node.open`."""
        heard = self._heard
        await self._recall()
        self.opened.push_async_callback(self._finish)
        await self._hear(topics.AUDIT, AuditEvent, self._told)
        await self._hear(topics.CHAT_INPUT, ChatInput, heard.on_input)
        await self._hear(topics.CHAT_ACTION, ChatAction, heard.on_action)
        await self._hear(
            topics.UMRF_CORRECTION, ChatAction, lambda order: heard.on_action(order, Effect.REPAIR)
        )
        await self._listen(topics.PLAN, decode_plan, heard.on_plan)
        await self._hear(topics.PLAN_DECISION, PlanDecision, heard.on_decision)
        await self._hear(topics.GRAPH_EVENTS, GraphEvent, heard.on_graph)
        await self._hear(
            topics.ACTOR_STATUS, ActorStatus, lambda told: heard.on_status(told, self._clock.unix_ms())
        )
        await self._hear(topics.STOP, StopCommand, heard.on_stop)
        await self._hear(topics.STOP_REPORT, StopReport, heard.on_report)
        await self._hear(topics.ADD_TO_MEMORY, AddToMemory, heard.on_add)
        await self._hear(topics.MEMORY_EVENT, MemoryEvent, heard.on_memory)
        await self._hear(topics.REJECTION, Rejection, heard.on_rejection)
        server = await self.transport.serve(topics.GET_AUDIT, self._on_get)
        self.opened.push_async_callback(server.close)
        self.write([AuditEvent(effect="open")])
        await self._prune()

    async def _recall(self) -> None:
        """Know who wanted what of robots that go on with what they were told before this began."""
        found: list[AuditEntry] = []
        try:
            for effect in ("begin", "start", "end"):
                found += await self._store.entries(GetAudit(effect=effect, limit=_RECALLED))
        except StoreError as error:
            self.log.warning("the log cannot be read", error=str(error))
        found.sort(key=lambda entry: entry.number)
        self._heard.recall(found)

    def write(self, events: Sequence[AuditEvent]) -> None:
        """Have events written soon, in their order; returns at once."""
        missed, self._missed = self._missed, sum(end.dropped for end in self._ends)
        self._drop(self._missed - missed)
        for event in events:
            if len(self._waiting) >= self._max:
                self._drop(1)
                continue
            stamped = event if event.unix_ms else event.model_copy(update={"unix_ms": self._clock.unix_ms()})
            self._waiting.append(stamped)
        if events and (self._writer is None or self._writer.done()):
            self._writer = asyncio.create_task(self._write(), name="audit log")

    def _drop(self, count: int) -> None:
        if count:
            self._dropped_since = self._dropped_since or self._clock.unix_ms()
            self._dropped += count

    async def flush(self) -> None:
        """Wait until everything is written that can be written."""
        while (self._waiting or self._dropped) and not self.problem and self._writer is not None:
            await asyncio.shield(self._writer)

    async def _hear(
        self, topic: Topic[String], kind: type[P], events: Callable[[P], list[AuditEvent]]
    ) -> None:
        await self._listen(topic, lambda text: decode(kind, text), events)

    async def _listen(
        self, topic: Topic[String], read: Callable[[str], P], events: Callable[[P], list[AuditEvent]]
    ) -> None:
        """Write down what a topic carries; what cannot be read is refused by those it is meant for."""

        def receive(message: String) -> None:
            try:
                self.write(events(read(message.data)))
            except InvalidMessageError as error:
                self.log.debug("unreadable message", topic=topic.name, problem=str(error))

        end = await self.subscribe_raw(topic, receive, depth=max(topic.qos.depth, 1000), late=True)
        if topic.qos.kept:  # else no message is an entry
            self._ends.append(end)

    def _told(self, event: AuditEvent) -> list[AuditEvent]:
        """What others tell; what this log says about itself it says alone."""
        if event.effect in (PRUNE, "open", "close", "gap"):
            self.log.warning("not written: only the log itself says so", effect=event.effect)
            return []
        return [event]

    # -- writing ---------------------------------------------------------------------------------------

    async def _write(self) -> None:
        while self._waiting or self._dropped:
            if not await self._write_batch():
                await asyncio.sleep(self._retry_s)

    async def _write_batch(self) -> bool:
        """Whether the oldest entries that wait, or the gap behind them, are durable now."""
        batch = [self._waiting[index] for index in range(min(_BATCH, len(self._waiting)))]
        gap = () if batch else (self._gap(),)
        dropped = 0 if batch else self._dropped
        try:
            await self._store.append([*batch, *gap])
        except StoreError as error:
            if not self.problem:
                self.log.error("audit log not written", problem=str(error))
                self._tell("The log of who did what cannot be written now. Robots go on and can be stopped.")
            self.problem = str(error)
            return False
        if self.problem:
            self.problem = ""
            self._tell("The log of who did what is written again.")
        for _ in batch:
            self._waiting.popleft()
        self._dropped -= dropped
        if gap:
            self._dropped_since = 0
            text = sentence(
                "The log of who did what lacks {count} messages: its disk could not be written, or the "
                "connection was away for too long. What was done then may not stand in it.",
                count=dropped,
            )
            self._tell(text)
        return True

    def _gap(self) -> AuditEvent:
        return AuditEvent(
            effect="gap",
            outcome="failed",
            detail={"dropped": self._dropped, "since_unix_ms": self._dropped_since},
            unix_ms=self._clock.unix_ms(),
        )

    async def _prune(self) -> None:
        if self._months is None:
            return
        now = self._clock.unix_ms()
        event = AuditEvent(effect=PRUNE, unix_ms=now)
        try:
            await self._store.prune(now - self._months * _MONTH_MS, event)
        except StoreError as error:
            self.log.error("old entries not removed", problem=str(error))

    async def _finish(self) -> None:
        """Write what waits; a file that cannot be written holds nobody up."""
        self.write([AuditEvent(effect="close")])
        await self.flush()
        if self._writer is not None:
            self._writer.cancel()
            await asyncio.gather(self._writer, return_exceptions=True)
        if self._waiting:
            self.log.error("entries of the audit log lost", count=len(self._waiting) + self._dropped)

    # -- reading ---------------------------------------------------------------------------------------

    async def _on_get(self, request: ChatRequest) -> ChatResponse:
        try:
            wanted = decode(GetAudit, request.message)
            await self.flush()
            found = AuditList(
                entries=await self._store.entries(wanted),
                chain=await self._store.check() if wanted.verify else None,
                problem=self.problem,
            )
        except InvalidMessageError as error:
            self.refuse(topics.GET_AUDIT.name, error)
            found = AuditList(problem=str(error))
        except StoreError as error:
            found = AuditList(problem=str(error))
        return ChatResponse(encode(found))
