"""Transitions as they are told on `/parley/graph_events`."""

from __future__ import annotations

from typing import Any

from parley.messages.pvf import write_parameters
from parley.umrf.transition import Transition

__all__ = ["event_fields"]


def event_fields(actor: str, graph_name: str, transition: Transition) -> dict[str, Any]:
    """The fields of a `GraphEvent` as its JSON holds them.

    Two are told for each action of each graph; building and checking the payload took longer than all else.
    """
    return {
        "actor": actor,
        "graph_name": graph_name,
        **transition._asdict(),
        "result": transition.result.value if transition.result is not None else "",
        "outputs": write_parameters(transition.outputs) if transition.outputs else {},
    }
