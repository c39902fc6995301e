"""What happens in a world by itself: at its time, on its condition, once, and the same for the same seed."""

from __future__ import annotations

import asyncio
from typing import Any

import pytest
import yaml

from parley.clock import SimClock
from parley.errors import FileFormatError
from parley.sim.events import Events, WorldEvent
from parley.sim.simulator import Simulator
from parley.sim.world_file import WorldFile
from parley.world.geometry import Pose2D
from tests.sim.worlds import TWO_ROOMS, box

ADDED = {"add": [box("parcel", 1.0, 3.0)]}


def world(*events: dict[str, Any]) -> WorldFile:
    return WorldFile.parse(TWO_ROOMS + yaml.safe_dump({"events": list(events)}, sort_keys=False))


async def happened(world: WorldFile, count: int, speed: float | None = None) -> list[tuple[str, float]]:
    """The first events with their times, while nobody does anything."""
    clock, seen, enough = SimClock(), list[tuple[str, float]](), asyncio.Event()

    def note(event: WorldEvent) -> None:
        seen.append((event.name, round(clock.now_s(), 2)))
        if len(seen) == count:
            enough.set()

    async with Simulator(world, clock=clock, speed=speed) as simulator:
        simulator.on_event = note
        await enough.wait()
        assert [thing.name for thing in simulator.world.things] == ["crate_1"]
    return seen


async def test_it_happens_at_its_time_and_one_after_the_other_while_nobody_waits() -> None:
    comes = {"name": "comes", "at_s": 20, "change": ADDED}
    goes = {"name": "goes", "after": "comes", "delay_s": 30, "change": {"remove": ["parcel"]}}
    assert await happened(world(comes, goes), 2) == [("comes", 20.0), ("goes", 50.0)]


def test_it_happens_when_a_robot_comes_near_and_never_twice() -> None:
    (event,) = world({"name": "e", "near": {"thing": "crate_1", "within_m": 2}, "change": ADDED}).events
    events, crate = Events([event]), Pose2D(5.2, 2.0)
    assert events.due(1.0, {"A": Pose2D(1.0, 1.0)}, lambda _: crate) == []
    assert events.due(2.0, {"A": Pose2D(4.0, 2.0)}, lambda _: None) == []
    assert events.due(3.0, {"A": Pose2D(4.0, 2.0)}, lambda _: crate) == [event]
    assert events.due(4.0, {"A": Pose2D(4.0, 2.0)}, lambda _: crate) == []


def test_who_only_passes_does_not_count_where_a_robot_has_to_stand() -> None:
    near = {"thing": "crate_1", "within_m": 2, "stands_s": 5}
    (event,) = world({"name": "e", "near": near, "change": ADDED}).events
    events, crate = Events([event]), Pose2D(5.2, 2.0)
    for second in range(20):
        assert events.due(float(second), {"A": Pose2D(3.5 + second / 10, 2.0)}, lambda _: crate) == []
    here = {"A": Pose2D(5.4, 2.0)}
    times = [second for second in range(20, 30) if events.due(float(second), here, lambda _: crate)]
    assert times == [24]


def test_a_range_of_times_is_drawn_by_the_seed() -> None:
    (event,) = world({"name": "e", "at_s": [10, 60], "change": ADDED}).events
    times = []
    for seed in (1, 1, 2):
        events = Events([event], seed)
        times.append(next(t for t in range(100) if events.due(float(t), {}, lambda _: None)))
    assert times[0] == times[1] != times[2]
    assert 10 <= min(times) <= max(times) <= 61


async def test_time_of_an_idle_world_goes_on_at_its_pace() -> None:
    clock = SimClock()
    async with Simulator(world(), clock=clock, speed=500):
        while clock.now_s() < 1.0:  # noqa: ASYNC110 - nothing happens that could be waited for
            await asyncio.sleep(0)


@pytest.mark.parametrize(
    ("event", "where"),
    [
        ({"name": "e", "change": ADDED}, "events[0]"),
        ({"name": "e", "at_s": 1, "after": "e", "change": ADDED}, "events[0]"),
        ({"name": "e", "after": "nothing", "change": ADDED}, "events[0].after"),
        ({"name": "e", "near": {"thing": "box", "within_m": 1}, "change": ADDED}, "events[0].near.thing"),
        ({"name": "e", "at_s": 1, "change": {"remove": ["box"]}}, "events[0].change"),
    ],
)
def test_what_cannot_happen_is_refused_with_its_place(event: dict[str, Any], where: str) -> None:
    with pytest.raises(FileFormatError) as refused:
        world(event)
    assert where in str(refused.value)
