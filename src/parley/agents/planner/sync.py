"""How the engine's graph is made to follow a plan: now, or as soon as that is possible. Pure."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Final

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
from parley.agents.planner.flow import pending_calls
from parley.agents.planner.graph import build_graph
from parley.agents.planner.state import PlanState
from parley.agents.planner.steps import OPEN_STATES, Step, failure_message, fill_inputs, verdict
from parley.errors import FailureCode
from parley.messages.failure import FailureReport

__all__ = ["KEEP_DONE", "Sync"]

KEEP_DONE: Final = 20
"""Finished steps that stay in the graph; older ones are dropped so that graphs do not grow for ever (P11)."""


class Sync:
    """Tells the engine about a plan.

    Args:
        plan: Whose state is told, and changes with it.
    """

    def __init__(self, plan: PlanState) -> None:
        self._plan = plan

    def push(self) -> list[Effect]:
        """Make the engine's graph what the plan says, now or as soon as that is possible."""
        if self._plan.run == "stopping" or self._plan.held:
            return []
        if not self._plan.graph_name:
            return [] if self._plan.pause_wanted else self.start()
        if self._plan.run in ("starting", "continuing") or (self._stands and not self._takes_standing):
            self._plan.dirty = True
            return []
        return self.go_on() if self._plan.run == "halted" else self.modify()

    @property
    def _stands(self) -> bool:
        return self._plan.run == "paused" or self._plan.pause_wanted

    @property
    def _takes_standing(self) -> bool:
        """Whether the engine changes a graph that stands still, and so keeps what is added over a crash."""
        return self._plan.run in ("running", "paused") and self._plan.can_end_step()

    def start(self) -> list[Effect]:
        """Begin a new graph with what is still to be done."""
        self._plan.leave_out_excluded()
        for step in self._plan.steps:
            if step.state in OPEN_STATES:
                step.again()
        fill_inputs(self._plan.steps)
        waiting = [step for step in self._plan.steps if step.state == "queued" and not step.taken_back]
        there = {id(step) for step in waiting}
        for step in waiting:
            if step.when is not None and id(step.when.step) not in there:
                if verdict(step) is None:  # nobody will ever say how that step ended
                    step.state = "skipped"
                step.when = None
        self._plan.leave_out_excluded()
        self._plan.steps = [step for step in waiting if step.state == "queued"]
        if not self._plan.steps:
            return []
        self._plan.next_id = 0
        self._number(self._plan.steps)
        self._plan.graph_name, self._plan.run = self._plan.new_graph_name(), "starting"
        self._plan.dirty, self._plan.nudged, self._plan.pause_wanted, self._plan.awaiting = (
            False,
            set(),
            False,
            False,
        )
        return [StartGraph(build_graph(self._plan.graph_name, self._plan.steps))]

    def go_on(self) -> list[Effect]:
        """Tell a dry graph where to go on."""
        self._plan.tidy()
        following, self._plan.awaiting = self._plan.front(), False
        if not following:
            return [Say("Nothing else is left to do.")]
        if self.unheard() or any(verdict(step) is None for step in following):
            if (
                self._plan.can_end_step()
            ):  # our engines say how a step ended, but that may still be on its way
                self._plan.run, self._plan.awaiting = "halted", True
                return [AwaitResult(self._plan.graph_name)]
            return self.unknown()
        fill_inputs(self._plan.steps)
        for step in following:
            blank = {name for name in step.fed if not step.call.input_parameters[name].has_data}
            if blank and self._plan.can_end_step():
                # Our engines report outputs, so what is not known was not given (P10).
                reason = "The step before gave no result that I could go on with."
                missing = {"missing": sorted(blank)}
                report = FailureReport(message=reason, code=FailureCode.INTERNAL, details=missing)
                return self.fail(step, report)
        effects = self.modify(following)
        self._plan.run, self._plan.nudged = "continuing", {step.node for step in following}
        return effects

    def unheard(self) -> list[Step]:
        """Steps of which it is not known yet whether they came to their end before they were stopped."""
        if not self._plan.can_end_step():
            return []
        return [
            step
            for step in self._plan.steps
            if step.upset and step.state == "finished" and step.result is None
        ]

    def unknown(self) -> list[Effect]:
        """It will not become known how a step ended: what depends on that is left out."""
        for step in self._plan.steps:
            step.upset = False
        unknown = [step for step in self._plan.front() if verdict(step) is None]
        if not unknown:
            return self.go_on()
        for step in unknown:
            step.state = "skipped"
        text = "I could not tell how a step ended, so I leave out what depends on it."
        self._plan.tidy()
        return [Say(text, "error"), *(self.go_on() if self._plan.front() else [])]

    def modify(self, continue_from: Sequence[Step] = ()) -> list[Effect]:
        """Tell the engine the plan as it stands, and where it goes on from if it ran dry."""
        self._plan.leave_out_excluded()
        fill_inputs(self._plan.steps)
        done = [step for step in self._plan.steps if step.state == "finished"]
        kept = {id(step) for step in done[-KEEP_DONE:]}
        keep = [step for step in self._plan.steps if step.state in OPEN_STATES or id(step) in kept]
        self._number(keep)
        self._plan.dirty = False
        graph = build_graph(self._plan.graph_name, keep)
        return [ModifyGraph(graph, step.node) for step in continue_from] or [ModifyGraph(graph)]

    def _number(self, steps: Iterable[Step]) -> None:
        """Give ids so that they rise along the plan; what has begun keeps its own."""
        last = -1
        for step in steps:
            if step.instance_id < 0 or (step.state == "queued" and step.instance_id <= last):
                step.instance_id = self._plan.next_id
                self._plan.next_id += 1
            last = max(last, step.instance_id)

    def end(self, step: Step) -> list[Effect]:
        """Make the engine end a step that runs (one that is about to run is ended when it does)."""
        if self._plan.can_end_step():
            return [EndStep(self._plan.graph_name, step.node)]
        step.state = "skipped"
        self._plan.tidy()
        if not self._plan.graph_name:
            return []  # all of it is being stopped already
        self._plan.stopping, self._plan.graph_name, self._plan.run = self._plan.graph_name, "", "stopping"
        return [StopGraph(self._plan.stopping)]

    def fail(self, step: Step, report: FailureReport) -> list[Effect]:
        """A step failed: hold the plan and report it."""
        step.state, step.alerted = "failed", report.code is FailureCode.ATTENTION
        self._plan.held = True
        self.upset(step)
        others = pending_calls(self._plan.update(), failed=False)
        message = failure_message(
            self._plan.target, self._plan.graph_name, step, others, self._plan.steps, report
        )
        return [ReportFailure(message)]

    def upset(self, failed: Step) -> None:
        """What runs beside a step that failed is stopped by the engine, and will be done again."""
        for step in self._plan.steps:
            if step is not failed and step.together is failed.together:
                open_yet = step.state in OPEN_STATES or step.state == "finished"  # or not known to have begun
                step.upset = open_yet and step.result is None
                if step.upset and step.state == "finished" and step.stopped:
                    step.again()
