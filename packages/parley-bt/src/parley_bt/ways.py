"""What each end of each action leads to: a graph's conditions, followed through bypasses.

This is the propagation of `spec/umrf.md` 10.4 without a run: it says which actions would be told to run,
which edges into joins would be seen, and whether the graph would end.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

from parley.errors import Problem
from parley.umrf.model import EXIT, ChildRelation, Graph, Node, NodeRef, ParentRelation, Response, Result
from parley_bt.reasons import refusal

__all__ = ["Cont", "Edge", "Way", "Ways"]

Edge = tuple[NodeRef, NodeRef]

RESULTS = (Result.ON_TRUE, Result.ON_FALSE, Result.ON_ERROR)
_CONTROL = (Response.STOP, Response.PAUSE, Response.RESTART)


@dataclass(frozen=True, slots=True)
class Cont:
    """Where it goes on: at some actions, or not at all."""

    targets: frozenset[NodeRef] = frozenset()
    verdict: bool | None = None
    """At an end: whether the last action succeeded."""
    end: Literal["", "finish", "dry", "either"] = ""
    """At an end: whether the exit was reached, or nothing is left to do, or that depends."""

    @property
    def is_end(self) -> bool:
        """Whether nothing follows."""
        return not self.targets

    def same(self, other: Cont) -> bool:
        """Whether a tree need not tell the two apart: it ends either way, however the graph does."""
        return (self.targets, self.verdict) == (other.targets, other.verdict)


@dataclass(frozen=True, slots=True)
class Way:
    """One result of one action: where it goes on, and the edges into joins that were seen."""

    cont: Cont
    seen: frozenset[Edge] = frozenset()


class Ways:
    """All ways of a graph.

    Attributes:
        problems: What keeps the graph from being followed; the ways are worthless if there are any.
        joins: Actions (and the exit) that wait for several parents -> the parents they require.
    """

    def __init__(self, graph: Graph) -> None:
        self.graph = graph
        self.nodes = {node.ref: node for node in graph.nodes}
        self.index = {node.ref: index for index, node in enumerate(graph.nodes)}
        self.exits = {relation.node: relation for relation in graph.exit}
        self.problems: list[Problem] = list(self._broken())
        self.joins: dict[NodeRef, frozenset[NodeRef]] = {}
        self._relations = {(item.node, node.ref): item for node in graph.nodes for item in node.parents}
        if not self.problems:
            self.problems = list(self._refusals())
            self._find_joins()

    def path(self, ref: NodeRef) -> str:
        """Where an action stands in the graph, for messages."""
        return f"actions[{self.index[ref]}]" if ref in self.index else "graph_exit"

    def entry(self) -> Way:
        """Where the graph begins."""
        targets = frozenset(relation.node for relation in self.graph.entry)
        return Way(Cont(targets) if targets else Cont(verdict=True, end="dry"))

    def follow(self, ref: NodeRef, result: Result) -> Way:
        """Where it goes on after the action `ref` has ended so."""
        targets: set[NodeRef] = set()
        seen: dict[Edge, Response] = {}
        waiting, followed = deque([ref]), {ref}
        verdict = result is Result.ON_TRUE
        while waiting:
            parent = waiting.popleft()
            for child in self.nodes[parent].children:
                response = self._relations[parent, child.node].response(result)
                if child.node in self.joins:
                    seen[parent, child.node] = response
                match response:
                    case Response.RUN if child.node != ref:  # what still runs is not run again
                        targets.add(child.node)
                    case Response.BYPASS if child.node not in followed:
                        followed.add(child.node)
                        waiting.append(child.node)
            if parent in self.exits:
                response = self.exits[parent].response(result)
                if response is Response.IGNORE:
                    continue
                seen[parent, EXIT] = response
                if response is Response.BYPASS or EXIT not in self.joins:
                    return Way(self._finish(parent, result, targets, verdict), frozenset(seen))
                targets.add(EXIT)
        self._check_order(seen)
        cont = Cont(frozenset(targets)) if targets else Cont(verdict=verdict, end="dry")
        if EXIT in targets and result is Result.ON_ERROR:
            self.problems.append(refusal("three_ways", self.path(ref), f"{ref.full_name} at the exit"))
        return Way(cont, frozenset(seen))

    def _check_order(self, seen: Mapping[Edge, Response]) -> None:
        """An end that reaches a join by several edges must be answered alike: the last one would count."""
        answers: dict[NodeRef, Response] = {}
        for (_, join), response in seen.items():
            if answers.setdefault(join, response) is not response:
                self.problems.append(refusal("join_order", self.path(join), join.full_name))

    def _finish(self, parent: NodeRef, result: Result, targets: set[NodeRef], verdict: bool) -> Cont:
        if targets:
            self.problems.append(refusal("ends_while_running", self.path(parent), parent.full_name))
        at_once = len(self.exits) == 1 or self.exits[parent].response(result) is Response.BYPASS
        return Cont(verdict=verdict, end="finish" if at_once else "either")

    # -- what cannot be followed ----------------------------------------------------------------------------

    def _broken(self) -> Iterator[Problem]:
        if len(self.nodes) < len(self.graph.nodes):
            yield refusal("broken_graph", "actions", "two actions have one name")
        for index, node in enumerate(self.graph.nodes):
            sides = [(item.node, "children") for item in node.children]
            for other, key in sides + [(item.node, "parents") for item in node.parents]:
                if node.ref not in self._related(other, "parents" if key == "children" else "children"):
                    yield refusal("broken_graph", f"actions[{index}].{key}", other.full_name)
        relations: list[tuple[str, Sequence[ChildRelation | ParentRelation]]]
        relations = [("graph_entry", self.graph.entry), ("graph_exit", self.graph.exit)]
        for key, related in relations:
            for position, relation in enumerate(related):
                if relation.node not in self.nodes:
                    yield refusal("broken_graph", f"{key}[{position}]", relation.node.full_name)

    def _related(self, ref: NodeRef, key: str) -> list[NodeRef]:
        node = self.nodes.get(ref)
        relations: tuple[ParentRelation | ChildRelation, ...] = ()
        if node is not None:
            relations = node.parents if key == "parents" else node.children
        return [relation.node for relation in relations]

    def _refusals(self) -> Iterator[Problem]:
        for node in self.graph.nodes:
            own = self._relations.get((node.ref, node.ref))
            if own is not None and any(own.response(result) is Response.RUN for result in Result):
                yield refusal("self_edge", self.path(node.ref), node.full_name)
        actors = {node.actor for node in self.graph.nodes}
        if len(actors) > 1:
            yield refusal("several_actors", "actions", ", ".join(sorted(actors - {""})))
        for index, node in enumerate(self.graph.nodes):
            path = f"actions[{index}]"
            if node.type == "spontaneous":
                yield refusal("spontaneous", f"{path}.type", node.full_name)
            if node.retries or node.timeout_s is not None:
                yield refusal("limits", f"{path}.parley", node.full_name)
            for position, relation in enumerate(node.parents):
                yield from self._conditions(relation, f"{path}.parents[{position}]", node)
        for position, relation in enumerate(self.graph.exit):
            if relation.response(Result.ON_STOPPED) not in (Response.IGNORE, Response.BYPASS):
                yield refusal("stopped_response", f"graph_exit[{position}]")

    def _conditions(self, relation: ParentRelation, path: str, node: Node) -> Iterator[Problem]:
        if any(relation.response(result) in _CONTROL for result in RESULTS):
            yield refusal("control_response", path, node.full_name)
        if relation.response(Result.ON_STOPPED) is not Response.IGNORE:
            yield refusal("stopped_response", path, node.full_name)

    def _find_joins(self) -> None:
        entries = {relation.node for relation in self.graph.entry}
        for node in self.graph.nodes:
            required = frozenset(relation.node for relation in node.parents if relation.required)
            if required and node.ref in entries:
                self.problems.append(refusal("entry_waits", self.path(node.ref), node.full_name))
            elif required and len(node.parents) > 1:
                self.joins[node.ref] = required
                if self._on_cycle(node.ref):
                    self.problems.append(refusal("join_in_cycle", self.path(node.ref), node.full_name))
        required = frozenset(relation.node for relation in self.graph.exit if relation.required)
        if required and len(self.exits) > 1:
            self.joins[EXIT] = required

    def _on_cycle(self, ref: NodeRef) -> bool:
        waiting = [child.node for child in self.nodes[ref].children]
        reached: set[NodeRef] = set()
        while waiting:
            at = waiting.pop()
            if at == ref:
                return True
            if at not in reached:
                reached.add(at)
                waiting += [child.node for child in self.nodes[at].children]
        return False
