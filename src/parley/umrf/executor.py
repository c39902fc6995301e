"""Running one graph (`spec/umrf.md` 8, 10 and 11): states, commands, and what observers are told.

`GraphRun` belongs to the asyncio loop: every command and every end of an action is one synchronous step, so
there is nothing to lock and nothing to poll. Deciding what follows is `flow`, running one node is `node_run`.
"""

from __future__ import annotations

import asyncio
import functools
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any, Final

import structlog

from parley.clock import Clock
from parley.errors import GraphRefusedError, Problem
from parley.messages.failure import FailureReport
from parley.umrf.action import ActionSpec, RunHandle
from parley.umrf.admission import check_entry, check_removed, values_to_continue
from parley.umrf.catalogue import Catalogue
from parley.umrf.check import resolve
from parley.umrf.flow import Effect, Flow, FlowNode
from parley.umrf.graph_index import GraphSpec
from parley.umrf.model import ENDED, NOTHING, Graph, GraphState, Node, NodeState, Result
from parley.umrf.node_run import Ended, Inside, NodeRun
from parley.umrf.other_runs import RemoteRun, SubgraphRun
from parley.umrf.remote import Peers, RemoteEnd, RemoteSpec
from parley.umrf.reports import failure_lines, overdue_text, stop_timed_out_text
from parley.umrf.rounds import Rounds
from parley.umrf.saved import Later, SavedRun, kept_outputs, load, save_frame, save_node
from parley.umrf.slices import in_slices
from parley.umrf.transition import Announcer, Observer

__all__ = ["STOP_TIMEOUT_S", "GraphRun"]

log = structlog.get_logger(__name__)

STOP_TIMEOUT_S: Final = 5.0
"""How long a node may take to stop, in wall time (11.2)."""

_MARGIN_S: Final = 0.1
"""Closing waits so much longer than a stop, so that the time-out is told first."""

