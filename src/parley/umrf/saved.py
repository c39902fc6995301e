"""What of a running graph must be kept to go on with it in another process. Pure.

A run is saved as values that JSON can hold: its frame (`Later`, seen exit edges) and, for each node that has
changed, state, data and seen edges. What an action has in memory is not kept: whatever was going on is run
again, from its beginning and with the same inputs. Values of opaque types cannot be kept; who still needs one
when it is restored is refused rather than run without it.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

from parley.errors import GraphRefusedError, Problem
from parley.messages.pvf import Parameter, fits_type
from parley.umrf.flow import Flow, FlowNode
from parley.umrf.model import ENDED, Graph, GraphState, LogMessage, NodeState, Result
from parley.umrf.node_run import NodeRun
from parley.umrf.rounds import Rounds

__all__ = ["Later", "SavedRun", "kept_outputs", "load", "save_frame", "save_node"]


@dataclass(frozen=True, slots=True)
class SavedRun:
    """A run as it was saved last."""

    graph: Graph
    frame: Mapping[str, Any]
    """Of `GraphRun.save`."""
    nodes: Mapping[str, Mapping[str, Any]]
    """Full name -> what `save_node` gave."""
    inner: Mapping[str, SavedRun] = field(default_factory=dict)
    """The newest runs of its sub-graphs, by graph name."""

    @property
    def state(self) -> GraphState:
        """What it is in when it is restored: nothing goes on before somebody says so."""
        state = GraphState(self.frame["state"])
        if state in ENDED or state is GraphState.HALTED:
            return state
        return GraphState.STOPPED if state is GraphState.STOPPING else GraphState.PAUSED

    @property
    def result(self) -> Result | None:
        """How it had ended, if it had."""
        if self.state is GraphState.STOPPED:
            return Result.ON_STOPPED
        result = self.frame.get("result")
        return Result(result) if result and self.state is not GraphState.PAUSED else None


class Later:
    """What a graph that stands still will do when it goes on."""

    def __init__(self) -> None:
        self.held: list[tuple[str, Result]] = []
        """Nodes that ended meanwhile: what follows them is held back."""
        self.again: list[str] = []
        """Nodes that an earlier process was carrying out."""

    def clear(self) -> None:
        """Nothing."""
        self.held.clear()
        self.again.clear()

    def keep(self, names: Iterable[str]) -> None:
        """Forget nodes that are not among `names`."""
        kept = set(names)
        self.held = [item for item in self.held if item[0] in kept]
        self.again = [name for name in self.again if name in kept]

    def end(self, name: str) -> bool:
        """Do not run a node again after all; whether it was to be."""
        if name not in self.again:
            return False
        self.again.remove(name)
        self.held.append((name, Result.ON_STOPPED))
        return True

    def take(self) -> tuple[list[str], list[tuple[str, Result]]]:
        """What is to be run again and what is to be followed, once."""
        again, held = self.again, self.held
        self.again, self.held = [], []
        return again, held

    def save(self) -> dict[str, Any]:
        """As JSON can hold it."""
        return {"held": [(name, result.value) for name, result in self.held], "again": list(self.again)}

    def load(self, frame: Mapping[str, Any], nodes: Iterable[FlowNode]) -> None:
        """Take over what was saved, and what was going on then; `nodes` are at rest afterwards."""
        self.held = [(name, Result(result)) for name, result in frame["held"]]
        self.again = list(frame["again"])
        for item in nodes:
            if not item.active:
                continue
            if item.state is NodeState.STOPPING and item.name not in frame["restart"]:
                item.state = NodeState.FINISHED
                self.held.append((item.name, Result.ON_STOPPED))
            else:
                item.state = NodeState.UNINITIALIZED
                self.again.append(item.name)
            item.touch()
        self.held += [(name, Result(result)) for name, result in frame["rounds"].items()]


def save_node(item: FlowNode) -> dict[str, Any]:
    """The changing part of a node; takes the mark `unsaved` away."""
    item.unsaved = False
    saved: dict[str, Any] = {"state": item.state.value}
    lost = _put(saved, "values", item.values, item.node.input_parameters)
    lost |= _put(saved, "last", item.last_values, item.node.input_parameters)
    lost |= _put(saved, "outputs", item.outputs, item.node.output_parameters)
    for key, names in (("transferred", item.transferred), ("received", item.received), ("lost", lost)):
        if names:
            saved[key] = sorted(names)
    if item.skipped is not None:
        saved["skipped"] = item.skipped.value
    if item.log:
        saved["log"] = [(line.timestamp, line.message) for line in list(item.log)]
    return saved


def kept_outputs(item: FlowNode) -> dict[str, Any]:
    """What a node gave, as far as JSON can hold it."""
    saved: dict[str, Any] = {}
    _put(saved, "outputs", item.outputs, item.node.output_parameters)
    return dict(saved.get("outputs", {}))


def _put(
    saved: dict[str, Any], key: str, values: Mapping[str, Any], declared: Mapping[str, Parameter]
) -> set[str]:
    """Add those of `values` that JSON can hold; the names of the others."""
    if not values:
        return set()
    kept = {
        name: value
        for name, value in values.items()
        if name in declared and fits_type(declared[name].type, value)
    }
    if kept:
        saved[key] = kept
    return values.keys() - kept.keys()


def save_frame(
    state: GraphState,
    result: Result | None,
    flow: Flow,
    later: Later,
    rounds: Rounds,
    runs: Mapping[str, NodeRun],
) -> dict[str, Any]:
    """The changing part of a run beside its nodes."""
    return later.save() | {
        "state": state.value,
        "result": result.value if result is not None else "",
        "rounds": {name: result.value for name, result in rounds.pending.items()},
        "flow": _save_exit(flow),
        "restart": [name for name, run in runs.items() if run.restart_wanted],
        "inner": [run.inner.name for run in runs.values() if run.inner is not None],
    }


def load(saved: SavedRun, flow: Flow, later: Later) -> None:
    """Give a new flow of the same graph the state that was saved; what was going on is left to `later`.

    Raises:
        GraphRefusedError: A value that is still needed could not be kept.
    """
    _load_flow(flow, saved)
    later.load(saved.frame, flow.nodes.values())


def _save_exit(flow: Flow) -> dict[str, Any]:
    """What has reached the exit so far."""
    needs = {name: Parameter(item.type) for name, item in flow.exit_needs.items()}
    saved: dict[str, Any] = {"started": flow.started}
    _put(saved, "exit_values", flow.exit_values, needs)
    if flow.exit_received:
        saved["exit_received"] = sorted(flow.exit_received)
    if flow.exit_given:
        saved["exit_given"] = sorted(flow.exit_given)
    return saved


def _load_flow(flow: Flow, saved: SavedRun) -> None:
    frame = saved.frame["flow"]
    flow.started = frame["started"]
    flow.exit_received = set(frame.get("exit_received", ()))
    flow.exit_given = set(frame.get("exit_given", ()))
    flow.exit_values = dict(frame.get("exit_values", {}))
    problems = []
    for item in flow.nodes.values():
        kept = saved.nodes.get(item.name)
        if kept is None:
            continue
        _load_node(item, kept)
        needed = sorted({*kept.get("lost", ())} & {*item.missing_inputs()})
        if needed and (item.active or item.state is NodeState.UNINITIALIZED):
            problems.append(
                Problem(
                    item.name,
                    f"{', '.join(needed)} of {item.name} could not be written down",
                    "start the graph anew",
                    "value_lost",
                )
            )
    if problems:
        raise GraphRefusedError(saved.graph.name, problems)


def _load_node(item: FlowNode, kept: Mapping[str, Any]) -> None:
    item.state = NodeState(kept["state"])
    item.values = dict(kept.get("values", {}))
    item.transferred = frozenset(kept.get("transferred", ()))
    item.last_values = dict(kept.get("last", {}))
    item.outputs = dict(kept.get("outputs", {}))
    item.received = set(kept.get("received", ()))
    item.skipped = Result(kept["skipped"]) if "skipped" in kept else None
    item.log[:] = (LogMessage(timestamp, message) for timestamp, message in kept.get("log", ()))
    item.touch()
