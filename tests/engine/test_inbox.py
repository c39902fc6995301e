"""Commands keep their order, and a heavy one does not keep the loop."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Generator

import pytest

from parley.engine import inbox as room
from parley.engine.inbox import Inbox, Work
from tests.umrf.spec_actions import chain, node

from .rig import rigged


def steps(done: list[str], name: str, count: int = 1) -> Work:
    def work() -> Generator[None, None, None]:
        for index in range(count):
            done.append(f"{name}{index}")
            if index < count - 1:
                yield

    return work


async def turns(until: Callable[[], bool]) -> int:
    count = 0
    while not until():
        await asyncio.sleep(0)
        count += 1
    return count


async def test_heavy_work_is_done_in_slices_and_each_turn_of_the_loop_does_as_many_as_it_has_time_for(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    done: list[str] = []
    inbox = Inbox()
    for index in range(50):
        inbox.put("g", steps(done, f"{index}_"))
    assert await turns(lambda: len(done) == 50) < 25
    monkeypatch.setattr(room, "TURN_S", 0.0)
    done.clear()
    inbox = Inbox()
    inbox.put("g", steps(done, "a", 3))
    inbox.put("h", steps(done, "b", 2))
    assert done == ["a0"]
    assert await turns(lambda: len(done) == 5) >= 4
    assert done == ["a0", "a1", "a2", "b0", "b1"]


async def test_a_light_command_overtakes_those_for_other_graphs_only(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(room, "TURN_S", 0.0)
    done: list[str] = []
    inbox = Inbox()
    inbox.put("g", steps(done, "start_g", 2))
    inbox.put("h", steps(done, "start_h"))
    inbox.put("h", steps(done, "stop_h"), light=True)
    inbox.put("i", steps(done, "stop_i"), light=True)
    assert done == ["start_g0", "stop_i0"]
    await turns(lambda: len(done) == 5)
    assert done[2:] == ["start_g1", "start_h0", "stop_h0"]
    inbox.put("h", steps(done, "pause_h"), light=True)
    assert done[-1] == "pause_h0", "nothing waits any more"


async def test_what_waits_is_dropped_at_the_end(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(room, "TURN_S", 0.0)
    done: list[str] = []
    inbox = Inbox()
    inbox.put("g", steps(done, "a", 2))
    inbox.close()
    await asyncio.sleep(0)
    await asyncio.sleep(0)
    assert done == ["a0"]


async def test_a_defect_in_one_command_does_not_silence_the_next() -> None:
    def broken() -> Generator[None, None, None]:
        raise RuntimeError("a defect")
        yield

    done: list[str] = []
    inbox = Inbox()
    inbox.put("g", broken)
    inbox.put("g", steps(done, "a"))
    await turns(lambda: done == ["a0"])


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
