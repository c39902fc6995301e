"""Spontaneous nodes: rounds until they are stopped, each ending what the one before set off (10.7)."""

from __future__ import annotations

import asyncio
from typing import Any

import pytest

from parley.clock import SimClock
from parley.errors import GraphRefusedError
from parley.umrf.executor import GraphRun
from parley.umrf.io import read_graph
from parley.umrf.model import GraphState, NodeState, Result
from parley.umrf.node_run import ROUND_S
from parley.umrf.transition import Transition

from .spec_actions import CATALOGUE, node
from .watched import Watched, until

LONG = 60.0


def ref(item: dict[str, Any], **more: Any) -> dict[str, Any]:
    return {"name": item["name"], "instance_id": item["instance_id"]} | more


def monitor(trigger: dict[str, Any], reaction: dict[str, Any], **graph: Any) -> dict[str, Any]:
    """`trigger` is spontaneous and sets off `reaction`."""
    trigger = trigger | {"type": "spontaneous", "children": [ref(reaction)]}
    reaction = reaction | {"parents": [ref(trigger)]}
    return {
        "graph_name": "g",
        "graph_entry": [ref(trigger)],
        "graph_exit": [],
        "actions": [trigger, reaction],
    } | graph


@pytest.mark.spec("10.7", "10.7-better", "10.4")
async def test_each_round_stops_what_the_last_one_set_off() -> None:
    watched = Watched(monitor(node("WaitFor", 0, seconds=0.005), node("WaitFor", 1, seconds=LONG)))
    watched.run.start()
    await until(lambda: watched.runs().count("WaitFor_1") == 3)
    assert watched.states("WaitFor_1")[:7] == [
        *("RUNNING", "STOPPING", "FINISHED") * 2,
        "RUNNING",
    ]
    assert watched.states("WaitFor_0")[:5] == ["RUNNING", "FINISHED", "RUNNING", "FINISHED", "RUNNING"]
    watched.run.stop()
    assert await watched.run.wait() is Result.ON_STOPPED
    assert watched.run.state is GraphState.STOPPED
    await watched.run.close()


@pytest.mark.spec("10.7-better")
async def test_the_end_of_the_graph_ends_it() -> None:
    """Better 10.7: on the reference it loops until the engine clears the graph."""
    counter = node("CountTo", 1, limit=3)
    graph = monitor(node("WaitFor", 0, seconds=0.001), counter)
    graph["graph_exit"] = [ref(counter, conditions=["on_false -> ignore"])]
    watched = Watched(graph)
    watched.run.start()
    assert await watched.run.wait() is Result.ON_TRUE
    await until(lambda: watched.run.idle)
    assert watched.states("WaitFor_0")[-3:] == ["RUNNING", "STOPPING", "FINISHED"]
    assert watched.runs().count("CountTo_1") == 3


@pytest.mark.spec("D37", "10.7-better")
async def test_an_error_ends_it_once_and_for_all() -> None:
    """D37: the reference sets it FINISHED and runs it again, an endless loop of errors."""
    reaction = node("NoOp", 1)
    graph = monitor(node("Crash", 0), reaction)
    graph["actions"][1]["parents"] = [ref(graph["actions"][0], conditions=["on_error -> run"])]
    watched = Watched(graph)
    watched.run.start()
    assert await watched.run.wait() is Result.ON_HALTED
    assert watched.states("Crash_0") == ["RUNNING", "ERROR"]
    assert watched.states("NoOp_1") == ["RUNNING", "FINISHED"], "the error is passed on"


@pytest.mark.spec("D31")
async def test_a_cycle_behind_it_is_walked_once() -> None:
    """D31: collecting the descendants of a spontaneous node in a cycle recursed without end."""
    tick, first = node("WaitFor", 0, seconds=0.005), node("WaitFor", 1, seconds=LONG)
    second = node("WaitFor", 2, seconds=LONG)
    graph = monitor(tick, first)
    tick, first = graph["actions"]
    back = ref(second, required=False)
    first |= {"parents": [ref(tick), back], "children": [ref(second)]}
    second |= {"parents": [ref(first)], "children": [ref(first), ref(tick)]}
    tick["parents"] = [ref(second, required=False)]
    graph["actions"].append(second)
    watched = Watched(graph)
    watched.run.start()
    await until(lambda: watched.runs().count("WaitFor_1") == 3)
    await watched.run.close()
    assert watched.run.idle


