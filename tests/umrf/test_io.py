"""Graphs in and out: what is accepted, what is refused and with which words, and that nothing is lost."""

from __future__ import annotations

import json
from dataclasses import replace
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from parley.errors import GraphRefusedError
from parley.messages.pvf import Parameter
from parley.umrf.io import (
    GraphWriter,
    graph_to_json,
    open_graph,
    read_descriptor,
    read_graph,
    write_descriptor,
    write_graph,
)
from parley.umrf.model import (
    DEFAULT_CONDITIONS,
    ChildRelation,
    Graph,
    GraphState,
    LogMessage,
    Node,
    NodeRef,
    NodeState,
    ParentRelation,
    Response,
    Result,
)

from .spec_actions import CATALOGUE

ONE = {"name": "NoOp", "type": "sync"}


def graph(**keys: Any) -> dict[str, Any]:
    return {"graph_name": "g", "graph_entry": [], "graph_exit": [], "actions": [], **keys}


def refused(raw: Any) -> dict[str, str]:
    """Path -> message of every problem."""
    with pytest.raises(GraphRefusedError) as error:
        read_graph(raw if isinstance(raw, str) else json.dumps(raw))
    return {problem.path: problem.message for problem in error.value.problems}


# -- reading ------------------------------------------------------------------------------------------------


@pytest.mark.spec("2")
def test_the_short_form_is_its_own_entry_and_exit() -> None:
    read = read_graph({"graph_name": "g", "actions": [ONE | {"instance_id": 3}]})
    assert read.entry == (ChildRelation(NodeRef("NoOp", 3)),)
    assert read.exit == (ParentRelation(NodeRef("NoOp", 3)),)


@pytest.mark.parametrize(
    "raw",
    [
        {"graph_name": "g", "actions": [ONE], "graph_entry": []},
        {"graph_name": "g", "actions": [ONE], "graph_exit": []},
        {"graph_name": "g", "actions": [ONE, ONE | {"instance_id": 1}]},
        {"graph_name": "g", "actions": []},
    ],
)
@pytest.mark.spec("2")
def test_other_graphs_must_state_entry_and_exit(raw: dict[str, Any]) -> None:
    assert {"graph_entry", "graph_exit"} & refused(raw).keys()


@pytest.mark.spec("2", "17")
def test_unknown_keys_are_ignored_at_every_level() -> None:
    extra: dict[str, Any] = {"x_ours": {"deep": [1]}}
    action: dict[str, Any] = ONE | extra | {"input_parameters": {"a": {"pvf_type": "string"} | extra}}
    action |= {"parents": [{"name": "NoOp"} | extra], "children": [{"name": "NoOp"} | extra]}
    assert len(read_graph(graph(actions=[action]) | extra).nodes) == 1


@pytest.mark.parametrize("text", ["on_true -> run", "on_true->run", "  on_true  ->  run "])
@pytest.mark.spec("5.3")
def test_blanks_in_conditions_do_not_matter(text: str) -> None:
    action = ONE | {"parents": [{"name": "NoOp", "conditions": [text]}]}
    [relation] = read_graph(graph(actions=[action])).nodes[0].parents
    assert relation.conditions == {Result.ON_TRUE: Response.RUN}


@pytest.mark.spec("5.3")
def test_the_last_condition_of_a_precondition_wins() -> None:
    action = ONE | {"parents": [{"name": "NoOp", "conditions": ["on_true -> run", "on_true -> stop"]}]}
    [relation] = read_graph(graph(actions=[action])).nodes[0].parents
    assert relation.response(Result.ON_TRUE) is Response.STOP
    assert relation.response(Result.ON_ERROR) is DEFAULT_CONDITIONS[Result.ON_ERROR]


@pytest.mark.spec("3")
def test_only_the_ten_newest_messages_are_kept_oldest_first() -> None:
    messages = [{"timestamp": stamp, "message": str(stamp)} for stamp in range(14, 0, -1)]
    read = read_graph(graph(actions=[ONE | {"runtime": {"messages": messages}}]))
    assert [item.timestamp for item in read.nodes[0].messages] == list(range(5, 15))


