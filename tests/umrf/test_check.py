"""The one checker: each kind of mistake has its code, its place and a remedy, and all are named at once."""

from __future__ import annotations

from typing import Any

import pytest

from parley.errors import GraphRefusedError, Problem
from parley.messages.pvf import Parameter
from parley.umrf.action import ActionSpec
from parley.umrf.catalogue import Catalogue
from parley.umrf.check import check, reasons, resolve
from parley.umrf.io import read_graph

from .spec_actions import CATALOGUE, chain, node


def problems(raw: dict[str, Any], **options: Any) -> list[Problem]:
    return check(read_graph(raw), CATALOGUE, **({"actor": "A"} | options))


def found(raw: dict[str, Any], **options: Any) -> dict[str, str]:
    """Path -> code."""
    return {problem.path: problem.code for problem in problems(raw, **options)}


def two(**second: Any) -> dict[str, Any]:
    """JoinText_0 -> SameText_1, with keys of the second action replaced."""
    raw = chain("g", [node("JoinText", 0, left="a", right="b"), node("SameText", 1, expected="x")])
    raw["actions"][1] |= second
    return raw


def test_a_good_graph_has_no_problems() -> None:
    assert problems(two()) == []


@pytest.mark.spec("D7", "2-better")
def test_two_nodes_of_one_name_are_refused() -> None:
    raw = two()
    raw["actions"].append(raw["actions"][0])
    assert found(raw) == {"actions[2].instance_id": "duplicate_node"}


@pytest.mark.parametrize("name", ["graph_entry", "graph_exit"])
@pytest.mark.spec("1")
def test_the_names_of_entry_and_exit_are_reserved(name: str) -> None:
    raw = {"graph_name": "g", "actions": [{"name": name, "type": "sync"}]}
    assert found(raw)["actions[0].name"] in ("reserved_name", "unknown_action")
    assert "reserved_name" in {problem.code for problem in problems(raw)}


@pytest.mark.spec("5.2-better", "5.2", "D6", "2-better")
def test_a_relation_must_be_stated_on_both_sides() -> None:
    assert found(two(parents=[])) == {
        "actions[0].children[0]": "one_sided_relation",
        "actions[1].input_parameters.text": "missing_input",
    }
    raw = two()
    raw["actions"][0]["children"] = []
    assert found(raw)["actions[1].parents[0]"] == "one_sided_relation"


@pytest.mark.spec("2-better", "D6")
def test_relations_to_missing_nodes_are_refused() -> None:
    raw = two()
    raw["actions"][1]["children"] = [{"name": "Ghost", "instance_id": 4}]
    raw["actions"][0]["parents"] = [{"name": "Ghost"}]
    assert found(raw) == {"actions[0].parents[0]": "missing_node", "actions[1].children[0]": "missing_node"}


def test_a_relation_stated_twice_is_refused() -> None:
    raw = two()
    raw["actions"][0]["children"] *= 2
    assert found(raw) == {"actions[0].children[1]": "duplicate_relation"}


@pytest.mark.spec("2-better")
def test_nodes_that_cannot_be_reached_are_refused() -> None:
    raw = two()
    raw["actions"].append(node("NoOp", 7))
    assert found(raw) == {"actions[2]": "unreachable_node"}


def test_a_graph_without_an_entry_may_wait_for_a_modify() -> None:
    raw = {"graph_name": "g", "graph_entry": [], "graph_exit": [], "actions": [node("NoOp")]}
    assert found(raw) == {}


@pytest.mark.spec("7.2", "D7")
def test_an_unknown_action_is_refused_with_the_names_that_look_like_it() -> None:
    raw = {"graph_name": "g", "actions": [{"name": "waitfor", "type": "sync"}]}
    [problem] = problems(raw)
    assert (problem.path, problem.code) == ("actions[0].name", "unknown_action")
    assert "WaitFor" in problem.remedy
    assert problem.message == "A has no action 'waitfor'"


@pytest.mark.spec("7.2")
def test_missing_and_surplus_parameters_are_named() -> None:
    raw = {"graph_name": "g", "actions": [node("JoinText", 0, left="a", right="b")]}
    inputs = raw["actions"][0]["input_parameters"]  # type: ignore[index]
    inputs["middle"] = inputs.pop("right")
    raw["actions"][0]["output_parameters"] = {}  # type: ignore[index]
    assert found(raw) == {
        "actions[0].input_parameters.right": "missing_parameter",
        "actions[0].input_parameters.middle": "surplus_parameter",
        "actions[0].output_parameters.text": "missing_parameter",
    }


