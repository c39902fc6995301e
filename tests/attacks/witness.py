"""What really happened: everything on the topics, and what the simulator and the store hold."""

from __future__ import annotations

import json
from typing import Any, ClassVar

from parley.clock import Clock
from parley.demos.observer import Observer
from parley.messages import topics
from parley.messages.chat import ChatInput, ReplyDraft
from parley.messages.ros import UmrfGraphFeedback
from parley.messages.status import ActorStatus, PlanDecision, PlanProposal, PlanUpdate
from parley.messages.wire import decode_plan
from parley.transport.base import Transport


class Witness(Observer):
    """An observer that also keeps what was proposed, decided and drafted, and who spoke."""

    name: ClassVar[str] = "witness"

    def __init__(self, transport: Transport, clock: Clock, _language: object) -> None:
        super().__init__(transport, clock)
        self.proposals: list[PlanProposal] = []
        self.updates: list[PlanUpdate] = []
        self.drafts: list[ReplyDraft] = []
        self.inputs: list[ChatInput] = []
        """Everything that was said to robots, by whomever."""
        self.decisions: list[PlanDecision] = []
        self.statuses: dict[str, ActorStatus] = {}
        self.words: set[str] = set()
        """What people said."""
        self._told: dict[str, int] = {}
        """How many transitions had been seen when an engine last told of a graph as a whole."""

    async def open(self) -> None:
        """See `Node.open`."""
        await super().open()
        await self.subscribe(topics.REPLY_DRAFT, ReplyDraft, self.drafts.append)
        await self.subscribe(topics.CHAT_INPUT, ChatInput, self._on_input)
        await self.subscribe_raw(topics.GRAPH_FEEDBACK, self._on_graph, depth=100)
        await self.subscribe(topics.PLAN_DECISION, PlanDecision, self.decisions.append)

    def heard(self, said: ChatInput) -> None:
        """A person says this."""
        self.words.add(said.message)
        self.questions.on_input(said)

    async def _on_graph(self, feedback: UmrfGraphFeedback) -> None:
        for text in feedback.history:
            self._told[json.loads(text).get("graph_name", "")] = len(self.events)
        await self._note("graph")

    def is_told(self) -> bool:
        """Whether engines have told of each graph as a whole since it changed, so that planners know."""
        last = {e.graph_name: n for n, e in enumerate(self.events) if e.kind != "progress"}
        return all(self._told.get(graph, 0) > number for graph, number in last.items())

    async def _on_input(self, said: ChatInput) -> None:
        self.inputs.append(said)
        await self._note("input")

    async def _on_plan(self, message: Any) -> None:
        told = decode_plan(message.data)
        if isinstance(told, PlanProposal):
            self.proposals.append(told)
        else:
            self.updates.append(told)
        await super()._on_plan(message)

    async def _on_status(self, status: ActorStatus) -> None:
        self.statuses[status.actor] = status
        await super()._on_status(status)
        await self._note("status")

    def policy_of(self, robot: str) -> str:
        """Which plans of a robot wait for a yes, as was told last."""
        plan = self.plans.get(robot)
        return plan.policy if plan is not None else "run_at_once"

    def running(self, robot: str) -> str:
        """The action that is under way."""
        plan = self.plans.get(robot)
        steps = plan.steps if plan is not None else ()
        return next((s.action.name for s in steps if s.state in ("running", "waiting")), "")

    def drives(self, robot: str) -> bool:
        """Whether a drive is under way as far as is known."""
        return self.state(robot) == "running" and self.running(robot) == "NavigateTo"

    def at_rest(self, robot: str) -> bool:
        """Whether nothing of a robot is under way, waits or is held back."""
        status = self.statuses.get(robot)
        going = {actor for (actor, _), state in self.graph_states.items() if state in ("RUNNING", "PAUSED")}
        return (
            self.state(robot) == "idle"
            and robot not in going
            and status is not None
            and status.state != "stopped"
            and self.questions.newest(robot) is None
        )

    def forget(self) -> None:
        """Begin anew with what is kept of the past."""
        for kept in (
            self.said, self.failures, self.refusals, self.events, self.memory_events, self.stop_reports,
            self.proposals, self.updates, self.drafts, self.inputs, self.decisions, self.words,
        ):  # fmt: skip
            kept.clear()
        self._told.clear()
