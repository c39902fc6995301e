"""Graphs that a killed process left: the same words go for them as for a plan."""

from __future__ import annotations

from parley.agents.planner.effects import PauseGraph, ResumeGraph, StopGraph
from parley.agents.planner.left_graphs import LeftGraphs
from parley.messages.status import GraphEvent


def over(name: str, state: str) -> GraphEvent:
    return GraphEvent(actor="A", graph_name=name, sequence=9, kind="graph", state=state)


def test_they_go_on_stand_still_and_are_dropped_together() -> None:
    left = LeftGraphs()
    left.hold("A", "g")
    left.hold("A", "h")
    left.hold("B", "i")
    assert left.go_on("A") == [ResumeGraph("g"), ResumeGraph("h")]
    assert left.pause("A") == [PauseGraph("g"), PauseGraph("h")]
    assert left.stop("A") == [StopGraph("g"), StopGraph("h")]
    assert left.go_on("A") == []
    assert left.go_on("B") == [ResumeGraph("i")]


def test_what_is_over_is_forgotten_and_what_is_paused_is_not() -> None:
    left = LeftGraphs()
    left.hold("A", "g")
    left.told(over("g", "PAUSED"))
    left.told(over("another", "FINISHED"))
    assert left.go_on("A") == [ResumeGraph("g")]
    left.told(over("g", "FINISHED"))
    assert left.go_on("A") == []
