"""Defects of the reference that are about moments: none of them may come back."""

from __future__ import annotations

import asyncio
import json
from dataclasses import dataclass
from typing import Any

import pytest

from parley.clock import WallClock
from parley.engine.runs import KEPT_HALTED
from parley.messages import ros, topics
from parley.umrf.action import RunHandle, action
from parley.umrf.catalogue import Catalogue
from parley.umrf.executor import GraphRun
from parley.umrf.io import read_graph
from parley.umrf.model import GraphState, Result
from tests.umrf.spec_actions import chain, node, planner_chain
from tests.umrf.watched import Watched

from .rig import rigged


@pytest.mark.spec("D15")
async def test_a_halted_graph_goes_on_from_an_action_that_ends_at_once() -> None:
    for _ in range(50):
        watched = Watched(planner_chain("g", [node("Fail", 0, reason="door"), node("NoOp", 1)]))
        watched.run.start()
        assert await watched.run.wait() is Result.ON_HALTED
        fixed = planner_chain("g", [node("NoOp", 2), node("NoOp", 1)])
        watched.run.modify(read_graph(fixed), "NoOp_2")
        async with asyncio.timeout(5):
            await watched.run.wait()
        assert watched.runs() == ["Fail_0", "NoOp_2", "NoOp_1"]


@dataclass(frozen=True)
class Three:
    a: str
    m: str
    z: str


@action
async def give_three(ctx: RunHandle) -> Three:
    """Give three texts."""
    return Three("A", "M", "Z")


@action
async def take_three(ctx: RunHandle, zz: str, m: str, z: str) -> bool:
    """Check three texts."""
    return (zz, m, z) == ("A", "M", "Z")


@pytest.mark.spec("D20")
async def test_a_remap_among_several_outputs_is_found_again() -> None:
    texts = {"pvf_type": "string"}
    graph = {
        "graph_name": "g", "graph_entry": [{"name": "GiveThree"}], "graph_exit": [{"name": "TakeThree"}],
        "actions": [
            {"name": "GiveThree", "type": "sync", "output_parameters": dict.fromkeys("amz", texts),
             "children": [{"name": "TakeThree", "remap": [{"from": "a", "to": "zz"}]}]},
            {"name": "TakeThree", "type": "sync",
             "input_parameters": dict.fromkeys(("zz", "m", "z"), texts), "parents": [{"name": "GiveThree"}]},
        ],
    }  # fmt: skip
    run = GraphRun(
        read_graph(graph), Catalogue([give_three.spec, take_three.spec]), actor="A", clock=WallClock(),
        make_context=lambda handle: handle,
    )  # fmt: skip
    run.start()
    assert await run.wait() is Result.ON_TRUE


@pytest.mark.spec("D21")
@pytest.mark.parametrize("name", ["WaitFor", "ThreadLoop"])
async def test_what_was_stopped_once_runs_again(name: str) -> None:
    values = {"seconds": 60.0} if name == "WaitFor" else {}
    watched = Watched(planner_chain("g", [node(name, 0, **values)]))
    for _ in range(2):
        if watched.run.state is GraphState.HALTED:
            watched.run.resume(f"{name}_0")
        else:
            watched.run.start()
        await asyncio.sleep(0.05)
        assert watched.state(f"{name}_0") == "RUNNING"
        watched.run.end_node(f"{name}_0")
        await watched.run.wait()
    assert watched.states(f"{name}_0") == ["RUNNING", "STOPPING", "FINISHED"] * 2


@pytest.mark.spec("D22")
@pytest.mark.parametrize("state", ["FINISHED", "RUNNING", "ERROR", "PAUSED"])
async def test_a_published_graph_can_be_started_again(state: str) -> None:
    graph = chain("g", [node("NoOp", 0), node("NoOp", 1)])
    graph["graph_state"] = "RUNNING"
    graph["actions"][0]["state"] = state
    watched = Watched(graph)
    watched.run.start()
    assert await watched.run.wait() is Result.ON_TRUE
    assert watched.runs() == ["NoOp_0", "NoOp_1"]


@pytest.mark.spec("D24")
async def test_everybody_who_waits_hears_the_end_also_afterwards() -> None:
    watched = Watched(chain("g", [node("WaitFor", 0, seconds=0.01)]))
    early = [asyncio.create_task(watched.run.wait()) for _ in range(3)]
    watched.run.start()
    assert await asyncio.gather(*early) == [Result.ON_TRUE] * 3
    assert await watched.run.wait() is Result.ON_TRUE


@pytest.mark.spec("D29")
@pytest.mark.parametrize("name", ["NoOp", "InThread"])
async def test_a_stop_at_the_moment_of_an_end_takes_no_time(name: str) -> None:
    values = {"text": "a"} if name == "InThread" else {}
    for turns in range(30):
        watched = Watched(chain("g", [node(name, 0, **values)]))
        watched.run.start()
        for _ in range(turns % 10):
            await asyncio.sleep(0)
        watched.run.stop()
        async with asyncio.timeout(2):
            await watched.run.wait()
        assert watched.run.state in (GraphState.STOPPED, GraphState.FINISHED)


@pytest.mark.spec("W3", "W5")
async def test_a_burst_of_commands_is_carried_out_whole() -> None:
    async with rigged() as rig:
        before = len(asyncio.all_tasks())
        for index in range(50):
            rig.start(chain(f"g{index}", [node("NoOp", 0)]))
        await rig.until(lambda: sum(item.state == "FINISHED" and not item.node for item in rig.events) == 50)
        assert rig.rejections == []
        await asyncio.sleep(0.05)
        assert len(asyncio.all_tasks()) <= before


async def test_an_engine_does_not_keep_every_graph_that_ran_dry() -> None:
    async with rigged() as rig:
        for index in range(KEPT_HALTED + 30):
            rig.start(planner_chain(f"g{index}", [node("NoOp", 0)]))
        last = f"g{KEPT_HALTED + 29}"
        await rig.until_graph(last, "HALTED")
        rig.start(planner_chain("newest", [node("NoOp", 0)]))
        await rig.until(lambda: rig.statuses and rig.statuses[-1].graphs.get("newest") == "HALTED")
        assert len(rig.statuses[-1].graphs) <= KEPT_HALTED + 1
        assert last in rig.statuses[-1].graphs


@pytest.mark.spec("W6")
async def test_error_texts_are_told_as_they_are() -> None:
    text = "%s%n{0}\\x"
    graph: dict[str, Any] = {"graph_name": text, "actions": [{"name": text, "type": "sync"}]}
    async with rigged() as rig:
        start = rig.transport.publisher(topics.GRAPH_START)
        start.publish(ros.UmrfGraphStart("", json.dumps(graph), ("A",)))
        await rig.until(lambda: rig.rejections)
    assert rig.rejections[0].graph_name == text
    assert text in rig.rejections[0].problems[0].message.replace("\\\\", "\\")
