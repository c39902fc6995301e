"""Indexed graphs: files whose graphs can be started by name and used as actions (7.1, 10.8)."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from typing import Final

from parley.messages.pvf import Parameter
from parley.umrf.action import ActionSpec
from parley.umrf.model import ChildRelation, Graph, Node

__all__ = ["GRAPH_MARK", "LEVELS", "GraphSpec", "entry_inputs", "exit_outputs"]

GRAPH_MARK: Final = "graph.json"
LEVELS: Final = ("*", "*/*", "*/*/*")
"""The folder itself and two levels below it (7.1)."""


@dataclass(frozen=True, slots=True)
class GraphSpec(ActionSpec):
    """An indexed graph as an action: its inputs are those of its entry, its outputs those of its exit."""

    graph: Graph = field(kw_only=True)


def entry_inputs(graph: Graph) -> dict[str, Parameter]:
    """The inputs of the entry actions that have no value; of equal names the first counts (6).

    An input that the entry renames goes by the name under which it is given.
    """
    nodes = {node.ref: node for node in graph.nodes}
    found: dict[str, Parameter] = {}
    for relation in graph.entry:
        for name, parameter in _blank(nodes.get(relation.node)):
            found.setdefault(given_name(relation, name), parameter)
    return found


def _blank(node: Node | None) -> Iterator[tuple[str, Parameter]]:
    inputs = node.input_parameters if node is not None else {}
    return ((name, parameter) for name, parameter in inputs.items() if not parameter.has_data)


def given_name(relation: ChildRelation, name: str) -> str:
    """The name under which the input `name` of an entry action is given at the start."""
    return next((source for source, target in relation.remap if target == name), name)


def exit_outputs(graph: Graph) -> dict[str, Parameter]:
    """The outputs of the last listed exit action that has any (6)."""
    nodes = {node.ref: node for node in graph.nodes}
    outputs = [nodes[relation.node].output_parameters for relation in graph.exit if relation.node in nodes]
    last = next((item for item in reversed(outputs) if item), {})
    return {name: replace(parameter, value=None) for name, parameter in last.items()}
