"""What waits for a yes: made from what it really is, shown again when it has become something else."""

from __future__ import annotations

from collections.abc import Sequence

from parley.agents.base import Node
from parley.agents.planner import orders
from parley.agents.planner.approval import Bound
from parley.agents.planner.asking import SHALL_I, wish_of
from parley.agents.planner.plan import TargetPlan
from parley.agents.planner.robot_plans import RobotPlans
from parley.agents.planner.steps import Step
from parley.gate.cards import Labels, command_label, digest_of, for_next, labels_of, lines_of
from parley.messages import topics
from parley.messages.chat import ActionCall, ChatAction, SystemCommand
from parley.messages.status import PlanProposal
from parley.sentences import Sentence, together

__all__ = ["Proposals"]


class Proposals:
    """Proposals, as people see them.

    Args:
        node: Whose topics and language.
        plans: What is known of each robot.
    """

    def __init__(self, node: Node, plans: RobotPlans) -> None:
        self._node, self._plans = node, plans
        plans.settle = self.settle

    def propose(
        self,
        plan: TargetPlan,
        order: ChatAction,
        calls: Sequence[ActionCall],
        commands: Sequence[SystemCommand] = (),
        *,
        repairs: Step | None = None,
        why: str = "",
    ) -> PlanProposal:
        """Let steps and changes wait for a yes to what they really are."""
        target = plan.target
        commands = [*orders.forgetting(order), *commands]
        bound: list[Bound] = []
        for command in commands:
            bound.append((command, plan.meant(command)))
        proposal = self._made(plan, order, calls, commands, bound, why)
        for same in [item for item in self._plans.approvals.of(target) if item.digest == proposal.digest]:
            self._plans.approvals.drop(same.id)  # said once more, it is asked about once
        proposal = self._plans.approvals.propose(
            proposal, self._plans.presence.get(target), repairs=repairs, bound=bound
        )
        self._node.publish(topics.PLAN, proposal)
        self._plans.send(plan, [])
        return proposal

    def _made(
        self,
        plan: TargetPlan,
        order: ChatAction,
        calls: Sequence[ActionCall],
        commands: Sequence[SystemCommand],
        bound: Sequence[Bound],
        why: str,
    ) -> PlanProposal:
        return PlanProposal(
            id="new",
            target=plan.target,
            message=order.message_response,
            steps=tuple(calls),
            commands=tuple(commands),
            digest=digest_of(plan.target, calls, commands, self._plans.objects(plan.target)),
            by=order.by,
            why=self._node.spoken(why),
            words=order.words,
            order=order.id,
            after=order.after,
            **self._told(plan, calls, bound),
        )

    def show_again(self, plan: TargetPlan, proposal: PlanProposal, why: str = "") -> None:
        """Something else was agreed to than what waits, or it would mean something else by now.

        `why` it is asked now, though it was not then; may be empty.
        """
        self.ask_instead(
            plan, self._renew(plan, proposal, self._plans.approvals.bound(proposal.id), why), why
        )

    def ask_instead(self, plan: TargetPlan, shown: PlanProposal, why: str = "") -> None:
        """Say what waits by now in the place of what was agreed to."""
        text = together(orders.NOT_AS_SHOWN, wish_of(shown.lines, why), SHALL_I)
        self._plans.say(plan.target, text, "info", asks_yes=True)

    def settle(self, plan: TargetPlan) -> None:
        """Ask no longer about what is over: failures that were repaired, changes of steps that have ended."""
        approvals = self._plans.approvals
        approvals.drop_settled(plan)
        for proposal in approvals.of(plan.target):
            bound = approvals.bound(proposal.id)
            left = [(command, step) for command, step in bound if step is None or step in plan.pending]
            if len(left) == len(bound):
                continue
            if left or proposal.steps:
                self._renew(plan, proposal, left)  # in silence: a yes in words is asked for once more
            else:
                approvals.drop(proposal.id)
                self._plans.say(plan.target, orders.STEP_OVER, "info")
        self._keep_unbegun(plan)

    def _keep_unbegun(self, plan: TargetPlan) -> None:
        """Write down what was kept for after an emergency stop: after a restart it waits for a yes."""
        kept = plan.unbegun and not plan.graph_name
        steps = [step for step in plan.pending if step.state == "queued"] if kept else []
        words = steps[0].words if steps else ""
        calls = [step.call for step in steps]
        made = self._made(plan, ChatAction(words=words), calls, (), (), "") if calls else None
        self._plans.approvals.keep_unbegun(plan.target, made, self._plans.presence.get(plan.target))

    def _renew(
        self, plan: TargetPlan, proposal: PlanProposal, bound: Sequence[Bound], why: str = ""
    ) -> PlanProposal:
        """Let what a proposal has become wait in its place."""
        approvals = self._plans.approvals
        repairs = approvals.repairs(proposal.id)
        approvals.drop(proposal.id)
        changed = proposal.model_copy(update={"commands": tuple(command for command, _ in bound)})
        told = self._told(plan, proposal.steps, bound)
        renewed = changed.model_copy(
            update={"digest": self.digest(changed), "why": why or proposal.why, **told}
        )
        status = self._plans.presence.get(plan.target)
        shown = approvals.propose(renewed, status, repairs=repairs, bound=bound)
        self._node.publish(topics.PLAN, shown)
        self._plans.send(plan, [])
        return shown

    def digest(self, proposal: PlanProposal) -> str:
        """What a proposal stands for by now."""
        return digest_of(
            proposal.target, proposal.steps, proposal.commands, self._plans.objects(proposal.target)
        )

    def _told(
        self, plan: TargetPlan, calls: Sequence[ActionCall], bound: Sequence[Bound]
    ) -> dict[str, tuple[str, ...]]:
        """What is shown of changes and steps: a label and a line of each."""
        known = [step.call for step in plan.steps]
        texts = {id(step): label for step, label in zip(plan.steps, self._labels(plan, known), strict=True)}
        changes = [command_label(command, texts.get(id(step), "")) for command, step in bound]
        labels = self._labels(plan, calls)
        steps = zip(
            plan.steps, plan.steps[1:], for_next(known, self._plans.catalogue(plan.target)), strict=False
        )
        parts = {
            id(step): id(next_) for step, next_, hidden in steps if hidden
        }  # a search is a part of its way
        out = {id(step) for _, step in bound}
        shown = [
            text for text, (_, step) in zip(changes, bound, strict=True) if parts.get(id(step)) not in out
        ]
        return {
            "labels": self._spoken(changes, labels),
            "lines": self._spoken(shown, self._lines(plan, calls, labels)),
        }

    def _labels(self, plan: TargetPlan, calls: Sequence[ActionCall]) -> Labels:
        return labels_of(calls, self._plans.catalogue(plan.target), self._plans.objects(plan.target))

    def _lines(self, plan: TargetPlan, calls: Sequence[ActionCall], labels: Labels) -> Labels:
        return lines_of(calls, labels, self._plans.catalogue(plan.target))

    def _spoken(self, *told: Sequence[Sentence]) -> tuple[str, ...]:
        return tuple(self._node.spoken(text) for texts in told for text in texts)
