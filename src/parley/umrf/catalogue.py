"""The actions one actor can carry out: found by name, matched against nodes, told to others (7)."""

from __future__ import annotations

import copy
import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from typing import Any, Self, cast

from rapidfuzz import fuzz, process

from parley.messages.pvf import Parameter
from parley.messages.status import ActionInfo, ParameterInfo
from parley.umrf.action import ActionSpec
from parley.umrf.graph_index import GraphSpec, entry_inputs, exit_outputs
from parley.umrf.kinds import parameters_of
from parley.umrf.model import Graph, Node
from parley.umrf.remote import actors_of

__all__ = ["DESCRIPTOR_MARK", "Catalogue", "descriptor_file_name", "fully_described", "info_of", "merge"]

DESCRIPTOR_MARK = "umrf.json"
_SIMILAR = 60.0
"""rapidfuzz score from which a name is worth suggesting."""


class Catalogue:
    """Action descriptions by name, and indexed graphs; the first of a name wins (7.2).

    Args:
        specs: The actions.
        graphs: Graphs that can be started by name and used as actions.
    """

    def __init__(self, specs: Iterable[ActionSpec] = (), graphs: Iterable[Graph] = ()) -> None:
        self.capabilities: frozenset[str] | None = None
        """What the robot has; None if that is not known, and then nothing is asked of it."""
        self._specs: dict[str, ActionSpec] = {}
        self._graphs: dict[str, Graph] = {}
        self._told: list[tuple[ActionInfo, ...]] = []
        """What `infos` gave last, or nothing; shared by the views of `for_robot`."""
        self.resolved: dict[object, tuple[Graph, tuple[Node, ...], Sequence[ActionSpec]]] = {}
        """For `check.resolve`: graphs as read, merged, and what runs their nodes; shared likewise."""
        self.replace(specs, graphs)

    def replace(self, specs: Iterable[ActionSpec], graphs: Iterable[Graph] = ()) -> None:
        """Hold these actions and graphs from now on; what runs already goes on with what it has."""
        for kept, items in ((self._specs, specs), (self._graphs, graphs)):
            found: dict[str, Any] = {}
            for item in items:
                found.setdefault(item.name, item)
            cast("dict[str, Any]", kept).clear()
            cast("dict[str, Any]", kept).update(found)
        self._told.clear()
        self.resolved.clear()

    def for_robot(self, capabilities: Iterable[str]) -> Self:
        """The same catalogue, changes to come included, as it is for a robot with these capabilities."""
        view = copy.copy(self)
        view.capabilities = frozenset(capabilities)
        return view

    def missing_capabilities(self, spec: ActionSpec) -> list[str]:
        """What `spec` needs and the robot has not, sorted."""
        return [] if self.capabilities is None else sorted({*spec.capabilities} - self.capabilities)

    def __iter__(self) -> Iterator[ActionSpec]:
        return iter(self._specs.values())

    @property
    def graphs(self) -> tuple[Graph, ...]:
        """The indexed graphs."""
        return tuple(self._graphs.values())

    def get(self, name: str) -> ActionSpec | None:
        """The action of that name, else the indexed graph as an action, or None."""
        return self._specs.get(name) or self._graph_spec(name)

    def graph(self, name: str) -> Graph | None:
        """The indexed graph of that name, or None."""
        return self._graphs.get(name)

    def match(self, node: Node) -> ActionSpec | None:
        """What `node` means: same name, same flat inputs, same flat outputs (7.2); actions before graphs."""
        for spec in (self._specs.get(node.name), self._graph_spec(node.name)):
            if spec is None or node.input_parameters.keys() != spec.inputs.keys():
                continue
            if node.output_parameters.keys() == spec.outputs.keys():
                return spec
        return None

    def actors(self, graph: Graph) -> set[str]:
        """Every actor that `graph` and the graphs inside it name."""
        found, seen, waiting = actors_of(graph), {graph.name}, [graph]
        while waiting:
            for node in waiting.pop().nodes:
                inner = self._graphs.get(node.name)
                if inner is not None and inner.name not in seen:
                    seen.add(inner.name)
                    found |= actors_of(inner)
                    waiting.append(inner)
        return found

    def infos(self) -> tuple[ActionInfo, ...]:
        """What others are told of the actions, as given, then of the graphs; of a robot what it can do."""
        if not self._told:
            graphs = (spec for name in self._graphs if (spec := self._graph_spec(name)) is not None)
            self._told.append(tuple(info_of(spec) for spec in (*self, *graphs)))
        has = self.capabilities
        return tuple(info for info in self._told[0] if has is None or {*info.capabilities} <= has)

    def suggestions(self, name: str) -> list[str]:
        """Names that look like `name`, the most similar first, at most three."""
        names = [*self._specs, *self._graphs]
        found = process.extract(
            name, names, scorer=fuzz.WRatio, processor=str.lower, limit=3, score_cutoff=_SIMILAR
        )
        return [choice for choice, _, _ in found]

    def _graph_spec(self, name: str) -> GraphSpec | None:
        graph = self._graphs.get(name)
        if graph is None:
            return None
        # A descriptor may know that an input is not required, or a value for it.
        nodes = tuple(
            merge(node, spec) if (spec := self._specs.get(node.name)) is not None else node
            for node in graph.nodes
        )
        known = entry_inputs(replace(graph, nodes=nodes))
        return GraphSpec(
            name=name,
            inputs={
                name: known.get(name, replace(item, required=False))
                for name, item in entry_inputs(graph).items()
            },
            outputs=exit_outputs(graph),
            description=graph.description,
            graph=graph,
        )


