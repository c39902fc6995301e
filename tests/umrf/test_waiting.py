"""Graphs that wait in vain: told before the start where that can be known, and with a reason where not."""

from __future__ import annotations

from typing import Any

from parley.umrf.catalogue import Catalogue
from parley.umrf.check import MAX_LEVELS, check, doubts
from parley.umrf.io import read_graph
from parley.umrf.model import Graph, Result

from .spec_actions import CATALOGUE, SPECS, chain, node, planner_chain
from .watched import Watched


def ref(number: int, **more: Any) -> dict[str, Any]:
    return {"name": "NoOp", "instance_id": number, **more}


def loop(**back: Any) -> dict[str, Any]:
    first, second = node("NoOp", 0), node("NoOp", 1)
    first |= {"children": [ref(1)], "parents": [ref(1, **back)]}
    second |= {"children": [ref(0)], "parents": [ref(0)]}
    return {"graph_name": "g", "graph_entry": [ref(0)], "graph_exit": [ref(1)], "actions": [first, second]}


def before(raw: dict[str, Any]) -> dict[str, Any]:
    """The same with another entry."""
    first = node("NoOp", 2) | {"children": [ref(0)]}
    head = raw["actions"][0] | {"parents": [*raw["actions"][0]["parents"], ref(2)]}
    return raw | {"graph_entry": [ref(2)], "actions": [first, head, raw["actions"][1]]}


def test_a_loop_that_nothing_can_enter_is_told_before_the_start() -> None:
    for graph in (loop(), before(loop())):
        problems = check(read_graph(graph), CATALOGUE)
        assert {item.code for item in problems} == {"endless_wait"}
        assert problems[0].message.startswith("NoOp_0 waits for NoOp_1")
    for graph in (loop(required=False), before(loop(required=False))):
        assert check(read_graph(graph), CATALOGUE) == []


async def test_a_graph_that_halts_names_the_exit_that_never_came() -> None:
    first, second = node("NoOp", 0), node("NoOp", 1)
    first |= {"children": [ref(1)]}
    second |= {"parents": [ref(0, conditions=["on_true -> ignore"])]}
    exits = [ref(0), ref(1)]
    graph = {"graph_name": "g", "graph_entry": [ref(0)], "graph_exit": exits, "actions": [first, second]}
    watched = Watched(graph)
    watched.run.start()
    assert await watched.run.wait() is Result.ON_HALTED
    assert watched.told[-1].message == "the exit still waits for NoOp_1"


async def test_a_graph_without_an_entry_halts_and_says_so() -> None:
    watched = Watched(chain("g", [node("NoOp", 0)]) | {"graph_entry": [], "graph_exit": []})
    watched.run.start()
    assert await watched.run.wait() is Result.ON_HALTED
    assert watched.told[-1].message == "nothing is at the entry"


async def test_a_graph_that_is_meant_to_run_dry_gives_no_reason() -> None:
    watched = Watched(planner_chain("g", [node("JoinText", 0, left="a", right="b")]))
    watched.run.start()
    assert await watched.run.wait() is Result.ON_HALTED
    assert watched.told[-1].message == ""


async def test_a_second_round_that_lacks_an_input_says_so() -> None:
    giver, taker, back = (
        node("JoinText", 0, left="a", right="b"),
        node("SameText", 0, expected="a-b"),
        node("NoOp", 0),
    )
    taken = {"name": "SameText", "instance_id": 0}
    giver |= {"children": [taken]}
    taker |= {
        "parents": [{"name": "JoinText", "required": False}, ref(0, required=False)],
        "children": [ref(0)],
    }
    back |= {"parents": [{"name": "SameText"}], "children": [taken]}
    graph = {
        "graph_name": "g",
        "graph_entry": [{"name": "JoinText"}],
        "graph_exit": [],
        "actions": [giver, taker, back],
    }
    assert check(read_graph(graph), CATALOGUE) == []
    (doubt,) = doubts(read_graph(graph), CATALOGUE)
    assert doubt.message == "SameText_0 has no data for text when it runs again after NoOp_0"
    watched = Watched(graph)
    watched.run.start()
    assert await watched.run.wait() is Result.ON_HALTED
    assert watched.told[-1].message == "SameText_0 has no data for text to run again"


def nested(levels: int, width: int = 1) -> list[Graph]:
    """Graphs D0, D1, ... of which each is `width` times in the one before."""
    names = [{"name": f"D{level}", "type": "sync"} for level in range(1, levels + 1)]
    graphs = [
        read_graph(chain(f"D{level}", [item | {"instance_id": index} for index in range(width)]))
        for level, item in enumerate(names)
    ]
    return [*graphs, read_graph(chain(f"D{levels}", [node("NoOp", 0)]))]


def test_graphs_inside_of_each_other_have_a_limit_that_is_told() -> None:
    graphs = nested(MAX_LEVELS + 5)
    catalogue = Catalogue(SPECS, graphs)
    (problem,) = check(graphs[0], catalogue)
    assert problem.code == "too_deep"
    assert check(graphs[4], catalogue)[0].code == "too_deep"
    assert check(graphs[5], catalogue) == []


def test_graphs_that_are_inside_of_others_many_times_are_looked_into_once() -> None:
    graphs = nested(MAX_LEVELS, width=3)
    assert check(graphs[0], Catalogue(SPECS, graphs)) == []
