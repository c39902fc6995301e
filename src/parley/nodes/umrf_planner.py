"""The UMRF planner node: from Chat Actions to graphs, and from feedback to what happens next (thesis 4.3.6).

It only wires: what a robot's plan becomes is decided in `parley.nodes.plan`.
"""

from __future__ import annotations

import asyncio
import uuid
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import ClassVar, Literal

from parley.clock import Clock
from parley.errors import GraphRefusedError, Problem
from parley.messages import ros, topics
from parley.messages.chat import ActionCall, ChatAction, ChatFeedback, SystemCommand
from parley.messages.memory import AddToMemory, MemoryBody, RemoveMemory
from parley.messages.status import (
    ActorStatus,
    GraphEvent,
    PlanDecision,
    PlanProposal,
    PlanUpdate,
    Rejection,
    RejectionProblem,
    StepCommand,
)
from parley.messages.wire import to_string
from parley.nodes.base import Node
from parley.nodes.plan import TargetPlan
from parley.nodes.plan_check import check_calls, complete_calls
from parley.nodes.plan_steps import (
    Effect,
    EndStep,
    ModifyGraph,
    PauseGraph,
    ReportFailure,
    ResumeGraph,
    Say,
    StartGraph,
    Step,
    StopGraph,
)
from parley.nodes.presence import LOST_AFTER_S, Presence
from parley.transport.base import Transport
from parley.umrf.io import read_graph, write_graph

__all__ = ["Patience", "UmrfPlanner"]


@dataclass(frozen=True, slots=True)
class Patience:
    """Wall time that an engine is given."""

    answer_s: float = 5.0
    """To report something about a graph that was started."""
    progress_s: float = 3.0
    """To go on with a dry graph after it was told to."""
    end_s: float = 7.0
    """To end a stopped graph; an engine gives its actions 5 s."""


