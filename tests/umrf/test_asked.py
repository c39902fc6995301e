"""An action is told whether what follows depends on its answer."""

from __future__ import annotations

import asyncio
from dataclasses import dataclass
from typing import Any

import pytest

from parley.errors import ActionFailure, FailureCode
from parley.umrf.action import Outcome, RunHandle, action
from parley.umrf.catalogue import Catalogue
from parley.umrf.io import read_graph
from parley.umrf.model import GraphState, Result

from .spec_actions import wait_for
from .watched import Watched


@dataclass(frozen=True)
class Report:
    text: str


@action
async def search(ctx: RunHandle) -> Report | Outcome:
    """Find nothing: an answer if it is asked for, else a failure."""
    if ctx.result_asked:
        return Outcome(False, {"text": "nothing there"})
    raise ActionFailure(FailureCode.NO_MATCH, "I found nothing.")


@action(isolated=True)
async def search_apart(ctx: RunHandle) -> bool:
    """The same in another process."""
    if not ctx.result_asked:
        raise ActionFailure(FailureCode.NO_MATCH, "I found nothing.")
    return False


@action
async def search_long(ctx: RunHandle) -> bool:
    """Say at the end of a pause what is asked then."""
    await asyncio.sleep(0)
    await ctx.wait_while_paused()
    return ctx.result_asked


CATALOGUE = Catalogue([search.spec, search_apart.spec, search_long.spec, wait_for.spec])
WAITS = {
    "input_parameters": {"seconds": {"pvf_type": "number", "pvf_value": 0.0}},
    "output_parameters": {"waited": {"pvf_type": "number"}},
}


def graph(name: str, *conditions: str, exits: tuple[str, ...] = ()) -> dict[str, Any]:
    """The action, one that follows it on `conditions`, and one that follows in any case."""
    first = {"name": name, "instance_id": 0}
    last, other = {"name": "WaitFor", "instance_id": 1}, {"name": "WaitFor", "instance_id": 2}
    outputs = {"output_parameters": {"text": {"pvf_type": "string"}}} if name == "Search" else {}
    return {
        "graph_name": "g",
        "graph_entry": [first],
        "graph_exit": [last | {"conditions": list(exits)}],
        "actions": [
            first | outputs | {"type": "sync", "children": [last, other]},
            last | WAITS | {"type": "sync", "parents": [first | {"conditions": list(conditions)}]},
            other | WAITS | {"type": "sync", "parents": [first]},
        ],
    }


@pytest.mark.parametrize("name", ["Search", "SearchApart"])
async def test_an_edge_that_tells_false_from_true_makes_it_an_answer(name: str) -> None:
    watched = Watched(graph(name, "on_false -> ignore"), catalogue=CATALOGUE)
    watched.run.start()
    await watched.run.wait()
    (end,) = [item for item in watched.told if item.node == f"{name}_0" and item.result]
    assert end.result is Result.ON_FALSE
    assert watched.runs() == [f"{name}_0", "WaitFor_2"]


async def test_an_answer_that_nobody_asks_for_is_a_failure() -> None:
    watched = Watched(graph("Search", "on_error -> ignore", "on_stopped -> run"), catalogue=CATALOGUE)
    watched.run.start()
    await watched.run.wait()
    assert watched.state("Search_0") == "ERROR"


async def test_the_exit_may_be_what_asks() -> None:
    alone = {"name": "Search", "instance_id": 0}
    action_ = alone | {"type": "sync", "output_parameters": {"text": {"pvf_type": "string"}}}
    for condition, state in (("on_false -> ignore", "FINISHED"), ("on_error -> ignore", "ERROR")):
        text = {
            "graph_name": "g",
            "graph_entry": [alone],
            "graph_exit": [alone | {"conditions": [condition]}],
            "actions": [action_],
        }
        watched = Watched(text, catalogue=CATALOGUE)
        watched.run.start()
        await watched.run.wait()
        assert watched.state("Search_0") == state


async def test_an_edge_that_is_changed_meanwhile_counts_as_it_is_then() -> None:
    watched = Watched(graph("SearchLong"), catalogue=CATALOGUE)
    watched.run.start()
    watched.run.pause()
    watched.run.modify(read_graph(graph("SearchLong", "on_false -> ignore")))
    watched.run.resume()
    await watched.run.wait()
    assert watched.run.state is GraphState.FINISHED
    (end,) = [item for item in watched.told if item.node == "SearchLong_0" and item.result]
    assert end.result is Result.ON_TRUE, "it was asked at its end"
