"""Hears what robots tell, for the door: one stream per listener, and what is known of each robot."""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import Callable
from typing import ClassVar, Final, Self

from parley.agents.base import Node
from parley.agents.planner.asking import Offered
from parley.agents.questions import OpenQuestions
from parley.errors import ParleyError
from parley.messages import topics
from parley.messages.chat import ChatFeedback, ChatInput
from parley.messages.incident import Incident
from parley.messages.memory import MemoryEvent
from parley.messages.status import (
    ActorStatus,
    GraphEvent,
    PlanDecision,
    PlanProposal,
    PlanRuling,
    PlanUpdate,
    Rejection,
    StopReport,
)
from parley.transport.base import Transport

__all__ = ["Event", "Events", "Listener"]

Event = (
    ChatFeedback | PlanUpdate | PlanProposal | GraphEvent | StopReport | Rejection | MemoryEvent | Incident
)
"""Everything that a stream of events carries."""

KEPT: Final = 10_000
"""Events that wait for a slow listener; when there are more, it is told that some are lost."""


class Events:
    """A stream of events, from when it was asked for: ``async for event in events``; `close` ends it.

    Raises, while iterating:
        ParleyError: More came than were fetched in time; says how many are lost. The next ones follow.
    """

    def __init__(self, wanted: Callable[[Event], bool], forget: Callable[[Events], None]) -> None:
        self._wanted, self._forget = wanted, forget
        self._waiting: deque[Event] = deque()
        self._arrived = asyncio.Event()
        self._lost = 0
        self._closed = False

    def put(self, event: Event) -> None:
        """Add an event, if it is wanted."""
        if self._closed or not self._wanted(event):
            return
        if len(self._waiting) >= KEPT:
            self._waiting.popleft()
            self._lost += 1
        self._waiting.append(event)
        self._arrived.set()

    def close(self) -> None:
        """End the stream. Idempotent."""
        self._closed = True
        self._forget(self)
        self._arrived.set()

    async def __aenter__(self) -> Self:
        return self

    async def __aexit__(self, *exc: object) -> None:
        self.close()

    def __aiter__(self) -> Self:
        return self

    async def __anext__(self) -> Event:
        while not self._waiting:
            if self._closed:
                raise StopAsyncIteration
            self._arrived.clear()
            await self._arrived.wait()
        if self._lost:
            lost, self._lost = self._lost, 0
            raise ParleyError(f"{lost} events are lost: they were not fetched in time")
        return self._waiting.popleft()


class Listener(Node):
    """Subscribes to what the door tells; knows plans, proposals and questions of each robot."""

    name: ClassVar[str] = "door"

    def __init__(self, transport: Transport, rulings: Callable[[PlanRuling], None]) -> None:
        super().__init__(transport)
        self.plans: dict[str, PlanUpdate] = {}
        """The newest plan of each robot."""
        self.statuses: dict[str, ActorStatus] = {}
        """The newest heartbeat of each robot."""
        self.questions, self.offered = OpenQuestions(), Offered()
        self._rulings = rulings
        self._streams: list[Events] = []
        self._changed = asyncio.Event()

    async def open(self) -> None:
        """See `Node.open`."""
        await self.subscribe(topics.CHAT_FEEDBACK, ChatFeedback, self._on_said)
        await self.subscribe(topics.CHAT_INPUT, ChatInput, self.questions.on_input)
        await self.subscribe_plans(self._on_plan)
        await self.subscribe(topics.PLAN_DECISION, PlanDecision, self.offered.on_decision)
        await self.subscribe(topics.RULING, PlanRuling, self._rulings)
        await self.subscribe(topics.GRAPH_EVENTS, GraphEvent, self._tell)
        await self.subscribe(topics.STOP_REPORT, StopReport, self._tell)
        await self.subscribe(topics.REJECTION, Rejection, self._tell)
        await self.subscribe(topics.MEMORY_EVENT, MemoryEvent, self._tell)
        await self.subscribe(topics.INCIDENT, Incident, self._tell)
        await self.subscribe(topics.ACTOR_STATUS, ActorStatus, self._on_status)
        self.opened.callback(self._end)

    def stream(self, wanted: Callable[[Event], bool] = lambda _: True) -> Events:
        """A new stream of the events that `wanted` picks."""
        events = Events(wanted, self._forget)
        self._streams.append(events)
        return events

    async def until(self, condition: Callable[[], bool]) -> None:
        """Wait until `condition` holds; looked at whenever something happened."""
        while not condition():
            self._changed.clear()
            await self._changed.wait()

    def _forget(self, events: Events) -> None:
        if events in self._streams:
            self._streams.remove(events)

    def _end(self) -> None:
        for events in list(self._streams):
            events.close()

    def _on_said(self, said: ChatFeedback) -> None:
        self.questions.on_feedback(said)
        self._tell(said)

    def _on_plan(self, told: PlanUpdate | PlanProposal) -> None:
        if isinstance(told, PlanProposal):
            self.offered.on_proposal(told)
        else:
            self.plans[told.target] = told
            self.offered.on_update(told)
        self._tell(told)

    def _on_status(self, status: ActorStatus) -> None:
        self.statuses[status.actor] = status
        self._changed.set()

    def _tell(self, event: Event) -> None:
        for events in list(self._streams):
            events.put(event)
        self._changed.set()