_MOVING: Final = (NodeState.RUNNING, NodeState.PAUSE_REQUESTED)
_STILL: Final = (NodeState.PAUSED, NodeState.PAUSE_REQUESTED)


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
        parameters: Inputs of the entry, by flat name.
        peers: The other actors that take part; without them nodes of others are refused.
        make_inner: Makes the run of a sub-graph from the graph and its `parameters`; by default it is like
            this one and nobody observes it.

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
        parameters: Mapping[str, Any] = NOTHING,
        peers: Peers | None = None,
        make_inner: Callable[..., GraphRun] | None = None,
    ) -> None:
        self.name, self.actor = graph.name, actor
        self.outer = ""
        """Name of the graph inside of which it runs."""
        self.state = GraphState.INITIALIZED
        self.result: Result | None = None
        self.peers = peers
        self.on_state: Callable[[GraphState], None] | None = None
        """Told each change of `state`; for whoever waits for this run."""
        self.clock = clock
        known = peers.actors if peers is not None else ()
        self._resolve = functools.partial(
            resolve, catalogue=catalogue, actor=actor, known_actors=known, given=parameters.keys()
        )
        self._graph, specs = self._resolve(graph)
        self._flow = Flow(self._graph, specs)
        self._flow.give(parameters)
        if parameters:
            check_entry(self.name, self._flow)
        self.make_context = make_context
        self._announce = Announcer(graph.name, clock, observer)
        self._stop_timeout_s = stop_timeout_s
        self._runs: dict[str, NodeRun] = {}
        like_this = functools.partial(
            GraphRun, catalogue=catalogue, actor=actor, clock=clock, make_context=make_context
        )
        self._make_inner: Callable[..., GraphRun] = make_inner or functools.partial(
            like_this, stop_timeout_s=stop_timeout_s, peers=peers
        )
        self._left: list[Inside] = []
        """Graphs inside that their nodes left; the others are reached by the runs of their nodes."""
        self._begun: dict[str, SavedRun] = {}
        """Sub-graphs that an earlier process had begun, by graph name."""
        self._rounds = Rounds()
        self._later = Later()
        self._holding = self._stop_failed = False
        self._rested = asyncio.Event()

    # -- commands -------------------------------------------------------------------------------------------

    def start(self, result: Result = Result.ON_TRUE) -> None:
        """Begin at the entry, as if it had ended with `result`; only once."""
        if self.state is not GraphState.INITIALIZED:
            raise self._refusal("already_started", f"{self.name} was started already")
        self._set_graph(GraphState.RUNNING, "start")
        self._apply(self._flow.start(result), "start")
        self._settle()

    def pause(self) -> None:
        """Stand still (11.3); no effect on a graph that does nothing.

        Actions that honour a pause are PAUSED at once, plain ones when they have looked. The others are let
        finish, and what follows is held back; the graph is PAUSED when the last of them is done.
        """
        if self.state is GraphState.RUNNING:
            self._holding = True
        for item in self._active():
            self._pause_node(item, "pause")
        for inner in self._left:
            inner.pause()
        self._settle()

    def resume(self, continue_from: str = "") -> None:
        """Go on after a pause, or run `continue_from` now, whatever its edges say (11.4).

        Without `continue_from` a halted graph stays halted and a running one just goes on.

        Raises:
            GraphRefusedError: The graph has ended, or `continue_from` is unknown or lacks inputs.
        """
        over = self.state in ENDED and (continue_from or self.idle)
        if over or self.state is GraphState.STOPPING:
            raise self._refusal("graph_ended", f"{self.name} is {self.state}", "start it anew")
        form = {name: item.node for name, item in self._flow.nodes.items()}
        past = values_to_continue(self.name, self._flow, form, continue_from, self._runs)
        self._go_on(continue_from, past, "resume")

    def stop(self) -> None:
        """End the run (11.2): the graph is STOPPED when all that runs has; else after a time-out in ERROR."""
        if self.state in (GraphState.RUNNING, GraphState.PAUSED, GraphState.HALTED, GraphState.INITIALIZED):
            self._holding = self._stop_failed = False
            self._later.clear()
            self._set_graph(GraphState.STOPPING, "stop")
        active = self._active()
        for item in active:
            self._runs[item.name].motion.revoke()  # no drive waits for its turn
        in_slices(active, lambda item: self._stop_node(item, "stop"))
        for inner in self._left:
            inner.stop()
        self._settle()

    def end_node(self, name: str) -> None:
        """Stop one node; its edges for `on_stopped` say what follows. One that is over already is left alone.

        Raises:
            GraphRefusedError: There is no such node.
        """
        item = self._flow.nodes.get(name)
        if item is None:
            raise self._refusal("unknown_node", f"{self.name} has no node {name!r}", path="node")
        if not self._later.end(name):
            self._stop_node(item, "end")
        self._settle()

    def modify(self, graph: Graph, continue_from: str = "") -> None:
        """Replace the graph by another form of itself (11.5), in one step, and go on as in `resume`.

        What runs is not disturbed. A paused graph stays paused unless `continue_from` says where to go on.

        Raises:
            GraphRefusedError: With every reason; then nothing has changed.
        """
        changed, specs, past = self._checked(graph, continue_from)
        self._flow.change(changed, specs)
        self._graph = replace(changed, description=self._graph.description)
        self._later.keep(self._flow.nodes)
        self._announce.graph(self.state, "modify", self.result)
        if continue_from:
            self._go_on(continue_from, past, "modify")

    def save(self, *, everything: bool) -> tuple[dict[str, Any], list[tuple[str, dict[str, Any]]]]:
        """What `restore` needs besides the graph: the frame, and the nodes (that changed since last time)."""
        changed = (item for item in self._flow.nodes.values() if everything or item.unsaved)
        nodes = [(item.name, save_node(item)) for item in changed]
        return save_frame(self.state, self.result, self._flow, self._later, self._rounds, self._runs), nodes

    def kept_outputs(self) -> dict[str, dict[str, Any]]:
        """What its nodes gave so far, as far as JSON can hold it: full name -> flat name -> value."""
        return {item.name: given for item in self._flow.nodes.values() if (given := kept_outputs(item))}

    def restore(self, saved: SavedRun) -> None:
        """Instead of `start`: stand where another process was interrupted, until `resume` (or `stop`).

        What was going on is run again then; what had ended keeps its outputs and its seen edges.

        Raises:
            GraphRefusedError: Something that is still needed could not be kept.
        """
        load(saved, self._flow, self._later)
        self._begun = {name: saved.inner[name] for name in saved.frame["inner"] if name in saved.inner}
        self._set_graph(saved.state, "restore", saved.result)
        for item in self._flow.nodes.values():
            if item.state is not NodeState.UNINITIALIZED:
                self._announce.node(item, "restore")

    def check_modify(self, graph: Graph, continue_from: str = "") -> None:
        """Refuse what `modify` would refuse now, without doing it."""
        self._checked(graph, continue_from)

    def _checked(
        self, graph: Graph, continue_from: str
    ) -> tuple[Graph, Sequence[ActionSpec], Mapping[str, Any]]:
        if self.state in ENDED or self.state is GraphState.STOPPING:
            text = f"{self.name} is {self.state} and cannot be changed"
            raise self._refusal("graph_ended", text, "start a new graph")
        resolved, specs = self._resolve(replace(graph, name=self.name))
        form = {node.full_name: node for node in resolved.nodes}
        check_removed(self.name, self._active(), form)
        return resolved, specs, values_to_continue(self.name, self._flow, form, continue_from, self._runs)

    async def wait(self) -> Result:
        """Wait until the graph has ended or halted; how it ended."""
        await self._rested.wait()
        return self.result or Result.ON_STOPPED

    async def close(self) -> None:
        """Stop, wait (at most the time-out) for what runs, abandon what still does not end. Idempotent."""
        if self.state is not GraphState.HALTED or self._runs:  # what has come to rest keeps saying so
            self.stop()
        if tasks := [run.task for run in self._runs.values() if not isinstance(run, RemoteRun)]:
            await asyncio.wait(tasks, timeout=self._stop_timeout_s + _MARGIN_S)
        for name, run in list(self._runs.items()):
            if not await run.abandon():
                log.error("action cannot be ended", graph=self.name, node=name)
        for inner in self._left:
            await inner.close()

    # -- what can be seen -----------------------------------------------------------------------------------

    @property
    def idle(self) -> bool:
        """Whether no action of this graph is going on, nor of those inside of it."""
        return not self._runs and all(inner.idle for inner in self._left)

    @property
    def size(self) -> int:
        """How many nodes it has."""
        return len(self._flow.nodes)

    @property
    def over(self) -> bool:
        """Whether no command changes anything any more, nor in graphs inside of it."""
        return self.state in ENDED and not self._runs and all(inner.over for inner in self._left)

    @property
    def holding(self) -> bool:
        """Whether a pause is in force, even if an action still has to end."""
        return self._holding or self.state is GraphState.PAUSED

    @property
    def resumable(self) -> bool:
        """Whether a resume lets anything go on, also what one of its edges paused or its end left behind."""
        if self.state is GraphState.STOPPING:
            return False
        still = any(item.state in _STILL or self._runs[item.name].resumable for item in self._each_active())
        return self.holding or still or any(inner.resumable for inner in self._left)

    def snapshot(self) -> Graph:
        """The graph as it is now, with states, logs and the data that is there (4.3)."""
        return replace(self._graph, nodes=self._flow.snapshot(), state=self.state)

    @property
    def nodes(self) -> Iterator[tuple[Node, NodeState]]:
        """Its nodes in their order, each with the state it has."""
        return ((item.node, item.state) for item in self._flow.nodes.values())

    def node(self, name: str) -> Node | None:
        """The node of that full name, or None."""
        item = self._flow.nodes.get(name)
        return item.node if item is not None else None

    def outputs(self, node: str) -> Mapping[str, Any]:
        """What the node of that full name gave in its last run, by flat name."""
        return dict(self._flow.nodes[node].outputs) if node in self._flow.nodes else {}

    def exit_values(self) -> Mapping[str, Any]:
        """What the graph as a whole has given, by flat name."""
        return dict(self._flow.exit_values)

    def _active(self) -> list[FlowNode]:
        return list(self._each_active())

    def _each_active(self) -> Iterator[FlowNode]:
        nodes = self._flow.nodes
        return (nodes[name] for name in self._runs if name in nodes and nodes[name].active)

    def _run_node(self, item: FlowNode, cause: str, attempt: int = 1) -> None:
        """Start a run, unless one is going on: then the trigger is ignored (10.4)."""
        if item.name in self._runs or item.name in self._rounds:
            if item.name in self._runs and not item.active:
                log.warning("node has still not stopped", graph=self.name, node=item.name)
            return
        item.last_values, item.skipped = dict(item.values), None
        self._set_node(item, NodeState.RUNNING, cause)
        kind = NodeRun
        if isinstance(item.spec, GraphSpec):
            kind = SubgraphRun
        elif isinstance(item.spec, RemoteSpec) and self.peers is not None:
            kind = RemoteRun
        run = self._runs[item.name] = kind(item, self, attempt)
        run.begin()

    # -- what runs of nodes ask and tell (`Host`) -----------------------------------------------------------

    def asks(self, node: str) -> bool:
        """See `Flow.asks`."""
        return self._flow.asks(node)

    def progressed(self, run: NodeRun, fraction: float | None, text: str) -> None:
        """A node got on."""
        self._announce.progress(run.item.node, fraction, text)

    def begin_inner(self, run: NodeRun) -> GraphRun:
        """Run the graph behind a node under the name of section 1, or go on with what is left of it."""
        assert isinstance(run.spec, GraphSpec)
        node, graph = run.item.node, run.spec.graph
        name = f"{self.name}__{node.name}__{node.instance_id}"
        left = self._begun.pop(name, None)
        if left is None:
            inner = self._make_inner(replace(graph, name=name), parameters=run.values)
        else:
            inner = self._make_inner(left.graph, parameters={})
        inner.outer = self.name
        for old in self._left:
            if old.name == name:  # discarded (11.1): what it left behind is stopped
                old.stop()
        self._left = [old for old in self._left if not old.over]
        if left is None:
            inner.start()
        else:
            inner.restore(left)
            if inner.holding:
                inner.resume()
        return inner

    def moved(self, node: str, state: GraphState) -> None:
        """A sub-graph or a plain action came to stand still, or goes on."""
        item = self._flow.nodes[node]
        if state is GraphState.PAUSED and item.state in _MOVING:
            self._set_node(item, NodeState.PAUSED, "pause")
            self._settle()
        elif state is GraphState.RUNNING and item.state in _STILL:
            self._set_node(item, NodeState.RUNNING, "resume")

    def ended(self, run: NodeRun) -> None:
        """An action is over, however: note it, tell it, and go on with what follows."""
        del self._runs[run.node]
        if run.inner is not None and not run.inner.over:
            self._left.append(run.inner)
        item = self._flow.nodes.get(run.node)
        if item is None or not item.active:  # its stop timed out, which was told already
            return
        ending = run.ending()
        stopped = item.state is NodeState.STOPPING
        if isinstance(ending, BaseException) and not (stopped and isinstance(ending, asyncio.CancelledError)):
            for text in failure_lines(self.name, item.node, ending, run.last_log):
                item.note(text, self.clock.unix_ms())
        if run.restart_wanted and self.state in (GraphState.RUNNING, GraphState.PAUSED):
            self._set_node(item, NodeState.FINISHED, "restart", Result.ON_STOPPED)
            self._hand_over(item, Result.ON_STOPPED)
            if self.holding:
                self._later.again.append(item.name)
                self._settle()
            else:
                self._run_node(item, "restart")
            return
        if not stopped and self._tries_again(item, run, ending):
            return
        if stopped or not item.spontaneous or not isinstance(ending, Ended):
            item.drop_transferred()
        if stopped and not (isinstance(run, RemoteRun) and isinstance(ending, Ended)):
            self._node_over(item, Result.ON_STOPPED, {}, "stop")
        elif isinstance(ending, Ended):
            self._node_over(item, ending.result, ending.outputs, "run", ending.facts, failed=False)
        else:
            self._node_over(item, Result.ON_ERROR, {}, "run")

    def overdue(self, run: NodeRun) -> None:
        """What runs takes its time-out for nothing: it failed, and is left to itself without its drive."""
        item = self._flow.nodes.get(run.node)
        if item is None or not item.active or self._runs.get(run.node) is not run:
            return
        if item.state is NodeState.STOPPING:
            return  # a stop has a time-out of its own
        log.error("action goes on after its time-out", graph=self.name, node=run.node)
        item.note(overdue_text(item.node.name), self.clock.unix_ms())
        self._node_over(item, Result.ON_ERROR, {}, "run")

    def _tries_again(self, item: FlowNode, run: NodeRun, ending: Ended | BaseException) -> bool:
        """Begin another attempt of a node that failed, unless there were enough or it would make no sense."""
        if not run.may_repeat(ending) or self.state not in (GraphState.RUNNING, GraphState.PAUSED):
            return False
        item.note(f"attempt {run.attempt} failed, another one follows", self.clock.unix_ms())
        hold = item.state in _STILL or self._holding
        self._run_node(item, "retry", run.attempt + 1)
        if hold:
            self._pause_node(item, "pause")
            self._settle()
        return True

    def _node_over(
        self,
        item: FlowNode,
        result: Result,
        outputs: Mapping[str, Any],
        cause: str,
        facts: Mapping[str, Any] = NOTHING,
        *,
        failed: bool = True,
    ) -> None:
        """A node is over; a sub-graph that failed inside leaves its node FINISHED (10.8), so not `failed`."""
        stood = item.state in _STILL  # it was told to pause and ended all the same: what follows waits (10.3)
        item.outputs = dict(outputs)
        state = NodeState.ERROR if failed and result is Result.ON_ERROR else NodeState.FINISHED
        self._set_node(item, state, cause, result, facts)
        self._hand_over(item, result)
        self._follow(item.name, result, hold=stood)  # before a round goes on that waited for it (10.7)
        self._rounds.over(item.name)
        self._next_rounds()
        self._settle()

    def _hand_over(self, item: FlowNode, result: Result) -> None:
        """Let the other actors know that a node of this one has ended."""
        if self.peers is not None and item.node.actor == self.actor:
            message = item.log[-1].message if item.state is NodeState.ERROR and item.log else ""
            self.peers.ended(self.name, item.node, RemoteEnd(result, item.given_outputs(), message))

    def _pause_node(self, item: FlowNode, cause: str) -> None:
        self._rounds.pause(item.name)
        if item.state is not NodeState.RUNNING:
            return
        run = self._runs[item.name]
        run.pause()
        if item.state is NodeState.RUNNING:  # a sub-graph has said already that it stands still
            still = NodeState.PAUSED if run.stands_still else NodeState.PAUSE_REQUESTED
            self._set_node(item, still, cause)

    def _stop_node(self, item: FlowNode, cause: str) -> None:
        self._rounds.stop(item.name)
        if not item.active or item.state is NodeState.STOPPING:
            return
        self._set_node(item, NodeState.STOPPING, cause)
        self._runs[item.name].stop(self._stop_timeout_s, lambda: self._stop_timed_out(item.name))

    def _stop_timed_out(self, name: str) -> None:
        item = self._flow.nodes[name]
        self._stop_failed = True
        item.note(stop_timed_out_text(item.node.name, self._stop_timeout_s), self.clock.unix_ms())
        log.error("node did not stop", graph=self.name, node=name)
        self._node_over(item, Result.ON_ERROR, {}, "stop")

    # -- what follows ---------------------------------------------------------------------------------------

    def _follow(self, name: str, result: Result, *, hold: bool = False) -> None:
        """Propagate the end of a node, or hold it back while a pause is in force."""
        if hold or self._holding or self.state is GraphState.PAUSED:
            self._later.held.append((name, result))
        elif self.state is GraphState.RUNNING and self._flow.nodes[name].spontaneous:
            # What the last round set off is stopped before this one sets off anything (10.7).
            reached = self._flow.reachable(name)
            others = [item for item in reached if item.active or self._rounds.between(item.name)]
            for item in others:
                self._stop_node(item, "round")
            self._rounds.wait(name, [item.name for item in others], result)
            self._next_rounds()
        elif self.state is GraphState.RUNNING:
            self._apply(self._flow.propagate(name, result), "edge", source=name)

    def _next_rounds(self) -> None:
        """Propagate ends of spontaneous nodes and run these again, unless they were stopped or failed."""
        for name, result, held in self._rounds.take_ready():
            if held or self._holding or self.state is GraphState.PAUSED:
                self._later.held.append((name, result))
            elif self.state is GraphState.RUNNING and name in self._flow.nodes:
                self._apply(self._flow.propagate(name, result), "edge", source=name)
                if self.state is GraphState.RUNNING and result in (Result.ON_TRUE, Result.ON_FALSE):
                    self._run_node(self._flow.nodes[name], "round")

    def _apply(self, effects: Iterable[Effect], cause: str, source: str = "") -> None:
        waiting = deque(effects)
        while waiting:
            effect = waiting.popleft()
            if effect.kind == "finish":
                self._set_graph(GraphState.FINISHED, "exit", effect.result)
                for item in self._active():
                    if item.spontaneous:  # nothing else would ever end it
                        self._stop_node(item, "exit")
                return
            item = self._flow.nodes[effect.node]
            match effect.kind:
                case "run" if item.name != source or item.state is NodeState.ERROR:
                    self._run_node(item, cause)  # who triggers itself counts as running (10.4), unless failed
                case "stop":
                    self._stop_node(item, cause)
                case "pause":
                    self._pause_node(item, cause)
                case "restart" if item.active:
                    self._runs[item.name].restart_wanted = True
                    self._stop_node(item, cause)
                case "restart":
                    self._run_node(item, cause)
                case "bypassed":
                    item.skipped = effect.result
                    self._set_node(item, item.state, "bypass", effect.result)
                case "fail" if not item.active:
                    item.note(FailureReport(message=effect.message).to_text(), self.clock.unix_ms())
                    item.outputs = {}
                    self._set_node(item, NodeState.ERROR, cause, Result.ON_ERROR)
                    self._hand_over(item, Result.ON_ERROR)
                    waiting.extend(self._flow.propagate(item.name, Result.ON_ERROR))

    def _go_on(self, continue_from: str, past: Mapping[str, Any], cause: str) -> None:
        """Lift the pause, run what was held back, then `continue_from`; checked before."""
        self._holding = False
        self._rounds.resume()
        if self.state is GraphState.PAUSED or (self.state is GraphState.HALTED and continue_from):
            self._set_graph(GraphState.RUNNING, cause)
        for item in self._active():
            if item.state in _STILL or self._runs[item.name].resumable:
                self._runs[item.name].resume()
                if item.state in _STILL:  # a sub-graph has said already that it goes on
                    self._set_node(item, NodeState.RUNNING, cause)
        for inner in self._left:
            if inner.resumable:
                inner.resume()
        again, held = self._later.take()
        for name in again:
            self._run_node(self._flow.nodes[name], "restore")
        for name, result in held:
            self._follow(name, result)
        if continue_from and self.state is GraphState.RUNNING:
            item = self._flow.nodes[continue_from]
            if not item.active:
                item.take(past)
            self._run_node(item, "continue")
        self._settle()

    def _settle(self) -> None:
        """Notice that the graph has come to rest: paused, halted or stopped."""
        going = next(self._each_active(), None) is not None
        if self.state is GraphState.RUNNING and (self._holding or (self._later.held and not going)):
            if not any(item.state in _MOVING for item in self._each_active()):
                self._set_graph(GraphState.PAUSED, "pause")
        elif self.state not in (GraphState.RUNNING, GraphState.STOPPING) or going:
            return
        elif self.state is GraphState.STOPPING:
            if self._stop_failed:
                self._set_graph(GraphState.ERROR, "stop", Result.ON_ERROR)
            else:
                self._set_graph(GraphState.STOPPED, "stop", Result.ON_STOPPED)
        else:
            if reason := self._flow.waiting_for():
                log.warning("graph halted", graph=self.name, reason=reason)
            self._set_graph(GraphState.HALTED, "dry", Result.ON_HALTED, reason)

    def _set_node(
        self,
        item: FlowNode,
        state: NodeState,
        cause: str,
        result: Result | None = None,
        facts: Mapping[str, Any] = NOTHING,
    ) -> None:
        item.state = state
        item.touch()
        self._announce.node(item, cause, result, facts)

    def _set_graph(
        self, state: GraphState, cause: str, result: Result | None = None, message: str = ""
    ) -> None:
        self.state, self.result = state, result
        if state in ENDED or state is GraphState.HALTED:
            self._rested.set()
        else:
            self._rested.clear()
        self._announce.graph(state, cause, result, message)
        if self.on_state is not None:
            self.on_state(state)

    def _refusal(self, code: str, message: str, remedy: str = "", path: str = "") -> GraphRefusedError:
        return GraphRefusedError(self.name, [Problem(path, message, remedy, code)])