@pytest.mark.parametrize(
    ("action", "path"),
    [
        (3, "actions[0]"),
        ({"type": "sync"}, "actions[0].name"),
        ({"name": "", "type": "sync"}, "actions[0].name"),
        ({"name": "A"}, "actions[0].type"),
        (ONE | {"instance_id": -1}, "actions[0].instance_id"),
        (ONE | {"instance_id": "0"}, "actions[0].instance_id"),
        (ONE | {"instance_id": True}, "actions[0].instance_id"),
        (ONE | {"instance_id": 70_000}, "actions[0].instance_id"),
        (ONE | {"state": "SLEEPING"}, "actions[0].state"),
        (ONE | {"state": 1}, "actions[0].state"),
        (ONE | {"parley": {"retry": 2}}, "actions[0].parley.retry"),
        (ONE | {"parents": {}}, "actions[0].parents"),
        (ONE | {"parents": [{}]}, "actions[0].parents[0].name"),
        (ONE | {"parents": ["A"]}, "actions[0].parents[0]"),
        (ONE | {"parents": [{"name": "A", "required": 1}]}, "actions[0].parents[0].required"),
        (ONE | {"parents": [{"name": "A", "conditions": [1]}]}, "actions[0].parents[0].conditions[0]"),
        (ONE | {"parents": [{"name": "A", "conditions": ["run"]}]}, "actions[0].parents[0].conditions[0]"),
        (
            ONE | {"parents": [{"name": "A", "conditions": ["on_maybe -> run"]}]},
            "actions[0].parents[0].conditions[0]",
        ),
        (
            ONE | {"parents": [{"name": "A", "conditions": ["on_true -> walk"]}]},
            "actions[0].parents[0].conditions[0]",
        ),
        (ONE | {"children": [{"name": "A", "remap": [1]}]}, "actions[0].children[0].remap[0]"),
        (ONE | {"children": [{"name": "A", "remap": [{"from": "a"}]}]}, "actions[0].children[0].remap[0].to"),
        (
            ONE
            | {"children": [{"name": "A", "remap": [{"from": "a", "to": "b"}, {"from": "a", "to": "c"}]}]},
            "actions[0].children[0].remap[1].from",
        ),
        (ONE | {"input_parameters": []}, "actions[0].input_parameters"),
        (ONE | {"input_parameters": {"a": 3}}, "actions[0].input_parameters.a"),
        (ONE | {"input_parameters": {"a": {"b": "c"}}}, "actions[0].input_parameters.a.b"),
        (ONE | {"input_parameters": {"a": {"pvf_type": ""}}}, "actions[0].input_parameters.a.pvf_type"),
        (
            ONE | {"input_parameters": {"a": {"b": {"pvf_type": "number", "pvf_value": "1"}}}},
            "actions[0].input_parameters.a.b.pvf_value",
        ),
        (
            ONE | {"input_parameters": {"a": {"pvf_type": "string", "pvf_value": None}}},
            "actions[0].input_parameters.a.pvf_value",
        ),
        (
            ONE | {"input_parameters": {"a": {"pvf_type": "Picture", "pvf_value": "x"}}},
            "actions[0].input_parameters.a.pvf_value",
        ),
        (
            ONE | {"input_parameters": {"a": {"pvf_type": "string"}, "a::b": {"pvf_type": "string"}}},
            "actions[0].input_parameters",
        ),
        (ONE | {"runtime": {}}, "actions[0].runtime.messages"),
        (ONE | {"runtime": 1}, "actions[0].runtime"),
        (ONE | {"runtime": {"messages": [{"timestamp": "1"}]}}, "actions[0].runtime.messages[0]"),
    ],
)
@pytest.mark.spec("3", "4.1", "4.2", "5.1", "5.2", "5.3")
def test_a_wrong_action_is_refused_with_the_path_of_what_is_wrong(action: Any, path: str) -> None:
    assert list(refused(graph(actions=[action]))) == [path]


