"""What a robot's plan consists of, and how the engine's graph is made to follow it. Pure."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Final, Literal

from parley.agents.planner.effects import (
    AwaitResult,
    Effect,
    EndStep,
    ModifyGraph,
    ReportFailure,
    Say,
    StartGraph,
    StopGraph,
)
from parley.agents.planner.flow import listed, pending_calls, steps_of
from parley.agents.planner.graph import build_graph
from parley.agents.planner.steps import (
    ACTIVE_STATES,
    OPEN_STATES,
    RunState,
    Step,
    StepState,
    failure_message,
    fill_inputs,
    stages,
    verdict,
    without_orphans,
)
from parley.errors import FailureCode
from parley.messages.chat import ActionCall
from parley.messages.failure import FailureReport
from parley.messages.status import PlanStep, PlanUpdate

__all__ = ["GOING", "KEEP_DONE", "PlanCore"]

KEEP_DONE: Final = 20
"""Finished steps that stay in the graph; older ones are dropped so that graphs do not grow for ever (P11)."""

GOING: Final = ("starting", "continuing", "running", "paused")


def _shown(step: Step, asking: bool) -> StepState:
    if step.ended_by_others:
        return "stopped"
    return "waiting" if asking else step.state


class PlanCore:
    """State of the plan of one robot, and the ways to tell the engine about it; see `TargetPlan`."""

    def __init__(
        self,
        target: str,
        *,
        new_graph_name: Callable[[], str],
        waits_for_operator: Callable[[str], bool] = lambda _: False,
        can_end_step: Callable[[], bool] = lambda: True,
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
        self._new_graph_name = new_graph_name
        self._waits = waits_for_operator
        self._can_end_step = can_end_step
        self._pause_wanted = False
        self._dirty = False
        """The engine does not yet know the plan as it stands."""
        self._stopping = ""
        """A graph whose end is awaited before anything new starts."""
        self._abandoned = ""
        """A graph whose start nobody answered; should it come to life after all, it is stopped."""
        self._next_id = 0
        self._nudged: set[str] = set()
        """The steps that a dry graph was last asked to continue with."""
        self._awaiting = False
        """How a step ended has to be heard before it is known what comes next."""

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
            told = {id(step) for step in self._front()}
        return [step for step in self.steps if step.state == "queued" and id(step) not in told]

    def update(self) -> PlanUpdate:
        """The plan for people and for the language engine; flows name places in it."""
        state: Literal["idle", "running", "paused", "held"] = "idle"
        if self.held:
            state = "held"
        elif any(step.state in OPEN_STATES for step in self.steps):
            still = self._pause_wanted or self.run in ("paused", "none")
            state = "paused" if still else "running"
        asking = self._asking() if self.asked and not self.held else None
        shown = [
            PlanStep(action=call, node=step.node, state=_shown(step, step is asking))
            for step, call in zip(self.steps, listed(self.steps), strict=True)
        ]
        return PlanUpdate(target=self.target, graph_name=self.graph_name, state=state, steps=tuple(shown))

    def _asking(self) -> Step | None:
        """Whose question is open: a step that waits for a person anyway, or else the first that runs."""
        going = [step for step in self.steps if step.state in ("running", "waiting")]
        return next((step for step in going if step.state == "waiting"), next(iter(going), None))

    # -- changing the plan -----------------------------------------------------------------------------

    def _add(self, calls: Sequence[ActionCall]) -> None:
        self.steps += steps_of(calls, self.steps)

    def _decide(self) -> None:
        """Leave out the steps whose condition does not hold, and those that live on them."""
        for step in self.steps:
            if step.state == "queued" and verdict(step) is False:
                step.state = "skipped"

    def _tidy(self) -> None:
        """Drop waiting steps that lost what they depend on."""
        self._decide()
        self.steps = without_orphans(self.steps)

    def _front(self) -> list[Step]:
        """The group of steps that comes next, or that runs: those of it that are still to be done."""
        for group in stages(self.steps):
            if still := [step for step in group if step.state in OPEN_STATES]:
                return still
        return []

    # -- telling the engine ----------------------------------------------------------------------------

    def _push(self) -> list[Effect]:
        """Make the engine's graph what the plan says, now or as soon as that is possible."""
        if self.run == "stopping" or self.held:
            return []
        if not self.graph_name:
            return [] if self._pause_wanted else self._start()
        if self.run in ("starting", "continuing", "paused") or self._pause_wanted:
            self._dirty = True
            return []
        return self._continue() if self.run == "halted" else self._modify()

    def _start(self) -> list[Effect]:
        """Begin a new graph with what is still to be done."""
        self._decide()
        for step in self.steps:
            if step.state in OPEN_STATES:
                step.again()
        fill_inputs(self.steps)
        waiting = [step for step in self.steps if step.state == "queued"]
        there = {id(step) for step in waiting}
        for step in waiting:
            if step.when is not None and id(step.when.step) not in there:
                if verdict(step) is None:  # nobody will ever say how that step ended
                    step.state = "skipped"
                step.when = None
        self._decide()
        self.steps = [step for step in waiting if step.state == "queued"]
        if not self.steps:
            return []
        self._next_id = 0
        self._number(self.steps)
        self.graph_name, self.run = self._new_graph_name(), "starting"
        self._dirty, self._nudged, self._pause_wanted, self._awaiting = False, set(), False, False
        return [StartGraph(build_graph(self.graph_name, self.steps))]

    def _continue(self) -> list[Effect]:
        """Tell a dry graph where to go on."""
        self._tidy()
        following, self._awaiting = self._front(), False
        if not following:
            return [Say("Nothing else is left to do.")]
        if self._unheard() or any(verdict(step) is None for step in following):
            if self._can_end_step():  # our engines say how a step ended, but that may still be on its way
                self.run, self._awaiting = "halted", True
                return [AwaitResult(self.graph_name)]
            return self._unknown()
        fill_inputs(self.steps)
        for step in following:
            blank = {name for name in step.fed if not step.call.input_parameters[name].has_data}
            if blank and self._can_end_step():
                # Our engines report outputs, so what is not known was not given (P10).
                reason = "The step before gave no result that I could go on with."
                missing = {"missing": sorted(blank)}
                report = FailureReport(message=reason, code=FailureCode.INTERNAL, details=missing)
                return self._fail(step, report)
        effects = self._modify(following)
        self.run, self._nudged = "continuing", {step.node for step in following}
        return effects

    def _unheard(self) -> list[Step]:
        """Steps of which it is not known yet whether they came to their end before they were stopped."""
        if not self._can_end_step():
            return []
        return [
            step for step in self.steps if step.upset and step.state == "finished" and step.result is None
        ]

    def _unknown(self) -> list[Effect]:
        """It will not become known how a step ended: what depends on that is left out."""
        for step in self.steps:
            step.upset = False
        unknown = [step for step in self._front() if verdict(step) is None]
        if not unknown:
            return self._continue()
        for step in unknown:
            step.state = "skipped"
        text = "I could not tell how a step ended, so I leave out what depends on it."
        self._tidy()
        return [Say(text, "error"), *(self._continue() if self._front() else [])]

    def _modify(self, continue_from: Sequence[Step] = ()) -> list[Effect]:
        self._decide()
        fill_inputs(self.steps)
        done = [step for step in self.steps if step.state == "finished"]
        kept = {id(step) for step in done[-KEEP_DONE:]}
        keep = [step for step in self.steps if step.state in OPEN_STATES or id(step) in kept]
        self._number(keep)
        self._dirty = False
        graph = build_graph(self.graph_name, keep)
        return [ModifyGraph(graph, step.node) for step in continue_from] or [ModifyGraph(graph)]

    def _number(self, steps: Iterable[Step]) -> None:
        """Give ids so that they rise along the plan; what has begun keeps its own."""
        last = -1
        for step in steps:
            if step.instance_id < 0 or (step.state == "queued" and step.instance_id <= last):
                step.instance_id = self._next_id
                self._next_id += 1
            last = max(last, step.instance_id)

    def _end(self, step: Step) -> list[Effect]:
        """Make the engine end a step that runs (one that is about to run is ended when it does)."""
        if self._can_end_step():
            return [EndStep(self.graph_name, step.node)]
        step.state = "skipped"
        self._tidy()
        if not self.graph_name:
            return []  # all of it is being stopped already
        self._stopping, self.graph_name, self.run = self.graph_name, "", "stopping"
        return [StopGraph(self._stopping)]

    def _fail(self, step: Step, report: FailureReport) -> list[Effect]:
        step.state = "failed"
        self.held = True
        self._upset(step)
        others = pending_calls(self.update(), failed=False)
        message = failure_message(self.target, self.graph_name, step, others, self.steps, report)
        return [ReportFailure(message)]

    def _upset(self, failed: Step) -> None:
        """What runs beside a step that failed is stopped by the engine, and will be done again."""
        for step in self.steps:
            if step is not failed and step.together is failed.together:
                open_yet = step.state in OPEN_STATES or step.state == "finished"  # or not known to have begun
                step.upset = open_yet and step.result is None
                if step.upset and step.state == "finished" and step.stopped:
                    step.again()
