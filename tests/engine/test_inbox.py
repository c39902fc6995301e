"""Commands keep their order, and a heavy one does not keep the loop."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from functools import partial

import pytest

from parley.engine import inbox as room
from parley.engine.inbox import Inbox
from tests.umrf.spec_actions import chain, node

from .rig import rigged


async def turns(until: Callable[[], bool]) -> int:
    count = 0
    while not until():
        await asyncio.sleep(0)
        count += 1
    return count


async def test_each_turn_of_the_loop_does_as_many_as_it_has_time_for(monkeypatch: pytest.MonkeyPatch) -> None:
    done: list[str] = []
    inbox = Inbox()
    for _ in range(50):
        inbox.put("g", lambda: done.append("a"))
    assert await turns(lambda: len(done) == 50) < 25
    monkeypatch.setattr(room, "TURN_S", 0.0)
    done.clear()
    inbox = Inbox()
    for name in "abc":
        inbox.put("g", partial(done.append, name))
    assert done == ["a"]
    assert await turns(lambda: len(done) == 3) >= 2
    assert done == ["a", "b", "c"]


async def test_a_light_command_overtakes_those_for_other_graphs_only(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(room, "TURN_S", 0.0)
    done: list[str] = []
    inbox = Inbox()
    inbox.put("g", partial(done.append, "start_g"))
    inbox.put("h", partial(done.append, "start_h"))
    inbox.put("h", partial(done.append, "stop_h"), light=True)
    inbox.put("i", partial(done.append, "stop_i"), light=True)
    assert done == ["start_g", "stop_i"]
    await turns(lambda: len(done) == 4)
    assert done[2:] == ["start_h", "stop_h"]
    inbox.put("h", partial(done.append, "pause_h"), light=True)
    assert done[-1] == "pause_h", "nothing waits any more"


async def test_what_waits_is_dropped_at_the_end(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(room, "TURN_S", 0.0)
    done: list[str] = []
    inbox = Inbox()
    inbox.put("g", partial(done.append, "a"))
    inbox.put("g", partial(done.append, "b"))
    inbox.close()
    await asyncio.sleep(0)
    await asyncio.sleep(0)
    assert done == ["a"]


async def test_a_defect_in_one_command_does_not_silence_the_next() -> None:
    def broken() -> None:
        raise RuntimeError("a defect")

    done: list[str] = []
    inbox = Inbox()
    inbox.put("g", broken)
    inbox.put("g", partial(done.append, "a"))
    await turns(lambda: done == ["a"])


@pytest.mark.spec("W3", "11.2")
async def test_a_graph_is_stopped_although_a_hundred_others_are_only_starting() -> None:
    async with rigged() as rig:
        rig.start(chain("g", [node("WaitFor", 0, seconds=60)]))
        await rig.until_graph("g", "RUNNING")
        for index in range(100):
            rig.start(chain(f"other{index}", [node("NoOp", number) for number in range(10)]))
        rig.stop("g")
        await rig.until_graph("g", "STOPPED")
        begun = {item.graph_name for item in rig.events if item.kind == "graph"} - {"g"}
        assert len(begun) < 100
        await rig.until(lambda: all(rig.graph_states(f"other{index}") for index in range(100)))


async def test_a_stop_right_behind_the_start_of_a_large_graph_stops_it() -> None:
    async with rigged() as rig:
        rig.start(chain("g", [node("WaitFor", number, seconds=60) for number in range(300)]))
        rig.stop("g")
        await rig.until_graph("g", "STOPPED")
        assert rig.rejections == []
