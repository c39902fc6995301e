"""What a robot's plan consists of, and what others see of it. Pure."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Final, Literal

from parley.agents.planner.flow import listed, steps_of
from parley.agents.planner.steps import (
    ACTIVE_STATES,
    OPEN_STATES,
    RunState,
    Step,
    StepState,
    stages,
    verdict,
    without_orphans,
)
from parley.messages.chat import ActionCall
from parley.messages.status import PlanStep, PlanUpdate

__all__ = ["GOING", "PlanState"]

GOING: Final = ("starting", "continuing", "running", "paused")


def _shown(step: Step, asking: bool) -> StepState:
    if step.ended_by_others:
        return "stopped"
    return "waiting" if asking else step.state


class PlanState:
    """State of the plan of one robot; see `TargetPlan` for the arguments."""

    def __init__(
        self,
        target: str,
        *,
        new_graph_name: Callable[[], str],
        waits_for_operator: Callable[[str], bool],
        can_end_step: Callable[[], bool],
    ) -> None:
        self.target = target
        self.graph_name = ""
        """The live graph; empty when there is none."""
        self.run: RunState = "none"
        self.steps: list[Step] = []
        self.held = False
        """A failed step is being repaired; new orders wait."""
        self.given_up = False
        """Repair ended without success; the next order takes the failed step's place."""
        self.asked = False
        """The robot has an open question to a person."""
        self.new_graph_name = new_graph_name
        self.waits_for_operator = waits_for_operator
        self.can_end_step = can_end_step
        self.pause_wanted = False
        """Somebody told the robot to stand still."""
        self.resumed = False
        """It was told to go on by a person, and was not seen to; nobody has told it to stand since."""
        self.dirty = False
        """The engine does not yet know the plan as it stands."""
        self.stopping = ""
        """A graph whose end is awaited before anything new starts."""
        self.abandoned = ""
        """A graph whose start nobody answered; should it come to life after all, it is stopped."""
        self.unbegun = False
        """It was refused because of an emergency stop, so no engine keeps it."""
        self.next_id = 0
        self.nudged: set[str] = set()
        """The steps that a dry graph was last asked to continue with."""
        self.awaiting = False
        """How a step ended has to be heard before it is known what comes next."""
        self.dropped: list[Step] = []
        """What was left when all was given up last: somebody may put it back."""
        self.continues = ""
        """The graph of an earlier process of which this is what was left."""

    # -- what others see -------------------------------------------------------------------------------

    @property
    def pending(self) -> list[Step]:
        """What is still to be done; 0 is the step being executed, or the failed one."""
        return [step for step in self.steps if step.state in OPEN_STATES or step.state == "failed"]

    @property
    def failed(self) -> Step | None:
        """The step that failed and is not yet repaired."""
        return next((step for step in self.steps if step.state == "failed"), None)

    @property
    def current(self) -> Step | None:
        """The step that "this one" means: the failed one, the first that runs, or the next."""
        active = (step for step in self.steps if step.state in ACTIVE_STATES)
        return self.failed or next(active, None) or next(iter(self.pending), None)

    @property
    def not_begun(self) -> list[Step]:
        """The steps that can still be exchanged for others."""
        told: set[int] = set()
        if self.run in ("starting", "continuing"):
            told = {id(step) for step in self.front()}
        return [step for step in self.steps if step.state == "queued" and id(step) not in told]

    def update(self) -> PlanUpdate:
        """The plan for people and for the language engine; flows name places in it."""
        state: Literal["idle", "running", "paused", "held"] = "idle"
        if self.held:
            state = "held"
        elif any(step.state in OPEN_STATES for step in self.steps):
            still = self.pause_wanted or self.run in ("paused", "none")
            state = "paused" if still else "running"
        asking = self._asking() if self.asked and not self.held else None
        shown = [
            PlanStep(
                action=call, id=step.id, node=step.node, state=_shown(step, step is asking), order=step.order
            )
            for step, call in zip(self.steps, listed(self.steps), strict=True)
        ]
        return PlanUpdate(
            target=self.target,
            graph_name=self.graph_name,
            state=state,
            steps=tuple(shown),
            continues=self.continues,
        )

    def _asking(self) -> Step | None:
        """Whose question is open: a step that waits for a person anyway, or else the first that runs."""
        going = [step for step in self.steps if step.state in ("running", "waiting")]
        return next((step for step in going if step.state == "waiting"), next(iter(going), None))

    # -- changing the plan -----------------------------------------------------------------------------

    def add(self, calls: Sequence[ActionCall], words: str = "", order: str = "") -> None:
        """Put actions behind the steps."""
        added = steps_of(calls, self.steps)
        for step in added:
            step.words, step.order = words, order
        self.steps += added

    def leave_out_excluded(self) -> None:
        """Leave out the steps whose condition does not hold, and those that live on them."""
        for step in self.steps:
            if step.state == "queued" and verdict(step) is False:
                step.state = "skipped"

    def tidy(self) -> None:
        """Drop waiting steps that lost what they depend on."""
        self.leave_out_excluded()
        self.steps = without_orphans(self.steps)

    def forget_taken_back(self) -> None:
        """Drop the steps that others stand for, once they are over."""
        if not any(step.taken_back and step.state in OPEN_STATES for step in self.steps):
            self.steps = [step for step in self.steps if not step.taken_back]

    def front(self) -> list[Step]:
        """The group of steps that comes next, or that runs: those of it that are still to be done."""
        for group in stages(self.steps):
            if still := [step for step in group if step.state in OPEN_STATES]:
                return still
        return []