@pytest.mark.parametrize(
    ("raw", "path"),
    [
        (graph(graph_name=""), "graph_name"),
        (graph(graph_name=3), "graph_name"),
        (graph(graph_state="ASLEEP"), "graph_state"),
        (graph(graph_entry=[{"name": "Ghost"}]), "graph_entry[0]"),
        (graph(graph_exit=[{"name": "Ghost"}]), "graph_exit[0]"),
        (graph(actions=None), "actions"),
        ([1], ""),
        ("{", ""),
        ('{"graph_name": NaN}', ""),
        ("[" * 5000 + "]" * 5000, ""),
        ('{"graph_name": "g", "actions": ' + '{"a": ' * 100 + "1" + "}" * 101, ""),
        ('{"graph_name": "\\ud800", "actions": []}', ""),
        ('{"graph_name": "g", "gui": 1e999, "actions": []}', ""),
    ],
)
@pytest.mark.spec("2")
def test_a_wrong_graph_is_refused_with_the_path_of_what_is_wrong(raw: Any, path: str) -> None:
    assert path in refused(raw)


@pytest.mark.parametrize("value", [{1, 2}, float("nan"), "\ud800", object()])
def test_an_object_that_is_no_json_is_refused_like_its_text(value: object) -> None:
    with pytest.raises(GraphRefusedError):
        read_graph(graph(x=value))


@pytest.mark.spec("2-better", "17")
def test_every_problem_is_named_at_once() -> None:
    actions = [
        {"name": "A"},
        ONE
        | {"state": "?", "input_parameters": {"a": {"x": 1, "y": {"pvf_type": "number", "pvf_value": ""}}}},
    ]
    assert set(refused(graph(graph_name="", actions=actions))) == {
        "graph_name",
        "actions[0].type",
        "actions[1].state",
        "actions[1].input_parameters.a.x",
        "actions[1].input_parameters.a.y.pvf_value",
    }


def test_problems_say_what_to_do() -> None:
    action = ONE | {"parents": [{"name": "A", "conditions": ["on_true -> walk"]}]}
    with pytest.raises(GraphRefusedError) as error:
        read_graph(graph(actions=[action]))
    assert str(error.value.problems[0]) == (
        "actions[0].parents[0].conditions[0]: unknown response 'walk' "
        "(use one of bypass, ignore, pause, restart, run, stop)"
    )


# -- writing ------------------------------------------------------------------------------------------------


@pytest.mark.spec("9", "12.1", "17")
def test_the_published_form_is_the_reference_s() -> None:
    exit_relation = ParentRelation(NodeRef("B", 10), conditions={Result.ON_TRUE: Response.IGNORE})
    first = Node("B", 2, children=(ChildRelation(NodeRef("B", 10), (("x", "y"),)),), type="async")
    second = Node(
        "B",
        10,
        parents=(ParentRelation(NodeRef("B", 2), False, {Result.ON_FALSE: Response.STOP}),),
        input_parameters={"p::y": Parameter("number", 5.0, required=False, updatable=False, allowed=(5.0,))},
        messages=(LogMessage(1, "hello"),),
        state=NodeState.FINISHED,
    )
    entry = ChildRelation(NodeRef("B", 2), (("a", "b"),))
    text = write_graph(Graph("g", (first, second), (entry,), (exit_relation,)))
    assert text == json.dumps(json.loads(text), sort_keys=True, indent=4)
    assert json.loads(text) == {
        "graph_name": "g",
        "graph_description": "",
        "graph_state": "INITIALIZED",
        "graph_entry": [{"name": "B", "instance_id": 2}],
        "graph_exit": [{"name": "B", "instance_id": 10, "required": True}],
        "actions": [  # sorted as text: B_10 before B_2
            {
                "name": "B",
                "instance_id": 10,
                "description": "",
                "type": "sync",
                "state": "FINISHED",
                "parents": [
                    {
                        "name": "B",
                        "instance_id": 2,
                        "required": False,
                        "conditions": [
                            "on_true -> run",
                            "on_false -> stop",
                            "on_stopped -> ignore",
                            "on_error -> bypass",
                        ],
                    }
                ],
                "input_parameters": {
                    "p": {
                        "y": {
                            "pvf_type": "number",
                            "pvf_value": 5.0,
                            "pvf_updatable": False,
                            "pvf_allowed_values": [5.0],
                        }
                    }
                },
                "runtime": {"messages": [{"message": "hello", "timestamp": 1}]},
            },
            {
                "name": "B",
                "instance_id": 2,
                "description": "",
                "type": "async",
                "state": "UNINITIALIZED",
                "children": [{"name": "B", "instance_id": 10, "remap": [{"from": "x", "to": "y"}]}],
            },
        ],
    }


