"""However an action ends, its node ends with it and everybody is told."""

from __future__ import annotations

import asyncio
import math
import threading
from typing import Any

import numpy
import pytest

from parley.engine.events import event_fields
from parley.errors import ActionFailure, FailureCode
from parley.messages.status import GraphEvent
from parley.messages.wire import decode, to_string_unchecked
from parley.umrf.action import Outcome, RunHandle, action
from parley.umrf.catalogue import Catalogue
from parley.umrf.io import read_graph
from parley.umrf.model import GraphState, NodeState, Result

from .spec_actions import chain, insist, no_op, node, planner_chain
from .watched import Watched, until


class Speechless(Exception):  # noqa: N818 - what an action may raise
    def __str__(self) -> str:
        raise RuntimeError("no words")


@action
async def fail_without_words(ctx: RunHandle) -> None:
    """Raise what cannot say why."""
    raise Speechless


class FailTwice:
    """Work at the third try."""

    def __init__(self) -> None:
        self.runs = 0

    async def run(self, ctx: RunHandle) -> None:
        self.runs += 1
        if self.runs < 3:
            raise ActionFailure(FailureCode.BLOCKED, "not yet")


fail_twice = action(FailTwice)


@action
async def tell_oddly(ctx: RunHandle) -> Outcome:
    """Tell what JSON has no form for."""
    ctx.progress(math.nan, "no number")
    await asyncio.sleep(0)
    return Outcome(facts={5: "five", "half \ud800": 1})  # type: ignore[dict-item]


@action
async def answer_in_words(ctx: RunHandle) -> Outcome:
    """Say no, but not as a truth value."""
    return Outcome("no")  # type: ignore[arg-type]


@action
async def answer_in_bits(ctx: RunHandle) -> Outcome:
    """Say no as array libraries do."""
    return Outcome(numpy.bool_(False))  # type: ignore[arg-type]


def lone(name: str) -> dict[str, object]:
    return {"name": name, "instance_id": 0, "type": "sync"}


async def test_an_error_that_cannot_say_why_ends_its_node_all_the_same() -> None:
    watched = Watched(chain("g", [lone("FailWithoutWords")]), catalogue=Catalogue([fail_without_words.spec]))
    watched.run.start()
    assert await watched.run.wait() is Result.ON_ERROR
    assert "Speechless" in watched.log("FailWithoutWords_0")[-1]


@pytest.mark.parametrize("through", ["itself", "a bypassed node"])
async def test_a_node_that_failed_is_tried_again_when_its_error_comes_back_to_it(through: str) -> None:
    other = "FailTwice" if through == "itself" else "NoOp"
    again = {
        "name": other,
        "instance_id": 0,
        "required": False,
        "conditions": ["on_error -> run", "on_true -> ignore"],
    }
    flaky = lone("FailTwice") | {"parents": [again], "children": [{"name": other, "instance_id": 0}]}
    back = {"name": "FailTwice", "instance_id": 0}
    between = lone("NoOp") | {"parents": [back | {"conditions": ["on_true -> ignore"]}], "children": [back]}
    graph = {
        "graph_name": "g",
        "graph_entry": [back],
        "graph_exit": [back | {"conditions": ["on_error -> ignore"]}],
        "actions": [flaky] if through == "itself" else [flaky, between],
    }
    watched = Watched(graph, catalogue=Catalogue([fail_twice.spec, no_op.spec]))
    watched.run.start()
    assert await watched.run.wait() is Result.ON_TRUE
    assert watched.runs() == ["FailTwice_0"] * 3


async def test_what_follows_a_node_that_an_edge_paused_waits_for_the_resume_though_the_node_ends() -> None:
    first, held, last = node("NoOp"), node("Insist", seconds=0.01), node("NoOp", 1)
    pausing = {"name": "NoOp", "instance_id": 0, "required": False, "conditions": ["on_true -> pause"]}
    graph = chain("g", [held, last]) | {
        "graph_entry": [{"name": "NoOp", "instance_id": 0}, {"name": "Insist", "instance_id": 0}]
    }
    graph["actions"][0]["parents"] = [pausing]
    graph["actions"].append(first | {"children": [{"name": "Insist", "instance_id": 0}]})
    watched = Watched(graph)
    watched.run.start()
    await until(lambda: watched.run.state is not GraphState.RUNNING)
    assert watched.run.state is GraphState.PAUSED
    assert watched.states("Insist_0") == ["RUNNING", "PAUSE_REQUESTED", "FINISHED"]
    assert "NoOp_1" not in watched.runs()
    watched.run.resume()
    assert await watched.run.wait() is Result.ON_TRUE
    assert watched.runs()[-1] == "NoOp_1"


