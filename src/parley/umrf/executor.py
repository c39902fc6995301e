"""Running one graph (`spec/umrf.md` 8, 10 and 11): states, commands, and what observers are told.

`GraphRun` belongs to the asyncio loop: every command and every end of an action is one synchronous step, so
there is nothing to lock and nothing to poll. Deciding what follows is `flow`, running one node is `node_run`.
"""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from types import MappingProxyType
from typing import Any, Final

import structlog

from parley.clock import Clock
from parley.errors import ActionFailure, FailureCode, GraphRefusedError, Problem
from parley.messages.failure import FailureReport
from parley.messages.pvf import Parameter, native_type
from parley.umrf.action import Outcome, RunHandle
from parley.umrf.catalogue import Catalogue
from parley.umrf.flow import Effect, Flow, FlowNode
from parley.umrf.model import Graph, GraphState, LogMessage, Node, NodeState, Result
from parley.umrf.node_run import NodeRun
from parley.umrf.reports import failure_text, is_report
from parley.umrf.resolve import resolve
from parley.umrf.transition import Announcer, Observer

__all__ = ["STOP_TIMEOUT_S", "GraphRun"]

log = structlog.get_logger(__name__)

STOP_TIMEOUT_S: Final = 5.0
"""How long a node may take to stop, in wall time (11.2)."""

_MARGIN_S: Final = 0.1
"""Closing waits so much longer than a stop, so that the time-out is told first."""

_ENDED: Final = frozenset({GraphState.FINISHED, GraphState.STOPPED, GraphState.ERROR})
_RESTING: Final = _ENDED | {GraphState.HALTED}
_MOVING: Final = (NodeState.RUNNING, NodeState.PAUSE_REQUESTED)

NO_FACTS: Final[Mapping[str, Any]] = MappingProxyType({})


