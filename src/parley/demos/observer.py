"""Watches everything that crosses the topics of a running system, writes it down, and waits for things."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Callable, Sequence
from typing import Any, ClassVar, Final

from parley.agents.base import Node
from parley.agents.questions import OpenQuestions
from parley.clock import Clock
from parley.messages import topics
from parley.messages.chat import ChatFeedback, ChatInput
from parley.messages.display import DisplayFeed
from parley.messages.failure import ErrorHandlingMessage
from parley.messages.incident import Incident
from parley.messages.memory import MemoryEvent
from parley.messages.ros import String
from parley.messages.status import (
    ActorStatus,
    GraphEvent,
    PlanProposal,
    PlanUpdate,
    PoseInfo,
    Rejection,
    StopReport,
)
from parley.transport.base import Transport

__all__ = ["Observer"]

Emit = Callable[[dict[str, Any]], None]

DRIVE: Final = "NavigateTo"
PLACE: Final = ("pose::position::x", "pose::position::y")


class Observer(Node):
    """An operator's eyes and mouth, for scripts: what happened so far, and a way to speak.

    Args:
        transport: Where the topics are.
        clock: For the time stamps of what is written down.
        emit: Gets every event as a JSON-able object, in order.
    """

    name: ClassVar[str] = "observer"

    def __init__(self, transport: Transport, clock: Clock, emit: Emit = lambda _: None) -> None:
        super().__init__(transport)
        self._clock, self._emit = clock, emit
        self.said: list[ChatFeedback] = []
        """Everything robots said, in order."""
        self.failures: list[ErrorHandlingMessage] = []
        """Every failed step, in order."""
        self.refusals: list[Rejection] = []
        """Everything that was refused."""
        self.events: list[GraphEvent] = []
        """Every transition of every graph, in order."""
        self.graph_states: dict[tuple[str, str], str] = {}
        """The newest state of each graph."""
        self.plans: dict[str, PlanUpdate] = {}
        """The newest plan of each robot."""
        self.proposed: dict[str, PlanProposal] = {}
        """The newest plan of each robot that was shown for a yes."""
        self.incidents: dict[str, Incident] = {}
        """The newest form of each record of a failure, oldest failure first."""
        self.memory_events: list[MemoryEvent] = []
        self.stop_reports: list[StopReport] = []
        self.feeds: set[tuple[str, str]] = set()
        """(robot, feed) that had a picture."""
        self.looks: list[tuple[str, str, float, float]] = []
        """Every picture that was asked for, in order: robot, feed, and where it stood (x and y in metres)."""
        self.robots: set[str] = set()
        self._stands: dict[str, tuple[float, float]] = {}
        """Where each robot is by what was heard last: a heartbeat, or the end of a drive."""
        self.poses: dict[str, PoseInfo] = {}
        """Where each robot said last that it is."""
        self.questions = OpenQuestions()
        self._changed = asyncio.Condition()
        self._count = 0

    async def open(self) -> None:
        """See `Node.open`."""
        await self.subscribe(topics.CHAT_FEEDBACK, ChatFeedback, self._on_said)
        await self.subscribe(topics.ERROR_HANDLING, ErrorHandlingMessage, self._on_failure)
        await self.subscribe(topics.REJECTION, Rejection, self._on_refusal)
        await self.subscribe(topics.GRAPH_EVENTS, GraphEvent, self._on_event)
        await self.subscribe(topics.MEMORY_EVENT, MemoryEvent, self._on_memory)
        await self.subscribe(topics.STOP_REPORT, StopReport, self._on_stop_report)
        await self.subscribe(topics.DISPLAY_FEED, DisplayFeed, self._on_picture)
        await self.subscribe(topics.ACTOR_STATUS, ActorStatus, self._on_status)
        await self.subscribe(topics.INCIDENT, Incident, self._on_incident)
        await self.subscribe_raw(topics.PLAN, self._on_plan)

    def say(self, text: str, robot: str, *, answer: bool = False, also: Sequence[str] = ()) -> str:
        """Speak as the operator; `answer` marks it as the answer to the robot's open question.

        Args:
            text: The words.
            robot: Whom they are for.
            answer: See above.
            also: Who else is spoken to in the same message.

        Returns:
            The id of the message.
        """
        question = self.questions.newest(robot) if answer else None
        said = ChatInput(
            message=text,
            targets=(robot, *also),
            type="response" if answer else "request",
            reply_to=question.id if question else "",
            id=f"observer-{id(self)}-{self._count}",
        )
        self._count += 1
        self.questions.on_input(said)
        self._write("operator", robot=robot, text=text, type=said.type)
        self.publish(topics.CHAT_INPUT, said)
        return said.id

    async def until(self, condition: Callable[[], bool], *, timeout_s: float = 60.0) -> None:
        """Wait until `condition` holds; looked at whenever something happened.

        Raises:
            TimeoutError: It did not within `timeout_s` of wall time.
        """
        async with asyncio.timeout(timeout_s), self._changed:
            await self._changed.wait_for(condition)

    def state(self, robot: str) -> str:
        """The state of a robot's plan; `idle` if it has none."""
        plan = self.plans.get(robot)
        return plan.state if plan is not None else "idle"

    # -- what happens ----------------------------------------------------------------------------------

    async def _on_said(self, feedback: ChatFeedback) -> None:
        self.questions.on_feedback(feedback)
        self.said.append(feedback)
        extra: dict[str, Any] = {"choices": list(feedback.choices)} if feedback.choices else {}
        if feedback.sources:
            extra["sources"] = list(feedback.sources)
        robot = ",".join(feedback.targets)
        await self._note("said", robot=robot, type=feedback.type, text=feedback.message, **extra)

    async def _on_failure(self, failure: ErrorHandlingMessage) -> None:
        self.failures.append(failure)
        await self._note(
            "failure",
            robot=failure.target,
            action=failure.action_called.name,
            code=failure.code.value,
            text=failure.error_message,
        )

    async def _on_refusal(self, refusal: Rejection) -> None:
        self.refusals.append(refusal)
        problems = [f"{problem.path}: {problem.message}" for problem in refusal.problems]
        await self._note("refused", by=refusal.source, what=refusal.what, problems=problems)

    async def _on_event(self, event: GraphEvent) -> None:
        self.events.append(event)
        if event.kind == "progress":
            await self._note("progress", robot=event.actor, node=event.node, text=event.progress_text)
            return
        if event.kind == "graph":
            self.graph_states[event.actor, event.graph_name] = event.state
        outputs = {name: item.value for name, item in event.outputs.items() if item.has_data}
        if event.node.startswith(DRIVE) and outputs.keys() >= {*PLACE}:
            x_m, y_m = (float(outputs[name]) for name in PLACE)
            self._stands[event.actor] = x_m, y_m
        await self._note(
            "transition",
            robot=event.actor,
            graph=event.graph_name,
            node=event.node,
            state=event.state,
            **({"result": event.result} if event.result else {}),
            **({"outputs": outputs} if outputs else {}),
        )

    async def _on_memory(self, event: MemoryEvent) -> None:
        self.memory_events.append(event)
        await self._note("memory", kind=event.kind, name=event.name)

    async def _on_stop_report(self, report: StopReport) -> None:
        self.stop_reports.append(report)
        await self._note("stop", robot=report.actor, state=report.state)

    async def _on_picture(self, feed: DisplayFeed) -> None:
        new = (feed.target, feed.name) not in self.feeds
        self.feeds.add((feed.target, feed.name))
        if feed.info and feed.target in self._stands:
            self.looks.append((feed.target, feed.name, *self._stands[feed.target]))
        if new or feed.info:
            await self._note("picture", robot=feed.target, feed=feed.name)

    async def _on_status(self, status: ActorStatus) -> None:
        if status.pose is not None:
            self.poses[status.actor] = status.pose
            self._stands[status.actor] = status.pose.x, status.pose.y
        if status.actor not in self.robots:
            self.robots.add(status.actor)
            await self._note("robot", robot=status.actor, state=status.state)
        else:
            await self._wake()

    async def _on_incident(self, incident: Incident) -> None:
        self.incidents[incident.id] = incident
        await self._note("incident", robot=incident.robot, code=incident.code.value, ending=incident.ending)

    async def _on_plan(self, message: String) -> None:
        raw = json.loads(message.data)
        if raw.get("kind") != "update":
            if raw.get("kind") == "proposal":
                proposal = PlanProposal.model_validate(raw)
                self.proposed[proposal.target] = proposal
            await self._note("proposal", robot=raw.get("target", ""))
            return
        update = PlanUpdate.model_validate(raw)
        self.plans[update.target] = update
        steps = [{"action": step.action.name, "state": step.state} for step in update.steps]
        await self._note("plan", robot=update.target, state=update.state, steps=steps)

    async def _note(self, event: str, **facts: Any) -> None:
        self._write(event, **facts)
        await self._wake()

    async def _wake(self) -> None:
        async with self._changed:
            self._changed.notify_all()

    def _write(self, event: str, **facts: Any) -> None:
        stamp = {"robot_time_s": round(self._clock.now_s(), 2), "event": event}
        self._emit(stamp | facts)
