"""What follows when a node ends (10.4), as tables: graph, who ended how, what is to be done."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from parley.messages.pvf import Parameter
from parley.umrf.check import resolve
from parley.umrf.flow import Flow
from parley.umrf.io import read_graph
from parley.umrf.model import Result

from .spec_actions import CATALOGUE, chain, node


def flow_of(raw: dict[str, Any]) -> Flow:
    return Flow(*resolve(read_graph(raw), CATALOGUE))


def effects(flow: Flow, name: str, result: str) -> list[tuple[str, str]]:
    return [(item.kind, item.node) for item in flow.propagate(name, Result(result))]


def diamond(**conditions: list[str]) -> dict[str, Any]:
    """Entries A=NoOp_0 and B=NoOp_1, both parents of C=NoOp_2, then D=NoOp_3, the exit."""
    first, second, join, last = (node("NoOp", index) for index in range(4))
    first["children"] = second["children"] = [{"name": "NoOp", "instance_id": 2}]
    join["parents"] = [
        {"name": "NoOp", "instance_id": 0, "conditions": conditions.get("a", [])},
        {"name": "NoOp", "instance_id": 1, "conditions": conditions.get("b", [])},
    ]
    if "optional" in conditions:
        join["parents"] = [item | {"required": False} for item in join["parents"]]
    join["children"] = [{"name": "NoOp", "instance_id": 3}]
    last["parents"] = [{"name": "NoOp", "instance_id": 2}]
    return {
        "graph_name": "diamond",
        "graph_entry": [{"name": "NoOp", "instance_id": 0}, {"name": "NoOp", "instance_id": 1}],
        "graph_exit": [{"name": "NoOp", "instance_id": 3}],
        "actions": [first, second, join, last],
    }


RUN, FINISH = [("run", "NoOp_2")], [("bypassed", "NoOp_2"), ("bypassed", "NoOp_3"), ("finish", "")]


@pytest.mark.parametrize(
    ("conditions", "first", "then"),
    [
        ({}, ("on_true", []), ("on_true", RUN)),
        ({}, ("on_false", []), ("on_false", RUN)),
        ({}, ("on_stopped", []), ("on_true", RUN)),
        ({"a": ["on_true -> ignore"]}, ("on_true", []), ("on_true", RUN)),
        ({"b": ["on_true -> ignore"]}, ("on_true", []), ("on_true", [])),
        ({"b": ["on_true -> stop"]}, ("on_true", []), ("on_true", [("stop", "NoOp_2")])),
        ({"b": ["on_true -> pause"]}, ("on_true", []), ("on_true", [("pause", "NoOp_2")])),
        ({"b": ["on_true -> restart"]}, ("on_true", []), ("on_true", [("restart", "NoOp_2")])),
        ({"optional": []}, ("on_true", RUN), ("on_true", RUN)),
    ],
)
@pytest.mark.spec("10.4", "5.2", "5.3")
def test_a_join_waits_for_all_required_edges_and_the_last_one_decides(
    conditions: dict[str, list[str]],
    first: tuple[str, list[tuple[str, str]]],
    then: tuple[str, list[tuple[str, str]]],
) -> None:
    flow = flow_of(diamond(**conditions))
    assert [item.node for item in flow.start()] == ["NoOp_0", "NoOp_1"]
    assert effects(flow, "NoOp_0", first[0]) == first[1]
    assert effects(flow, "NoOp_1", then[0]) == then[1]


@pytest.mark.spec("10.4", "5.3")
def test_an_early_bypass_does_not_wait_for_the_other_edges() -> None:
    flow = flow_of(diamond(a=["on_false -> bypass"]))
    flow.start()
    assert effects(flow, "NoOp_0", "on_false") == [("bypassed", "NoOp_2"), ("run", "NoOp_3")]


@pytest.mark.spec("10.9", "D5", "5.3")
def test_an_error_is_bypassed_to_the_exit_by_default() -> None:
    flow = flow_of(diamond())
    flow.start()
    assert effects(flow, "NoOp_0", "on_error") == FINISH


@pytest.mark.spec("10.4")
def test_edges_stay_received_so_a_join_fires_at_once_in_the_next_round() -> None:
    flow = flow_of(diamond())
    flow.start()
    effects(flow, "NoOp_0", "on_true")
    assert effects(flow, "NoOp_1", "on_true") == RUN
    assert effects(flow, "NoOp_0", "on_true") == RUN


def test_a_cycle_of_bypasses_ends() -> None:
    back = ["on_true -> bypass", "on_error -> bypass"]
    first, second = node("NoOp", 0), node("NoOp", 1)
    first |= {"children": [{"name": "NoOp", "instance_id": 1}]}
    first |= {"parents": [{"name": "NoOp", "instance_id": 1, "required": False, "conditions": back}]}
    second |= {"children": [{"name": "NoOp", "instance_id": 0}]}
    second |= {"parents": [{"name": "NoOp", "instance_id": 0, "conditions": back}]}
    flow = flow_of(
        {
            "graph_name": "g",
            "graph_entry": [{"name": "NoOp", "instance_id": 0}],
            "graph_exit": [],
            "actions": [first, second],
        }
    )
    flow.start()
    assert effects(flow, "NoOp_0", "on_true") == [("bypassed", "NoOp_1"), ("bypassed", "NoOp_0")]


@pytest.mark.parametrize(
    ("condition", "ends"),
    [("run", True), ("stop", True), ("pause", True), ("restart", True), ("bypass", True), ("ignore", False)],
)
@pytest.mark.spec("5.3")
def test_every_response_but_ignore_ends_the_graph_at_its_exit(condition: str, ends: bool) -> None:
    flow = flow_of(chain("g", [node("NoOp", 0)], exit_conditions=[f"on_false -> {condition}"]))
    flow.start()
    assert effects(flow, "NoOp_0", "on_false") == ([("finish", "")] if ends else [])


@pytest.mark.spec("6")
def test_all_required_exits_must_be_reached() -> None:
    raw = {
        "graph_name": "g",
        "graph_entry": [{"name": "NoOp", "instance_id": 0}, {"name": "NoOp", "instance_id": 1}],
        "graph_exit": [{"name": "NoOp", "instance_id": 0}, {"name": "NoOp", "instance_id": 1}],
        "actions": [node("NoOp", 0), node("NoOp", 1)],
    }
    flow = flow_of(raw)
    assert effects(flow, "NoOp_0", "on_true") == []
    assert effects(flow, "NoOp_1", "on_true") == [("finish", "")]
    raw["graph_exit"] = [item | {"required": False} for item in raw["graph_exit"]]  # type: ignore[operator]
    assert effects(flow_of(raw), "NoOp_0", "on_true") == [("finish", "")]


@pytest.mark.spec("6")
def test_an_optional_exit_without_the_outputs_of_the_graph_does_not_end_it() -> None:
    ends = [node("NoOp", 0), node("JoinText", 1, left="a", right="b")]
    refs = [{"name": item["name"], "instance_id": item["instance_id"]} for item in ends]
    raw = {
        "graph_name": "g",
        "graph_entry": refs,
        "graph_exit": [ref | {"required": False} for ref in refs],
        "actions": ends,
    }
    assert effects(flow_of(raw), "NoOp_0", "on_true") == []
    assert effects(flow_of(raw), "JoinText_1", "on_true") == [("finish", "")]


@pytest.mark.spec("10.6")
def test_values_of_another_type_are_not_handed_over() -> None:
    raw = read_graph(chain("g", [node("NoOp", 0), node("NoOp", 1)]))
    giver = raw.nodes[0]._replace(output_parameters={"size": Parameter("string")})
    taker = raw.nodes[1]._replace(input_parameters={"size": Parameter("number", 1.0)})
    spec = CATALOGUE.get("NoOp")
    assert spec is not None
    flow = Flow(replace(raw, nodes=(giver, taker)), [spec, spec])
    flow.start()
    flow.nodes["NoOp_0"].outputs = {"size": "big"}
    assert effects(flow, "NoOp_0", "on_true") == [("run", "NoOp_1")]
    assert flow.nodes["NoOp_1"].values == {"size": 1.0}


def handing(remap: list[dict[str, str]], **parameter: Any) -> Flow:
    """JoinText_0 -> SameText_1, whose input `text` gets the keys of `parameter`."""
    raw = chain("g", [node("JoinText", 0, left="a", right="b"), node("SameText", 1, expected="x")])
    raw["actions"][0]["children"][0]["remap"] = remap
    raw["actions"][1]["input_parameters"]["text"] |= parameter
    return flow_of(raw)


def end_with(flow: Flow, value: str) -> list[tuple[str, str]]:
    flow.start()
    flow.nodes["JoinText_0"].outputs = {"text": value}
    return effects(flow, "JoinText_0", "on_true")


@pytest.mark.spec("10.6")
def test_equal_names_hand_values_over_and_overwrite() -> None:
    flow = handing([], pvf_value="old")
    assert end_with(flow, "new") == [("run", "SameText_1")]
    assert flow.nodes["SameText_1"].values == {"text": "new", "expected": "x"}


@pytest.mark.spec("10.6", "5.1")
def test_after_a_rename_the_old_name_is_gone() -> None:
    flow = handing([{"from": "text", "to": "expected"}], pvf_value="own")
    assert end_with(flow, "new") == [("run", "SameText_1")]
    assert flow.nodes["SameText_1"].values == {"text": "own", "expected": "new"}


@pytest.mark.spec("4.3", "10.3")
def test_transferred_values_are_dropped_after_the_run_and_own_ones_stay() -> None:
    flow = handing([])
    end_with(flow, "new")
    flow.nodes["SameText_1"].drop_transferred()
    assert flow.nodes["SameText_1"].values == {"expected": "x"}


@pytest.mark.spec("4.4", "4.4-better", "D6")
def test_a_value_that_is_not_allowed_is_the_error_of_the_node() -> None:
    flow = handing([], pvf_allowed_values=["red", "green"])
    assert end_with(flow, "red") == [("run", "SameText_1")]
    flow = handing([], pvf_allowed_values=["red", "green"])
    flow.start()
    flow.nodes["JoinText_0"].outputs = {"text": "blue"}
    [effect] = flow.propagate("JoinText_0", Result.ON_TRUE)
    assert effect.kind == "fail"
    assert "text must be one of red, green, not blue" in effect.message


@pytest.mark.spec("10.5-better", "D19")
def test_a_node_without_its_inputs_waits_and_says_for_what() -> None:
    flow = handing([])
    flow.start()
    assert effects(flow, "JoinText_0", "on_false") == []
    assert flow.waiting_for() == "SameText_1 has no data for text"


@pytest.mark.spec("D5", "10.4")
def test_a_bypassed_node_hands_nothing_on() -> None:
    conditions = ["on_true -> bypass"]
    raw = chain(
        "g", [node("NoOp", 0), node("JoinText", 1, left="a", right="b"), node("SameText", 2, text="own")]
    )
    raw["actions"][1]["parents"][0]["conditions"] = conditions
    raw["actions"][2]["input_parameters"]["expected"]["pvf_value"] = "x"
    flow = flow_of(raw)
    flow.start()
    flow.nodes["JoinText_1"].outputs = {"text": "of an earlier run"}
    assert effects(flow, "NoOp_0", "on_true") == [("bypassed", "JoinText_1"), ("run", "SameText_2")]
    assert flow.nodes["SameText_2"].values["text"] == "own"


def test_all_of_a_node_is_shown_and_only_what_changed_is_shown_anew() -> None:
    raw = chain("g", [node("JoinText", 0, left="a", right="b"), node("NoOp", 1)])
    raw["actions"][0] |= {
        "actor": "A",
        "description": "joins",
        "gui_attributes": {"x": 1},
        "runtime": {"messages": [{"timestamp": 1, "message": "old"}]},
    }
    graph, specs = resolve(read_graph(raw), CATALOGUE, actor="A")
    flow = Flow(graph, specs)
    first = flow.snapshot()
    assert first[0] == graph.nodes[0]._replace(messages=())
    flow.nodes["JoinText_0"].note("new", 2)
    second = flow.snapshot()
    assert [item.message for item in second[0].messages] == ["new"]
    assert second[1] is first[1]
    assert flow.snapshot() == second
