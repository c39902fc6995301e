"""Graphs that a killed process left and that are no plan of ours: the same words go for them."""

from __future__ import annotations

from typing import Final

from parley.agents.planner.effects import Effect, PauseGraph, ResumeGraph, StopGraph
from parley.messages.status import GraphEvent
from parley.umrf.model import GraphState

__all__ = ["LeftGraphs"]

_OVER: Final = frozenset(
    state.value for state in (GraphState.FINISHED, GraphState.STOPPED, GraphState.ERROR, GraphState.HALTED)
)


class LeftGraphs:
    """Which engine holds which of them; an engine holds them still until it is told to go on."""

    def __init__(self) -> None:
        self._names: dict[str, list[str]] = {}

    def hold(self, target: str, name: str) -> None:
        """The engine of `target` holds the graph of that name."""
        self._names.setdefault(target, []).append(name)

    def go_on(self, target: str) -> list[Effect]:
        """Let all of a robot's go on."""
        return [ResumeGraph(name) for name in self._names.get(target, ())]

    def pause(self, target: str) -> list[Effect]:
        """Let all of a robot's stand still."""
        return [PauseGraph(name) for name in self._names.get(target, ())]

    def stop(self, target: str) -> list[Effect]:
        """End all of a robot's."""
        return [StopGraph(name) for name in self._names.pop(target, ())]

    def told(self, event: GraphEvent) -> None:
        """Forget what is over."""
        names = self._names.get(event.actor)
        if names and event.kind == "graph" and event.state in _OVER and event.graph_name in names:
            names.remove(event.graph_name)
