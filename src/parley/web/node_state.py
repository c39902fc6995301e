"""What engines tell of the nodes of a graph, as people see it. No loop, no clock."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Final, Literal

from parley.messages.chat import ActionCall
from parley.messages.failure import FailureReport
from parley.messages.pvf import Parameter, fits_type
from parley.messages.status import GraphEvent
from parley.messages.work import Work
from parley.umrf.model import Graph, Node
from parley.web.models import ParameterView

__all__ = ["OVER", "GraphShown", "GraphTold", "NodeTold", "StepState", "parameter_views"]

StepState = Literal[
    "queued", "running", "finished", "failed", "stopped", "skipped", "paused", "stopping", "waiting"
]
GraphShown = Literal["running", "paused", "held", "ended"]

OVER: Final = frozenset({"finished", "failed", "stopped", "skipped"})
"""States of a step from which nothing follows any more."""
_NODE_STATES: Final[Mapping[str, StepState]] = {
    "RUNNING": "running",
    "PAUSE_REQUESTED": "running",
    "PAUSED": "paused",
    "STOPPING": "stopping",
    "FINISHED": "finished",
    "BYPASSED": "skipped",
    "ERROR": "failed",
}
_GRAPH_STATES: Final[Mapping[str, GraphShown]] = {
    "PAUSED": "paused",
    "HALTED": "held",
    "STOPPED": "ended",
    "FINISHED": "ended",
    "ERROR": "ended",
}


@dataclass(slots=True)
class NodeTold:
    """What an engine told of one node."""

    state: StepState = "queued"
    progress: float | None = None
    progress_text: str = ""
    message: str = ""
    outputs: tuple[ParameterView, ...] = ()
    started_unix_ms: int = 0
    ended_unix_ms: int = 0
    work: Work = field(default_factory=Work)
    call: ActionCall | None = None
    """What it does, as far as the whole graph was told."""

    def on_event(self, event: GraphEvent) -> None:
        """A transition or progress."""
        self.work.on_event(event)
        if event.kind == "progress":
            self.progress, self.progress_text = event.progress, event.progress_text
            return
        self.state = _NODE_STATES.get(event.state, "queued")
        if event.result == "on_stopped" and self.state == "finished":
            self.state = "stopped"
        if self.state == "running" and not self.started_unix_ms:
            self.started_unix_ms = event.unix_ms
        if self.state in OVER:
            self.ended_unix_ms = event.unix_ms
        if event.outputs:
            self.outputs = parameter_views(event.outputs)
        self.message = FailureReport.parse(event.message).message if event.message else ""


@dataclass(slots=True)
class GraphTold:
    """One graph: its nodes by full name, in the order of the graph or in which they were heard of."""

    nodes: dict[str, NodeTold] = field(default_factory=dict)
    state: GraphShown = "running"
    has_events: bool = False
    """Its engine tells each transition; whole graphs say later what those said already."""

    def on_event(self, event: GraphEvent) -> None:
        """A transition or progress."""
        self.has_events = True
        if event.kind == "graph":
            self.state = _GRAPH_STATES.get(event.state, "running")
        elif event.node:
            self.nodes.setdefault(event.node, NodeTold()).on_event(event)

    def on_graph(self, graph: Graph) -> None:
        """The whole graph: which nodes there are and what they do; their states unless events tell them."""
        self.nodes = {node.full_name: self._node(node) for node in graph.nodes}
        if not self.has_events:
            self.state = _GRAPH_STATES.get(graph.state, "running")

    def _node(self, node: Node) -> NodeTold:
        told = self.nodes.get(node.full_name) or NodeTold()
        told.call = ActionCall(
            name=node.name,
            input_parameters=dict(node.input_parameters),
            output_parameters=dict(node.output_parameters),
            reason=node.description,
        )
        if not self.has_events:
            told.state = _NODE_STATES.get(node.state, "queued")
        return told


def parameter_views(parameters: Mapping[str, Parameter]) -> tuple[ParameterView, ...]:
    """Flat parameters for the page; values that cannot be written in JSON are left out."""
    return tuple(
        ParameterView(
            name=name, type=item.type, value=item.value if fits_type(item.type, item.value) else None
        )
        for name, item in parameters.items()
    )
