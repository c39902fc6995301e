"""The UMRF planner node: from Chat Actions to graphs, and from feedback to what happens next (thesis 4.3.6).

It only wires: what a robot's plan becomes is decided in `parley.nodes.plan`.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar, Literal

from parley.errors import GraphRefusedError, Problem
from parley.messages import ros, topics
from parley.messages.chat import ActionCall, ChatAction, ChatFeedback, ChatInput, SystemCommand
from parley.messages.memory import AddToMemory, RemoveMemory
from parley.messages.status import GraphEvent, PlanDecision, Rejection
from parley.nodes import plan_orders as orders
from parley.nodes.asking import CHANGED, REFUSED
from parley.nodes.plan import TargetPlan
from parley.nodes.plan_approval import Policy
from parley.nodes.plan_check import check_calls, complete_calls
from parley.nodes.plan_effects import Effect
from parley.nodes.plan_flow import listed, rebased
from parley.nodes.plan_memory import memory_change
from parley.nodes.plan_steps import Step
from parley.nodes.robot_plans import RobotPlans
from parley.umrf.io import read_graph

__all__ = ["UmrfPlanner"]


class UmrfPlanner(RobotPlans):
    """Sends graphs, reads feedback, holds a robot whose step failed; see `RobotPlans` for the arguments."""

    name: ClassVar[str] = "umrf_planner"

    async def open(self) -> None:
        """See `Node.open`."""
        await super().open()
        await self.subscribe(topics.CHAT_ACTION, ChatAction, self._on_chat_action)
        await self.subscribe(topics.UMRF_CORRECTION, ChatAction, self._on_correction)
        await self.subscribe(topics.PLAN_DECISION, PlanDecision, self._on_decision)
        await self.subscribe(topics.REJECTION, Rejection, self._on_rejection)
        await self.subscribe(topics.GRAPH_EVENTS, GraphEvent, self._on_event)
        await self.subscribe_raw(topics.GRAPH_FEEDBACK, self._on_feedback, depth=100)
        await self.subscribe(topics.CHAT_FEEDBACK, ChatFeedback, self._on_said)
        await self.subscribe(topics.CHAT_INPUT, ChatInput, self._on_input)

    # -- orders ----------------------------------------------------------------------------------------

    def _on_chat_action(self, order: ChatAction) -> None:
        targets = self._targets(order, "chat_action")
        self._remember(order.system_cmd, targets)
        for target in targets:
            plan = self._plan(target)
            calls = self._accept(plan, order.queue)
            commands = orders.in_order(order.system_cmd)
            if calls is None:  # nothing of such an order is done, but stopping is never refused
                commands = [item for item in commands if item.command in ("stop", "pause")]
            for command in commands:
                self._send(plan, self._command(plan, command))
            if calls and self._approvals.asks(target, calls, self._catalogue(target)):
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
            control = [c for c in order.system_cmd if c.command not in ("add_memory", "remove_memory")]
            clears = any(command.command == "clear" for command in control)
            calls = self._accept(plan, order.queue, correcting=not clears)
            if calls is None:
                self._send(plan, plan.give_up())
                continue
            for command in orders.in_order(control):
                self._send(plan, self._command(plan, command))
            if clears:
                self._take_anew(plan, order.message_response, calls)
            elif calls or not control:
                self._correct(plan, order.message_response, calls)

    def _take_anew(self, plan: TargetPlan, message: str, calls: list[ActionCall]) -> None:
        """A repair that dropped the plan brings another one."""
        if self._asks_for_repair(plan, calls):
            self._propose(plan, message, calls, announced=True)
        elif calls:
            self._send(plan, plan.append(calls))

    def _correct(self, plan: TargetPlan, message: str, calls: list[ActionCall]) -> None:
        """Repair, unless new steps that nobody asked for wait for a yes first; it is held till then."""
        failed = plan.failed
        new = failed is not None and [call for call in calls if not orders.is_same(call, failed.call)]
        if new and not plan.given_up and self._asks_for_repair(plan, calls):
            self._propose(plan, message, calls, failed, announced=True)
            self._say(plan.target, "I wait for your yes before I do this.", "info")
        else:
            self._send(plan, plan.correct(calls))

    def _asks_for_repair(self, plan: TargetPlan, calls: Sequence[ActionCall]) -> bool:
        """Whoever answered the question about a failure has said yes to what follows from the answer."""
        answered = plan.target in self._answered
        return not answered and self._approvals.asks(plan.target, calls, self._catalogue(plan.target))

    # -- decisions -------------------------------------------------------------------------------------

    def _on_decision(self, decision: PlanDecision) -> None:
        target = self._presence.resolve(decision.target) or decision.target
        if decision.decision == "policy":
            self._set_policy(target, decision.policy)
        elif decision.decision == "edit" and not decision.id:
            self._edit(target, decision)
        else:
            self._decide(decision)

    def _decide(self, decision: PlanDecision) -> None:
        proposal = self._approvals.get(decision.id)
        if proposal is None:
            self._say(decision.target, "That plan is no longer waiting for an answer.", "error")
            return
        plan, repairs = self._plan(proposal.target), self._approvals.repairs(decision.id)
        if decision.decision == "reject":
            self._approvals.drop(decision.id)
            self._send(plan, plan.give_up() if repairs else [])
            self._say(plan.target, orders.WAITING if repairs else REFUSED, "info")
            return
        calls: list[ActionCall] | None = list(proposal.steps)
        if decision.decision == "edit":
            calls, problems = rebased(decision.steps, proposal.steps)
            if problems:
                self._refuse_plan(plan, problems, decided=True)
                return
        edited = decision.decision == "edit"
        calls = self._accept(plan, calls or (), correcting=repairs, decided=edited)
        if calls is None:
            return  # it goes on waiting, for a better edit
        agreed = CHANGED if edited else self._approvals.agreed(decision.id)
        self._approvals.drop(decision.id)
        if agreed:
            self._say(plan.target, agreed, "info")
        if repairs:
            self._send(plan, orders.take_repair(plan, calls))
        else:
            self._append(plan, calls)

    def _edit(self, target: str, decision: PlanDecision) -> None:
        """Put other steps in the place of all that have not begun; whoever edits has said yes to them."""
        plan = self._plan(target)
        if self._board.is_past(target, decision.revision):
            problem = Problem(
                "revision", "the plan is another by now", "edit it as it is now", "past_revision"
            )
            self._refuse(topics.PLAN_DECISION.name, target, [problem])
            self._say(target, orders.PLAN_CHANGED, "error")
            return
        free = {id(step) for step in plan.not_begun}
        begun = [index for index, step in enumerate(plan.steps) if id(step) not in free]
        known, catalogue = [plan.steps[index] for index in begun], self._catalogue(target)
        calls, problems = rebased(decision.steps, listed(plan.steps), begun)
        if not problems:
            calls = complete_calls(calls, catalogue, known=len(known))
            problems = check_calls(calls, catalogue, before=known, known=known, path="steps")
        if problems:
            self._refuse_plan(plan, problems, decided=True)
        else:
            self._send(plan, plan.edit(calls))

    def _set_policy(self, target: str, policy: Policy | Literal[""]) -> None:
        if policy:
            self._approvals.choose(target, policy)
            self._send(self._plan(target), [])

    def _propose(
        self,
        plan: TargetPlan,
        message: str,
        calls: Sequence[ActionCall],
        repairs: Step | None = None,
        *,
        announced: bool = False,
    ) -> None:
        status = self._presence.get(plan.target)
        proposal = self._approvals.propose(
            plan.target, message, calls, status, repairs=repairs, announced=announced
        )
        self.publish(topics.PLAN, proposal)
        self._send(plan, [])

    def _append(self, plan: TargetPlan, calls: Sequence[ActionCall]) -> None:
        still = plan.update().state == "paused"
        self._send(plan, plan.append(calls))
        if calls and still and plan.update().state == "paused":
            self._say(plan.target, "I am still standing still. Say “carry on” when I should go on.", "info")

    def _approve(self, plan: TargetPlan) -> list[Effect]:
        """The operator said to go ahead, and nothing else can be meant than what waits for approval."""
        repair = self._approvals.repair(plan.target)
        if repair is not None:
            self._approvals.drop(repair.id)
            return orders.take_repair(plan, repair.steps)
        effects: list[Effect] = []
        for proposal in [] if plan.pending else self._approvals.of(plan.target):
            self._approvals.drop(proposal.id)
            effects += plan.append(proposal.steps)
        return effects

    def _command(self, plan: TargetPlan, command: SystemCommand) -> list[Effect]:
        match command.command:
            case "stop" | "pause":
                return [*self._left.pause(plan.target), *plan.pause()]
            case "start":
                left = [] if plan.pending else self._left.go_on(plan.target)
                return self._approve(plan) or left or plan.start()
            case "clear":
                for proposal in self._approvals.of(plan.target):
                    self._approvals.drop(proposal.id)
                return [*self._left.stop(plan.target), *plan.clear()]
            case "skip":
                return plan.skip()
            case "pop":
                return plan.pop(command.pop_index)
        return []  # memories are everybody's, see _remember

    def _remember(self, commands: Sequence[SystemCommand], targets: Sequence[str]) -> None:
        for command in commands:
            match memory_change(command):
                case AddToMemory() as added:
                    self.publish(topics.ADD_TO_MEMORY, added)
                case RemoveMemory() as removed:
                    self.publish(topics.REMOVE_MEMORY, removed)
                case Problem() as problem:
                    self._refuse("chat_action", ",".join(targets), [problem])

    def _accept(
        self,
        plan: TargetPlan,
        queue: Sequence[ActionCall],
        *,
        correcting: bool = False,
        decided: bool = False,
    ) -> list[ActionCall] | None:
        """The completed actions, or None (and everybody told) if the robot cannot carry them out.

        Args:
            plan: Of the robot.
            queue: The actions.
            correcting: Whether they take the failed step's place.
            decided: Whether a person put them together.
        """
        catalogue = self._catalogue(plan.target)
        calls = complete_calls(queue, catalogue)
        put = plan.correction(calls) if correcting else calls
        problems = check_calls(put, catalogue, path="steps" if decided else "queue")
        if not problems:
            return calls
        text = orders.WAITING_HELPLESS if correcting and not decided else ""
        self._refuse_plan(plan, problems, decided=decided, text=text)
        return None

    def _refuse_plan(
        self, plan: TargetPlan, problems: Sequence[Problem], *, decided: bool, text: str = ""
    ) -> None:
        topic = topics.PLAN_DECISION if decided else topics.CHAT_ACTION
        self._refuse(topic.name, plan.target, problems)
        self._say(plan.target, text or (orders.LEFT if decided else orders.NOTHING_DONE), "error")

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
        self._left.told(event)
        plan = self._plans.get(event.actor)
        if plan is None or event.kind != "node":
            return
        if event.outputs:
            values = {name: item.value for name, item in event.outputs.items() if item.has_data}
            plan.on_outputs(event.graph_name, event.node, values)
        if event.result and event.cause != "bypass":
            self._send(plan, plan.on_result(event.graph_name, event.node, event.result))

    def _on_said(self, feedback: ChatFeedback) -> None:
        self._questions.on_feedback(feedback)
        for target in feedback.targets:
            self._note_question(target)

    def _on_input(self, said: ChatInput) -> None:
        answered = [target for target, _ in self._questions.answered(said)]
        self._questions.on_input(said)
        for target in answered:
            self._note_question(target)
            plan = self._plans.get(target)
            if plan is not None and plan.held:
                self._answered.add(target)

    def _note_question(self, target: str) -> None:
        plan = self._plans.get(target)
        asked = self._questions.first(target) is not None
        if plan is not None and plan.asked != asked:
            plan.asked = asked
            self._send(plan, [])

    def _on_rejection(self, rejection: Rejection) -> None:
        plan = self._plans.get(rejection.target or rejection.source)
        if plan is None or not rejection.what.startswith("umrf_graph_"):
            return
        if rejection.source == self.name or rejection.graph_name != plan.graph_name:
            return
        codes = {problem.code for problem in rejection.problems}
        self._send(plan, plan.on_refused(rejection.graph_name, rejection.what, codes))
