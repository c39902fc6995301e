"""From a graph as sent to a graph that can run here: checked, and merged with the descriptors (7.2, 7.3)."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, replace

from parley.errors import GraphRefusedError
from parley.umrf.action import ActionSpec
from parley.umrf.catalogue import Catalogue, merge
from parley.umrf.check import check
from parley.umrf.model import Graph, Node
from parley.umrf.remote import RemoteSpec

__all__ = ["Resolved", "resolve"]


@dataclass(frozen=True, slots=True)
class Resolved:
    """A graph that can run, and what runs each of its nodes."""

    graph: Graph
    specs: Mapping[str, ActionSpec]
    """By full name."""


def resolve(
    graph: Graph,
    catalogue: Catalogue,
    *,
    actor: str = "",
    known_actors: Collection[str] = (),
    given: Collection[str] = (),
) -> Resolved:
    """Match every node of `graph` with an action of `catalogue`, an indexed graph or another actor.

    Args:
        graph: As read.
        catalogue: The actions of `actor`.
        actor: Who is to run it.
        known_actors: The others who take part.
        given: Names of the parameters that the start brings.

    Raises:
        GraphRefusedError: With every reason why it cannot run.
    """
    if problems := check(graph, catalogue, actor=actor, known_actors=known_actors, given=given):
        raise GraphRefusedError(graph.name, problems)

    def spec_of(node: Node) -> ActionSpec | None:
        return RemoteSpec.of(node) if node.actor not in ("", actor) else catalogue.match(node)

    specs = {node.full_name: spec for node in graph.nodes if (spec := spec_of(node)) is not None}
    nodes = tuple(merge(node, specs[node.full_name]) for node in graph.nodes)
    return Resolved(replace(graph, nodes=nodes), specs)