async def test_facts_without_a_name_and_progress_that_is_no_number_lose_no_transition() -> None:
    watched = Watched(chain("g", [lone("TellOddly")]), catalogue=Catalogue([tell_oddly.spec]))
    watched.run.start()
    assert await watched.run.wait() is Result.ON_TRUE
    events = [
        decode(GraphEvent, to_string_unchecked(event_fields("A", "g", each)).data) for each in watched.told
    ]
    assert [event.sequence for event in events] == list(range(len(events)))
    (end,) = [event for event in events if event.result and event.node]
    assert set(end.outputs) == {"5", "half ?"}


@pytest.mark.parametrize(("name", "result"), [("AnswerInWords", "on_error"), ("AnswerInBits", "on_false")])
async def test_a_result_that_is_neither_true_nor_false_is_a_failure(name: str, result: str) -> None:
    watched = Watched(
        chain("g", [lone(name)]), catalogue=Catalogue([answer_in_words.spec, answer_in_bits.spec])
    )
    watched.run.start()
    await watched.run.wait()
    assert [told.result for told in watched.told if told.node and told.result] == [result]


async def test_a_running_node_is_seen_and_heard_also_after_the_graph_was_modified() -> None:
    gate = asyncio.Event()

    @action
    async def talk(ctx: RunHandle) -> None:
        """Say a line when it is time."""
        await gate.wait()
        ctx.log("a line")
        await asyncio.sleep(60)

    graph = chain("g", [lone("Talk"), node("NoOp")])
    watched = Watched(graph, catalogue=Catalogue([talk.spec, no_op.spec]))
    watched.run.start()
    await asyncio.sleep(0)
    assert watched.log("Talk_0") == []
    watched.run.modify(read_graph(chain("g", [lone("Talk"), node("NoOp"), node("NoOp", 1)])))
    assert watched.log("Talk_0") == []
    gate.set()
    await until(lambda: watched.log("Talk_0") == ["a line"])
    await watched.run.close()


async def test_a_node_that_runs_is_the_same_after_a_modify() -> None:
    gate = asyncio.Event()
    handles: dict[str, Any] = {}

    @action
    async def talk(ctx: RunHandle) -> None:
        """Say a line when it is time."""
        handles[ctx.node] = ctx
        await gate.wait()
        ctx.log("a line")

    graph = chain("g", [lone("Talk"), node("NoOp")])
    watched = Watched(graph, catalogue=Catalogue([talk.spec, no_op.spec]))
    watched.run.start()
    await until(lambda: handles)
    before = handles["Talk_0"].item
    for count in range(1, 4):
        names = ["Talk_0", *(f"NoOp_{index}" for index in range(count))]
        longer = [lone("Talk"), *(node("NoOp", index) for index in range(count))]
        watched.run.modify(read_graph(chain("g", longer)))
        assert handles["Talk_0"].item is before
    gate.set()
    assert await watched.run.wait() is Result.ON_TRUE
    assert (before.state, [line.message for line in before.log]) == (NodeState.FINISHED, ["a line"])
    assert [item.full_name for item in watched.run.snapshot().nodes] == names


@pytest.mark.spec("11.5")
async def test_what_was_taken_out_of_a_graph_may_still_log() -> None:
    released = threading.Event()
    begun: list[RunHandle] = []

    @action
    def hang(ctx: RunHandle) -> None:
        """Hear nothing."""
        begun.append(ctx)
        released.wait(5)
        ctx.log("late")

    graph = planner_chain("g", [lone("Hang"), node("NoOp")])
    watched = Watched(graph, catalogue=Catalogue([hang.spec, no_op.spec]), stop_timeout_s=0.01)
    watched.run.start()
    await until(lambda: begun)
    watched.run.end_node("Hang_0")
    await until(lambda: watched.state("Hang_0") is NodeState.ERROR)
    watched.run.modify(read_graph(planner_chain("g", [node("NoOp")])))
    assert watched.state("NoOp_0") is NodeState.UNINITIALIZED
    released.set()
    await until(lambda: watched.run.idle)
    assert [item.full_name for item in watched.run.snapshot().nodes] == ["NoOp_0"]


async def test_a_sub_graph_stands_still_when_paused_also_after_the_graph_was_modified() -> None:
    inner = read_graph(chain("Inner", [node("Insist", seconds=0.01), node("NoOp")]))
    catalogue = Catalogue([insist.spec, no_op.spec], [inner])
    watched = Watched(chain("g", [lone("Inner"), node("NoOp")]), catalogue=catalogue)
    watched.run.start()
    await asyncio.sleep(0)
    watched.run.modify(read_graph(chain("g", [lone("Inner"), node("NoOp"), node("NoOp", 1)])))
    watched.run.pause()
    await until(lambda: watched.run.state is GraphState.PAUSED)
    assert watched.state("Inner_0") is NodeState.PAUSED
    watched.run.resume()
    assert await watched.run.wait() is Result.ON_TRUE