class GraphRun:
    """One run of one graph.

    Args:
        graph: As read.
        catalogue: What this actor can do.
        actor: Its name.
        clock: Robot time for actions, wall time for stopping.
        make_context: Builds what an action gets as its first argument.
        observer: Told every transition; only looks.
        stop_timeout_s: Wall time a node may take to stop.

    Raises:
        GraphRefusedError: The graph cannot run here; with every reason.
    """

    def __init__(
        self,
        graph: Graph,
        catalogue: Catalogue,
        *,
        actor: str,
        clock: Clock,
        make_context: Callable[[RunHandle], Any],
        observer: Observer | None = None,
        stop_timeout_s: float = STOP_TIMEOUT_S,
    ) -> None:
        resolved = resolve(graph, catalogue, actor=actor)
        self.name = graph.name
        self.actor = actor
        self.state = GraphState.INITIALIZED
        self.result: Result | None = None
        self._graph, self._flow = resolved.graph, Flow(resolved.graph, resolved.specs)
        self._catalogue, self._clock = catalogue, clock
        self._make_context = make_context
        self._announce = Announcer(graph.name, clock, observer)
        self._stop_timeout_s = stop_timeout_s
        self._runs: dict[str, NodeRun] = {}
        self._held: list[tuple[str, Result]] = []
        self._holding = False
        self._stop_failed = False
        self._rested = asyncio.Event()

    # -- commands -------------------------------------------------------------------------------------------

    def start(self) -> None:
        """Begin at the entry; only once."""
        if self.state is not GraphState.INITIALIZED:
            raise self._refusal("already_started", f"{self.name} was started already")
        self._set_graph(GraphState.RUNNING, "start")
        self._apply(self._flow.start(), "start")
        self._settle()

    def pause(self) -> None:
        """Stand still (11.3); no effect on a graph that does nothing.

        Actions that honour a pause are PAUSED at once. The others are let finish, and what follows them is
        held back; the graph is PAUSED when the last of them is done.
        """
        if self.state is GraphState.RUNNING:
            self._holding = True
        for item in self._active():
            self._pause_node(item, "pause")
        self._settle()

    def resume(self, continue_from: str = "") -> None:
        """Go on after a pause, or run `continue_from` now, whatever its edges say (11.4).

        Without `continue_from` a halted graph stays halted and a running one just goes on.

        Raises:
            GraphRefusedError: The graph has ended, or `continue_from` is unknown or lacks inputs.
        """
        over = self.state in _ENDED and (continue_from or not self._active())
        if over or self.state is GraphState.STOPPING:
            raise self._refusal("graph_ended", f"{self.name} is {self.state}", "start it anew")
        past = self._check_continue(self._flow, continue_from)
        self._go_on(continue_from, past, "resume")

    def stop(self) -> None:
        """End the run (11.2): what runs is told to stop at once, the graph is STOPPED when all of it has.

        A node that takes longer than the time-out ends in ERROR, and so does the graph.
        """
        if self.state in (GraphState.RUNNING, GraphState.PAUSED, GraphState.HALTED, GraphState.INITIALIZED):
            self._holding = self._stop_failed = False
            self._held.clear()
            self._set_graph(GraphState.STOPPING, "stop")
        for item in self._active():
            self._stop_node(item, "stop")
        self._settle()

    def end_node(self, name: str) -> None:
        """Stop one node; its edges for `on_stopped` say what follows. One that is over already is left alone.

        Raises:
            GraphRefusedError: There is no such node.
        """
        item = self._flow.nodes.get(name)
        if item is None:
            raise self._refusal("unknown_node", f"{self.name} has no node {name!r}", path="node")
        self._stop_node(item, "end")
        self._settle()

    def modify(self, graph: Graph, continue_from: str = "") -> None:
        """Replace the graph by another form of itself (11.5), in one step, and go on as in `resume`.

        What runs is not disturbed. A paused graph stays paused unless `continue_from` says where to go on.

        Raises:
            GraphRefusedError: With every reason; then nothing has changed.
        """
        if self.state in _ENDED or self.state is GraphState.STOPPING:
            raise self._refusal(
                "graph_ended", f"{self.name} is {self.state} and cannot be changed", "start a new graph"
            )
        resolved = resolve(replace(graph, name=self.name), self._catalogue, actor=self.actor)
        kept = {node.full_name for node in graph.nodes}
        problems = [
            Problem(
                "actions",
                f"{item.name} is {item.state} and cannot be removed",
                "stop it first",
                "node_active",
            )
            for item in self._active()
            if item.name not in kept
        ]
        if problems:
            raise GraphRefusedError(self.name, problems)
        flow = self._flow.replaced(resolved.graph, resolved.specs)
        past = self._check_continue(flow, continue_from)
        self._flow = flow
        self._graph = replace(resolved.graph, description=self._graph.description)
        self._held = [(name, result) for name, result in self._held if name in kept]
        self._announce.graph(self.state, "modify", self.result)
        if continue_from:
            self._go_on(continue_from, past, "modify")

    async def wait(self) -> Result:
        """Wait until the graph has ended or halted; how it ended."""
        await self._rested.wait()
        return self.result or Result.ON_STOPPED

    async def close(self) -> None:
        """Stop, wait (at most the time-out) for what runs, abandon what still does not end. Idempotent."""
        if self.state is not GraphState.HALTED or self._runs:  # what has come to rest keeps saying so
            self.stop()
        if self._runs:
            tasks = [run.task for run in self._runs.values()]
            await asyncio.wait(tasks, timeout=self._stop_timeout_s + _MARGIN_S)
        for name, run in list(self._runs.items()):
            if not await run.abandon():
                log.error("action cannot be ended", graph=self.name, node=name)

    # -- what can be seen -----------------------------------------------------------------------------------

    @property
    def idle(self) -> bool:
        """Whether no action of this graph is going on."""
        return not self._runs

    @property
    def holding(self) -> bool:
        """Whether a pause is in force, even if an action still has to come to its end."""
        return self._holding or self.state is GraphState.PAUSED

    def snapshot(self) -> Graph:
        """The graph as it is now, with states, logs and the data that is there (4.3)."""
        nodes = tuple(_snapshot(item) for item in self._flow.nodes.values())
        return replace(self._graph, nodes=nodes, state=self.state)

    def outputs(self, node: str) -> Mapping[str, Any]:
        """What the node of that full name gave in its last run, by flat name."""
        item = self._flow.nodes.get(node)
        return dict(item.outputs) if item is not None else {}

    # -- nodes ----------------------------------------------------------------------------------------------

    def _active(self) -> list[FlowNode]:
        found = (self._flow.nodes.get(name) for name in self._runs)
        return [item for item in found if item is not None and item.active]

    def _any_active(self) -> bool:
        found = (self._flow.nodes.get(name) for name in self._runs)
        return any(item is not None and item.active for item in found)

    def _run_node(self, item: FlowNode, cause: str) -> None:
        """Start a run, unless one is going on: then the trigger is ignored (10.4)."""
        if item.name in self._runs:
            if not item.active:
                log.warning("node has still not stopped", graph=self.name, node=item.name)
            return
        item.last_values = dict(item.values)
        self._set_node(item, NodeState.RUNNING, cause)
        run = NodeRun(
            item,
            actor=self.actor,
            graph_name=self.name,
            clock=self._clock,
            on_progress=lambda fraction, text: self._announce.progress(item.node, fraction, text),
        )
        self._runs[item.name] = run
        run.begin(self._make_context, self._run_ended)

    def _run_ended(self, run: NodeRun) -> None:
        """An action is over, however: note it, tell it, and go on with what follows."""
        del self._runs[run.node]
        item = self._flow.nodes.get(run.node)
        if item is None or not item.active:  # its stop timed out, which was told already
            return
        ending = run.ending()
        stopped = item.state is NodeState.STOPPING
        if isinstance(ending, BaseException) and not (stopped and isinstance(ending, asyncio.CancelledError)):
            self._log_failure(item, ending, run.last_log)
        if run.restart_wanted and self.state is GraphState.RUNNING and not self._holding:
            self._set_node(item, NodeState.FINISHED, "restart", Result.ON_STOPPED)
            self._run_node(item, "restart")
            return
        item.drop_transferred()
        if stopped:
            self._node_over(item, Result.ON_STOPPED, {}, "stop")
        elif isinstance(ending, Outcome):
            result = Result.ON_TRUE if ending.result else Result.ON_FALSE
            self._node_over(item, result, ending.outputs, "run", ending.facts)
        else:
            self._node_over(item, Result.ON_ERROR, {}, "run")

    def _log_failure(self, item: FlowNode, error: BaseException, last_log: str) -> None:
        """Leave the reason as the node's newest log line, where planners look for it (12.6).

        An action in the reference's style logs its report itself and raises anything; then that one counts.
        """
        if not isinstance(error, ActionFailure | asyncio.CancelledError):
            log.error("action raised", graph=self.name, node=item.name, exc_info=error)
            if is_report(last_log):
                return
        self._log_line(item, failure_text(item.node.name, error))

    def _log_line(self, item: FlowNode, text: str) -> None:
        item.log.append(LogMessage(self._clock.unix_ms(), text))

    def _node_over(
        self,
        item: FlowNode,
        result: Result,
        outputs: Mapping[str, Any],
        cause: str,
        facts: Mapping[str, Any] = NO_FACTS,
    ) -> None:
        item.outputs = dict(outputs)
        state = NodeState.ERROR if result is Result.ON_ERROR else NodeState.FINISHED
        self._set_node(item, state, cause, result, facts)
        self._follow(item.name, result)
        self._settle()

    def _pause_node(self, item: FlowNode, cause: str) -> None:
        if item.state is not NodeState.RUNNING:
            return
        self._runs[item.name].pause()
        state = NodeState.PAUSED if item.spec.pausable else NodeState.PAUSE_REQUESTED
        self._set_node(item, state, cause)

    def _stop_node(self, item: FlowNode, cause: str) -> None:
        if not item.active or item.state is NodeState.STOPPING:
            return
        self._set_node(item, NodeState.STOPPING, cause)
        self._runs[item.name].stop(self._stop_timeout_s, lambda: self._stop_timed_out(item.name))

    def _stop_timed_out(self, name: str) -> None:
        item = self._flow.nodes[name]
        self._stop_failed = True
        report = FailureReport(
            message=f"{item.node.name} did not stop within {self._stop_timeout_s:g} s.",
            code=FailureCode.TIMED_OUT,
        )
        self._log_line(item, report.to_text())
        log.error("node did not stop", graph=self.name, node=name)
        self._node_over(item, Result.ON_ERROR, {}, "stop")

    # -- what follows ---------------------------------------------------------------------------------------

    def _follow(self, name: str, result: Result) -> None:
        """Propagate the end of a node, or hold it back while a pause is in force."""
        if self._holding or self.state is GraphState.PAUSED:
            self._held.append((name, result))
        elif self.state is GraphState.RUNNING:
            self._apply(self._flow.propagate(name, result), "edge", source=name)

    def _apply(self, effects: Iterable[Effect], cause: str, source: str = "") -> None:
        waiting = deque(effects)
        while waiting:
            effect = waiting.popleft()
            if effect.kind == "finish":
                self._set_graph(GraphState.FINISHED, "exit", effect.result)
                return
            item = self._flow.nodes[effect.node]
            match effect.kind:
                case "run" if item.name != source:  # a node that triggers itself counts as running (10.4)
                    self._run_node(item, cause)
                case "stop":
                    self._stop_node(item, cause)
                case "pause":
                    self._pause_node(item, cause)
                case "restart":
                    self._restart_node(item, cause)
                case "bypassed":
                    self._set_node(item, item.state, "bypass", effect.result)
                case "fail" if not item.active:
                    self._log_line(item, FailureReport(message=effect.message).to_text())
                    item.outputs = {}
                    self._set_node(item, NodeState.ERROR, cause, Result.ON_ERROR)
                    waiting.extend(self._flow.propagate(item.name, Result.ON_ERROR))

    def _restart_node(self, item: FlowNode, cause: str) -> None:
        if not item.active:
            self._run_node(item, cause)
            return
        self._runs[item.name].restart_wanted = True
        self._stop_node(item, cause)

    def _check_continue(self, flow: Flow, name: str) -> dict[str, Any]:
        """The inputs that a `continue_from` takes from the past; refused if it cannot run even so."""
        if not name:
            return {}
        item = flow.nodes.get(name)
        if item is None:
            known = ", ".join(flow.nodes) or "none"
            raise self._refusal(
                "unknown_node",
                f"{self.name} has no node {name!r}",
                f"its nodes are: {known}",
                "continue_from",
            )
        if item.active:
            return {}
        if name in self._runs:
            raise self._refusal(
                "still_stopping", f"{name} has still not stopped", "wait for it", "continue_from"
            )
        past = flow.past_values(item)
        if missing := [need for need in item.missing_inputs() if need not in past]:
            raise self._refusal(
                "missing_input",
                f"{name} cannot run without {', '.join(missing)}",
                "give values, or continue from the action that provides them",
                "continue_from",
            )
        return past

    def _go_on(self, continue_from: str, past: Mapping[str, Any], cause: str) -> None:
        """Lift the pause, run what was held back, then `continue_from`; checked before."""
        self._holding = False
        if self.state is GraphState.PAUSED or (self.state is GraphState.HALTED and continue_from):
            self._set_graph(GraphState.RUNNING, cause)
        for item in self._active():
            if item.state in (NodeState.PAUSED, NodeState.PAUSE_REQUESTED):
                self._runs[item.name].resume()
                self._set_node(item, NodeState.RUNNING, cause)
        held, self._held = self._held, []
        for name, result in held:
            self._follow(name, result)
        if continue_from and self.state is GraphState.RUNNING:
            item = self._flow.nodes[continue_from]
            if not item.active:
                item.values |= past
                item.transferred |= past.keys()
            self._run_node(item, "continue")
        self._settle()

    def _settle(self) -> None:
        """Notice that the graph has come to rest: paused, halted or stopped."""
        if self.state is GraphState.RUNNING and self._holding:
            if not any(item.state in _MOVING for item in self._active()):
                self._set_graph(GraphState.PAUSED, "pause")
        elif self.state not in (GraphState.RUNNING, GraphState.STOPPING) or self._any_active():
            return
        elif self.state is GraphState.STOPPING:
            if self._stop_failed:
                self._set_graph(GraphState.ERROR, "stop", Result.ON_ERROR)
            else:
                self._set_graph(GraphState.STOPPED, "stop", Result.ON_STOPPED)
        else:
            reason = self._flow.waiting_for()
            if reason:
                log.warning("graph halted", graph=self.name, reason=reason)
            self._set_graph(GraphState.HALTED, "dry", Result.ON_HALTED, reason)

    # -- telling --------------------------------------------------------------------------------------------

    def _set_node(
        self,
        item: FlowNode,
        state: NodeState,
        cause: str,
        result: Result | None = None,
        facts: Mapping[str, Any] = NO_FACTS,
    ) -> None:
        item.state = state
        outputs = _valued(item.node.output_parameters, item.outputs) if cause == "run" else {}
        outputs |= {name: Parameter(native_type(value), value) for name, value in facts.items()}
        message = item.log[-1].message if state is NodeState.ERROR and item.log else ""
        self._announce.node(item.node, state, cause, result=result, outputs=outputs, message=message)

    def _set_graph(
        self, state: GraphState, cause: str, result: Result | None = None, message: str = ""
    ) -> None:
        self.state, self.result = state, result
        if state in _RESTING:
            self._rested.set()
        else:
            self._rested.clear()
        self._announce.graph(state, cause, result, message)

    def _refusal(self, code: str, message: str, remedy: str = "", path: str = "") -> GraphRefusedError:
        return GraphRefusedError(self.name, [Problem(path, message, remedy, code)])


def _snapshot(item: FlowNode) -> Node:
    inputs = _valued(item.node.input_parameters, item.values)
    return replace(item.node, state=item.state, input_parameters=inputs, messages=tuple(item.log))


def _valued(declared: Mapping[str, Parameter], values: Mapping[str, Any]) -> dict[str, Parameter]:
    """The declared parameters holding exactly `values`."""
    return {name: item.with_value(values.get(name)) for name, item in declared.items()}
