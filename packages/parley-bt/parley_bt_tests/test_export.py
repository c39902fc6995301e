"""Graphs as BehaviorTree.CPP trees: what they become, and each reason why one cannot be exported."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise
from typing import Any
from xml.etree import ElementTree

import pytest

from parley.errors import GraphRefusedError
from parley.messages.pvf import Parameter
from parley.umrf.model import ChildRelation, Graph, NodeRef, Response, Result
from parley_bt import EXPORT_REASONS, export_tree
from parley_bt.shape import Fallback, ForceSuccess, Inverter, Leaf, Parallel, Retry, Shape
from parley_bt.shape import Sequence as Row
from parley_bt.structure import structure

from .format_rules import violations
from .graphs import ALWAYS, DEFAULT, RECOVER, STRICT, graph

FORK = {("A", "B"): DEFAULT, ("A", "C"): DEFAULT}

NUMBER, TEXT = Parameter("number"), Parameter("string")


def leaf(name: str, *, lenient: bool = False) -> Leaf:
    return Leaf(NodeRef(name), lenient)


A, B, C, D = map(leaf, "ABCD")
a, b = leaf("A", lenient=True), leaf("B", lenient=True)

TREES: list[tuple[str, Graph, Shape]] = [
    ("one action", graph({}, leave={"A": DEFAULT}), A),
    (
        "a chain with default conditions goes on after false",
        graph({("A", "B"): DEFAULT}, leave={"B": DEFAULT}),
        Row((a, B)),
    ),
    (
        "a planner's chain, which halts at its end",
        graph({("A", "B"): "run run ignore"}, leave={"B": "ignore ignore ignore"}),
        Row((a, B)),
    ),
    ("a chain that ends at false", graph({("A", "B"): STRICT}, leave={"B": DEFAULT}), Row((A, B))),
    (
        "a chain that goes on after everything",
        graph({("A", "B"): ALWAYS}, leave={"B": DEFAULT}),
        Row((ForceSuccess(a), B)),
    ),
    ("a second try", graph({("A", "B"): RECOVER}, leave={"B": DEFAULT}), Fallback((A, B))),
    (
        "a step that is left out after success",
        graph({("A", "B"): "ignore run run", ("A", "C"): "run ignore ignore?", ("B", "C"): STRICT + "?"}),
        Row((Fallback((A, B)), C)),
    ),
    (
        "a step only after success, then on",
        graph({("A", "B"): "run ignore ignore", ("A", "C"): "ignore run run?", ("B", "C"): STRICT + "?"}),
        Row((Fallback((Inverter(A), B)), C)),
    ),
    (
        "branches that meet",
        graph(FORK | {("B", "D"): DEFAULT, ("C", "D"): DEFAULT}, leave={"D": DEFAULT}),
        Row((a, Parallel((b, leaf("C", lenient=True))), D)),
    ),
    (
        "branches that nothing follows",
        graph({}, entry=("A", "B")),
        Parallel((A, B), all_end=True),
    ),
    (
        "data that skips a step",
        graph({("A", "B"): DEFAULT, ("A", "C"): DEFAULT, ("B", "C"): DEFAULT}, leave={"C": DEFAULT}),
        Row((a, b, C)),
    ),
]  # fmt: skip


@pytest.mark.parametrize(("what", "given", "expected"), TREES, ids=[what for what, _, _ in TREES])
def test_a_graph_becomes_the_tree(what: str, given: Graph, expected: Shape) -> None:
    assert structure(given) == expected
    assert violations(export_tree(given)) == []


def test_two_that_take_turns_until_one_succeeds_are_a_retry() -> None:
    turns = graph(
        {("A", "B"): "ignore run run", ("B", "A"): "ignore run run?"},
        leave={"A": "run ignore ignore?", "B": "run ignore ignore?"},
    )
    assert structure(turns) == Retry(Fallback((A, B)))


def with_parameters(*, entry: dict[str, Any] | None = None, **more: Any) -> Graph:
    """A gives a number and a text to B, which calls the text otherwise."""
    nodes = {
        "A": {"output_parameters": {"pose::x": NUMBER, "said": TEXT}},
        "B": {"input_parameters": {"pose::x": NUMBER, "heard": TEXT, "limit": Parameter("number", 2.0)}},
    }
    nodes["B"]["input_parameters"] |= more
    made = graph({("A", "B"): DEFAULT}, leave={"B": DEFAULT}, nodes=nodes)
    first = made.nodes[0]._replace(children=(ChildRelation(NodeRef("B"), (("said", "heard"),)),))
    return replace(made, nodes=(first, *made.nodes[1:]))


def test_transfers_become_blackboard_entries_and_values_become_text() -> None:
    text = export_tree(with_parameters())
    assert violations(text) == []
    giver, taker = ElementTree.fromstring(text).findall(".//BehaviorTree//Action")
    assert giver.attrib == {
        "ID": "A", "name": "A_0", "pose__x": "{A_0__pose__x}", "said": "{A_0__said}", "on_false": "SUCCESS",
    }  # fmt: skip
    assert taker.attrib == {
        "ID": "B", "name": "B_0", "pose__x": "{A_0__pose__x}", "heard": "{A_0__said}", "limit": "2.0",
    }  # fmt: skip


def test_the_model_names_every_port_with_its_type() -> None:
    root = ElementTree.fromstring(export_tree(with_parameters()))
    model = next(item for item in root.iter("Action") if item.get("ID") == "B" and len(item))
    assert [(port.tag, port.get("name"), port.get("type")) for port in model] == [
        ("input_port", "pose__x", "double"),
        ("input_port", "heard", "std::string"),
        ("input_port", "limit", "double"),
        ("input_port", "on_false", "BT::NodeStatus"),
    ]


def test_a_tree_gets_a_name_that_a_tree_can_have() -> None:
    assert '<BehaviorTree ID="to_the_door_">' in export_tree(replace(with_parameters(), name="to the door!"))
    assert '<BehaviorTree ID="A_tree">' in export_tree(replace(with_parameters(), name="A"))


def parameter(value: Any, kind: str = "string") -> dict[str, Any]:
    return {"A": {"input_parameters": {"p": Parameter(kind, value)}}}


def given_twice() -> Graph:
    """C gets one input from both parents, D from one of them only."""
    out, taken = {"output_parameters": {"p": TEXT}}, {"input_parameters": {"p": TEXT}}
    return graph(
        {("A", "B"): ALWAYS, ("A", "D"): ALWAYS, ("B", "D"): ALWAYS, ("D", "C"): ALWAYS, ("B", "C"): ALWAYS},
        nodes={"A": out, "B": out, "C": taken, "D": taken | out},
    )


def one_sided() -> Graph:
    made = graph({("A", "B"): DEFAULT})
    return replace(made, nodes=(made.nodes[0]._replace(children=()), made.nodes[1]))


def stopped() -> Graph:
    made = graph({("A", "B"): DEFAULT})
    relation = made.nodes[1].parents[0]._replace(conditions={Result.ON_STOPPED: Response.RUN})
    return replace(made, nodes=(made.nodes[0], made.nodes[1]._replace(parents=(relation,))))


def deep() -> Graph:
    names = [f"N{index:03}" for index in range(300)]
    pairs = enumerate(pairwise(names))
    return graph({pair: (STRICT, RECOVER)[index % 2] for index, pair in pairs}, entry=names[:1])


REFUSED: list[tuple[str, Callable[[], Graph]]] = [
    ("broken_graph", one_sided),
    ("broken_graph", lambda: replace(graph({}), nodes=graph({}).nodes * 2)),
    ("control_response", lambda: graph({("A", "B"): "run stop bypass"})),
    ("stopped_response", stopped),
    ("spontaneous", lambda: graph({}, nodes={"A": {"type": "spontaneous"}})),
    ("limits", lambda: graph({}, nodes={"A": {"retries": 1}})),
    ("several_actors", lambda: graph({("A", "B"): DEFAULT}, nodes={"A": {"actor": "a"}})),
    ("three_ways", lambda: graph({("A", "B"): "run ignore ignore", ("A", "C"): "ignore run ignore"})),
    ("self_edge", lambda: graph({("A", "A"): "ignore run ignore"})),
    ("entry_waits", lambda: graph({("A", "B"): DEFAULT}, entry=("A", "B"))),
    ("join_in_cycle", lambda: graph(FORK | {("B", "D"): DEFAULT, ("C", "D"): DEFAULT,
                                             ("D", "A"): DEFAULT + "?"})),
    ("join_never", lambda: graph({("A", "B"): "run ignore ignore", ("A", "C"): "ignore run run",
                                  ("B", "D"): DEFAULT, ("C", "D"): DEFAULT}, leave={"D": DEFAULT})),
    ("join_order", lambda: graph({("A", "B"): "bypass bypass run", ("A", "C"): ALWAYS, ("B", "C"): STRICT})),
    ("join_error", lambda: graph(FORK | {("B", "D"): "run run ignore", ("C", "D"): "run run ignore"})),
    ("ends_while_running", lambda: graph({("A", "B"): DEFAULT}, leave={"A": DEFAULT})),
    ("unreachable_node", lambda: graph({("B", "C"): DEFAULT})),
    ("unstructured", lambda: graph({("A", "B"): "run ignore ignore", ("A", "C"): "ignore run run",
                                    ("B", "D"): DEFAULT + "?", ("C", "D"): DEFAULT + "?"})),
    ("unstructured", lambda: graph({}, entry=())),
    ("too_deep", deep),
    ("node_name", lambda: graph({}, entry=("Sequence",))),
    ("node_name", lambda: graph({}, entry=("open door",))),
    ("port_name", lambda: graph({}, nodes={"A": {"input_parameters": {"on_false": TEXT}}})),
    ("port_name", lambda: graph({}, nodes={"A": {"input_parameters": {"p": TEXT},
                                                "output_parameters": {"p": TEXT}}})),
    ("value_form", lambda: graph({}, nodes=parameter("{box}"))),
    ("value_form", lambda: graph({}, nodes=parameter("a\x07b"))),
    ("value_form", lambda: graph({}, nodes=parameter(["a;b"], "strings"))),
    ("several_givers", given_twice),
    ("value_and_giver", lambda: with_parameters(heard=Parameter("string", "before"))),
    ("allowed_values", lambda: with_parameters(heard=Parameter("string", allowed=("yes",)))),
]  # fmt: skip


@pytest.mark.parametrize(("code", "given"), REFUSED, ids=[code for code, _ in REFUSED])
def test_a_graph_without_a_tree_is_refused_with_the_reason(code: str, given: Callable[[], Graph]) -> None:
    with pytest.raises(GraphRefusedError) as refused:
        export_tree(given())
    assert code in [problem.code for problem in refused.value.problems]
    assert all(problem.path for problem in refused.value.problems)


def test_every_reason_has_an_example() -> None:
    assert {code for code, _ in REFUSED} == EXPORT_REASONS.keys()
