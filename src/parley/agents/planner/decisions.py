"""What people decide about plans: yes, no, other steps, and whether they are asked at all."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final, Literal

from parley.agents.base import Node
from parley.agents.planner import orders
from parley.agents.planner.approval import Policy
from parley.agents.planner.asking import CHANGED, REFUSED, begun
from parley.agents.planner.check import check_calls, complete_calls
from parley.agents.planner.commands import Commands
from parley.agents.planner.flow import listed, rebased
from parley.agents.planner.ordering import BeginFor, Ordering
from parley.agents.planner.plan import TargetPlan
from parley.agents.planner.presses import Presses
from parley.agents.planner.proposing import Proposals
from parley.agents.planner.robot_plans import RobotPlans
from parley.agents.questions import SeenIds
from parley.errors import Problem
from parley.gate.cards import for_next
from parley.gate.judge import Judgement
from parley.gate.table import Effect, verdict
from parley.messages import topics
from parley.messages.audit import AuditEvent
from parley.messages.chat import ActionCall, ChatAction, SystemCommand
from parley.messages.status import PlanDecision, PlanProposal
from parley.sentences import together

__all__ = ["Decisions"]

DECIDES: Final = {
    "approve": Effect.APPROVE, "reject": Effect.REJECT, "edit": Effect.EDIT, "policy": Effect.POLICY,
}  # fmt: skip


class Decisions:
    """Decisions of people; nobody else's count.

    Args:
        node: Whose topics.
        plans: What is known of each robot.
        proposals: What waits for a yes.
        commands: Does what a command says.
        ordering: Has the steps of an edit weighed, in turn with orders.
        begin_for: Told on whose account a robot acts from now on.
        presses: Of buttons.
    """

    def __init__(
        self,
        node: Node,
        plans: RobotPlans,
        proposals: Proposals,
        commands: Commands,
        ordering: Ordering,
        begin_for: BeginFor,
        presses: Presses,
    ) -> None:
        self._node, self._plans, self._proposals, self._commands = node, plans, proposals, commands
        self._ordering, self._begin_for, self._presses = ordering, begin_for, presses
        self._begun = SeenIds()
        """What somebody said yes to."""

    async def open(self) -> None:
        """Take decisions; closed with the node."""
        await self._node.subscribe(topics.PLAN_DECISION, PlanDecision, self._on_decision, in_charge=True)

    def _on_decision(self, decision: PlanDecision) -> None:
        harmless = decision.decision in ("reject", "policy")
        if not self._presses.counts(decision.press, decision.target, harmless=harmless):
            return
        target = self._plans.presence.resolve(decision.target) or decision.target
        if verdict(decision.by, DECIDES[decision.decision]) != "allow":
            problem = Problem("by", "only a person decides that", "let a person say it", "not_a_person")
            self._plans.refuse(topics.PLAN_DECISION.name, target, [problem])
            self._node.publish(
                topics.AUDIT,
                AuditEvent(
                    effect=DECIDES[decision.decision], by=decision.by, robot=target, outcome="refused"
                ),
            )
        elif decision.decision == "policy":
            self._set_policy(target, decision.policy)
        elif decision.decision == "reject":
            self._decide(target, decision)
        else:  # what the rules say now counts, not what they said when it was shown
            edits = decision.decision == "edit"
            proposal = self._plans.approvals.get(decision.id)
            shown = proposal.steps if proposal is not None and proposal.target == target else ()
            self._ordering.weighed(
                target,
                decision.steps if edits else shown,
                decision.by,
                lambda found: (self._take_edit if edits else self._take_yes)(target, decision, found),
                lambda: self._undone(decision, orders.NOTHING_DONE),
            )

    def _take_yes(self, target: str, decision: PlanDecision, judgement: Judgement | None) -> None:
        """Take up a yes unless the rules forbid what it is to by now, or have come to ask about it."""
        proposal = self._plans.approvals.get(decision.id)
        if proposal is None or judgement is None:
            self._decide(target, decision)
            return
        plan = self._plans.plan(target)
        asked = [self._node.spoken(text).rstrip(".") for text in orders.reasons(judgement.ask)]
        asks = [text for text in asked if text not in proposal.why]
        if judgement.forbidden:
            repairs = self._plans.approvals.repairs(decision.id)
            self._plans.approvals.drop(decision.id)
            self._plans.forbid(target, judgement)
            self._plans.send(plan, plan.give_up() if repairs else [])
        elif asks and self._plans.approvals.policy(target) != "ask_first":
            self._proposals.show_again(plan, proposal, "; ".join(asks))
        else:
            self._decide(target, decision)

    def _take_edit(self, target: str, decision: PlanDecision, judgement: Judgement | None) -> None:
        """Take up an edit unless the rules forbid what it says."""
        if judgement is not None and judgement.forbidden:
            before = 0 if decision.id else self._shown_before(self._plans.plan(target))
            texts = self._plans.forbid(target, judgement, before)
            problems = [Problem("steps", text, "leave that out", "forbidden") for text in texts]
            self._plans.refuse(topics.PLAN_DECISION.name, target, problems)
            self._presses.over(decision.press, together(*texts))
        elif decision.id:
            self._decide(target, decision)
        else:
            self._edit(target, decision)

    def _decide(self, target: str, decision: PlanDecision) -> None:
        proposal = self._plans.approvals.get(decision.id)
        if proposal is None or proposal.target != target:
            self._too_late(target, decision)
            return
        plan, repairs = self._plans.plan(proposal.target), self._plans.approvals.repairs(decision.id)
        if decision.decision == "reject":
            self._plans.approvals.drop(decision.id)
            self._plans.send(plan, plan.give_up() if repairs else [])
            self._plans.say(plan.target, orders.WAITING if plan.held else REFUSED, "response")
            return
        shown = decision.digest or (proposal.digest if decision.decision == "edit" else "")
        if shown != proposal.digest or self._proposals.digest(proposal) != proposal.digest:
            self._proposals.show_again(plan, proposal)
            self._presses.over(decision.press, orders.NOT_AS_SHOWN, past=True)
            return
        edited = decision.decision == "edit"
        calls: list[ActionCall] | None = list(proposal.steps)

        def refuse(put: Sequence[ActionCall], problems: Sequence[Problem]) -> None:
            self._refuse_edit(plan, decision, put, problems)

        if edited:
            calls, problems = rebased(decision.steps, proposal.steps)
            if problems:
                refuse(decision.steps, problems)
                return
        calls = self._plans.accept(
            plan, calls or (), correcting=repairs is not None, refuse=refuse if edited else None
        )
        if calls is None:
            return  # it goes on waiting, for a better edit
        self._begin(plan, decision, proposal, calls)

    def _too_late(self, target: str, decision: PlanDecision) -> None:
        """A no to what somebody else's yes has begun meanwhile is a stop; nothing else is done."""
        plan = self._plans.plan(target)
        if decision.decision == "reject" and decision.id in self._begun and plan.update().state == "running":
            stop = SystemCommand(command="stop")
            self._plans.send(plan, self._commands.effects_of(plan, stop, decision.by))
            self._plans.say(target, orders.BEGUN_ALREADY, "response")
        elif self._is_past_yes(decision) and (waiting := self._plans.approvals.of(target)):
            self._proposals.ask_instead(plan, waiting[-1])
            self._presses.over(decision.press, orders.NOT_AS_SHOWN, past=True)
        else:
            self._undone(decision, orders.WAITS_NO_MORE, past=True)

    def _is_past_yes(self, decision: PlanDecision) -> bool:
        """Whether it is to what has become something else meanwhile, and was not begun by another yes."""
        return decision.decision != "reject" and decision.id not in self._begun

    def _undone(self, decision: PlanDecision, why: str, *, past: bool = False) -> None:
        """Tell that nothing came of a decision."""
        target = self._plans.presence.resolve(decision.target) or decision.target
        self._plans.say(target, why, "error")
        self._presses.over(decision.press, why, past=past)

    def _shown_before(self, plan: TargetPlan) -> int:
        """How many steps people see before those of a plan that have not begun."""
        free = {id(step) for step in plan.not_begun}
        begun = [step.call for step in plan.steps if id(step) not in free]
        return len(begun) - sum(for_next(begun, self._plans.catalogue(plan.target)))

    def _refuse_edit(
        self,
        plan: TargetPlan,
        decision: PlanDecision,
        calls: Sequence[ActionCall],
        problems: Sequence[Problem],
    ) -> None:
        """Tell everybody which of the steps that a person put together cannot be carried out."""
        self._plans.refuse(topics.PLAN_DECISION.name, plan.target, problems)
        before = 0 if decision.id else self._shown_before(plan)
        why = orders.impossible(calls, self._plans.catalogue(plan.target), problems, before)
        self._undone(decision, why)

    def _begin(
        self, plan: TargetPlan, decision: PlanDecision, proposal: PlanProposal, calls: list[ActionCall]
    ) -> None:
        """Do what was agreed to; the steps wait behind what a person told to wait."""
        edited, repairs = decision.decision == "edit", self._plans.approvals.repairs(decision.id)
        bound = self._plans.approvals.bound(decision.id)
        self._plans.approvals.drop(decision.id)
        self._begun.is_new(decision.id)
        self._plans.say(plan.target, CHANGED if edited else begun(proposal.lines), "response")
        for command, step in bound:
            self._commands.change(plan, command, step, decision)
        told_to_wait = [step for step in plan.pending if not step.ending]
        rest = not repairs and plan.update().state == "paused" and bool(told_to_wait)
        if calls and not rest:  # whoever says yes to steps wants them done, but not what they told to wait
            self._plans.held_by.pop(plan.target, None)
        if repairs:
            if calls:
                self._begin_for(plan.target, decision.by)
            self._plans.send(plan, orders.take_repair(plan, calls))
        elif calls:
            order = ChatAction(words=proposal.words, id=proposal.order, after=proposal.after)
            self._commands.append(plan, calls, order, decision.by, goes_on=not rest)
            if not rest and plan.update().state == "paused":
                self._plans.send(plan, plan.start())
        else:
            self._plans.send(plan, [])
        self._presses.over(decision.press)

    def _edit(self, target: str, decision: PlanDecision) -> None:
        """Put other steps in the place of all that have not begun; whoever edits has said yes to them."""
        plan = self._plans.plan(target)
        if self._plans.board.is_past(target, decision.revision):
            problem = Problem(
                "revision", "the plan is another by now", "edit it as it is now", "past_revision"
            )
            self._plans.refuse(topics.PLAN_DECISION.name, target, [problem])
            self._undone(decision, orders.PLAN_CHANGED, past=True)
            return
        known, catalogue = plan.staying(decision.undoes), self._plans.catalogue(target)
        begun = [index for index, step in enumerate(plan.steps) if step in known]
        calls, problems = rebased(decision.steps, listed(plan.steps), begun)
        if not problems:
            calls = complete_calls(calls, catalogue, known=len(known))
            problems = check_calls(calls, catalogue, before=known, known=known, path="steps")
        if problems:
            self._refuse_edit(plan, decision, decision.steps, problems)
        else:
            self._plans.send(plan, plan.edit(calls, decision.undoes))
            self._presses.over(decision.press)

    def _set_policy(self, target: str, policy: Policy | Literal[""]) -> None:
        if policy:
            self._plans.approvals.choose(target, policy)
            self._plans.send(self._plans.plan(target), [])