async def test_one_that_is_stopped_by_an_edge_does_not_run_again() -> None:
    tick, timer = node("WaitFor", 0, seconds=LONG) | {"type": "spontaneous"}, node("NoOp", 1)
    tick["parents"] = [ref(timer, required=False, conditions=["on_true -> stop"])]
    timer["children"] = [ref(tick)]
    graph = {
        "graph_name": "g",
        "graph_entry": [ref(tick), ref(timer)],
        "graph_exit": [],
        "actions": [tick, timer],
    }
    watched = Watched(graph)
    watched.run.start()
    assert await watched.run.wait() is Result.ON_HALTED
    assert watched.states("WaitFor_0") == ["RUNNING", "STOPPING", "FINISHED"]


async def test_a_pause_holds_the_next_round() -> None:
    watched = Watched(monitor(node("Insist", 0, seconds=0.005), node("WaitFor", 1, seconds=LONG)))
    watched.run.start()
    await until(lambda: watched.runs().count("WaitFor_1") == 1)
    watched.run.pause()
    await until(lambda: watched.run.state is GraphState.PAUSED)
    rounds = watched.states("Insist_0").count("RUNNING")
    assert watched.state("Insist_0") is NodeState.FINISHED
    assert watched.state("WaitFor_1") is NodeState.PAUSED, "the reaction is not ended by a pause"
    await asyncio.sleep(0.02)
    assert watched.states("Insist_0").count("RUNNING") == rounds
    watched.run.resume()
    await until(lambda: watched.runs().count("WaitFor_1") == 2)
    assert watched.states("Insist_0").count("RUNNING") > rounds
    await watched.run.close()


async def test_a_trigger_between_two_rounds_is_ignored() -> None:
    watched = Watched(monitor(node("NoOp", 0), node("Stubborn", 1, seconds=0.03)), stop_timeout_s=1.0)
    watched.run.start()
    await until(lambda: watched.states("Stubborn_1")[-1:] == ["STOPPING"])
    assert watched.state("NoOp_0") is NodeState.FINISHED
    watched.run.resume("NoOp_0")
    assert watched.state("NoOp_0") is NodeState.FINISHED
    await watched.run.close()
    assert watched.run.state is GraphState.STOPPED


async def test_inputs_that_came_along_an_edge_serve_every_round() -> None:
    giver, tick = node("JoinText", 0, left="a", right="b"), node("SameText", 1, expected="a-b")
    after = node("WaitFor", 2, seconds=0.002)
    giver["children"] = [ref(tick)]
    tick |= {"type": "spontaneous", "parents": [ref(giver)], "children": [ref(after)]}
    after["parents"] = [ref(tick, conditions=["on_false -> stop"])]
    graph = {
        "graph_name": "g",
        "graph_entry": [ref(giver)],
        "graph_exit": [],
        "actions": [giver, tick, after],
    }
    watched = Watched(graph)
    watched.run.start()
    await until(lambda: watched.states("SameText_1").count("FINISHED") >= 3)
    watched.run.stop()
    await watched.run.wait()
    ends = [item.result for item in watched.told if item.node == "SameText_1" and item.cause == "run"]
    assert {item for item in ends if item} == {Result.ON_TRUE}
    with pytest.raises(GraphRefusedError):
        watched.run.resume()
    await watched.run.close()


async def test_one_that_returns_at_once_is_held_to_a_hundred_rounds_a_second_of_robot_time() -> None:
    clock = SimClock()
    told: list[Transition] = []
    run = GraphRun(
        read_graph(monitor(node("NoOp", 0), node("NoOp", 1))),
        CATALOGUE,
        actor="A",
        clock=clock,
        make_context=lambda handle: handle,
        observer=told.append,
    )

    def rounds() -> int:
        return sum(item.node == "NoOp_0" and item.state == "FINISHED" for item in told)

    run.start()
    for _ in range(50):
        await asyncio.sleep(0)
    assert rounds() == 1, "the robot's time stands still"
    for number in (2, 3):
        clock.advance(ROUND_S)
        for _ in range(50):
            await asyncio.sleep(0)
        assert rounds() == number
    await run.close()
