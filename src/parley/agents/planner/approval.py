"""Whose plans wait for a person's yes, what waits for one, and which plan an edit was made from. Pure."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from types import MappingProxyType

from parley.agents.planner.plan import TargetPlan
from parley.agents.planner.steps import Step, without_given
from parley.gate.cards import for_next, labels_of
from parley.gate.ruling import Policy
from parley.messages.chat import SystemCommand
from parley.messages.principal import Principal
from parley.messages.status import ActionInfo, PlanProposal, PlanUpdate
from parley.world.object_map import MapObject

__all__ = ["Approvals", "Bound", "PlanBoard", "Policy"]

Bound = tuple[SystemCommand, Step | None]
"""A command that waits for a yes, and the step it is about, however the plan moves on meanwhile."""


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
        self._repairs: dict[str, Step] = {}
        self._bound: dict[str, tuple[Bound, ...]] = {}

    def policy(self, target: str) -> Policy:
        """The policy of a robot."""
        return self._policies.get(target, self._default)

    def choose(self, target: str, policy: Policy) -> None:
        """Take another policy for a robot; what waits already goes on waiting."""
        self._policies[target] = policy

    def put(self, proposal: PlanProposal, repairs: Step | None = None, bound: Sequence[Bound] = ()) -> None:
        """Let a proposal wait.

        Args:
            proposal: What is proposed.
            repairs: The failed step in whose place it would be done, if it is a repair.
            bound: Its commands, each with the step it is about.
        """
        self._waiting[proposal.id] = proposal
        if bound:
            self._bound[proposal.id] = tuple(bound)
        if repairs is not None:
            self._repairs[proposal.id] = repairs

    def get(self, identity: str) -> PlanProposal | None:
        """The proposal of that id, if it waits."""
        return self._waiting.get(identity)

    def bound(self, identity: str) -> tuple[Bound, ...]:
        """What a yes to the proposal of that id changes before its steps begin."""
        return self._bound.get(identity, ())

    def repairs(self, identity: str) -> Step | None:
        """The failed step in whose place the proposal would be done; None: it repairs nothing."""
        return self._repairs.get(identity)

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
        self._repairs.pop(identity, None)
        self._bound.pop(identity, None)

    def drop_settled(self, plan: TargetPlan) -> None:
        """Forget repairs of what was repaired or left out otherwise."""
        for proposal in self.of(plan.target):
            failed = self._repairs.get(proposal.id)
            if failed is not None and failed is not plan.failed:
                self.drop(proposal.id)


class PlanBoard:
    """What was last published of each plan: counts its changes and knows which edits come too late.

    Args:
        catalogue: What a robot can do, by its name.
        objects: What its map knows.
        before: Revisions come after this one, and so after all that an earlier process counted.
    """

    def __init__(
        self,
        catalogue: Callable[[str], Sequence[ActionInfo]] = lambda _: (),
        objects: Callable[[str], Sequence[MapObject]] = lambda _: (),
        before: int = 0,
    ) -> None:
        self._catalogue, self._objects, self._before = catalogue, objects, before
        self._shown: dict[str, PlanUpdate] = {}
        self._known: dict[str, Sequence[ActionInfo]] = {}
        """What each robot could do when its steps were put into words: a robot may come after its plan."""
        self._free: dict[str, tuple[Step, ...]] = {}
        self._free_since: dict[str, int] = {}

    def show(
        self,
        plan: TargetPlan,
        approvals: Approvals,
        held_by: Principal | None = None,
    ) -> PlanUpdate | None:
        """The plan as it is to be published, or None if that would say nothing new."""
        before = self._shown.get(plan.target)
        revision = before.revision if before is not None else self._before
        changes: dict[str, object] = {
            "policy": approvals.policy(plan.target), "revision": revision, "held_by": held_by,
        }  # fmt: skip
        update = self._labelled(plan, before)
        changes["waits"] = tuple(proposal.id for proposal in approvals.of(plan.target))
        if changes["waits"] and update.state == "idle":
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

    def _labelled(self, plan: TargetPlan, before: PlanUpdate | None) -> PlanUpdate:
        """The plan with what each step does in our words; worked out anew only where the steps are others."""
        update = plan.update()
        calls = [step.action for step in update.steps]
        catalogue = self._catalogue(update.target)
        same = before is not None and calls == [step.action for step in before.steps]
        if before is not None and same and (not catalogue or self._known.get(update.target) == catalogue):
            told = [{"label": step.label, "for_next": step.for_next} for step in before.steps]
        else:
            self._known[update.target] = catalogue
            labels = labels_of(without_given(plan.steps, calls), catalogue, self._objects(update.target))
            pairs = zip(labels, for_next(calls, catalogue), strict=True)
            told = [{"label": str(text), "for_next": hidden} for text, hidden in pairs]
        steps = zip(update.steps, told, strict=True)
        return update.model_copy(update={"steps": tuple(step.model_copy(update=new) for step, new in steps)})

    @property
    def shown(self) -> tuple[PlanUpdate, ...]:
        """What was last published of each plan."""
        return tuple(self._shown.values())

    def is_past(self, target: str, revision: int | None) -> bool:
        """Whether the steps that have not begun are others than at `revision`; None is never past."""
        return revision is not None and revision < self._free_since.get(target, 0)
