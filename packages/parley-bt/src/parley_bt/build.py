"""From a tree to the graph that does the same: edges, joins, exits, and what moves along them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import Literal

from parley.errors import GraphRefusedError, Problem
from parley.umrf.model import ChildRelation, Graph, Node, NodeRef, ParentRelation, Response, Result
from parley_bt.reasons import refusal
from parley_bt.shape import (
    Fallback,
    ForceSuccess,
    Inverter,
    Leaf,
    Parallel,
    Retry,
    Sequence,
    Shape,
    ends,
    leaves,
    starts,
)

__all__ = ["Links", "build"]


@dataclass(slots=True)
class Links:
    """Which input reads and which output writes which blackboard entry."""

    reads: dict[tuple[NodeRef, str], str] = field(default_factory=dict)
    writes: dict[tuple[NodeRef, str], str] = field(default_factory=dict)
    lines: dict[NodeRef, str] = field(default_factory=dict)
    """Where each action stands in the XML, for messages."""


@dataclass(frozen=True, slots=True)
class _Next:
    """What follows a success or a failure."""

    targets: tuple[NodeRef, ...] = ()
    joins: bool = False
    """Whether the targets (or the exit) wait for others as well."""
    end: Literal["", "ok", "bad"] = ""
    """Without targets: the tree ends so."""
    apart: bool = False
    """At an end: whether others go on to ends of their own, so that the exit must not be reached."""
    through: Leaf | None = None
    """An action that is bypassed on the way, because it passes a failure on to the same place."""


@dataclass(slots=True)
class _Edge:
    required: bool
    responses: dict[Result, Response] = field(default_factory=dict)


def build(name: str, shape: Shape, nodes: Mapping[NodeRef, Node], links: Links) -> Graph:
    """The graph of a tree.

    Args:
        name: Of the graph.
        shape: What the tree does; every action stands in it once.
        nodes: Its actions, without relations.
        links: Its data.

    Raises:
        GraphRefusedError: There is none; with codes of `IMPORT_REASONS`.
    """
    builder = _Builder(links)
    builder.emit(shape, _Next(end="ok"), _Next(end="bad"), in_loop=False)
    graph = builder.graph(name, shape, nodes)
    if builder.problems:
        raise GraphRefusedError(name, builder.problems)
    return graph


class _Builder:
    def __init__(self, links: Links) -> None:
        self.problems: list[Problem] = []
        self._links = links
        self._edges: dict[NodeRef, dict[NodeRef, _Edge]] = {}
        self._exits: dict[NodeRef, _Edge] = {}

    # -- control --------------------------------------------------------------------------------------------

    def emit(self, shape: Shape, ok: _Next, bad: _Next, *, in_loop: bool) -> None:
        """Draw the edges of `shape`, given what follows it."""
        match shape:
            case Leaf():
                self._leaf(shape, ok, bad)
            case Sequence():
                self._sequence(shape.children, ok, bad, in_loop)
            case Fallback():
                for child, after in pairwise(shape.children):
                    self.emit(child, ok, _Next(starts(after)), in_loop=in_loop)
                self.emit(shape.children[-1], ok, bad, in_loop=in_loop)
            case Parallel():
                self._parallel(shape, ok, bad, in_loop)
            case Retry():
                self.emit(shape.child, ok, _Next(starts(shape.child)), in_loop=True)
            case Inverter():
                self.emit(shape.child, bad, ok, in_loop=in_loop)
            case ForceSuccess():
                self.emit(shape.child, ok, ok, in_loop=in_loop)

    def _sequence(self, children: tuple[Shape, ...], ok: _Next, bad: _Next, in_loop: bool) -> None:
        for child, after in pairwise(children):
            failed = replace(bad, through=after) if isinstance(after, Leaf) and not in_loop else bad
            self.emit(child, _Next(starts(after)), failed, in_loop=in_loop)
        self.emit(children[-1], ok, bad, in_loop=in_loop)

    def _parallel(self, shape: Parallel, ok: _Next, bad: _Next, in_loop: bool) -> None:
        at_end = ok.end == "ok" and bad.end == "bad" and not ok.joins
        fails_elsewhere = bool(ends(shape, False)) and (bad.end != "bad" or bad.apart)
        if not at_end if shape.all_end else fails_elsewhere:
            self._refuse("join_error", shape)
        if in_loop:
            self._refuse("join_in_cycle", shape)
        if not shape.all_end and not all(_one_end(child) for child in shape.children):
            self._refuse("branch_ends", shape)
        after = replace(ok, apart=True) if shape.all_end else replace(ok, joins=True)
        failed = replace(bad, apart=bad.apart or shape.all_end, through=None)
        for child in shape.children:
            self.emit(child, after, failed, in_loop=in_loop)

    def _leaf(self, leaf: Leaf, ok: _Next, bad: _Next) -> None:
        false = ok if leaf.false_succeeds else bad
        for result, after in ((Result.ON_TRUE, ok), (Result.ON_FALSE, false), (Result.ON_ERROR, bad)):
            by = after.through
            if by is not None and (
                result is Result.ON_ERROR or (result is Result.ON_FALSE and not by.false_succeeds)
            ):
                self._edge(leaf.node, by.node, False).responses[result] = Response.BYPASS
                continue
            for target in after.targets:
                self._edge(leaf.node, target, after.joins).responses[result] = Response.RUN
            if after.end:
                self._end(leaf, result, after)

    def _end(self, leaf: Leaf, result: Result, after: _Next) -> None:
        # Where branches meet at the exit, a false that goes on counts as arrived.
        wanted = result is Result.ON_TRUE or (after.joins and result is Result.ON_FALSE)
        if (after.end == "ok") != wanted and not (after.end == "bad" and result is not Result.ON_TRUE):
            self._refuse("end_result", leaf)
        if after.apart:
            return
        edge = self._exits.setdefault(leaf.node, _Edge(False))
        arrives = after.joins and after.end == "ok"
        edge.required = edge.required or arrives
        edge.responses[result] = Response.RUN if arrives else Response.BYPASS

    def _edge(self, parent: NodeRef, child: NodeRef, required: bool) -> _Edge:
        edge = self._edges.setdefault(parent, {}).setdefault(child, _Edge(required))
        edge.required = edge.required or required
        return edge

    def _refuse(self, code: str, shape: Shape, what: str = "") -> None:
        first = next(leaves(shape)).node
        problem = refusal(code, self._links.lines.get(first, ""), what or first.full_name)
        if problem not in self.problems:
            self.problems.append(problem)

    # -- the whole ------------------------------------------------------------------------------------------

    def graph(self, name: str, shape: Shape, nodes: Mapping[NodeRef, Node]) -> Graph:
        """The graph, once everything was emitted."""
        parents: dict[NodeRef, dict[NodeRef, _Edge]] = {ref: {} for ref in nodes}
        for parent, edges in self._edges.items():
            for child, edge in edges.items():
                parents[child][parent] = edge
        reached = self._reached(starts(shape))
        for child, given in parents.items():
            if child not in reached:
                self._refuse("never_runs", Leaf(child))
            elif (
                len({edge.required for edge in given.values() if Response.RUN in edge.responses.values()}) > 1
            ):
                self._refuse("join_mixed", Leaf(child))
        remaps = _Data(nodes, parents, self._links, self._refuse).remaps(starts(shape))
        linked = tuple(
            node._replace(
                parents=tuple(_relation(parent, edge) for parent, edge in parents[ref].items()),
                children=tuple(
                    ChildRelation(child, remaps.get((ref, child), ())) for child in self._edges.get(ref, {})
                ),
            )
            for ref, node in nodes.items()
        )
        # The exit waits for the outputs of the last that has any, so those that arrive there come last.
        exits = sorted(self._exits.items(), key=lambda item: item[1].required)
        entry = tuple(ChildRelation(ref) for ref in starts(shape))
        return Graph(name, linked, entry, tuple(_relation(ref, edge) for ref, edge in exits))

    def _reached(self, entry: tuple[NodeRef, ...]) -> set[NodeRef]:
        reached, waiting = set(entry), list(entry)
        while waiting:
            new = self._edges.get(waiting.pop(), {}).keys() - reached
            reached |= new
            waiting += new
        return reached


def _one_end(shape: Shape) -> bool:
    """Whether success is told by the same actions each time, as a join needs it."""
    match shape:
        case Parallel():
            return all(_one_end(child) for child in shape.children)
        case Sequence():
            return _one_end(shape.children[-1])
        case Retry():
            return _one_end(shape.child)
        case _:
            return len(ends(shape, True)) == 1


def _relation(parent: NodeRef, edge: _Edge) -> ParentRelation:
    results = (Result.ON_TRUE, Result.ON_FALSE, Result.ON_ERROR)
    conditions = {result: edge.responses.get(result, Response.IGNORE) for result in results}
    return ParentRelation(parent, edge.required, conditions)


class _Data:
    """Which entries become transfers along edges; UMRF has no store that outlives an edge."""

    def __init__(
        self,
        nodes: Mapping[NodeRef, Node],
        parents: Mapping[NodeRef, Mapping[NodeRef, _Edge]],
        links: Links,
        refuse: Callable[[str, Shape, str], None],
    ) -> None:
        self._nodes, self._parents, self._links, self._refuse = nodes, parents, links, refuse

    def remaps(
        self, entry: tuple[NodeRef, ...]
    ) -> dict[tuple[NodeRef, NodeRef], tuple[tuple[str, str], ...]]:
        """The renames of every edge that carries data."""
        found: dict[tuple[NodeRef, NodeRef], dict[str, str]] = {}
        written = set(self._links.writes.values())
        for (child, name), key in self._links.reads.items():
            givers = self._givers(child)
            if key not in written:
                self._refuse("entry_without_giver", Leaf(child), name)
                continue
            outputs = {giver: self._output(giver, key, self._type(child, name)) for giver in givers}
            known = {giver: output for giver, output in outputs.items() if output is not None}
            joined = any(self._parents[child][giver].required for giver in givers)
            if (
                child in entry
                or not known
                or (len(known) < len(givers) and not joined)
                or (joined and len(known) > 1)
            ):
                self._refuse("entry_passes_by", Leaf(child), name)
                continue
            for giver, output in known.items():
                renamed = found.setdefault((giver, child), {})
                if output in renamed:
                    self._refuse("entry_passes_by", Leaf(child), name)
                renamed[output] = name
        self._check_equal_names(found)
        return {
            edge: tuple((output, name) for output, name in renamed.items() if output != name)
            for edge, renamed in found.items()
        }

    def _givers(self, child: NodeRef) -> list[NodeRef]:
        edges = self._parents[child].items()
        return [parent for parent, edge in edges if Response.RUN in edge.responses.values()]

    def _type(self, ref: NodeRef, name: str) -> str:
        return str(self._nodes[ref].input_parameters[name].type)

    def _output(self, giver: NodeRef, key: str, kind: str) -> str | None:
        for name, parameter in self._nodes[giver].output_parameters.items():
            if self._links.writes.get((giver, name)) == key and parameter.type == kind:
                return str(name)
        return None

    def _check_equal_names(self, found: Mapping[tuple[NodeRef, NodeRef], Mapping[str, str]]) -> None:
        for child, node in self._nodes.items():
            for giver in self._givers(child):
                renamed = found.get((giver, child), {})
                for name, output in self._nodes[giver].output_parameters.items():
                    wanted = node.input_parameters.get(name)
                    meets = wanted is not None and wanted.type == output.type
                    if meets and name not in renamed:
                        self._refuse("equal_names", Leaf(child), name)
