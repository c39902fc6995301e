"""What a killed process was doing, as it is offered to whoever may go on with it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any, Final

from parley.umrf.model import ACTIVE, Graph, GraphState, Node, NodeState
from parley.umrf.saved import SavedRun

__all__ = ["FLOW_KEY", "ORDER_KEY", "Interrupted", "flow_of", "order_of"]

FLOW_KEY: Final = "parley_flow"
"""Under `gui_attributes`, which engines carry along unread: what a node depends on."""


ORDER_KEY: Final = "parley_order"
"""There, too: which order a node carries out."""


def order_of(node: Node) -> str:
    """`id` of the order that a node carries out, as the planner wrote it; may be empty."""
    attributes = node.gui_attributes
    order = attributes.get(ORDER_KEY) if isinstance(attributes, dict) else None
    return order if isinstance(order, str) else ""


def flow_of(node: Node) -> dict[str, Any]:
    """What a node depends on, as the planner wrote it; empty: nothing."""
    attributes = node.gui_attributes
    flow = attributes.get(FLOW_KEY) if isinstance(attributes, dict) else None
    return flow if isinstance(flow, dict) else {}


@dataclass(frozen=True, slots=True)
class Interrupted:
    """A graph that was under way when its engine's process ended without a goodbye."""

    actor: str
    graph: Graph
    """As it was last, with the states its nodes had."""
    unix_ms: int
    """When something was last heard of it."""
    outputs: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)
    """What finished nodes gave: full name -> flat name -> value."""
    saved: SavedRun | None = None
    """To be gone on with by `ActionEngine.restore`; None if that is not possible."""
    shared: bool = False
    """Other actors took part. They noticed that this one was gone and went on without it, so nobody can say
    any more where all of them stand: such a graph is not gone on with."""

    @classmethod
    def of(cls, actor: str, saved: SavedRun, unix_ms: int, *, shared: bool) -> Interrupted:
        """What was saved, as it is told to people."""
        states = {name: NodeState(kept["state"]) for name, kept in saved.nodes.items()}
        nodes = tuple(
            node._replace(state=states.get(node.full_name, NodeState.UNINITIALIZED))
            for node in saved.graph.nodes
        )
        outputs = {
            node.full_name: dict(given)
            for node in nodes
            if (given := saved.nodes.get(node.full_name, {}).get("outputs"))
        }
        graph = replace(saved.graph, nodes=nodes, state=GraphState(saved.frame["state"]))
        return cls(actor, graph, unix_ms, outputs, None if shared else saved, shared)

    @property
    def going_on(self) -> tuple[Node, ...]:
        """The nodes that were being carried out."""
        return tuple(node for node in self.graph.nodes if node.state in ACTIVE)

    @property
    def remaining(self) -> tuple[Node, ...]:
        """What was not finished, that which was going on included, in the order of the graph."""
        return tuple(node for node in self.graph.nodes if node.state is not NodeState.FINISHED)

    @property
    def is_linear(self) -> bool:
        """Whether it is one step after the other, so that the rest of it is again a graph."""
        nodes = self.graph.nodes
        edges = [(node.ref, [child.node for child in node.children]) for node in nodes]
        return len(self.graph.entry) == 1 and all(
            children == ([nodes[index + 1].ref] if index + 1 < len(nodes) else [])
            for index, (_, children) in enumerate(edges)
        )

    @property
    def has_flow(self) -> bool:
        """Whether a planner wrote into it which steps depend on how others end, or run beside them."""
        return any(flow_of(node) for node in self.graph.nodes)

    @property
    def is_sequence(self) -> bool:
        """Whether the rest of it can be planned as steps one after the other."""
        return self.is_linear and not self.has_flow

    @property
    def is_open(self) -> bool:
        """Whether something was still to come.

        A graph that ran dry is over unless it was being repaired; one that was being stopped is over.
        """
        saved = self.saved
        if self.graph.state is GraphState.STOPPING:
            return False
        if self.graph.state is GraphState.HALTED:
            return any(node.state is NodeState.ERROR for node in self.graph.nodes)
        if self.going_on or (
            saved is not None and any(saved.frame[key] for key in ("held", "again", "rounds"))
        ):
            return True
        return any(node.state is not NodeState.FINISHED for node in self.graph.nodes)
