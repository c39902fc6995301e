"""Whose plans wait for a person's yes, what waits for one, and which plan an edit was made from. Pure."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from types import MappingProxyType
from typing import Literal

from parley.messages.chat import ActionCall
from parley.messages.status import ActionInfo, PlanProposal, PlanUpdate
from parley.nodes.plan import TargetPlan
from parley.nodes.plan_steps import Step

__all__ = ["Approvals", "PlanBoard", "Policy", "waits_for_yes"]

Policy = Literal["run_at_once", "ask_when_risky", "ask_first"]


def waits_for_yes(policy: Policy, calls: Sequence[ActionCall], catalogue: Sequence[ActionInfo]) -> bool:
    """Whether actions wait for a yes under a policy; what nobody knows the risk of is not risky."""
    match policy:
        case "ask_first":
            return bool(calls)
        case "ask_when_risky":
            risky = {info.name for info in catalogue if info.risk == "high"}
            return any(call.name in risky for call in calls)
    return False


class Approvals:
    """The policy of each robot, and the proposals that wait.

    Args:
        default: The policy of robots for which none was chosen.
        policies: What was chosen for some.
        on_drop: Gets the id of each proposal that waits no longer.
    """

    def __init__(
        self,
        default: Policy = "run_at_once",
        policies: Mapping[str, Policy] = MappingProxyType({}),
        on_drop: Callable[[str], None] = lambda _: None,
    ) -> None:
        self._default, self._policies, self._on_drop = default, dict(policies), on_drop
        self._waiting: dict[str, PlanProposal] = {}
        self._agreed: dict[str, str] = {}
        self._repairs: dict[str, Step] = {}

    def policy(self, target: str) -> Policy:
        """The policy of a robot."""
        return self._policies.get(target, self._default)

    def choose(self, target: str, policy: Policy) -> None:
        """Take another policy for a robot; what waits already goes on waiting."""
        self._policies[target] = policy

    def asks(self, target: str, calls: Sequence[ActionCall], catalogue: Sequence[ActionInfo]) -> bool:
        """Whether these actions of a robot wait for a yes."""
        return waits_for_yes(self.policy(target), calls, catalogue)

    def put(self, proposal: PlanProposal, agreed: str = "", repairs: Step | None = None) -> None:
        """Let a proposal wait.

        Args:
            proposal: What is proposed.
            agreed: What the robot says when it begins.
            repairs: The failed step in whose place it would be done, if it is a repair.
        """
        self._waiting[proposal.id], self._agreed[proposal.id] = proposal, agreed
        if repairs is not None:
            self._repairs[proposal.id] = repairs

    def get(self, identity: str) -> PlanProposal | None:
        """The proposal of that id, if it waits."""
        return self._waiting.get(identity)

    def agreed(self, identity: str) -> str:
        """What the robot says when it begins with the proposal of that id."""
        return self._agreed.get(identity, "")

    def repairs(self, identity: str) -> bool:
        """Whether the proposal takes the place of a step that failed."""
        return identity in self._repairs

    def repair(self, target: str) -> PlanProposal | None:
        """The repair of a robot that waits, if one does."""
        return next(
            (p for key, p in self._waiting.items() if p.target == target and key in self._repairs), None
        )

    def of(self, target: str) -> list[PlanProposal]:
        """What waits of a robot, oldest first."""
        return [proposal for proposal in self._waiting.values() if proposal.target == target]

    @property
    def waiting(self) -> tuple[PlanProposal, ...]:
        """What waits of all robots, oldest first."""
        return tuple(self._waiting.values())

    def drop(self, identity: str) -> None:
        """Forget a proposal."""
        if self._waiting.pop(identity, None) is not None:
            self._on_drop(identity)
        self._agreed.pop(identity, None)
        self._repairs.pop(identity, None)

    def drop_settled(self, plan: TargetPlan) -> None:
        """Forget repairs of what was repaired or left out otherwise."""
        for proposal in self.of(plan.target):
            failed = self._repairs.get(proposal.id)
            if failed is not None and failed is not plan.failed:
                self.drop(proposal.id)


class PlanBoard:
    """What was last published of each plan: counts its changes and knows which edits come too late."""

    def __init__(self) -> None:
        self._shown: dict[str, PlanUpdate] = {}
        self._free: dict[str, tuple[Step, ...]] = {}
        self._free_since: dict[str, int] = {}

    def show(self, plan: TargetPlan, approvals: Approvals) -> PlanUpdate | None:
        """The plan as it is to be published, or None if that would say nothing new."""
        before = self._shown.get(plan.target)
        revision = before.revision if before is not None else 0
        changes: dict[str, object] = {"policy": approvals.policy(plan.target), "revision": revision}
        update = plan.update()
        if approvals.of(plan.target) and update.state == "idle":
            changes["state"] = "awaiting_approval"
        update = update.model_copy(update=changes)
        if update == before:
            return None
        update = update.model_copy(update={"revision": revision + 1})
        self._shown[plan.target] = update
        free = tuple(plan.not_begun)
        if self._free.get(plan.target) != free:
            self._free[plan.target] = free
            self._free_since[plan.target] = update.revision
        return update

    @property
    def shown(self) -> tuple[PlanUpdate, ...]:
        """What was last published of each plan."""
        return tuple(self._shown.values())

    def is_past(self, target: str, revision: int | None) -> bool:
        """Whether the steps that have not begun are others than at `revision`; None is never past."""
        return revision is not None and revision < self._free_since.get(target, 0)
