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
from parley.gate.cards import Labels, command_label, digest_of, labels_of, lines_of
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
        shown = zip(plan.steps, self._labels(plan, [step.call for step in plan.steps]), strict=True)
        texts = {id(step): label for step, label in shown}
        changes = [command_label(command, texts.get(id(step), "")) for command, step in bound]
        labels = self._labels(plan, calls)
        proposal = PlanProposal(
            id="new",
            target=target,
            message=order.message_response,
            steps=tuple(calls),
            commands=tuple(commands),
            labels=self._spoken(changes, labels),
            lines=self._spoken(changes, self._lines(plan, calls, labels)),
            digest=digest_of(target, calls, commands, self._plans.objects(target)),
            by=order.by,
            why=self._node.spoken(why),
            words=order.words,
        )
        for same in [item for item in self._plans.approvals.of(target) if item.digest == proposal.digest]:
            self._plans.approvals.drop(same.id)  # said once more, it is asked about once
        proposal = self._plans.approvals.propose(
            proposal, self._plans.presence.get(target), repairs=repairs, bound=bound
        )
        self._node.publish(topics.PLAN, proposal)
        self._plans.send(plan, [])
        return proposal

    def show_again(self, plan: TargetPlan, proposal: PlanProposal, why: str = "") -> None:
        """Something else was agreed to than what waits, or it would mean something else by now.

        `why` it is asked now, though it was not then; may be empty.
        """
        self._plans.approvals.drop(proposal.id)
        labels = self._labels(plan, proposal.steps)
        told = {
            "labels": self._spoken(labels),
            "lines": self._spoken(self._lines(plan, proposal.steps, labels)),
        }
        renewed = proposal.model_copy(
            update={"digest": self.digest(proposal), "why": why or proposal.why, **told}
        )
        if proposal.commands:
            self._plans.say(plan.target, orders.PLAN_CHANGED, "error")
            self._plans.send(plan, [])
            return
        shown = self._plans.approvals.propose(renewed, self._plans.presence.get(plan.target))
        self._node.publish(topics.PLAN, shown)
        self._plans.send(plan, [])
        self._plans.say(
            plan.target, together(orders.NOT_AS_SHOWN, wish_of(shown.lines, why), SHALL_I), "info"
        )

    def digest(self, proposal: PlanProposal) -> str:
        """What a proposal stands for by now."""
        return digest_of(
            proposal.target, proposal.steps, proposal.commands, self._plans.objects(proposal.target)
        )

    def _labels(self, plan: TargetPlan, calls: Sequence[ActionCall]) -> Labels:
        return labels_of(calls, self._plans.catalogue(plan.target), self._plans.objects(plan.target))

    def _lines(self, plan: TargetPlan, calls: Sequence[ActionCall], labels: Labels) -> Labels:
        return lines_of(calls, labels, self._plans.catalogue(plan.target))

    def _spoken(self, *told: Sequence[Sentence]) -> tuple[str, ...]:
        return tuple(self._node.spoken(text) for texts in told for text in texts)