def info_of(spec: ActionSpec) -> ActionInfo:
    """What language and people need to know about an action."""
    info = ActionInfo(
        name=spec.name,
        inputs={name: parameter.type for name, parameter in spec.inputs.items()},
        optional=tuple(name for name, item in spec.inputs.items() if not item.required or item.has_data),
        outputs={name: parameter.type for name, parameter in spec.outputs.items()},
        description=spec.description,
        label=spec.label,
        phrases=spec.phrases,
        effects=spec.effects,
        risk=spec.risk,
        capabilities=spec.capabilities,
        examples=spec.examples,
        duration_s=spec.duration_s,
        timeout_s=spec.timeout_s,
    )
    told = {name: _told(spec, name, found) for name, found in parameters_of(info).items()}
    return info.model_copy(update={"parameters": told})


def fully_described(spec: ActionSpec) -> ActionSpec:
    """With the kinds and units that are derived where its maker does not say them."""
    told = info_of(spec).parameters
    kinds = {name: item.kind for name, item in told.items()}
    return replace(spec, kinds=kinds, units={name: item.unit for name, item in told.items() if item.unit})


def _told(spec: ActionSpec, name: str, derived: ParameterInfo) -> ParameterInfo:
    """What is known about one input: as its maker says, else as derived."""
    parameter = spec.inputs[name]
    given: dict[str, Any] = {"help": spec.help.get(name, "")}
    if parameter.allowed:
        given |= {"kind": "choice", "choices": tuple(map(str, parameter.allowed)), "unit": ""}
    if name in spec.kinds:
        given["kind"] = spec.kinds[name]
    if name in spec.units:
        given["unit"] = spec.units[name]
    if isinstance(parameter.value, str | float | bool):
        given["default"] = parameter.value
    return derived.model_copy(update=given)


def merge(node: Node, spec: ActionSpec) -> Node:
    """The node with what the descriptor knows about its inputs; allowed values are the graph's (7.3)."""
    if not node.input_parameters:
        return node
    merged: dict[str, Parameter] = {}
    for name, given in node.input_parameters.items():
        known = spec.inputs.get(name)
        if known is None or known.type != given.type:
            merged[name] = given
            continue
        value = given.value if given.has_data else known.value
        merged[name] = replace(known, value=value, allowed=given.allowed)
    return node._replace(input_parameters=merged)


def descriptor_file_name(action: str) -> str:
    """The conventional file of an action: ``GetCoordinates`` -> ``get_coordinates.umrf.json`` (7.1)."""
    return re.sub(r"(?<!^)(?=[A-Z])", "_", action).lower() + f".{DESCRIPTOR_MARK}"
