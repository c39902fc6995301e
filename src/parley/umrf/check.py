"""The one checker: can this actor carry out this graph, and if not, why (all reasons at once).

Used before a start and before a modify, by the command line and by whoever writes graphs. A graph that passes
runs without waiting for something that nobody will give.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Sequence
from dataclasses import replace
from typing import Final

from parley.errors import GraphRefusedError, Problem
from parley.messages.pvf import SEPARATOR, Parameter, Parameters
from parley.umrf.action import ActionSpec
from parley.umrf.catalogue import Catalogue, merge
from parley.umrf.graph_index import GraphSpec, given_name
from parley.umrf.io import KEPT_GRAPHS, UnreadableGraphError
from parley.umrf.model import (
    ENTRY,
    EXIT,
    ChildRelation,
    Graph,
    Node,
    NodeRef,
    ParentRelation,
    Response,
    Result,
)
from parley.umrf.remote import RemoteSpec

__all__ = ["check", "doubts", "reasons", "resolve"]

MAX_LEVELS: Final = 30
"""How many graphs may be inside of each other."""

KEPT_ACTIONS: Final = 100
"""What was found about larger graphs is not kept."""

_OF_NAMES = frozenset({"unknown_action", "not_capable", "reserved_name", "duplicate_node"})
"""Codes of problems that no value can have caused."""


def check(
    graph: Graph,
    catalogue: Catalogue,
    *,
    actor: str = "",
    known_actors: Collection[str] = (),
    given: Collection[str] = (),
) -> list[Problem]:
    """Every reason why `actor` cannot run `graph`; empty if it can.

    Args:
        graph: As read.
        catalogue: The actions of `actor`.
        actor: Name of the engine that is to run it; empty for "whichever".
        known_actors: Others that take part in graphs; a node for anybody else is a mistake. What such nodes
            need is known to their own engines alone.
        given: Names of the parameters that the start brings.
    """
    return _Checker(graph, catalogue, actor, known_actors, given).problems()


def resolve(
    graph: Graph,
    catalogue: Catalogue,
    *,
    actor: str = "",
    known_actors: Collection[str] = (),
    given: Collection[str] = (),
) -> tuple[Graph, Sequence[ActionSpec]]:
    """The graph merged with the descriptors (7.3), and what runs each of its nodes; arguments as of `check`.

    What was found about the very same nodes before is not looked for again.

    Raises:
        GraphRefusedError: With every reason why it cannot run.
    """
    alone, key = not (known_actors or given), (id(graph.nodes), actor, catalogue.capabilities)
    known = catalogue.resolved.get(key) if alone else None
    if known is not None and (graph.entry, graph.exit) == (known[0].entry, known[0].exit):
        return replace(graph, nodes=known[1]), known[2]
    checker = _Checker(graph, catalogue, actor, known_actors, given)
    if problems := checker.problems():
        raise GraphRefusedError(graph.name, problems)
    found = zip(graph.nodes, checker.specs, strict=True)
    specs = [RemoteSpec.of(node) if spec is None else spec for node, spec in found]
    nodes = tuple(map(merge, graph.nodes, specs))
    if alone and len(nodes) <= KEPT_ACTIONS and not checker.levels:
        if len(catalogue.resolved) == KEPT_GRAPHS:
            catalogue.resolved.clear()
        catalogue.resolved[key] = graph, nodes, specs
    return replace(graph, nodes=nodes), specs


def doubts(graph: Graph, catalogue: Catalogue) -> list[Problem]:
    """What such a graph may come to wait for, although it can run: loops that nobody gives data again."""
    return list(_Checker(graph, catalogue).doubts())


def reasons(error: GraphRefusedError, catalogue: Catalogue, *, actor: str = "") -> list[Problem]:
    """Why a graph was refused; of one that could not be read also what is wrong with names in the rest of it.

    What hangs on values is left out, as those that could not be read would seem to be missing. So is whether
    other actors are there, which is for whoever starts the graph to find out.
    """
    problems = list(error.problems)
    if isinstance(error, UnreadableGraphError) and error.readable is not None:
        places = {problem.path for problem in problems}
        actors = {node.actor for node in error.readable.nodes}
        further = check(error.readable, catalogue, actor=actor, known_actors=actors)
        problems += [item for item in further if item.code in _OF_NAMES and item.path not in places]
    return problems


class _Checker:
    def __init__(
        self,
        graph: Graph,
        catalogue: Catalogue,
        actor: str = "",
        known_actors: Collection[str] = (),
        given: Collection[str] = (),
        inside: Sequence[str] = (),
        levels: dict[str, int] | None = None,
    ) -> None:
        self.graph, self.catalogue, self.actor, self.known_actors = graph, catalogue, actor, known_actors
        self.given, self.inside = given, (*inside, graph.name)
        self.levels: dict[str, int] = {} if levels is None else levels
        """Indexed graphs that were looked into -> how many levels are inside of them."""
        self.specs: list[ActionSpec | None] = []
        """What carries out each node here, once `problems` has looked; None: another actor, or nothing."""
        self.entries = {relation.node: relation for relation in graph.entry}
        self.refs = [node.ref for node in graph.nodes]
        self.nodes: dict[NodeRef, Node] = {}
        for ref, node in zip(self.refs, graph.nodes, strict=True):
            self.nodes.setdefault(ref, node)
        self.children = {ref: {c.node: c for c in node.children} for ref, node in self.nodes.items()}
        self.parents = {ref: {p.node for p in node.parents} for ref, node in self.nodes.items()}

    def problems(self) -> list[Problem]:
        """Each problem."""
        found = list(self._names())
        for index, node in enumerate(self.graph.nodes):
            path = f"actions[{index}]"
            found += self._relations(node, self.refs[index], path)
            found += self._action(node, self.refs[index], path)
        for key, relations in (("graph_entry", self.graph.entry), ("graph_exit", self.graph.exit)):
            found += self._known(relations, key)
        return [*found, *self._unreachable()]

    def doubts(self) -> Iterator[Problem]:
        """Each input that comes along an edge once, of an action to which a loop leads back (4.3)."""
        for index, node in enumerate(self.graph.nodes):
            # A spontaneous action keeps its data.
            inside = self._behind(self.refs[index]) if node.type != "spontaneous" else ()
            back = [
                p.node for p in node.parents if p.node in inside and Response.RUN in map(p.response, Result)
            ]
            spec = self.catalogue.match(node)
            for name, known in spec.inputs.items() if spec is not None and back else ():
                has_data = known.has_data or node.input_parameters[name].has_data
                if (
                    known.required
                    and not has_data
                    and not any(self._gives(p, self.refs[index], name, known) for p in back)
                ):
                    yield Problem(
                        f"actions[{index}].input_parameters.{_tree(name)}",
                        f"{node.full_name} has no data for {name} when it runs again after {_names(back)}",
                        "let an action of the loop output it, or give it a pvf_value",
                        "loop_without_data",
                    )

    def _behind(self, ref: NodeRef) -> set[NodeRef]:
        """What comes after a node, itself included if a loop leads back to it."""
        found: set[NodeRef] = set()
        waiting = [ref]
        while waiting:
            new = self.children.get(waiting.pop(), {}).keys() - found
            found |= new
            waiting.extend(new)
        return found

    def _names(self) -> Iterator[Problem]:
        for index, (ref, node) in enumerate(zip(self.refs, self.graph.nodes, strict=True)):
            if node.name in (ENTRY.name, EXIT.name):
                path = f"actions[{index}].name"
                yield Problem(path, f"{node.name!r} is reserved", "choose another name", "reserved_name")
            if self.nodes[ref] is not node:
                yield Problem(
                    f"actions[{index}].instance_id",
                    f"there are {self.refs.count(ref)} actions {ref.full_name}",
                    "give each its own instance_id",
                    "duplicate_node",
                )

    def _relations(self, node: Node, ref: NodeRef, path: str) -> Iterator[Problem]:
        yield from self._known(node.children, f"{path}.children")
        yield from self._known(node.parents, f"{path}.parents")
        for index, child in enumerate(node.children):
            other = self.nodes.get(child.node)
            if other is None:
                continue
            if ref not in self.parents[child.node]:
                yield _one_sided(f"{path}.children[{index}]", node, other, "child", "parent")
            if child.remap:
                yield from _remap(node, other, child, f"{path}.children[{index}]")
        for index, parent in enumerate(node.parents):
            other = self.nodes.get(parent.node)
            if other is not None and ref not in self.children[parent.node]:
                yield _one_sided(f"{path}.parents[{index}]", node, other, "parent", "child")

    def _known(self, relations: Sequence[ChildRelation | ParentRelation], path: str) -> Iterator[Problem]:
        """Relations must name nodes that exist, each once."""
        seen: set[NodeRef] = set()
        for index, relation in enumerate(relations):
            ref = relation.node
            if ref not in self.nodes:
                text, remedy = f"{ref.full_name} is not among the actions", "add it or drop the relation"
                yield Problem(f"{path}[{index}]", text, remedy, "missing_node")
            if ref in seen:
                text = f"{ref.full_name} is named twice"
                yield Problem(f"{path}[{index}]", text, "name it once", "duplicate_relation")
            seen.add(ref)

    def _unreachable(self) -> Iterator[Problem]:
        if not self.graph.entry:  # accepted: such a graph halts at once, and a modify may continue it
            return
        runs = self._followed(self.nodes)
        if len(runs) == len(self.nodes):
            return
        reached = self._followed(())
        runs = self._followed(reached)
        for index, node in enumerate(self.graph.nodes):
            if self.refs[index] not in reached:
                yield Problem(
                    f"actions[{index}]",
                    f"no way leads from graph_entry to {node.full_name}",
                    "make it a child of another action or an entry",
                    "unreachable_node",
                )
            elif self.refs[index] not in runs:
                waits = [p.node for p in node.parents if p.required and p.node in reached - runs]
                yield Problem(
                    f"actions[{index}].parents",
                    f"{node.full_name} waits for {_names(waits)}, which cannot run before it",
                    "say required: false of a parent that a loop comes back from",
                    "endless_wait",
                )

    def _followed(self, waited_for: Collection[NodeRef]) -> set[NodeRef]:
        """What comes to run from the entry on, if nodes wait only for those parents."""
        came: set[NodeRef] = set()
        waiting = [relation.node for relation in self.graph.entry]
        while waiting:
            ref = waiting.pop()
            node = self.nodes.get(ref)
            if node is not None and ref not in came and _can_follow(node, waited_for, came):
                came.add(ref)
                waiting += [child.node for child in node.children]
        return came

    def _action(self, node: Node, ref: NodeRef, path: str) -> Iterator[Problem]:
        if node.actor and node.actor != self.actor:
            self.specs.append(None)
            yield from self._other_actor(node, path)
            return
        spec = self.catalogue.match(node) or self.catalogue.get(node.name)
        self.specs.append(spec)
        if spec is None:
            yield self._unknown(node, path)
            return
        if node.input_parameters or spec.inputs:
            yield from _parameters(node.input_parameters, spec.inputs, f"{path}.input_parameters", spec)
            yield from self._missing_inputs(node, ref, spec, path)
        if node.output_parameters or spec.outputs:
            yield from _parameters(node.output_parameters, spec.outputs, f"{path}.output_parameters", spec)
        if missing := self.catalogue.missing_capabilities(spec):
            yield Problem(
                f"{path}.name",
                f"{self.actor or 'the robot'} has no {' and no '.join(missing)}, which {spec.name} needs",
                "use another robot",
                "not_capable",
            )
        if isinstance(spec, GraphSpec):
            yield from self._inside(node, spec, path)

    def _inside(self, node: Node, spec: GraphSpec, path: str) -> Iterator[Problem]:
        """The graph that is used as an action must be able to run itself, without itself inside (7.2)."""
        if node.name in self.inside:
            way = " -> ".join([*self.inside, node.name])
            yield Problem(
                f"{path}.name", f"{node.name} would run inside itself: {way}", "break the circle", "recursion"
            )
            return
        name = spec.graph.name
        if len(self.inside) + self.levels.get(name, 0) > MAX_LEVELS:
            yield Problem(
                f"{path}.name",
                f"with {node.name} more than {MAX_LEVELS} graphs would be inside of each other",
                "make fewer graphs of them",
                "too_deep",
            )
        elif name not in self.levels:
            inner = _Checker(
                spec.graph,
                self.catalogue,
                self.actor,
                self.known_actors,
                spec.inputs.keys(),
                self.inside,
                self.levels,
            )
            for problem in inner.problems():
                yield replace(problem, path=f"{path}.{spec.name}.{problem.path}")
            known = (self.levels.get(item.name, -1) for item in spec.graph.nodes)
            self.levels[name] = 1 + max(known, default=-1)

    def _other_actor(self, node: Node, path: str) -> Iterator[Problem]:
        if not self.actor or node.actor in self.known_actors:
            return
        known = ", ".join([self.actor, *self.known_actors])
        yield Problem(
            f"{path}.actor", f"there is no actor {node.actor!r}", f"known are {known}", "unknown_actor"
        )

    def _unknown(self, node: Node, path: str) -> Problem:
        similar = self.catalogue.suggestions(node.name)
        if similar:
            remedy = f"did you mean {' or '.join(similar)}?"
        else:
            remedy = f"known are {', '.join(spec.name for spec in self.catalogue) or 'none'}"
        owner = f"{self.actor} has" if self.actor else "there is"
        return Problem(f"{path}.name", f"{owner} no action {node.name!r}", remedy, "unknown_action")

    def _missing_inputs(self, node: Node, ref: NodeRef, spec: ActionSpec, path: str) -> Iterator[Problem]:
        for name, known in spec.inputs.items():
            given = node.input_parameters.get(name)
            if given is None or not known.required or given.has_data or known.has_data:
                continue
            entry = self.entries.get(ref)
            if entry is not None and given_name(entry, name) in self.given:
                continue
            if not any(self._gives(parent.node, ref, name, known) for parent in node.parents):
                yield Problem(
                    f"{path}.input_parameters.{_tree(name)}",
                    f"{node.full_name} needs {name}, and nobody gives it",
                    "give it a pvf_value, or let a parent output it",
                    "missing_input",
                )

    def _gives(self, parent: NodeRef, ref: NodeRef, name: str, wanted: Parameter) -> bool:
        """Whether the edge from `parent` to the node `ref` carries a value for the input `name`."""
        giver = self.nodes.get(parent)
        if giver is None or not wanted.updatable:
            return False
        relation = self.children[parent].get(ref)
        if relation is None:
            return False
        renamed = dict(relation.remap)
        return any(
            renamed.get(output, output) == name and parameter.type == wanted.type
            for output, parameter in giver.output_parameters.items()
        )


def _one_sided(path: str, node: Node, other: Node, side: str, opposite: str) -> Problem:
    return Problem(
        path,
        f"{node.full_name} names {other.full_name} as {side}, "
        f"but {other.full_name} does not name {node.full_name} as {opposite}",
        "state the relation on both sides",
        "one_sided_relation",
    )


def _remap(node: Node, child: Node, relation: ChildRelation, path: str) -> Iterator[Problem]:
    for index, (source, target) in enumerate(relation.remap):
        where = f"{path}.remap[{index}]"
        if source not in node.output_parameters:
            outputs = ", ".join(node.output_parameters) or "none"
            yield Problem(
                f"{where}.from",
                f"{node.full_name} has no output {source!r}",
                f"its outputs are: {outputs}",
                "unknown_output",
            )
        if target not in child.input_parameters:
            inputs = ", ".join(child.input_parameters) or "none"
            yield Problem(
                f"{where}.to",
                f"{child.full_name} has no input {target!r}",
                f"its inputs are: {inputs}",
                "unknown_input",
            )


def _parameters(given: Parameters, known: Parameters, path: str, spec: ActionSpec) -> Iterator[Problem]:
    """The flat names must be those of the descriptor, no more and no less (7.2), and the types too."""
    wanted = ", ".join(known) or "none"
    for name in [name for name in known if name not in given]:
        yield Problem(
            f"{path}.{_tree(name)}",
            f"{spec.name} has a parameter {name!r}, which is missing",
            f"give at least its pvf_type: {known[name].type}",
            "missing_parameter",
        )
    for name in [name for name in given if name not in known]:
        yield Problem(
            f"{path}.{_tree(name)}",
            f"{spec.name} has no parameter {name!r}",
            f"it has: {wanted}",
            "surplus_parameter",
        )
    for name in [name for name in given if name in known]:
        if given[name].type != known[name].type:
            yield Problem(
                f"{path}.{_tree(name)}.pvf_type",
                f"{name} is of type {known[name].type}, not {given[name].type}",
                f"use {known[name].type}",
                "wrong_type",
            )


def _can_follow(node: Node, reached: Collection[NodeRef], came: Collection[NodeRef]) -> bool:
    """Whether each reached parent that it needs came, or it passes on what one of them ended with.

    What happens when something fails is left out: a way that only a failure opens is none.
    """
    for parent in node.parents:
        if parent.required and parent.node not in came and parent.node in reached:
            break
    else:
        return True
    return any(
        parent.node in came and Response.BYPASS in map(parent.response, (Result.ON_TRUE, Result.ON_FALSE))
        for parent in node.parents
    )


def _names(refs: Iterable[NodeRef]) -> str:
    return " and ".join(ref.full_name for ref in refs)


def _tree(name: str) -> str:
    """The flat name as it is nested in JSON."""
    return name.replace(SEPARATOR, ".")
