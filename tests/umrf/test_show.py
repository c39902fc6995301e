"""Graphs as text, Mermaid and SVG: what is there is shown, and whatever it is called nothing breaks."""

from __future__ import annotations

import json
import re
from pathlib import Path
from xml.etree import ElementTree

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from parley.umrf.io import read_graph, write_graph
from parley.umrf.model import (
    ChildRelation,
    Graph,
    GraphState,
    Node,
    NodeRef,
    NodeState,
    ParentRelation,
    Response,
    Result,
)
from parley.umrf.show import FORMATS, STATE_COLOURS, as_mermaid, as_svg, as_text, show

from .spec_actions import chain, node, planner_chain

SVG = "{http://www.w3.org/2000/svg}"

LOOP = {
    "graph_name": "loop",
    "graph_description": "waits at a box",
    "graph_entry": [{"name": "Look"}],
    "graph_exit": [{"name": "Meet", "conditions": ["on_false -> ignore"]}],
    "actions": [
        {
            "name": "Look",
            "type": "sync",
            "state": "FINISHED",
            "actor": "Ada",
            "input_parameters": {"what": {"pvf_type": "string", "pvf_value": "a box"}},
            "output_parameters": {"pose": {"x": {"pvf_type": "number"}}},
            "children": [{"name": "Go"}, {"name": "Say"}],
            "parents": [{"name": "Meet", "required": False, "conditions": ["on_true -> ignore"]}],
        },
        {
            "name": "Go",
            "type": "sync",
            "state": "RUNNING",
            "input_parameters": {"pose": {"x": {"pvf_type": "number"}}},
            "children": [{"name": "Meet"}],
            "parents": [{"name": "Look", "conditions": ["on_error -> run"]}],
        },
        {"name": "Say", "type": "sync", "children": [{"name": "Meet"}], "parents": [{"name": "Look"}]},
        {
            "name": "Meet",
            "type": "sync",
            "children": [{"name": "Look"}],
            "parents": [{"name": "Go"}, {"name": "Say"}],
        },
    ],
}

TEXT = """\
graph loop (UNINITIALIZED): waits at a box
• Look_0 @Ada FINISHED
      what = "a box"
      gives pose::x
    • Go_0 RUNNING  [on_error -> run]
          pose::x (number)
    • Meet_0  (waits for Go_0, Say_0)
      ↺ Look_0  [on_true -> ignore, not required]
      → exit  [on_false -> ignore]
    • Say_0
      ⇢ Meet_0
"""


def test_the_text_shows_order_values_conditions_joins_and_cycles() -> None:
    assert as_text(read_graph(LOOP)) == TEXT


def test_the_page_about_graphs_shows_what_is_shown() -> None:
    page = (Path(__file__).parents[2] / "docs" / "graphs.md").read_text(encoding="utf-8")
    assert f"```text\n{TEXT}```" in page


def test_a_chain_stands_below_itself_without_indentation() -> None:
    lines = as_text(read_graph(chain("g", [node("NoOp", index) for index in range(3)]))).splitlines()
    assert lines[1:] == ["• NoOp_0", "• NoOp_1", "• NoOp_2", "  → exit"]


def test_the_conditions_of_planners_are_shown_where_they_differ() -> None:
    assert "• NoOp_1  [on_error -> ignore]" in as_text(
        read_graph(planner_chain("g", [node("NoOp", index) for index in range(2)]))
    )


def test_an_action_that_nothing_leads_to_is_shown_as_such() -> None:
    lost = Graph("g", (Node("A"), Node("B")), (ChildRelation(NodeRef("A")),))
    assert "not reached from the entry: B_0" in as_text(lost)


def test_a_relation_that_is_stated_on_one_side_only_is_shown_as_such() -> None:
    half = Graph(
        "g", (Node("A", children=(ChildRelation(NodeRef("B")),)), Node("B")), (ChildRelation(NodeRef("A")),)
    )
    assert "• B_0  [stated on one side only]" in as_text(half)


def test_a_rename_is_shown() -> None:
    first = Node("A", children=(ChildRelation(NodeRef("B"), (("x", "y"),)),))
    second = Node("B", parents=(ParentRelation(NodeRef("A")),))
    assert "• B_0  [x as y]" in as_text(Graph("g", (first, second), (ChildRelation(NodeRef("A")),)))


def test_mermaid_gives_every_action_its_state_as_a_class() -> None:
    lines = as_mermaid(read_graph(LOOP)).splitlines()
    assert lines[0] == "flowchart TD"
    assert '    n1["Go_0<br>pose#58;#58;x (number)"]:::RUNNING' in [
        line.replace("::x", "#58;#58;x") for line in lines
    ]
    assert '    n0 -->|"on_error -#62; run"| n1' in lines
    assert "    entry --> n0" in lines
    assert '    n3 -->|"on_false -#62; ignore"| leave' in lines
    assert any(line.startswith("    classDef RUNNING ") for line in lines)


