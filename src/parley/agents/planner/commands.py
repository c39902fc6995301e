"""What a command from the closed table does to a robot's plan and to memories."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Final

from parley.agents.base import Node
from parley.agents.planner import orders
from parley.agents.planner.asking import SHALL_I, wish_of
from parley.agents.planner.effects import Effect as PlanEffect
from parley.agents.planner.effects import Say
from parley.agents.planner.flow import shifted
from parley.agents.planner.plan import TargetPlan
from parley.agents.planner.relay import Relay
from parley.agents.planner.remembering import memory_change
from parley.agents.planner.robot_plans import RobotPlans
from parley.agents.planner.steps import LATCHED, Step
from parley.errors import Problem
from parley.gate.ruling import EFFECT_OF
from parley.gate.table import verdict
from parley.messages import topics
from parley.messages.chat import ActionCall, ChatAction, SystemCommand
from parley.messages.memory import AddToMemory, RemoveMemory
from parley.messages.principal import Principal
from parley.messages.status import PlanDecision
from parley.sentences import together

__all__ = ["Commands"]

STILL: Final = "I am still standing still. Say “carry on” when I should go on."


class Commands:
    """Commands, once it is ruled that they are done.

    Args:
        node: Whose topics.
        plans: What is known of each robot.
        relay: Knows who does which order.
        begin_for: Told on whose account a robot acts from now on.
    """

    def __init__(
        self,
        node: Node,
        plans: RobotPlans,
        relay: Relay,
        begin_for: Callable[[str, Principal | None], None],
    ) -> None:
        self._node, self._plans, self._relay, self._begin_for = node, plans, relay, begin_for

    def effects_of(self, plan: TargetPlan, command: SystemCommand, by: Principal | None) -> list[PlanEffect]:
        """What is to be sent because of a command; memories are everybody's, see `remember`."""
        match command.command:
            case "stop" | "pause":
                left = self._plans.left.pause(plan.target)
                if plan.pending or left:
                    self.hold_for(plan, by)
                return [*left, *plan.pause()]
            case "start":
                left = [] if plan.pending else self._plans.left.go_on(plan.target)
                waiting = self._plans.approvals.of(plan.target)
                repairs = any(self._plans.approvals.repairs(proposal.id) for proposal in waiting)
                if waiting and (
                    repairs or not plan.pending
                ):  # a yes is bound to what was shown, going on is not
                    return [Say(together(wish_of(waiting[-1].lines), SHALL_I), asks_yes=True)]
                self._plans.held_by.pop(plan.target, None)
                return left or plan.start()
            case "clear":
                return self._clear(plan, str(command.arguments.get("order", "")))
            case "skip" | "pop" if command.arguments.get("step"):  # the plan may be another by now
                step = plan.meant(command)
                return [Say(orders.STEP_OVER)] if step is None else plan.drop(step)
            case "skip":
                stays = plan.pause_wanted and len(plan.pending) > 1
                return [*plan.skip(), *([Say(self.still(plan.target))] if stays else ())]
            case "pop":
                return plan.pop(command.pop_index)
        return []  # memories are everybody's, see _remember

    def _clear(self, plan: TargetPlan, order: str) -> list[PlanEffect]:
        """Drop all that a robot is to do, or (with an order) only that."""
        for proposal in self._plans.approvals.of(plan.target):
            if order in ("", proposal.order):
                self._plans.approvals.drop(proposal.id)
        if order:
            return plan.clear_order(order)
        self._plans.held_by.pop(plan.target, None)
        return [*self._plans.left.stop(plan.target), *plan.clear()]

    def append(
        self,
        plan: TargetPlan,
        calls: Sequence[ActionCall],
        order: ChatAction,
        by: Principal | None,
        *,
        goes_on: bool = False,
    ) -> None:
        """Put steps behind the plan; a robot that stands still goes on standing, and says so.

        Args:
            plan: Of the robot.
            calls: The steps.
            order: Where they come from; steps that wait for what other robots are to do before come first.
            by: On whose account.
            goes_on: Whether who orders it holds the robot, and no person has held it since.
        """
        waits = self._relay.waits(plan, order, calls, by) if calls else ()
        if waits is None:
            return
        calls = [*waits, *shifted(calls, len(waits))]
        state = plan.update().state
        still = state == "paused"
        if calls and state == "idle" and by is not None and by.is_person:
            self._plans.held_by.pop(plan.target, None)  # what was held has ended, and a person begins anew
        if calls:
            self._begin_for(plan.target, by)
        effects = plan.append(calls, order.words, order.id)
        self._relay.note(order.id, plan)
        self._plans.send(plan, effects)
        if still and goes_on:
            self._plans.held_by.pop(plan.target, None)
            self._plans.send(plan, plan.start())
        elif calls and still and plan.update().state == "paused":
            self._plans.say(plan.target, self.still(plan.target), "info")

    def still(self, robot: str) -> str:
        """That a robot goes on standing, and what lets it move."""
        status = self._plans.presence.get(robot)
        return LATCHED if status is not None and status.state == "stopped" else STILL

    def hold_for(self, plan: TargetPlan, by: Principal | None) -> None:
        """Remember who told a robot to stand still; a person's word counts before anybody else's."""
        before = self._plans.held_by.get(plan.target)
        if before is None or not before.is_person:
            self._plans.held_by[plan.target] = by or Principal()

    def change(
        self, plan: TargetPlan, command: SystemCommand, step: Step | None, decision: PlanDecision
    ) -> None:
        """Do what a person said yes to, to the step that was meant."""
        if change := memory_change(command):
            self.remember(ChatAction(system_cmd=(command,), by=decision.by), [plan.target])
            assert not isinstance(change, Problem)
        elif command.command in ("pop", "skip"):
            if step in plan.pending:
                self._plans.send(plan, plan.pop(plan.pending.index(step)))
            else:
                self._plans.say(plan.target, orders.STEP_OVER, "info")
        else:
            self._plans.send(plan, self.effects_of(plan, command, decision.by))

    def remember(self, order: ChatAction, targets: Sequence[str]) -> None:
        """Let be remembered and forgotten what an order may."""
        for command in orders.of_memory(order):
            effect = EFFECT_OF[command.command]
            found = verdict(order.by, effect)
            if found == "yes" and order.behalf is not None and not order.needs_yes:
                found = "allow"  # the person's own words ask for it
            if found != "allow":
                if not order.needs_yes:
                    self._plans.audit(effect, order, ",".join(targets), "refused")
                continue
            concluded = command.arguments.get("way") == "concluded"
            match memory_change(command, order.by if concluded else order.behalf or order.by):
                case AddToMemory() as added:
                    self._node.publish(topics.ADD_TO_MEMORY, added)
                case RemoveMemory() as removed:
                    self._node.publish(topics.REMOVE_MEMORY, removed)
                case Problem() as problem:
                    self._plans.refuse("chat_action", ",".join(targets), [problem])
