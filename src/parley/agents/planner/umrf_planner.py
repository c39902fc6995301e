"""The UMRF planner node: from Chat Actions to graphs, and from feedback to what happens next (thesis 4.3.6).

It only wires: orders come in by `ordering`, decisions by `decisions`, what engines report is heard here. What
becomes of a robot's plan is decided in `plan`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from types import MappingProxyType
from typing import ClassVar

from parley.agents.base import Node
from parley.agents.planner.approval import Policy
from parley.agents.planner.commands import Commands
from parley.agents.planner.decisions import Decisions
from parley.agents.planner.offers import Offers
from parley.agents.planner.ordering import BeginFor, Judge, Ordering
from parley.agents.planner.presses import Presses
from parley.agents.planner.proposal_log import ProposalLog
from parley.agents.planner.proposing import Proposals
from parley.agents.planner.relay import Relay
from parley.agents.planner.robot_plans import RobotPlans
from parley.agents.planner.sending import Patience
from parley.clock import Clock
from parley.errors import GraphRefusedError
from parley.memory.proposals import ProposalStore
from parley.messages import ros, topics
from parley.messages.chat import ChatFeedback, ChatInput
from parley.messages.principal import person
from parley.messages.status import GraphEvent, Rejection, StopCommand
from parley.transport.base import Transport
from parley.umrf.io import read_graph
from parley.world.object_map import MapObject

__all__ = ["UmrfPlanner"]


class UmrfPlanner(Node):
    """Sends graphs, reads feedback, holds a robot whose step failed.

    Args:
        transport: Where the topics are.
        clock: Its wall time says who is gone.
        known_robots: Robots that send no heartbeat of ours (a TeMoto engine).
        approval: Whether new steps wait for a person's yes.
        policies: Robots for which that is otherwise.
        patience: How long an engine is waited for.
        proposals: Keeps what waits for a yes over restarts; None keeps it only while this process lives.
        tell: Gets a robot, what it has to say by itself and whether that asks for a yes; None says it at
            once, to whoever listens.
        objects: The things a robot's map knows, by the robot's name.
        judge: What the rules say about steps; None: there are none.
        begin_for: Told on whose account a robot acts from now on.
        met: Gets a robot whose engine said what is unfinished, and whether there was anything to say of it.
    """

    name: ClassVar[str] = "umrf_planner"
    apart = True

    def __init__(
        self,
        transport: Transport,
        clock: Clock,
        *,
        known_robots: Sequence[str] = (),
        approval: Policy = "run_at_once",
        policies: Mapping[str, Policy] = MappingProxyType({}),
        patience: Patience | None = None,
        proposals: ProposalStore | None = None,
        tell: Callable[[str, str, bool], None] | None = None,
        objects: Callable[[str], Sequence[MapObject]] = lambda _: (),
        judge: Judge | None = None,
        begin_for: BeginFor = lambda *_: None,
        met: Callable[[str, bool], None] = lambda *_: None,
    ) -> None:
        super().__init__(transport)
        self._log = ProposalLog(proposals)
        self._plans = RobotPlans(
            self,
            clock,
            known_robots=known_robots,
            approvals=Offers(self._log, clock, approval, policies),
            patience=patience or Patience(),
            tell=tell,
            objects=objects,
            met=met,
        )
        waiting = Proposals(self, self._plans)
        self._relay = Relay(self._plans, waiting)
        commands = self._commands = Commands(self, self._plans, self._relay, begin_for)
        self._presses = Presses(self, self._plans)
        self._orders = Ordering(self, self._plans, waiting, commands, judge, self._presses)
        self._decisions = Decisions(
            self, self._plans, waiting, commands, self._orders, begin_for, self._presses
        )
        self.restore, self.adopt = self._plans.restore, self._plans.adopt
        self.met, self.offer_again = self._plans.met, self._plans.offer_again

    async def open(self) -> None:
        """See `Node.open`."""
        await self.opened.enter_async_context(self._log)
        self.announce(topics.RULING)
        await self._plans.open()
        await self._orders.open()
        await self._decisions.open()
        self._presses.open()
        await self.subscribe(topics.STOP, StopCommand, self._on_emergency)
        await self.subscribe(topics.REJECTION, Rejection, self._on_rejection)
        await self.subscribe(topics.GRAPH_EVENTS, GraphEvent, self._on_event)
        await self.subscribe_raw(topics.GRAPH_FEEDBACK, self._on_feedback, depth=100)
        await self.subscribe(topics.CHAT_FEEDBACK, ChatFeedback, self._on_said)
        await self.subscribe(topics.CHAT_INPUT, ChatInput, self._on_input)

    def _on_emergency(self, command: StopCommand) -> None:
        """Whoever stops a robot holds its plan: only a person lets it go on after the reset."""
        for name in command.targets or tuple(self._plans.by_robot) if command.command == "stop" else ():
            plan = self._plans.plan(self._plans.presence.resolve(name) or name)
            plan.resumed = False
            if plan.pending:
                self._commands.hold_for(plan, command.by or person())
                self._plans.send(plan, [])

    def _on_feedback(self, feedback: ros.UmrfGraphFeedback) -> None:
        plan = self._plans.by_robot.get(feedback.actor)
        if plan is None:
            return
        for text in reversed(feedback.history):
            try:
                graph = read_graph(text)
            except GraphRefusedError as error:
                self._plans.refuse("umrf_graph_feedback", feedback.actor, error.problems)
                continue
            self._plans.send(plan, plan.reports.on_graph(graph))

    def _on_event(self, event: GraphEvent) -> None:
        self._plans.left.told(event)
        plan = self._plans.by_robot.get(event.actor)
        if plan is None or event.kind != "node":
            return
        if event.outputs:
            values = {name: item.value for name, item in event.outputs.items() if item.has_data}
            plan.reports.on_outputs(event.graph_name, event.node, values)
        if event.result and event.cause != "bypass":
            self._plans.send(plan, plan.reports.on_result(event.graph_name, event.node, event.result))

    def _on_said(self, feedback: ChatFeedback) -> None:
        self._plans.questions.on_feedback(feedback)
        for target in feedback.targets:
            self._note_question(target)

    def _on_input(self, said: ChatInput) -> None:
        answered = [target for target, _ in self._plans.questions.answered(said)]
        self._plans.questions.on_input(said)
        for target in answered:
            self._note_question(target)

    def _note_question(self, target: str) -> None:
        plan = self._plans.by_robot.get(target)
        asked = self._plans.questions.newest(target) is not None
        if plan is not None and plan.asked != asked:
            plan.asked = asked
            self._plans.send(plan, [])

    def _on_rejection(self, rejection: Rejection) -> None:
        plan = self._plans.by_robot.get(rejection.target or rejection.source)
        if plan is None or not rejection.what.startswith("umrf_graph_"):
            return
        if rejection.source == self.name or rejection.graph_name != plan.graph_name:
            return
        codes = {problem.code for problem in rejection.problems}
        self._plans.send(plan, plan.reports.on_refused(rejection.graph_name, rejection.what, codes))
