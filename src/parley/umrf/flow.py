"""What follows when a node has ended: the propagation of `spec/umrf.md` 10.4 and the transfer of 10.6.

A plain object without a loop: `Flow` holds the topology, which edges were seen and which data is where;
`propagate` moves results and data on and returns what is to be done. Who does it is `executor`.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Final, Literal, NamedTuple

from parley.errors import ActionFailure, FailureCode
from parley.messages.pvf import NATIVE_TYPES, Parameter, fits_type
from parley.umrf.action import ActionSpec
from parley.umrf.isolated import isolated
from parley.umrf.model import (
    ACTIVE,
    DEFAULT_CONDITIONS,
    ENTRY,
    EXIT,
    MAX_MESSAGES,
    NOTHING,
    ChildRelation,
    Graph,
    LogMessage,
    Node,
    NodeState,
    ParentRelation,
    Response,
    Result,
)

__all__ = ["Effect", "Flow", "FlowNode"]

_COMPARABLE = ("string", "number", "bool")
"""Types whose allowed values are compared; any list blocks the others (4.4)."""


class Effect(NamedTuple):
    """Something to be done, in the order in which propagation gave it."""

    kind: Literal["run", "stop", "pause", "restart", "bypassed", "fail", "finish"]
    node: str = ""
    """Full name; empty for `finish`, which ends the graph."""
    result: Result = Result.ON_TRUE
    """For `finish` the graph's result, for `bypassed` what is passed on."""
    message: str = ""
    """For `fail`: why the node cannot run."""


_ASKED: Final[Mapping[Response, Literal["run", "stop", "pause", "restart"]]] = {
    Response.RUN: "run",
    Response.STOP: "stop",
    Response.PAUSE: "pause",
    Response.RESTART: "restart",
}


@dataclass(slots=True, eq=False)
class FlowNode:
    """One node of a running graph: its description, matched, and everything that changes."""

    name: str
    """The full name."""
    node: Node
    spec: ActionSpec
    parents: dict[str, ParentRelation] = field(init=False)
    """By full name, the hidden entry included."""
    children: tuple[ChildRelation, ...] = field(init=False)
    """The hidden exit included, as the last."""
    state: NodeState = NodeState.UNINITIALIZED
    values: dict[str, Any] = field(init=False)
    """Inputs that have data now."""
    transferred: frozenset[str] = frozenset()
    """Those of `values` that came along an edge; they are dropped after the run (4.3)."""
    last_values: Mapping[str, Any] = field(default_factory=lambda: NOTHING)
    """The inputs of the last run, for a run that repeats it."""
    outputs: Mapping[str, Any] = field(default_factory=lambda: NOTHING)
    """Of the last run."""
    began_s: float = -math.inf
    """Robot time at which the last round of a spontaneous node began."""
    received: set[str] = field(default_factory=set)
    """Parents whose edge was seen at least once."""
    log: list[LogMessage] = field(default_factory=list)
    """The newest, at most `MAX_MESSAGES`; threads add to it."""
    starved: bool = False
    """Whether it was to run (again) and lacked an input."""
    skipped: Result | None = None
    """See `Node.skipped`."""
    made: Callable[..., Any] | None = None
    """What runs it, once it has run."""
    unsaved: bool = True
    """Whether something changed since it was last saved; whoever saves it takes the mark away."""
    stale: set[str] = field(default_factory=set, kw_only=True, repr=False)
    """Of its flow: full names of nodes that changed since they were last shown."""
    _shown: Node | None = field(default=None, init=False, repr=False)

    def __post_init__(self) -> None:
        self.values = _given_values(self.node)
        self._relate()

    def _relate(self) -> None:
        """Take the relations of the description; its graph adds those to the entry and the exit."""
        self.parents = {relation.node.full_name: relation for relation in self.node.parents}
        self.children = self.node.children
        self.touch()

    def change(self, node: Node) -> None:
        """Step 4 of 11.5: relations and limits are replaced, given values overwrite, nothing else."""
        given = self.taken_from(node)
        self.values |= given
        self.transferred = self.transferred.difference(given)
        self.node = self.node._replace(
            parents=node.parents, children=node.children, retries=node.retries, timeout_s=node.timeout_s
        )
        self._relate()
        self.received &= self.parents.keys() | {ENTRY.full_name}

    def taken_from(self, node: Node) -> dict[str, Any]:
        """The inputs that another description of it brings."""
        declared, given = self.node.input_parameters, node.input_parameters
        return {
            name: value
            for name, value in _given_values(node).items()
            if name in declared and _accepts(declared[name], given[name].type, value)
        }

    def touch(self) -> None:
        """Something about the node is different now; to be called after each change."""
        self._shown, self.unsaved = None, True
        self.stale.add(self.name)  # last, as a log line may come from a thread

    def runner(self) -> Callable[..., Any]:
        """What runs it: made before its first run and kept, so that class actions remember.

        Raises:
            ActionFailure: `not_capable`: the action is only described, by a descriptor file.
        """
        if self.made is None:
            self.made = isolated(self.spec) if self.spec.isolated else self.spec.runner()
        if self.made is None:
            text = f"{self.spec.name} is only described here; nothing carries it out."
            raise ActionFailure(FailureCode.NOT_CAPABLE, text)
        return self.made

    @property
    def spontaneous(self) -> bool:
        """Whether it runs again and again until it is stopped (10.7)."""
        return self.node.type == "spontaneous"

    @property
    def active(self) -> bool:
        """Whether a run of it is going on, standing still included."""
        return self.state in ACTIVE

    def missing_inputs(self) -> list[str]:
        """Required inputs without data."""
        inputs = self.node.input_parameters.items()
        return [name for name, known in inputs if known.required and name not in self.values]

    def missing_edges(self) -> list[str]:
        """Required parents whose edge was not seen yet."""
        return [name for name, edge in self.parents.items() if edge.required and name not in self.received]

    def given_outputs(self) -> dict[str, Parameter]:
        """The declared outputs, with what the last run gave."""
        return _valued(self.node.output_parameters, self.outputs)

    def snapshot(self) -> Node:
        """The node as it is now, with the data that is there (4.3); the same object until it changes."""
        if self._shown is None:
            node = self.node
            self._shown = node._replace(
                state=self.state,
                input_parameters=_valued(node.input_parameters, self.values),
                messages=tuple(self.log),
                skipped=self.skipped,
            )
        return self._shown

    def take(self, given: Mapping[str, Any]) -> None:
        """Take over inputs that came along an edge."""
        self.values |= given
        self.transferred = self.transferred.union(given)
        self.touch()

    def see(self, parent: str) -> None:
        """The edge from the parent of that full name was seen."""
        self.received.add(parent)
        self.unsaved = True

    def note(self, text: str, unix_ms: int) -> None:
        """Add a log line."""
        self.log.append(LogMessage(unix_ms, text))
        del self.log[:-MAX_MESSAGES]
        self.touch()

    def drop_transferred(self) -> None:
        """Forget what came along edges, after a run."""
        for name in self.transferred:
            self.values.pop(name, None)
        self.transferred = frozenset()
        self.touch()