class UmrfPlanner(Node):
    """One plan per robot; sends graphs, reads feedback, holds a robot whose step failed.

    Args:
        transport: Where the topics are.
        clock: Its wall time limits how long answers are waited for.
        known_robots: Robots that send no heartbeat of ours (a TeMoto engine).
        ask_first: Robots whose plans wait for a person's approval from the start.
        patience: How long an engine is waited for.
    """

    name: ClassVar[str] = "umrf_planner"

    def __init__(
        self,
        transport: Transport,
        clock: Clock,
        *,
        known_robots: Sequence[str] = (),
        ask_first: Sequence[str] = (),
        patience: Patience = Patience(),
    ) -> None:
        super().__init__(transport)
        self._patience = patience
        self._clock = clock
        self._presence = Presence(clock, tuple(known_robots), self._on_presence)
        self._plans: dict[str, TargetPlan] = {}
        self._ask_first = set(ask_first)
        self._proposals: dict[str, PlanProposal] = {}
        self._published: dict[str, PlanUpdate] = {}

    async def open(self) -> None:
        """See `Node.open`."""
        await self.subscribe(topics.ACTOR_STATUS, ActorStatus, self._presence.on_status)
        await self.subscribe(topics.CHAT_ACTION, ChatAction, self._on_chat_action)
        await self.subscribe(topics.UMRF_CORRECTION, ChatAction, self._on_correction)
        await self.subscribe(topics.PLAN_DECISION, PlanDecision, self._on_decision)
        await self.subscribe(topics.REJECTION, Rejection, self._on_rejection)
        await self.subscribe(topics.GRAPH_EVENTS, GraphEvent, self._on_event)
        await self.subscribe_raw(topics.GRAPH_FEEDBACK, self._on_feedback, depth=100)
        self.spawn(self._watch_presence(), name="presence")

    def restore(self, target: str, steps: Sequence[Step]) -> None:
        """Hold `steps`, which an earlier process left, until the operator says to go on or to drop them."""
        plan = self._plan(target)
        plan.restore(steps)
        self._send(plan, [])

    # -- orders ----------------------------------------------------------------------------------------

    def _on_chat_action(self, order: ChatAction) -> None:
        targets = self._targets(order, "chat_action")
        self._remember(order.system_cmd, targets)
        for target in targets:
            plan = self._plan(target)
            calls = self._accept(plan, order.queue)
            commands = _in_order(order.system_cmd)
            if calls is None:  # nothing of such an order is done, but stopping is never refused
                commands = [item for item in commands if item.command in ("stop", "pause")]
            for command in commands:
                self._send(plan, self._command(plan, command))
            if calls and target in self._ask_first:
                self._propose(plan, order.message_response, calls)
            elif calls:
                self._append(plan, calls)

    def _on_correction(self, order: ChatAction) -> None:
        targets = self._targets(order, "umrf_correction")
        self._remember(order.system_cmd, targets)
        for target in targets:
            plan = self._plan(target)
            if order.success is False:
                self._send(plan, plan.give_up())
                continue
            calls = self._accept(plan, order.queue, correcting=True)
            if calls is None:
                self._send(plan, plan.give_up())
                continue
            control = [c for c in order.system_cmd if c.command not in ("add_memory", "remove_memory")]
            for command in _in_order(control):
                self._send(plan, self._command(plan, command))
            if calls or not control:
                self._send(plan, plan.correct(calls))

    def _on_decision(self, decision: PlanDecision) -> None:
        if decision.decision == "policy":
            self._set_policy(self._presence.resolve(decision.target) or decision.target, decision.policy)
            return
        proposal = self._proposals.get(decision.id)
        if proposal is None:
            self._say(decision.target, "That plan is no longer waiting for an answer.", "error")
            return
        plan = self._plan(proposal.target)
        calls: list[ActionCall] | None = []
        if decision.decision != "reject":
            calls = self._accept(plan, decision.steps if decision.decision == "edit" else proposal.steps)
        if calls is None:
            return  # it goes on waiting, for a better edit
        del self._proposals[decision.id]
        self._append(plan, calls)

    def _set_policy(self, target: str, policy: Literal["run_at_once", "ask_when_risky", "ask_first", ""]) -> None:
        if policy == "ask_first":
            self._ask_first.add(target)
        elif policy == "run_at_once":
            self._ask_first.discard(target)

    def _propose(self, plan: TargetPlan, message: str, calls: list[ActionCall]) -> None:
        proposal = PlanProposal(id=uuid.uuid4().hex, target=plan.target, message=message, steps=tuple(calls))
        self._proposals[proposal.id] = proposal
        self.publish(topics.PLAN, proposal)
        self._send(plan, [])

    def _append(self, plan: TargetPlan, calls: Sequence[ActionCall]) -> None:
        still = plan.update().state == "paused"
        self._send(plan, plan.append(calls))
        if calls and still and plan.update().state == "paused":
            self._say(plan.target, "I am still standing still. Say “carry on” when I should go on.", "info")

    def _approve_all(self, plan: TargetPlan) -> list[Effect]:
        """The operator said to go ahead, and nothing else can be meant than what waits for approval."""
        waiting = [item for item in self._proposals.values() if item.target == plan.target]
        self._drop_proposals(plan.target)
        return [effect for item in waiting for effect in plan.append(item.steps)]

    def _command(self, plan: TargetPlan, command: SystemCommand) -> list[Effect]:
        match command.command:
            case "stop" | "pause":
                return plan.pause()
            case "start":
                return (self._approve_all(plan) if not plan.pending else []) or plan.start()
            case "clear":
                self._drop_proposals(plan.target)
                return plan.clear()
            case "skip":
                return plan.skip()
            case "pop":
                return plan.pop(command.pop_index)
        return []  # memories are everybody's, see _remember

    def _remember(self, commands: Sequence[SystemCommand], targets: Sequence[str]) -> None:
        for command in commands:
            arguments = command.arguments
            if command.command == "add_memory" and isinstance(arguments.get("data"), str):
                body = MemoryBody(
                    type="image" if arguments.get("type") == "image" else "text",
                    data=arguments["data"],
                    info=str(arguments.get("info") or arguments["data"]),
                    source="operator",
                )
                name = str(arguments.get("name") or f"memory_{uuid.uuid4().hex[:12]}")
                self.publish(topics.ADD_TO_MEMORY, AddToMemory({name: body}))
            elif command.command == "remove_memory":
                name = str(arguments.get("name") or arguments.get("parameters") or "")
                self.publish(topics.REMOVE_MEMORY, RemoveMemory({name: {}}))
            elif command.command == "add_memory":
                problem = Problem("system_cmd.add_memory.data", "expected a text to remember")
                self._refuse("chat_action", ",".join(targets), [problem])

    def _accept(
        self, plan: TargetPlan, queue: Sequence[ActionCall], *, correcting: bool = False
    ) -> list[ActionCall] | None:
        """The completed actions, or None (and everybody told) if the robot cannot carry them out."""
        status = self._presence.get(plan.target)
        if status is None or not status.catalogue or not queue:
            return list(queue)
        calls = complete_calls(queue, status.catalogue)
        problems = check_calls(plan.correction(calls) if correcting else calls, status.catalogue)
        if not problems:
            return calls
        self._refuse("chat_action", plan.target, problems)
        text = "I worked out a plan that I cannot carry out, so I did nothing."
        if correcting:
            text = (
                "What I worked out would not help, so I am waiting here. Say “try again”, “skip it” or "
                "“cancel everything”, or give me another order."
            )
        self._say(plan.target, text, "error")
        return None

    def _targets(self, order: ChatAction, what: str) -> list[str]:
        """The robots an order is for; no addressee or an unknown one means no motion."""
        found: list[str] = []
        for name in order.targets:
            known = self._presence.resolve(name)
            if known is None:
                problem = Problem(
                    "targets", f"no robot is called {name!r}", self._presence.known_text(), "unknown_robot"
                )
                self._refuse(what, name, [problem])
                self._say(name, f"There is no robot called {name}. {self._presence.known_text()}", "error")
            elif known not in found:
                found.append(known)
        if not order.targets:
            self._refuse(
                what, "", [Problem("targets", "no robot is named", self._presence.known_text(), "no_robot")]
            )
        return found

    # -- reports ---------------------------------------------------------------------------------------

    def _on_feedback(self, feedback: ros.UmrfGraphFeedback) -> None:
        plan = self._plans.get(feedback.actor)
        if plan is None:
            return
        for text in reversed(feedback.history):
            try:
                graph = read_graph(text)
            except GraphRefusedError as error:
                self._refuse("umrf_graph_feedback", feedback.actor, error.problems)
                continue
            self._send(plan, plan.on_graph(graph))

    def _on_event(self, event: GraphEvent) -> None:
        plan = self._plans.get(event.actor)
        if plan is not None and event.outputs:
            values = {name: item.value for name, item in event.outputs.items() if item.has_data}
            plan.on_outputs(event.graph_name, event.node, values)

    def _on_rejection(self, rejection: Rejection) -> None:
        plan = self._plans.get(rejection.target or rejection.source)
        if plan is None or not rejection.what.startswith("umrf_graph_"):
            return
        if rejection.source == self.name or rejection.graph_name != plan.graph_name:
            return
        codes = {problem.code for problem in rejection.problems}
        self._send(plan, plan.on_refused(rejection.graph_name, rejection.what, codes))

    def _on_presence(self, robot: str, joined: bool) -> None:
        plan = self._plans.get(robot)
        if plan is None or not plan.pending:
            return
        if not joined:
            self._say(robot, f"I have lost contact with {robot}. Its plan is kept.", "error")
        elif (status := self._presence.get(robot)) is not None:
            self._send(plan, plan.on_return(status.graphs))

    async def _watch_presence(self) -> None:
        while True:
            await asyncio.sleep(LOST_AFTER_S / 4)
            self._presence.expire()

    # -- sending ---------------------------------------------------------------------------------------

    def _plan(self, target: str) -> TargetPlan:
        plan = self._plans.get(target)
        if plan is None:
            plan = self._plans[target] = TargetPlan(
                target,
                new_graph_name=lambda: f"{target}_{uuid.uuid4().hex[:12]}",
                waits_for_operator=lambda action: self._has_effect(target, action, "asks_operator"),
                can_end_step=lambda: self._presence.get(target) is not None,
            )
        return plan

    def _has_effect(self, target: str, action: str, effect: str) -> bool:
        status = self._presence.get(target)
        return status is not None and any(i.name == action and effect in i.effects for i in status.catalogue)

    def _send(self, plan: TargetPlan, effects: Sequence[Effect]) -> None:
        for effect in effects:
            self._send_one(plan, effect)
        update = plan.update()
        waiting = any(proposal.target == plan.target for proposal in self._proposals.values())
        if waiting and update.state == "idle":
            update = update.model_copy(update={"state": "awaiting_approval"})
        if self._published.get(plan.target) != update:
            self._published[plan.target] = update
            self.publish(topics.PLAN, update)

    def _send_one(self, plan: TargetPlan, effect: Effect) -> None:
        targets = (plan.target,)
        match effect:
            case StartGraph(graph):
                text = write_graph(graph, faithful=True)
                self.send(topics.GRAPH_START, ros.UmrfGraphStart(umrf_graph_json=text, targets=targets))
                self._later(self._patience.answer_s, plan, lambda: plan.on_no_answer(graph.name))
            case ModifyGraph(graph, continue_from):
                text = write_graph(graph, faithful=True)
                message = ros.UmrfGraphModify(graph.name, targets, text, continue_from)
                self.send(topics.GRAPH_MODIFY, message)
                if continue_from:
                    self._later(
                        self._patience.progress_s,
                        plan,
                        lambda: plan.on_no_progress(graph.name, continue_from),
                    )
            case PauseGraph(name):
                self.send(topics.GRAPH_PAUSE, ros.UmrfGraphPause(name, targets))
                if self._presence.get(plan.target) is None:  # the reference listens to its own misspelling
                    self.send(topics.GRAPH_PAUSE_TEMOTO, ros.UmrfGraphPause(name, targets))
            case ResumeGraph(name):
                self.send(topics.GRAPH_RESUME, ros.UmrfGraphResume(name, targets))
            case StopGraph(name):
                self.send(topics.GRAPH_STOP, ros.UmrfGraphStop(name, targets))
                self._later(self._patience.end_s, plan, lambda: plan.on_no_end(name))
            case EndStep(name, node):
                self.publish(topics.STEP, StepCommand(target=plan.target, graph_name=name, node=node))
            case ReportFailure(message):
                self.publish(topics.ERROR_HANDLING, message)
            case Say(text, kind):
                self._say(plan.target, text, kind)

    def _later(self, seconds: float, plan: TargetPlan, look: Callable[[], list[Effect]]) -> None:
        """Look again after some wall time; `look` decides whether anything is still amiss."""

        async def wait() -> None:
            await asyncio.sleep(seconds)
            self._send(plan, look())

        self.spawn(wait(), name=f"deadline {plan.target}")

    def _drop_proposals(self, target: str) -> None:
        self._proposals = {key: p for key, p in self._proposals.items() if p.target != target}

    def _say(self, target: str, text: str, kind: Literal["info", "error"]) -> None:
        self.publish(topics.CHAT_FEEDBACK, ChatFeedback(message=text, targets=(target,), type=kind))

    def _refuse(self, what: str, target: str, problems: Sequence[Problem]) -> None:
        self.log.warning("refused", what=what, target=target, problems=[str(p) for p in problems])
        listed = tuple(
            RejectionProblem(path=p.path, message=p.message, remedy=p.remedy, code=p.code) for p in problems
        )
        rejection = Rejection(source=self.name, target=target, what=what, problems=listed)
        self.send(topics.REJECTION, to_string(rejection))


def _in_order(commands: Sequence[SystemCommand]) -> list[SystemCommand]:
    """Steps are counted before any is dropped, so the last is dropped first."""
    last_first = iter(
        sorted((c for c in commands if c.command == "pop"), key=lambda c: c.pop_index or 0, reverse=True)
    )
    return [next(last_first) if command.command == "pop" else command for command in commands]
