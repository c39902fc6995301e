"""What a killed process left, as steps: the interrupted one again, with what the done ones gave."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from parley.agents.planner.restore import interruption_text, restored_steps
from parley.engine.journal import Interrupted
from parley.umrf.io import read_graph
from parley.umrf.model import NodeState
from tests.umrf.spec_actions import node, planner_chain


def was(states: list[str], outputs: dict[str, dict[str, Any]]) -> Interrupted:
    graph = read_graph(
        planner_chain(
            "g",
            [
                node("JoinText", 0, left="a", right="b"),
                node("SameText", 1, expected="a-b"),
                node("WaitFor", 2, seconds=1.0),
            ],
        )
    )
    nodes = tuple(
        item._replace(state=NodeState(state)) for item, state in zip(graph.nodes, states, strict=True)
    )
    return Interrupted("A", replace(graph, nodes=nodes), 0, outputs)


def test_the_interrupted_step_gets_what_the_finished_one_gave() -> None:
    left = was(["FINISHED", "RUNNING", "UNINITIALIZED"], {"JoinText_0": {"text": "a-b"}})
    steps = restored_steps(left)
    assert [step.call.name for step in steps] == ["SameText", "WaitFor"]
    assert steps[0].call.input_parameters["text"].value == "a-b"
    text = interruption_text(left, steps)
    assert "SameText" in text
    assert "carry on" in text


def test_a_giver_whose_outputs_were_lost_is_done_again() -> None:
    steps = restored_steps(was(["FINISHED", "RUNNING", "UNINITIALIZED"], {}))
    assert [step.call.name for step in steps] == ["JoinText", "SameText", "WaitFor"]
    assert steps[1].fed == {"text"}


def test_what_only_finds_something_out_is_done_again_so_that_the_next_step_is_called_by_it() -> None:
    left = was(["FINISHED", "RUNNING", "UNINITIALIZED"], {"JoinText_0": {"text": "a-b"}})
    steps = restored_steps(left, {"JoinText"})
    assert [step.call.name for step in steps] == ["JoinText", "SameText", "WaitFor"]
    assert not steps[1].call.input_parameters["text"].has_data


def test_what_was_found_is_found_anew_also_where_a_changed_plan_held_it_already() -> None:
    left = was(["FINISHED", "RUNNING", "UNINITIALIZED"], {"JoinText_0": {"text": "a-b"}})
    first, second, *rest = left.graph.nodes
    filled = {name: value.with_value("a-b") for name, value in second.input_parameters.items()}
    changed = (first, second._replace(input_parameters=filled), *rest)
    steps = restored_steps(replace(left, graph=replace(left.graph, nodes=changed)), {"JoinText"})
    assert [step.call.name for step in steps] == ["JoinText", "SameText", "WaitFor"]
    assert not steps[1].call.input_parameters["text"].has_data


def test_what_is_no_sequence_is_named_and_not_gone_on_with() -> None:
    left = was(["RUNNING", "UNINITIALIZED", "UNINITIALIZED"], {})
    first, *rest = left.graph.nodes
    split = replace(left, graph=replace(left.graph, nodes=(first._replace(children=()), *rest)))
    assert restored_steps(split) == []
    assert "carry on" not in interruption_text(split, [])


def test_a_graph_that_was_killed_behind_its_last_step_is_told_of_too() -> None:
    left = was(["FINISHED", "FINISHED", "FINISHED"], {})
    assert restored_steps(left) == []
    assert "WaitFor" in interruption_text(left, True)
