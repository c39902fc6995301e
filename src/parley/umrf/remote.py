"""Actions that the engine of another actor carries out (`spec/umrf.md` 13), as a run sees them."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, replace
from typing import Protocol

from parley.messages.pvf import Parameter
from parley.umrf.action import ActionSpec
from parley.umrf.model import Graph, Node, Result

__all__ = ["Peers", "RemoteEnd", "RemoteSpec", "actors_of"]


@dataclass(frozen=True, slots=True)
class RemoteSpec(ActionSpec):
    """An action of another actor: here it only waits, so none of its inputs is waited for."""

    @classmethod
    def of(cls, node: Node) -> RemoteSpec:
        """What stands for `node` here."""
        inputs = {
            name: replace(item, value=None, required=False) for name, item in node.input_parameters.items()
        }
        return cls(name=node.name, inputs=inputs, outputs=node.output_parameters, type=node.type)


@dataclass(frozen=True, slots=True)
class RemoteEnd:
    """How a node ended elsewhere."""

    result: Result
    outputs: Mapping[str, Parameter]
    message: str = ""
    """The failure report of a node that failed."""


class Peers(Protocol):
    """The other actors of one graph run, sub-graphs included."""

    @property
    def actors(self) -> Collection[str]:
        """Who takes part besides this actor."""
        ...

    async def end_of(self, graph_name: str, node: Node) -> RemoteEnd:
        """Wait for the next end of a node of another actor; ends that came early count.

        Raises:
            ActionFailure: `unavailable`: that actor is gone.
        """
        ...

    def ended(self, graph_name: str, node: Node, end: RemoteEnd) -> None:
        """A node of this actor has ended: hand it over."""
        ...


def actors_of(graph: Graph) -> set[str]:
    """The actors that nodes of `graph` name; sub-graphs are not looked into."""
    return {node.actor for node in graph.nodes if node.actor}
