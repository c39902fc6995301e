"""What was refused, as a planner reads it that reads nothing but feedback."""

from __future__ import annotations

from parley.engine.refused import as_feedback
from parley.errors import Problem
from parley.umrf.model import Graph, GraphState, Node, NodeState

SENT = Graph("g", (Node("Go", 0), Node("Look", 1), Node("Say", 2)))
HELD = Graph("g", (Node("Go", 0, state=NodeState.RUNNING),), state=GraphState.RUNNING)


def states(graph: Graph | None) -> list[str]:
    assert graph is not None
    return [str(node.state) for node in graph.nodes]


def test_the_first_step_that_a_problem_names_is_at_fault() -> None:
    problems = [Problem("graph_entry", "odd"), Problem("actions[2].name", "it cannot", "say less")]
    told = as_feedback(SENT, None, problems, 7)
    assert states(told) == ["UNINITIALIZED", "UNINITIALIZED", "ERROR"]
    assert told is not None
    (why,) = told.nodes[2].messages
    assert (told.state, why.message, why.timestamp) == (GraphState.ERROR, "it cannot; say less", 7)


def test_where_no_problem_names_a_step_the_first_new_one_is_at_fault() -> None:
    assert states(as_feedback(SENT, None, [Problem("", "stopped")], 0))[0] == "ERROR"
    told = as_feedback(SENT, HELD, [Problem("actions[0]", "runs")], 0)
    assert states(told) == ["RUNNING", "ERROR"]
    assert told is not None
    assert (told.state, told.nodes[1].name) == (GraphState.RUNNING, "Look")


def test_of_steps_that_all_go_on_none_has_failed() -> None:
    assert as_feedback(Graph("g", SENT.nodes[:1]), HELD, [Problem("", "already runs")], 0) is None