@pytest.mark.spec("9", "D23")
def test_text_beyond_ascii_is_written_as_it_is() -> None:
    assert "Tür öffnen" in write_graph(Graph("g", description="Tür öffnen"))


# -- round trips --------------------------------------------------------------------------------------------

names = st.text(st.characters(categories=("L", "N")), min_size=1, max_size=6)
texts = st.text(st.characters(exclude_categories=["Cs"]), max_size=10)
numbers = st.floats(allow_nan=False, allow_infinity=False)
refs = st.builds(NodeRef, names, st.integers(0, 65535))
conditions = st.dictionaries(st.sampled_from(list(DEFAULT_CONDITIONS)), st.sampled_from(Response))


def parameters_of(kind: str, values: st.SearchStrategy[Any]) -> st.SearchStrategy[Parameter]:
    return st.builds(
        Parameter,
        st.just(kind),
        st.none() | values,
        st.booleans(),
        st.booleans(),
        st.lists(values, max_size=2).map(tuple),
    )


parameters = st.one_of(
    parameters_of("string", texts),
    parameters_of("number", numbers),
    parameters_of("bool", st.booleans()),
    parameters_of("strings", st.lists(texts, max_size=2)),
    parameters_of("numbers", st.lists(numbers, max_size=2)),
    st.builds(Parameter, names.map(lambda name: f"Opaque{name}"), required=st.booleans()),
)
flat = st.dictionaries(st.lists(names, min_size=1, max_size=3).map("::".join), parameters, max_size=3).filter(
    lambda given: not any(f"{a}::" == b[: len(a) + 2] for a in given for b in given)
)
messages = st.lists(st.builds(LogMessage, st.integers(0, 2**45), texts), max_size=10).map(
    lambda items: tuple(sorted(items, key=lambda item: item.timestamp))
)
parents = st.builds(ParentRelation, refs, st.booleans(), conditions)
remaps = st.dictionaries(names, names, max_size=2).map(lambda pairs: tuple(pairs.items()))
children = st.builds(ChildRelation, refs, remaps)
nodes = st.builds(
    lambda *given: Node(*given),
    names,
    st.integers(0, 65535),
    names,
    texts,
    texts,
    st.sampled_from(NodeState),
    flat,
    flat,
    st.lists(parents, max_size=2).map(tuple),
    st.lists(children, max_size=2).map(tuple),
    st.none() | st.dictionaries(names, numbers, max_size=2),
    messages,
)


@st.composite
def graphs(draw: st.DrawFn) -> Graph:
    found = tuple(draw(st.lists(nodes, max_size=3)))
    entry = tuple(ChildRelation(item.ref, draw(remaps)) for item in found if draw(st.booleans()))
    ends = tuple(ParentRelation(item.ref, draw(st.booleans()), draw(conditions)) for item in found)
    return Graph(draw(names), found, entry, ends, draw(texts), draw(st.sampled_from(GraphState)))


@given(graphs())
@pytest.mark.spec("9", "D35")
def test_the_faithful_form_reads_back_to_the_same_graph(written: Graph) -> None:
    assert read_graph(write_graph(written, faithful=True)) == written