def _given_values(node: Node) -> dict[str, Any]:
    """The inputs for which the description of a node has data."""
    return {name: item.value for name, item in node.input_parameters.items() if item.has_data}


def _valued(declared: Mapping[str, Parameter], values: Mapping[str, Any]) -> dict[str, Parameter]:
    """The declared parameters holding exactly `values`."""
    return {name: item.with_value(values.get(name)) for name, item in declared.items()}


class Flow:
    """The moving part of one graph.

    Args:
        graph: A checked graph whose inputs are merged with the descriptors.
        specs: What runs each of its nodes.
    """

    def __init__(self, graph: Graph, specs: Sequence[ActionSpec]) -> None:
        self.nodes: dict[str, FlowNode] = {}
        self.started: bool = False
        self.exit_received: set[str] = set()
        self.exit_given: set[str] = set()
        self.exit_values: dict[str, Any] = {}
        """What the exit was given: the outputs of the graph as a whole (6)."""
        self._stale: set[str] = set()
        self._shown: dict[str, Node] = {}
        self.change(graph, specs)

    def change(self, graph: Graph, specs: Sequence[ActionSpec]) -> None:
        """Take on another form (11.5): nodes that stay are the same and keep state, data and seen edges."""
        old, self.nodes = self.nodes, {}
        for node, spec in zip(graph.nodes, specs, strict=True):
            name = node.full_name
            if (item := old.get(name)) is None:
                item = FlowNode(name, node, spec, stale=self._stale)
            else:
                item.change(node)
            self.nodes[name] = item
        self._shown = {}
        self.entry = graph.entry
        self.exit = {relation.node.full_name: relation for relation in graph.exit}
        self.exit_received &= self.exit.keys()
        for relation in self.entry:
            item = self.nodes[relation.node.full_name]
            item.parents[ENTRY.full_name] = ParentRelation(ENTRY)
            if self.started:
                item.see(ENTRY.full_name)
        for name in self.exit:
            self.nodes[name].children += (ChildRelation(EXIT),)
        outputs = [self.nodes[name].node.output_parameters for name in self.exit]
        self.exit_needs: Mapping[str, Parameter] = next((item for item in reversed(outputs) if item), {})

    def give(self, parameters: Mapping[str, Any]) -> None:
        """Copy start parameters to those inputs of the entry actions that have no value (6)."""
        for relation in self.entry:
            item, renamed = self.nodes[relation.node.full_name], dict(relation.remap)
            for source, value in parameters.items():
                name = renamed.get(source, source)
                own = item.node.input_parameters.get(name)
                if own is None or name in item.values or not _accepts(own, own.type, value):
                    continue
                if own.type not in NATIVE_TYPES or fits_type(own.type, value):
                    item.values[name] = value
                    item.touch()

    def start(self, result: Result = Result.ON_TRUE) -> list[Effect]:
        """The entry has ended with `result`: what follows."""
        self.started = True
        effects: list[Effect] = []
        response = DEFAULT_CONDITIONS[result]
        for relation in self.entry:
            item = self.nodes[relation.node.full_name]
            item.see(ENTRY.full_name)
            if response is Response.RUN:
                effects += self._respond(item, response, "")
            elif response is Response.BYPASS:
                effects += [Effect("bypassed", item.name, result), *self.propagate(item.name, result)]
        return effects

    def propagate(self, name: str, result: Result) -> list[Effect]:
        """Node `name` has ended with `result`: mark edges, move data, and say what follows.

        Bypassed nodes pass the result on at once. An edge is followed once per call, so that a cycle of
        bypasses ends.
        """
        effects: list[Effect] = []
        followed: set[tuple[str, str]] = set()
        waiting: deque[str] = deque([name])
        while waiting:
            parent = self.nodes[waiting.popleft()]
            for relation in parent.children:
                edge = (parent.name, relation.node.full_name)
                if edge in followed:
                    continue
                followed.add(edge)
                outputs = parent.outputs if parent.name == name else {}  # a bypassed node gave none
                if relation.node == EXIT:
                    if self._reaches_exit(parent, result, outputs):
                        return [*effects, Effect("finish", result=result)]
                    continue
                child = self.nodes[edge[1]]
                child.see(parent.name)
                response = child.parents[parent.name].response(result)
                if response is Response.BYPASS:
                    effects.append(Effect("bypassed", child.name, result))
                    waiting.append(child.name)
                elif response is not Response.IGNORE:
                    given, refused = _carried(parent, outputs, child.node.input_parameters, relation)
                    if given:
                        child.take(given)
                    effects += self._respond(child, response, refused)
        return effects

    def snapshot(self) -> tuple[Node, ...]:
        """All nodes as they are now; only those that changed are looked at."""
        if not self._shown:
            self._shown = {name: item.snapshot() for name, item in self.nodes.items()}
        while self._stale:
            name = self._stale.pop()
            if name in self.nodes:  # what was taken out may still log
                self._shown[name] = self.nodes[name].snapshot()
        return tuple(self._shown.values())

    def reachable(self, name: str) -> list[FlowNode]:
        """All nodes to which edges lead from node `name`, itself left out; cycles are no obstacle."""
        found = {name: self.nodes[name]}
        waiting = deque([name])
        while waiting:
            for relation in self.nodes[waiting.popleft()].children:
                child = relation.node.full_name
                if relation.node != EXIT and child not in found:
                    found[child] = self.nodes[child]
                    waiting.append(child)
        del found[name]
        return list(found.values())

    def asks(self, name: str) -> bool:
        """Whether something else follows when node `name` ends false than when it ends true."""
        item = self.nodes.get(name)
        for relation in item.children if item is not None else ():
            child = self.nodes.get(relation.node.full_name)
            edge = child.parents.get(name) if child is not None else self.exit.get(name)
            if edge is not None and edge.response(Result.ON_TRUE) is not edge.response(Result.ON_FALSE):
                return True
        return False

    def waiting_for(self) -> str:
        """Why nodes that were reached do not run, or what the exit waits for, in words; may be empty."""
        if not self.entry and all(item.state is NodeState.UNINITIALIZED for item in self.nodes.values()):
            return "nothing is at the entry"
        reasons: list[str] = []
        for item in self.nodes.values():
            began = item.state is not NodeState.UNINITIALIZED
            if item.active or not item.received or (began and not item.starved):
                continue
            if missing := item.missing_inputs():
                again = " to run again" if began else ""
                reasons.append(f"{item.name} has no data for {', '.join(missing)}{again}")
            if missing := item.missing_edges():
                reasons.append(f"{item.name} still waits for {', '.join(missing)}")
        failed = any(item.state is NodeState.ERROR for item in self.nodes.values())
        return "; ".join(reasons) or ("" if failed else self._exit_waits_for())

    def _exit_waits_for(self) -> str:
        """What the exit lacks, unless its edges are such that graphs of this kind are meant to run dry."""
        usual = (Result.ON_TRUE, Result.ON_FALSE)
        ends = [
            name
            for name, edge in self.exit.items()
            if any(edge.response(result) is not Response.IGNORE for result in usual)
        ]
        if missing := [name for name in ends if self.exit[name].required and name not in self.exit_received]:
            return f"the exit still waits for {', '.join(missing)}"
        lacking = sorted(self.exit_needs.keys() - self.exit_given) if ends else ()
        return f"the exit was not given {', '.join(lacking)}" if lacking else ""

    def past_values(self, name: str, form: Mapping[str, Node]) -> tuple[dict[str, Any], list[str]]:
        """For a node that is run out of turn (11.4): what it lacks, as its parents or it had it last.

        Args:
            name: Its full name.
            form: The nodes of the graph, as they are or will be, by full name.

        Returns:
            The values, and the inputs that it lacks even so.
        """
        item, node = self.nodes.get(name), form[name]
        if item is None:
            declared, has, found = node.input_parameters, _given_values(node), {}
        else:
            new = item.taken_from(node) if node is not item.node else {}
            declared, has, found = item.node.input_parameters, item.values | new, dict(item.last_values)
        for edge in node.parents:
            parent = self.nodes.get(edge.node.full_name)
            for relation in form[edge.node.full_name].children if parent is not None else ():
                if parent is not None and relation.node == node.ref:
                    found |= _carried(parent, parent.outputs, declared, relation)[0]
        lacking = [name for name, known in declared.items() if known.required and name not in has]
        past = {name: found[name] for name in lacking if name in found}
        return past, [name for name in lacking if name not in past]

    def _respond(self, child: FlowNode, response: Response, refused: str) -> list[Effect]:
        """Do what the edge says once the child is ready; a value that is not allowed is the child's error."""
        if child.missing_edges():
            return []
        runs = response is Response.RUN
        lacks = bool(child.missing_inputs())
        child.starved = runs and lacks
        if lacks:
            return [Effect("fail", child.name, message=refused)] if refused and runs else []
        return [Effect(_ASKED[response], child.name)]

    def _reaches_exit(self, parent: FlowNode, result: Result, outputs: Mapping[str, Any]) -> bool:
        """Whether this end of an exit action ends the graph (5.3, 6)."""
        relation = self.exit[parent.name]
        self.exit_received.add(parent.name)
        response = relation.response(result)
        if response is Response.BYPASS:
            return True
        if response is Response.IGNORE:
            return False
        # The reference reads outputs that were not given as zero values: they are no reason to wait for ever.
        declared = parent.node.output_parameters
        self.exit_given |= declared.keys()
        for name, needed in self.exit_needs.items():
            if name in outputs and name in declared and declared[name].type == needed.type:
                self.exit_values[name] = outputs[name]
        if not self.exit_needs.keys() <= self.exit_given:
            return False
        return all(name in self.exit_received for name, edge in self.exit.items() if edge.required)


def _carried(
    parent: FlowNode, outputs: Mapping[str, Any], inputs: Mapping[str, Parameter], relation: ChildRelation
) -> tuple[dict[str, Any], str]:
    """What an edge brings to the inputs of the same (renamed) name, and why not, if a value is refused."""
    renamed = dict(relation.remap)
    given: dict[str, Any] = {}
    refused = ""
    for source, value in outputs.items():
        name = renamed.get(source, source)
        own, declared = inputs.get(name), parent.node.output_parameters.get(source)
        if own is None or declared is None:
            continue
        if _accepts(own, declared.type, value):
            given[name] = value
        elif own.updatable and own.type == declared.type:
            refused = f"{name} must be one of {', '.join(map(str, own.allowed))}, not {value}."
    return given, refused


def _accepts(own: Parameter, pvf_type: str, value: Any) -> bool:
    """Whether incoming data may be taken over (4.4, 10.6)."""
    if not own.updatable or own.type != pvf_type:
        return False
    return not own.allowed or (own.type in _COMPARABLE and value in own.allowed)
