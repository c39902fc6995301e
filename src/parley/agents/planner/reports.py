"""What a robot's plan makes of what the engine reports. Pure."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from typing import Any, Final

from parley.agents.planner.effects import Effect, EndStep, PauseGraph, ResumeGraph, Say, StopGraph
from parley.agents.planner.state import PlanState
from parley.agents.planner.steps import (
    ACTIVE_NODES,
    ACTIVE_STATES,
    GONE_CODES,
    KEPT_LATCHED,
    LATCHED,
    OPEN_STATES,
    Step,
    previous,
    stages,
    verdict,
)
from parley.agents.planner.sync import Sync
from parley.errors import FailureCode
from parley.messages.failure import FailureReport
from parley.messages.status import NOT_TAKEN
from parley.sentences import sentence
from parley.umrf.model import ACTIVE, Graph, GraphState, Node, NodeState, Response, Result

__all__ = ["Reports"]

_UNCHANGED: Final = "I could not do that, so I changed nothing."


def _state(nodes: Mapping[str, Node], step: Step) -> NodeState | None:
    node = nodes.get(step.node)
    return node.state if node is not None else None


class Reports:
    """Listens to the engine.

    Args:
        plan: Whose state changes by what is heard.
        sync: Tells the engine what follows from it.
    """

    def __init__(self, plan: PlanState, sync: Sync) -> None:
        self._plan, self._sync = plan, sync

    def on_graph(self, graph: Graph) -> list[Effect]:
        """Take over what the engine reports; reports about any other graph are late and dropped (P4)."""
        if graph.name == self._plan.stopping:
            return self._on_stopping(graph)
        if graph.name == self._plan.abandoned and graph.state in (GraphState.RUNNING, GraphState.PAUSED):
            return [StopGraph(graph.name)]
        if not self._plan.graph_name or graph.name != self._plan.graph_name:
            return []
        effects: list[Effect] = []
        by_name = {node.full_name: node for node in graph.nodes}
        answered = False
        found = [
            (step, by_name[step.node])
            for group in stages(self._plan.steps)
            # What failed comes first, as it decides whether the end of what ran beside it counts.
            for step in sorted(group, key=lambda s: _state(by_name, s) is not NodeState.ERROR)
            if step.node in by_name
        ]
        self._note_dropped(graph, found)
        self._note_unharmed(graph, found)
        cut = graph.state in (GraphState.STOPPING, GraphState.STOPPED) and not self._plan.can_end_step()
        for step, node in found:
            if step.node == node.full_name:
                if cut and step.state in ACTIVE_STATES and node.state is NodeState.FINISHED:
                    step.stopped = True  # the reference says no more of it
                was = step.result
                effects += self._on_node(step, node)
                answered |= node.state is NodeState.ERROR and was is None and step.result is False
        state = graph.state
        if answered and not any(node.state in ACTIVE for node in graph.nodes):
            state = GraphState.HALTED  # the reference's last word after an error is that the graph runs (D17)
        effects += self._end_strays(graph) + self._on_graph_state(state)
        self._plan.forget_taken_back()
        return effects

    def on_outputs(self, graph_name: str, node: str, outputs: dict[str, Any]) -> None:
        """Remember what a step gave, for steps that have to be run again apart from it."""
        if graph_name == self._plan.graph_name:
            for step in self._plan.steps:
                if step.node == node:
                    step.outputs.update(outputs)

    def on_result(self, graph_name: str, node: str, result: str) -> list[Effect]:
        """Take over how a step ended: `on_true`, `on_false`, `on_stopped` or `on_error`."""
        step = next((s for s in self._plan.steps if s.node == node), None) if node else None
        if graph_name != self._plan.graph_name or step is None:
            return []
        if result in ("on_true", "on_false"):
            step.result = result == "on_true"
        elif result == "on_stopped":
            step.stopped = True
            if step.upset and step.state == "finished":
                step.again()
                return self._sync.go_on() if self._may_continue() else []
        if self._plan.run == "halted":
            self._note_ended_by_others()
        self._plan.leave_out_excluded()
        return self._sync.go_on() if self._plan.awaiting and self._may_continue() else []

    def on_no_result(self, graph_name: str) -> list[Effect]:
        """How a step ended was waited for, and not heard."""
        if graph_name != self._plan.graph_name or not self._plan.awaiting or not self._may_continue():
            return []
        self._plan.awaiting = False
        return self._sync.unknown()

    def _may_continue(self) -> bool:
        return self._plan.run == "halted" and not self._plan.held and not self._plan.pause_wanted

    def on_refused(self, graph_name: str, what: str, codes: Collection[str] = ()) -> list[Effect]:
        """The engine refused the command `what`, for the reasons `codes`.

        A refused start means that nothing runs (P2). After an emergency stop, and when the engine has lost
        the graph, the plan is kept until the operator says to go on.
        """
        if graph_name != self._plan.graph_name or not graph_name:
            return []
        command, latched = what.removeprefix("umrf_graph_"), "stop_latched" in codes
        self._plan.resumed = self._plan.resumed and command != "resume"
        if command in ("pause", "resume") and self._plan.run == "starting":
            return []  # it overtook the start; a pause is sent again
        if command != "start" and not GONE_CODES.isdisjoint(codes):
            return self._on_gone(go_on=command == "resume")
        if command == "start" and self._plan.run == "starting":
            self._abandon_start()
            self._plan.unbegun = latched
            for step in self._plan.steps:
                if step.state == "queued" and not latched:
                    step.state = "stopped"
        elif command == "modify":
            told = self._plan.dirty and self._plan.run == "halted"
            self._plan.dirty = True
            if self._plan.nudged:
                self._plan.run, self._plan.nudged = "halted", set()
            elif told:
                return []  # one of several commands that are refused for the same reason
            if "node_active" in codes:
                return []  # a step began just before it was dropped; it is ended
        elif command == "pause":
            self._plan.pause_wanted = False
        return self._kept(command) if latched else [Say(self._unchanged(codes), "error")]

    def _unchanged(self, codes: Collection[str]) -> str:
        if NOT_TAKEN not in codes:
            return _UNCHANGED
        return sentence(
            "{robot} has not begun, and does not say why. Perhaps it cannot do one of the steps.",
            robot=self._plan.target,
        )

    def _kept(self, command: str) -> list[Effect]:
        """After an emergency stop nothing is sent, and refused, again before somebody says to go on."""
        self._plan.pause_wanted = bool(self._plan.pending)
        return [Say(LATCHED if command == "resume" else KEPT_LATCHED, "error")]

    def on_return(self, graphs: Mapping[str, str]) -> list[Effect]:
        """The robot is back after its contact was lost, with these graphs and their states.

        What was said while it was away it did not hear: it is told again to stop or to stand still.
        """
        going = {name for name, state in graphs.items() if state in (GraphState.RUNNING, GraphState.PAUSED)}
        given_up = [StopGraph(name) for name in (self._plan.stopping, self._plan.abandoned) if name in going]
        if not self._plan.graph_name or self._plan.run == "starting":
            return [*given_up]
        if self._plan.graph_name in graphs:
            stands = [PauseGraph(self._plan.graph_name)] if self._plan.pause_wanted else []
            return [*given_up, *stands, *self.on_no_resume(self._plan.graph_name)]
        return [*given_up, *self._on_gone(go_on=False)]

    def on_no_answer(self, graph_name: str) -> list[Effect]:
        """Nothing was heard since the start of `graph_name`: the robot may be away."""
        if graph_name != self._plan.graph_name or self._plan.run != "starting":
            return []
        self._abandon_start()
        self._plan.abandoned = graph_name
        text = sentence(
            "{robot} does not answer. The plan is kept; say “carry on” to try again.", robot=self._plan.target
        )
        return [Say(text, "error")]

    def on_no_progress(self, graph_name: str, node: str) -> list[Effect]:
        """A dry graph was told to go on with `node` some time ago; if it did not, that step failed."""
        step = next((s for s in self._plan.steps if s.node == node), None)
        asked = graph_name == self._plan.graph_name and node in self._plan.nudged and not self._plan.held
        if not asked or step is None or step.state != "queued" or self._plan.pause_wanted:
            return []
        reason = f"I could not begin with this step: {step.call.reason or step.call.name}."
        self._plan.nudged.clear()
        self._plan.run = "running" if any(s.state in ACTIVE_STATES for s in self._plan.steps) else "halted"
        return self._sync.fail(step, FailureReport(message=reason, code=FailureCode.INTERNAL))

    def on_no_resume(self, graph_name: str) -> list[Effect]:
        """A graph was told to go on some time ago: an engine that was out of reach may not have heard it."""
        if graph_name != self._plan.graph_name or self._plan.run != "paused" or not self._plan.resumed:
            return []
        return [ResumeGraph(graph_name)]

    def on_no_end(self, graph_name: str) -> list[Effect]:
        """A stopped graph did not report its end in time: go on without it."""
        if graph_name != self._plan.stopping:
            return []
        self._plan.abandoned, self._plan.stopping, self._plan.run = graph_name, "", "none"
        return self._sync.push()

    # -- inside ----------------------------------------------------------------------------------------

    def _on_node(self, step: Step, node: Node) -> list[Effect]:
        if step.state not in OPEN_STATES:
            return []
        match node.state:
            case NodeState.RUNNING:
                return self._on_running(step, node)
            case NodeState.STOPPING if step.state == "queued":
                step.state = "running"
            case NodeState.PAUSED | NodeState.PAUSE_REQUESTED:
                step.state = "paused"
                self._plan.nudged.discard(step.node)
            case NodeState.FINISHED:
                self._plan.nudged.discard(step.node)
                if step.upset and not step.ending and (step.stopped or not self._plan.can_end_step()):
                    step.again()  # an engine that does not say that it was stopped may have stopped it
                else:
                    step.state = "skipped" if step.ending else "finished"
            case NodeState.ERROR if step.ending:
                step.state = "skipped"
            case NodeState.ERROR if step.upset or self._plan.held:
                step.again()  # one failure at a time; should it fail again, it is told then
            case NodeState.ERROR:
                newest = max(node.messages, key=lambda entry: entry.timestamp, default=None)
                report = FailureReport.parse(newest.message if newest else "It failed without saying why.")
                return self._on_error(step, report)
        return []

    def _on_running(self, step: Step, node: Node) -> list[Effect]:
        begins = step.state == "queued"
        step.state = "waiting" if self._plan.waits_for_operator(node.name) else "running"
        self._plan.nudged.discard(step.node)
        if not begins:
            return []
        for other in self._plan.steps:
            other.ending = other.ending and other.state != "skipped"  # what follows it has begun
        return self._sync.end(step) if step.ending else []

    def _on_error(self, step: Step, report: FailureReport) -> list[Effect]:
        """A step that failed is repaired; but where others ask whether something is there, no will do."""
        self._plan.nudged.discard(step.node)
        asked = any(
            s.when is not None and s.when.step is step for s in self._plan.steps if s.state in OPEN_STATES
        )
        if report.code is FailureCode.NO_MATCH and asked:
            step.state, step.result = "finished", False
            self._sync.upset(step)
            return []
        return self._sync.fail(step, report)

    def _on_graph_state(self, state: GraphState) -> list[Effect]:
        match state:
            case GraphState.RUNNING | GraphState.INITIALIZED | GraphState.UNINITIALIZED:
                return self._on_going()
            case GraphState.PAUSED:
                self._plan.run = "paused"
                current = next((s for s in self._plan.steps if s.state in OPEN_STATES), None)
                if (
                    any(s.ending for s in self._plan.steps)
                    and current is not None
                    and current.state == "queued"
                ):
                    return self._go_on_after_skip()
            case GraphState.HALTED:
                return self._on_halted()
            case GraphState.STOPPED | GraphState.FINISHED | GraphState.ERROR:
                return self._on_ended_by_others(state)
        return []

    def _on_going(self) -> list[Effect]:
        just_started = self._plan.run in ("starting", "continuing")
        self._plan.resumed = self._plan.resumed and self._plan.run != "paused"
        self._plan.run = "running"
        if self._plan.held:
            # The reference's last word after an error is that the graph still runs (D17).
            if not any(step.state in ACTIVE_STATES for step in self._plan.steps):
                self._plan.run = "halted"
            return []
        if self._plan.pause_wanted:  # the pause may have overtaken what set it going
            return [PauseGraph(self._plan.graph_name)] if just_started else []
        return self._sync.modify() if self._plan.dirty else []

    def _infer(self) -> None:
        """An engine that does not say how steps ended shows it by what it left out.

        That is what it passed by, and what it did not begin although the step before decides about it.
        """
        begun = 0
        for index, step in enumerate(self._plan.steps):
            if step.state != "queued":
                begun = index
        for index, step in enumerate(self._plan.steps):
            on = step.when.step if step.when is not None else None
            if step.state != "queued" or on is None or on.state != "finished" or verdict(step) is not None:
                continue
            if index < begun or on in previous(self._plan.steps, index, step.together):
                step.state = "skipped"

    def _on_halted(self) -> list[Effect]:
        if not self._plan.held and not self._plan.nudged and not self._plan.can_end_step():
            self._infer()
        self._note_ended_by_others()
        self._plan.leave_out_excluded()
        waiting = [step for step in self._plan.steps if step.state in OPEN_STATES]
        if waiting and not self._plan.held and self._is_asked(waiting):
            return []  # asked already; this report may be older than that. `on_no_progress` watches it.
        self._plan.run = "halted"
        if self._plan.held:
            return []
        if any(step.ending and step.state == "skipped" for step in self._plan.steps):
            return self._go_on_after_skip()
        if not waiting or self._plan.pause_wanted or self._plan.awaiting:
            return []
        return self._sync.go_on()

    def _is_asked(self, waiting: list[Step]) -> bool:
        asked = {step.node for step in waiting if step.state == "queued"} & self._plan.nudged
        return bool(asked) and self._plan.run in ("continuing", "running")

    def _go_on_after_skip(self) -> list[Effect]:
        for step in self._plan.steps:
            step.ending = False
        self._plan.tidy()
        return [] if self._plan.pause_wanted else self._sync.go_on()

    def _end_strays(self, graph: Graph) -> list[Effect]:
        """A step that began just before it was dropped is ended."""
        known = {step.node for step in self._plan.steps if step.state != "skipped"}
        strays = [n.full_name for n in graph.nodes if n.state in ACTIVE_NODES and n.full_name not in known]
        return [EndStep(graph.name, node) for node in strays if self._plan.can_end_step()]

    def _on_gone(self, *, go_on: bool) -> list[Effect]:
        """The engine has no such graph, e.g. because it was started anew; the plan is kept."""
        self._abandon_start()
        self._plan.pause_wanted = False
        if go_on:
            return self._sync.push()
        text = "My plan was interrupted. It is kept; say “carry on” when I should go on with it."
        return [Say(text, "error")] if self._plan.pending and not self._plan.held else []

    def _note_ended_by_others(self) -> None:
        """Steps that somebody else ended are as those that were left out: nothing came of them."""
        for step in self._plan.steps:
            if step.ended_by_others:
                step.state = "stopped"

    def _on_ended_by_others(self, state: GraphState) -> list[Effect]:
        """The graph ended although nobody asked here: what is left will not run."""
        left = [
            step
            for step in self._plan.steps
            if step.state in OPEN_STATES or (step.state in ("finished", "stopped") and step.stopped)
        ]
        for step in left:
            step.state = "stopped"
        self._plan.graph_name, self._plan.run, self._plan.pause_wanted = "", "none", False
        if not left or state is GraphState.FINISHED:
            return []
        undone = "; ".join(step.call.reason for step in left if step.call.reason)
        if not undone:
            return [Say("The plan was stopped.")]
        return [Say(sentence("The plan was stopped. Not done: {undone}.", undone=undone))]

    def _note_dropped(self, graph: Graph, found: Sequence[tuple[Step, Node]]) -> None:
        """A step that was dropped when it had begun already may fail yet, and stop what ran beside it."""
        known = {step.node for step, _ in found}
        failed = {
            node.ref for node in graph.nodes if node.state is NodeState.ERROR and node.full_name not in known
        }
        for step, node in found:
            stops = (
                edge.node in failed and edge.response(Result.ON_ERROR) is Response.STOP
                for edge in node.parents
            )
            if failed and any(stops):
                step.upset = step.upset or (step.state in OPEN_STATES and step.result is None)

    def _note_unharmed(self, graph: Graph, found: Sequence[tuple[Step, Node]]) -> None:
        """What ran on beside a step that failed while all stood still was not stopped: its end counts."""
        if self._plan.can_end_step() or any(node.state is NodeState.ERROR for node in graph.nodes):
            return
        for step, node in found:
            step.upset = step.upset and node.state is not NodeState.RUNNING

    def _on_stopping(self, graph: Graph) -> list[Effect]:
        if graph.state is GraphState.RUNNING:
            self._note_done(graph)
            return [StopGraph(self._plan.stopping)]  # the stop may have overtaken the start
        if graph.state not in (GraphState.STOPPED, GraphState.ERROR, GraphState.FINISHED):
            return []
        self._plan.stopping, self._plan.run = "", "none"
        return self._sync.push()

    def _note_done(self, graph: Graph) -> None:
        """What has come to its end before the stop reached the engine need not be done again."""
        done = {node.full_name for node in graph.nodes if node.state is NodeState.FINISHED}
        for step in self._plan.steps:
            if step.state in OPEN_STATES and step.node in done:
                step.state = "finished"

    def _abandon_start(self) -> None:
        self._plan.graph_name, self._plan.run, self._plan.unbegun = "", "none", False
