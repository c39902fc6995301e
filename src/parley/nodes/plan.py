"""One robot's plan: what is to be done, what is being done, what went wrong. Pure; the planner node wires it.

Every method says what to send (a list of `Effect`s) and changes nothing else. The plan never assumes that a
message arrives: what the engine reports decides, and what differs from the plan is sent again.

Step identity: each node gets an ``instance_id`` from a counter that never goes back within a graph, kept in
plan order. A repeated or moved step gets a new one: late reports about an old one cannot be mistaken for it.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Sequence
from typing import Any, Final, Literal

from parley.errors import FailureCode
from parley.messages.chat import ActionCall
from parley.messages.failure import FailureReport
from parley.messages.status import PlanStep, PlanUpdate
from parley.nodes.plan_steps import (
    ACTIVE_STATES,
    GONE_CODES,
    LATCHED,
    OPEN_STATES,
    Effect,
    EndStep,
    ModifyGraph,
    PauseGraph,
    ReportFailure,
    ResumeGraph,
    RunState,
    Say,
    StartGraph,
    Step,
    StopGraph,
    build_graph,
    failure_message,
    fill_inputs,
    handed_over,
    with_givers,
    without_orphans,
)
from parley.umrf.model import Graph, GraphState, Node, NodeState

__all__ = ["KEEP_DONE", "TargetPlan"]

KEEP_DONE: Final = 20
"""Finished steps that stay in the graph; older ones are dropped so that graphs do not grow for ever (P11)."""

_GOING: Final = ("starting", "continuing", "running", "paused")


class TargetPlan:
    """The plan of one robot.

    Args:
        target: The robot.
        new_graph_name: Gives a name never used before.
        waits_for_operator: Whether an action (by name) waits for a person while it runs.
        can_end_step: Whether the engine understands `/parley/step`; if not, skipping restarts the rest.
    """

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
        self._new_graph_name = new_graph_name
        self._waits = waits_for_operator
        self._can_end_step = can_end_step
        self._hold_queue: list[ActionCall] = []
        self._pause_wanted = False
        self._dirty = False
        """The engine does not yet know the plan as it stands."""
        self._stopping = ""
        """A graph whose end is awaited before anything new starts."""
        self._abandoned = ""
        """A graph whose start nobody answered; should it come to life after all, it is stopped."""
        self._next_id = 0
        self._nudged = ""
        """The step that was last asked to continue a dry graph."""

    # -- what others see -------------------------------------------------------------------------------

    @property
    def pending(self) -> list[Step]:
        """What is still to be done; 0 is the step being executed, or the failed one."""
        return [step for step in self.steps if step.state in OPEN_STATES or step.state == "failed"]

    @property
    def failed(self) -> Step | None:
        """The step that failed and is not yet repaired."""
        return next((step for step in self.steps if step.state == "failed"), None)

    def update(self) -> PlanUpdate:
        """The plan for people and for the language engine."""
        state: Literal["idle", "running", "paused", "held"] = "idle"
        if self.held:
            state = "held"
        elif any(step.state in OPEN_STATES for step in self.steps):
            still = self._pause_wanted or self.run in ("paused", "none")
            state = "paused" if still else "running"
        return PlanUpdate(
            target=self.target,
            graph_name=self.graph_name,
            state=state,
            steps=tuple(PlanStep(action=s.call, node=s.node, state=s.state) for s in self.steps),
        )

    # -- orders ----------------------------------------------------------------------------------------

    def append(self, calls: Sequence[ActionCall]) -> list[Effect]:
        """Add actions behind the plan; during a repair they wait, after one that failed they go first."""
        if not calls:
            return []
        if self.given_up:
            return self._replace_failed(calls)
        if self.held:
            self._hold_queue += calls
            return []
        over = not any(step.state in OPEN_STATES for step in self.steps)
        self._add(calls)
        if over and self.run in ("none", "halted"):
            return self._start()
        return self._push()

    def restore(self, steps: Sequence[Step]) -> None:
        """Take over what an earlier process left; it waits until the operator says to go on."""
        self.steps, self._pause_wanted = [*steps], bool(steps)

    def pause(self) -> list[Effect]:
        """Stand still, keep the plan."""
        if self.held:
            self.given_up = True
            return []
        self._pause_wanted = bool(self.pending)
        return [PauseGraph(self.graph_name)] if self._pause_wanted and self.run in _GOING else []

    def start(self) -> list[Effect]:
        """Go on after a pause, or try a failed step again."""
        if self.held and self.failed is not None:
            return self._replace_failed([self.failed.call])
        if not self.pending:
            return [Say("There is nothing left to go on with.")]
        self._pause_wanted = False
        if self.run in ("none", "halted"):
            return self._push()
        if self.run not in _GOING:
            return []
        # A pause that somebody else caused may not have been reported yet; resuming what runs does nothing.
        changes = self._modify() if self._dirty else []
        return [*changes, ResumeGraph(self.graph_name)]

    def clear(self) -> list[Effect]:
        """Drop everything and stop the robot's graph."""
        for step in self.steps:
            if step.state in OPEN_STATES or step.state == "failed":
                step.state = "stopped"
        self.held = self.given_up = self._pause_wanted = self._dirty = False
        self._hold_queue.clear()
        if not self.graph_name:
            return []
        self._stopping, self.graph_name, self.run = self.graph_name, "", "stopping"
        return [StopGraph(self._stopping)]

    def pop(self, index: int | None) -> list[Effect]:
        """Drop the pending step `index` (0 is the one being executed).

        A missing or impossible index changes nothing and is said (P15).
        """
        pending = self.pending
        if index is None or not 0 <= index < len(pending):
            left = len(pending)
            what = "There is no such step" if index is None else f"There is no step number {index + 1}"
            return [Say(f"{what}; {left} {'step is' if left == 1 else 'steps are'} left.", "error")]
        if index == 0:
            return self.skip()
        self.steps.remove(pending[index])
        self.steps = without_orphans(self.steps)
        return self._push()

    def skip(self) -> list[Effect]:
        """Leave out the step being executed, or the failed one, and go on with the next."""
        pending = self.pending
        if not pending:
            return [Say("There is no step to skip.")]
        current = pending[0]
        if current.state == "failed":
            return self._replace_failed([])
        if current.state == "queued" and self.run not in ("starting", "continuing", "running"):
            current.state = "skipped"
            self.steps = without_orphans(self.steps)
            return self._push()
        current.ending = True
        self._pause_wanted = False
        return self._end(current) if current.state != "queued" else []

    def correction(self, calls: Sequence[ActionCall]) -> list[ActionCall]:
        """What will really be put in the failed step's place: `calls` with the values they can be given."""
        failed = self.failed
        if failed is None or not calls:
            return list(calls)
        return with_givers(calls, self.steps[: self.steps.index(failed)])

    def correct(self, calls: Sequence[ActionCall]) -> list[Effect]:
        """Put `calls` in the place of the failed step (none: leave it out) and go on.

        A correction for which nothing failed, or that comes after the repair was ended, is late and dropped.
        """
        return self._replace_failed(calls) if self.failed is not None and not self.given_up else []

    def give_up(self) -> list[Effect]:
        """Repair ended without success: stay held, keep the plan, take the next order."""
        self.given_up = self.held
        return [PauseGraph(self.graph_name)] if self.held and self.graph_name else []

    # -- reports ---------------------------------------------------------------------------------------

    def on_graph(self, graph: Graph) -> list[Effect]:
        """Take over what the engine reports; reports about any other graph are late and dropped (P4)."""
        if graph.name == self._stopping:
            return self._on_stopping(graph)
        if graph.name == self._abandoned and graph.state in (GraphState.RUNNING, GraphState.PAUSED):
            return [StopGraph(graph.name)]
        if not self.graph_name or graph.name != self.graph_name:
            return []
        effects: list[Effect] = []
        by_name = {node.full_name: node for node in graph.nodes}
        for step in self.steps:
            node = by_name.get(step.node)
            if node is not None:
                effects += self._on_node(step, node)
        return effects + self._end_strays(graph) + self._on_graph_state(graph.state)

    def on_outputs(self, graph_name: str, node: str, outputs: dict[str, Any]) -> None:
        """Remember what a step gave, for steps that have to be run again apart from it."""
        if graph_name == self.graph_name:
            for step in self.steps:
                if step.node == node:
                    step.outputs.update(outputs)

    def on_refused(self, graph_name: str, what: str, codes: Collection[str] = ()) -> list[Effect]:
        """The engine refused the command `what`, for the reasons `codes`.

        A refused start means that nothing runs (P2). After an emergency stop, and when the engine has lost
        the graph, the plan is kept until the operator says to go on.
        """
        if graph_name != self.graph_name or not graph_name:
            return []
        command, latched = what.removeprefix("umrf_graph_"), "stop_latched" in codes
        if command in ("pause", "resume") and self.run == "starting":
            return []  # it overtook the start; a pause is sent again
        if command != "start" and not GONE_CODES.isdisjoint(codes):
            return self._on_gone(go_on=command == "resume")
        if command == "start" and self.run == "starting":
            self._abandon_start()
            for step in self.steps:
                if step.state == "queued" and not latched:
                    step.state = "stopped"
        elif command == "modify":
            self._dirty = True
            if self._nudged:
                self.run, self._nudged = "halted", ""
            if "node_active" in codes:
                return []  # a step began just before it was dropped; it is ended
        elif command == "pause":
            self._pause_wanted = False
        return [Say(LATCHED if latched else "I could not do that, so I changed nothing.", "error")]

    def on_return(self, graphs: Collection[str]) -> list[Effect]:
        """The robot is back after its contact was lost, with these graphs."""
        if not self.graph_name or self.graph_name in graphs or self.run == "starting":
            return []
        return self._on_gone(go_on=False)

    def on_no_answer(self, graph_name: str) -> list[Effect]:
        """Nothing was heard since the start of `graph_name`: the robot may be away."""
        if graph_name != self.graph_name or self.run != "starting":
            return []
        self._abandon_start()
        self._abandoned = graph_name
        text = f"{self.target} does not answer. The plan is kept; say “carry on” to try again."
        return [Say(text, "error")]

    def on_no_progress(self, graph_name: str, node: str) -> list[Effect]:
        """A dry graph was told to go on with `node` some time ago; if it did not, that step failed."""
        step = next((s for s in self.steps if s.node == node), None)
        asked = graph_name == self.graph_name and self.run == "continuing"
        if not asked or step is None or step.state != "queued" or self._pause_wanted:
            return []
        reason = f"I could not begin with this step: {step.call.reason or step.call.name}."
        return self._fail(step, FailureReport(message=reason, code=FailureCode.INTERNAL))

    def on_no_end(self, graph_name: str) -> list[Effect]:
        """A stopped graph did not report its end in time: go on without it."""
        if graph_name != self._stopping:
            return []
        self._stopping, self.run = "", "none"
        return self._push()

    # -- inside ----------------------------------------------------------------------------------------

    def _add(self, calls: Iterable[ActionCall], index: int | None = None) -> None:
        at = len(self.steps) if index is None else index
        for call in calls:
            before = self.steps[at - 1] if at else None
            self.steps.insert(at, Step(call, fed=handed_over(call, before)))
            at += 1

    def _replace_failed(self, calls: Sequence[ActionCall]) -> list[Effect]:
        failed = self.failed
        if failed is None:
            self.held = self.given_up = False
            self._add(calls)
            return self._push()
        calls, index = self.correction(calls), self.steps.index(failed)
        del self.steps[index]
        self._add(calls, index)
        self.steps = without_orphans(self.steps)
        self.held = self.given_up = False
        self._add(self._hold_queue)
        self._hold_queue = []
        return self._push()

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
        for step in self.steps:
            if step.state in OPEN_STATES:
                step.instance_id, step.state = -1, "queued"
        fill_inputs(self.steps)
        self.steps = [step for step in self.steps if step.state == "queued"]
        if not self.steps:
            return []
        self._next_id = 0
        self._number(self.steps)
        self.graph_name, self.run = self._new_graph_name(), "starting"
        self._dirty, self._nudged, self._pause_wanted = False, "", False
        return [StartGraph(build_graph(self.graph_name, self.steps))]

    def _continue(self) -> list[Effect]:
        """Tell a dry graph where to go on."""
        following = next((step for step in self.steps if step.state in OPEN_STATES), None)
        if following is None:
            return [Say("Nothing else is left to do.")]
        fill_inputs(self.steps)
        blank = {n for n in following.fed if not following.call.input_parameters[n].has_data}
        if blank and self._can_end_step():
            # Our engines report outputs, so what is not known was not given (P10).
            reason = "The step before gave no result that I could go on with."
            return self._fail(following, FailureReport(message=reason, code=FailureCode.INTERNAL))
        effects = self._modify(following)
        self.run, self._nudged = "continuing", following.node
        return effects

    def _modify(self, continue_from: Step | None = None) -> list[Effect]:
        fill_inputs(self.steps)
        done = [step for step in self.steps if step.state == "finished"]
        keep = done[-KEEP_DONE:] + [step for step in self.steps if step.state in OPEN_STATES]
        self._number(keep)
        self._dirty = False
        node = continue_from.node if continue_from else ""
        return [ModifyGraph(build_graph(self.graph_name, keep), node)]

    def _number(self, steps: Sequence[Step]) -> None:
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
        self.steps = without_orphans(self.steps)
        self._stopping, self.graph_name, self.run = self.graph_name, "", "stopping"
        return [StopGraph(self._stopping)]

    def _on_node(self, step: Step, node: Node) -> list[Effect]:
        if step.state not in OPEN_STATES:
            return []
        match node.state:
            case NodeState.RUNNING:
                begins = step.state == "queued"
                step.state = "waiting" if self._waits(node.name) else "running"
                return self._end(step) if begins and step.ending else []
            case NodeState.PAUSED | NodeState.PAUSE_REQUESTED:
                step.state = "paused"
            case NodeState.FINISHED:
                step.state = "skipped" if step.ending else "finished"
            case NodeState.ERROR if step.ending:
                step.state = "skipped"
            case NodeState.ERROR:
                newest = max(node.messages, key=lambda entry: entry.timestamp, default=None)
                report = FailureReport.parse(newest.message if newest else "It failed without saying why.")
                return self._fail(step, report)
        return []

    def _fail(self, step: Step, report: FailureReport) -> list[Effect]:
        step.state = "failed"
        self.held = True
        message = failure_message(self.target, self.graph_name, step, self.steps, report)
        return [ReportFailure(message)]

    def _on_graph_state(self, state: GraphState) -> list[Effect]:
        match state:
            case GraphState.RUNNING | GraphState.INITIALIZED | GraphState.UNINITIALIZED:
                just_started, self.run = self.run in ("starting", "continuing"), "running"
                if self.held:  # the reference's last word after an error is that the graph still runs (D17)
                    self.run = "halted"
                    return []
                if self._pause_wanted:  # the pause may have overtaken what set it going
                    return [PauseGraph(self.graph_name)] if just_started else []
                return self._modify() if self._dirty else []
            case GraphState.PAUSED:
                self.run = "paused"
                current = next((s for s in self.steps if s.state in OPEN_STATES), None)
                if any(s.ending for s in self.steps) and current is not None and current.state == "queued":
                    return self._go_on_after_skip()
            case GraphState.HALTED:
                return self._on_halted()
            case GraphState.STOPPED | GraphState.FINISHED | GraphState.ERROR:
                return self._on_ended_by_others(state)
        return []

    def _on_halted(self) -> list[Effect]:
        waiting = [step for step in self.steps if step.state in OPEN_STATES]
        if self.run == "continuing" and waiting and self._nudged == waiting[0].node and not self.held:
            return []  # asked already; this report may be older than that. `on_no_progress` watches it.
        self.run = "halted"
        if self.held:
            return []
        if any(step.ending and step.state == "skipped" for step in self.steps):
            return self._go_on_after_skip()
        return self._continue() if waiting and not self._pause_wanted else []

    def _go_on_after_skip(self) -> list[Effect]:
        for step in self.steps:
            step.ending = False
        self.steps = without_orphans(self.steps)
        return [] if self._pause_wanted else self._continue()

    def _end_strays(self, graph: Graph) -> list[Effect]:
        """A step that began just before it was dropped is ended."""
        known = {step.node for step in self.steps}
        strays = [n.full_name for n in graph.nodes if n.state in ACTIVE_STATES and n.full_name not in known]
        return [EndStep(graph.name, node) for node in strays if self._can_end_step()]

    def _on_gone(self, *, go_on: bool) -> list[Effect]:
        """The engine has no such graph, e.g. because it was started anew; the plan is kept."""
        self._abandon_start()
        self._pause_wanted = False
        if go_on:
            return self._push()
        text = "My plan was interrupted. It is kept; say “carry on” when I should go on with it."
        return [Say(text, "error")] if self.pending and not self.held else []

    def _on_ended_by_others(self, state: GraphState) -> list[Effect]:
        """The graph ended although nobody asked here: what is left will not run."""
        left = [step for step in self.steps if step.state in OPEN_STATES]
        for step in left:
            step.state = "stopped"
        self.graph_name, self.run, self._pause_wanted = "", "none", False
        return [Say("The plan was stopped.")] if left and state is not GraphState.FINISHED else []

    def _on_stopping(self, graph: Graph) -> list[Effect]:
        if graph.state is GraphState.RUNNING:
            return [StopGraph(self._stopping)]  # the stop may have overtaken the start
        if graph.state not in (GraphState.STOPPED, GraphState.ERROR, GraphState.FINISHED):
            return []
        self._stopping, self.run = "", "none"
        return self._push()

    def _abandon_start(self) -> None:
        self.graph_name, self.run = "", "none"