def test_the_picture_has_a_box_per_action_and_a_line_per_relation() -> None:
    root = ElementTree.fromstring(as_svg(read_graph(LOOP)))
    words = [item.text for item in root.iter(f"{SVG}text")]
    assert {"entry", "exit", "Look_0 @Ada", "Go_0", "RUNNING", 'what = "a box"'} <= set(words)
    assert len(root.findall(f"{SVG}path")) == 7
    assert STATE_COLOURS[NodeState.RUNNING] in {item.get("fill") for item in root.findall(f"{SVG}rect")}


def test_boxes_of_a_picture_do_not_cover_each_other_and_lie_inside() -> None:
    root = ElementTree.fromstring(as_svg(read_graph(LOOP)))
    width, height = float(root.get("width", 0)), float(root.get("height", 0))
    boxes = [
        tuple(float(item.get(key, 0)) for key in ("x", "y", "width", "height"))
        for item in root.findall(f"{SVG}rect")
        if item.get("width") != "100%"
    ]
    assert all(x >= 0 and y >= 0 and x + w <= width and y + h <= height for x, y, w, h in boxes)
    for index, (x, y, w, h) in enumerate(boxes):
        for x2, y2, w2, h2 in boxes[:index]:
            assert x + w <= x2 or x2 + w2 <= x or y + h <= y2 or y2 + h2 <= y


def test_labels_lie_inside_of_the_picture() -> None:
    root = ElementTree.fromstring(as_svg(read_graph(LOOP)))
    labels = [item for item in root.iter(f"{SVG}text") if item.get("font-size") == "10"]
    assert len(labels) == 3
    for item in labels:
        x, width = float(item.get("x", 0)), len(item.text or "") * 6.1
        left = x - width if item.get("text-anchor") == "end" else x - width / 2
        assert left >= 0
        assert left + width <= float(root.get("width", 0))


def test_every_state_has_a_colour() -> None:
    assert STATE_COLOURS.keys() == set(NodeState)


def test_a_published_graph_is_shown_as_well() -> None:
    published = write_graph(read_graph(LOOP))
    assert json.loads(published)["graph_state"] == "INITIALIZED"
    for how in FORMATS:
        assert "RUNNING" in show(read_graph(published), how)


def test_a_long_graph_is_shown() -> None:
    long = read_graph(chain("g", [node("NoOp", index) for index in range(1000)]))
    for how in FORMATS:
        assert "NoOp_999" in show(long, how)


names = st.text(min_size=1, max_size=8)
refs = st.builds(NodeRef, st.sampled_from(["A", "B", "C", "<&\"'", "a\nb\x1b[2J"]), st.integers(0, 1))
answers = st.dictionaries(
    st.sampled_from([Result.ON_TRUE, Result.ON_FALSE, Result.ON_ERROR]), st.sampled_from(Response)
)
children = st.lists(st.builds(ChildRelation, refs), max_size=3).map(tuple)
parents = st.lists(st.builds(ParentRelation, refs, st.booleans(), answers), max_size=3).map(tuple)


@st.composite
def any_graph(draw: st.DrawFn) -> Graph:
    """Graphs that could run, and mostly graphs that could not."""
    nodes = tuple(
        Node(
            ref.name,
            ref.instance_id,
            actor=draw(st.text(max_size=3)),
            state=draw(st.sampled_from(NodeState)),
            parents=draw(parents),
            children=draw(children),
        )
        for ref in draw(st.lists(refs, max_size=5))
    )
    state = draw(st.sampled_from(GraphState))
    return Graph(draw(names), nodes, draw(children), draw(parents), draw(st.text(max_size=8)), state)


@settings(max_examples=80, deadline=None)
@given(any_graph())
def test_showing_never_fails_and_never_breaks_its_form(graph: Graph) -> None:
    text, mermaid, svg = as_text(graph), as_mermaid(graph), as_svg(graph)
    ElementTree.fromstring(svg)
    assert not re.search(r"[\x00-\x09\x0b-\x1f]", text + mermaid)
    assert all(mermaid.count(quote) % 2 == 0 for quote in '"')
    for node_ in graph.nodes:
        assert re.sub(r"[\x00-\x1f\x7f-\x9f\u2028\u2029]", " ", node_.full_name) in text


@pytest.mark.parametrize("how", FORMATS)
def test_an_empty_graph_is_shown(how: str) -> None:
    assert "g" in FORMATS[how](Graph("g"))  # type: ignore[index]
