"""From a graph as sent to a graph that can run here: checked, and merged with the descriptors (7.2, 7.3)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

from parley.errors import GraphRefusedError
from parley.umrf.action import ActionSpec
from parley.umrf.catalogue import Catalogue, merge
from parley.umrf.check import check
from parley.umrf.model import Graph

__all__ = ["Resolved", "resolve"]


@dataclass(frozen=True, slots=True)
class Resolved:
    """A graph that can run, and what runs each of its nodes."""

    graph: Graph
    specs: Mapping[str, ActionSpec]
    """By full name."""


def resolve(graph: Graph, catalogue: Catalogue, *, actor: str = "") -> Resolved:
    """Match every node of `graph` with an action of `catalogue`.

    Raises:
        GraphRefusedError: With every reason why it cannot run.
    """
    problems = check(graph, catalogue, actor=actor)
    if problems:
        raise GraphRefusedError(graph.name, problems)
    specs = {node.full_name: spec for node in graph.nodes if (spec := catalogue.match(node)) is not None}
    nodes = tuple(merge(node, specs[node.full_name]) for node in graph.nodes)
    return Resolved(replace(graph, nodes=nodes), specs)