@pytest.mark.spec("D30")
def test_a_parameter_of_another_type_is_refused() -> None:
    raw = {"graph_name": "g", "actions": [node("WaitFor", 0, seconds=1)]}
    raw["actions"][0]["input_parameters"]["seconds"] = {"pvf_type": "string", "pvf_value": "1"}  # type: ignore[index]
    assert found(raw) == {"actions[0].input_parameters.seconds.pvf_type": "wrong_type"}


@pytest.mark.spec("6-better", "D19")
def test_inputs_that_nobody_gives_are_refused_and_those_of_parents_are_not() -> None:
    assert found(two()) == {}
    raw = two()
    raw["actions"][0]["children"][0]["remap"] = [{"from": "text", "to": "expected"}]
    assert found(raw) == {"actions[1].input_parameters.text": "missing_input"}


@pytest.mark.spec("4.2")
def test_an_input_that_may_not_be_overwritten_needs_a_value() -> None:
    fixed = ActionSpec("SameText", {"text": Parameter("string", updatable=False)}, {})
    catalogue = Catalogue([fixed, *CATALOGUE])
    raw = two(input_parameters={"text": {"pvf_type": "string"}})
    codes = {problem.code for problem in check(read_graph(raw), catalogue)}
    assert codes == {"missing_input"}


@pytest.mark.spec("D6", "5.1")
def test_a_remap_must_name_an_output_and_an_input() -> None:
    raw = two(input_parameters=node("SameText", text="own", expected="x")["input_parameters"])
    raw["actions"][0]["children"][0]["remap"] = [{"from": "sound", "to": "picture"}]
    assert found(raw) == {
        "actions[0].children[0].remap[0].from": "unknown_output",
        "actions[0].children[0].remap[0].to": "unknown_input",
    }


@pytest.mark.parametrize(
    ("actor", "options", "code"),
    [
        ("A", {}, None),
        ("B", {}, "unknown_actor"),
        ("B", {"known_actors": ("B",)}, None),
        ("B", {"actor": ""}, None),
    ],
)
@pytest.mark.spec("13", "3")
def test_nodes_of_others_are_for_those_who_take_part(
    actor: str, options: dict[str, Any], code: str | None
) -> None:
    raw = {"graph_name": "g", "actions": [node("NoOp") | {"actor": actor}]}
    assert found(raw, **options) == ({"actions[0].actor": code} if code else {})


@pytest.mark.parametrize("kind", ["sync", "async", "spontaneous", "whatever"])
@pytest.mark.spec("3", "D30")
def test_every_type_of_node_is_accepted(kind: str) -> None:
    assert found({"graph_name": "g", "actions": [node("NoOp") | {"type": kind}]}) == {}


@pytest.mark.spec("2-better")
def test_all_problems_are_found_at_once_and_have_remedies() -> None:
    raw = two(children=[{"name": "Ghost"}], parents=[])
    raw["actions"].append({"name": "Nothing", "instance_id": 7, "type": "sync"})
    assert {problem.code for problem in problems(raw)} == {
        "missing_node",
        "one_sided_relation",
        "missing_input",
        "unknown_action",
        "unreachable_node",
    }
    assert all(problem.message and problem.remedy for problem in problems(raw))


@pytest.mark.spec("7.3")
def test_resolving_refuses_with_all_problems_and_merges_defaults() -> None:
    with pytest.raises(GraphRefusedError) as error:
        resolve(read_graph(two(parents=[])), CATALOGUE, actor="A")
    assert error.value.graph_name == "g"
    graph, specs = resolve(read_graph(two()), CATALOGUE, actor="A")
    assert [spec.name for spec in specs] == [node.name for node in graph.nodes]


def test_a_value_that_cannot_be_read_does_not_hide_what_else_is_wrong() -> None:
    graph = two(name="Unheard")
    graph["actions"][0]["input_parameters"]["left"]["pvf_value"] = 5
    with pytest.raises(GraphRefusedError) as refused:
        read_graph(graph)
    told = reasons(refused.value, CATALOGUE, actor="A")
    assert [(problem.path, problem.code) for problem in told] == [
        ("actions[0].input_parameters.left.pvf_value", "malformed"),
        ("graph_exit[0]", "missing_node"),
        ("actions[1].name", "unknown_action"),
    ]