@given(graphs())
@pytest.mark.spec("9", "9-better", "3")
def test_the_published_form_is_stable_and_loses_no_more_than_the_reference(written: Graph) -> None:
    text = write_graph(written)
    read = read_graph(text)
    if read.state is not GraphState.UNINITIALIZED:
        assert write_graph(read) == text
    assert sorted(item.full_name for item in read.nodes) == [item.full_name for item in read.nodes]
    assert read.description == written.description


@given(st.lists(graphs(), max_size=3))
@settings(max_examples=30, suppress_health_check=[HealthCheck.too_slow])  # a busy machine
@pytest.mark.spec("D18")
def test_a_writer_that_remembers_writes_the_same_text(versions: list[Graph]) -> None:
    writer = GraphWriter()
    for version in versions:
        unique = tuple({item.full_name: item for item in version.nodes}.values())
        version = replace(version, nodes=unique)
        assert writer.write(version) == write_graph(version)
        assert writer.write(version) == write_graph(version)


def test_both_forms_of_a_mapping_and_its_text_read_the_same() -> None:
    raw = graph(actions=[ONE])
    assert read_graph(raw) == read_graph(json.dumps(raw))


# -- descriptors --------------------------------------------------------------------------------------------


@pytest.mark.spec("7.1")
def test_descriptors_read_back_what_was_written() -> None:
    for spec in CATALOGUE:
        read = read_descriptor(write_descriptor(spec))
        assert (read.name, read.inputs, read.outputs) == (spec.name, spec.inputs, spec.outputs)
        assert read.description == spec.description
        assert read.runner() is None


def test_a_wrong_descriptor_is_refused_with_a_path() -> None:
    with pytest.raises(GraphRefusedError) as error:
        read_descriptor('{"name": "A", "input_parameters": {"x": 1}}')
    assert [problem.path for problem in error.value.problems] == ["type", "input_parameters.x"]


@pytest.mark.spec("12.6", "D35")
def test_the_form_of_planners_keeps_exit_conditions_and_what_is_not_required() -> None:
    conditions = {Result.ON_TRUE: Response.IGNORE}
    node = Node("A", input_parameters={"x": Parameter("string", required=False)})
    kept = Graph("g", (node,), (ChildRelation(node.ref),), (ParentRelation(node.ref, conditions=conditions),))
    raw = graph_to_json(replace(kept, description="why"))
    assert raw["graph_exit"][0]["conditions"] == ["on_true -> ignore"]
    assert raw["graph_description"] == "why"
    assert raw["actions"][0]["input_parameters"]["x"]["pvf_required"] is False


def test_a_graph_without_a_name_is_refused_though_its_text_is_known_but_for_that() -> None:
    def text(name: str, inside: str) -> str:
        action = {"name": "Say", "type": "sync", "gui_attributes": {"graph_name": inside}}
        return json.dumps({"graph_name": name, "actions": [action]})

    open_graph(text("g", ""))[1]()
    with pytest.raises(GraphRefusedError):
        open_graph(text("", "g"))[1]()


@pytest.mark.parametrize(
    "name", ["g", "graph", "graph_name", ":", " ", "jäär", 'a "quoted" one', "back\\slash"]
)
@pytest.mark.parametrize("inside", ["x", "graph_name", "g"])
def test_a_graph_that_was_read_under_another_name_is_the_same_as_one_read_anew(
    name: str, inside: str
) -> None:
    def text(name: str, value: str, indent: int | None) -> str:
        given = {inside: {"pvf_type": "string", "pvf_value": value}}
        action = {"name": "Say", "type": "sync", "input_parameters": given}
        return json.dumps({"actions": [action], "graph_name": name}, ensure_ascii=False, indent=indent)

    for value in ("one", name, f"{name}x", f"x{name}"):
        for indent in (None, 4):
            for named in ("first", name, "second"):
                source = text(named, value, indent)
                told, read = open_graph(source)
                assert (told, read()) == (named, read_graph(source))
