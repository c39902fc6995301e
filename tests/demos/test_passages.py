"""A narrow doorway that only one robot may be in: three robots drive through it in both directions."""

from __future__ import annotations

import asyncio
import contextlib
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager

import pytest

from parley.config import SystemConfig
from parley.messages import topics
from parley.messages.passages import PassageList
from parley.messages.wire import decode
from parley.sim.world_file import WorldFile
from parley.system import System
from tests.demos.house import PATIENCE_S, House, running

WORLD = """
name: two halls
walls:
  - {from: [0, 0], to: [12, 0]}
  - {from: [12, 0], to: [12, 6]}
  - {from: [12, 6], to: [0, 6]}
  - {from: [0, 6], to: [0, 0]}
  - {from: [6, 0], to: [6, 6], doorways: [{at_m: 3.0, width_m: 1.0}]}
areas:
  - {name: passage, corners: [[5.5, 2.4], [6.5, 2.4], [6.5, 3.6], [5.5, 3.6]], capacity: 1}
things:
  - &box
    name: lamp_1
    class: lamp
    description: lamp
    pose: [11.5, 5.4, 0]
    parts: [{size_m: [0.4, 0.4, 0.8], colour: red}]
  - {<<: *box, name: desk_1, class: desk, description: desk, pose: [11.4, 0.6, 0]}
  - {<<: *box, name: shelf_1, class: shelf, description: shelf, pose: [0.5, 5.3, 0]}
robots:
  - {name: Ada, model: turtlebot3_waffle, pose: [3.4, 3.0, 0.0]}
  - {name: Kim, model: turtlebot3_waffle, pose: [3.4, 4.4, 0.0]}
  - {name: Lee, model: turtlebot3_waffle, pose: [8.6, 3.2, 3.14]}
"""
LIFT = "name: elevator, corners: [[9.6, 4.0], [12, 4.0], [12, 6.0], [9.6, 6.0]]"
ROBOTS = ("Ada", "Kim", "Lee")


@asynccontextmanager
async def halls(
    speed: float | None = None, world: str = WORLD
) -> AsyncIterator[tuple[House, list[PassageList]]]:
    """The halls, and who was told to be in the passage; nobody may ever meet there."""
    system = System(WorldFile.parse(world), SystemConfig(speed=speed))
    (passage,) = system.objects.areas
    seen: list[PassageList] = []
    most = 0

    async def watch() -> None:
        nonlocal most
        while True:
            poses = [(robot.pose(), robot.radius_m) for robot in system.robots.values()]
            most = max(most, sum(passage.gap_m(pose.x_m, pose.y_m) < r for pose, r in poses))
            await asyncio.sleep(0.002)

    async with running(system) as home:
        await system.transport.subscribe(
            topics.PASSAGES, lambda message: seen.append(decode(PassageList, message.data))
        )
        watching = asyncio.create_task(watch())
        try:
            yield home, seen
        finally:
            watching.cancel()
            with contextlib.suppress(asyncio.CancelledError):
                await watching
    assert most == 1


async def test_robots_go_through_a_narrow_doorway_one_after_the_other() -> None:
    async with halls() as (home, seen):
        for robot, place in zip(ROBOTS, ("lamp", "desk", "shelf"), strict=True):
            await home.say(f"go to the {place}", robot)
        for robot, thing in zip(ROBOTS, ("lamp_1", "desk_1", "shelf_1"), strict=True):
            assert set(await home.done(robot)) == {"finished"}
            assert home.distance_m(thing, robot) < 1.0
        assert all(len(place.robots) <= 1 for told in seen for place in told.places)
        waited = {robot for told in seen for place in told.places for robot in place.waiting}
        assert waited
        told = [said.message for said in home.observer.said if "waiting before “passage”" in said.message]
        assert told
        assert len(told) <= 6  # said once for each that goes first


@pytest.mark.soak
async def test_who_is_stopped_in_the_doorway_is_waited_for_and_who_waits_can_be_stopped() -> None:
    async with halls(speed=4) as (home, _):  # a moment in the doorway is to be seen
        await home.say("go to the lamp", "Ada")
        await home.observer.until(lambda: _in_passage(home, "Ada"), timeout_s=PATIENCE_S)
        await home.say("stop", "Ada")
        await home.state("paused", "Ada")
        await home.say("go to the desk", "Kim")
        await home.observer.until(lambda: _waits(home, "Kim"), timeout_s=PATIENCE_S)
        await home.say("stop", "Kim")
        await home.state("paused", "Kim")
        await home.say("carry on", "Ada")
        assert set(await home.done("Ada")) == {"finished"}
        await home.say("carry on", "Kim")
        assert set(await home.done("Kim")) == {"finished"}


async def test_who_stands_in_the_doorway_and_is_seen_from_afar_is_waited_for_and_not_given_up() -> None:
    async with halls() as (home, _):
        await home.say("go to the passage", "Lee")
        assert set(await home.done("Lee")) == {"finished"}
        await home.say("go to the shelf", "Kim")
        assert set(await home.done("Kim")) == {"finished"}  # where it sees Lee from
        await home.say("go to the lamp", "Kim")
        await home.observer.until(lambda: _waits(home, "Kim"), timeout_s=PATIENCE_S)
        await home.say("go to the desk", "Lee")
        assert set(await home.done("Kim")) == {"finished"}
        assert home.distance_m("lamp_1", "Kim") < 1.0


async def test_an_elevator_holds_one_and_who_waits_for_it_says_so_when_asked() -> None:
    world = WORLD.replace("name: passage, corners: [[5.5, 2.4], [6.5, 2.4], [6.5, 3.6], [5.5, 3.6]]", LIFT)
    # At full speed it would have waited too long before it is asked.
    async with halls(10.0, world) as (home, _):
        await home.say("go to the elevator", "Lee")
        assert set(await home.done("Lee")) == {"finished"}
        await home.say("go to the elevator", "Kim")
        await home.observer.until(
            lambda: any("waiting before" in event.progress_text for event in home.observer.events),
            timeout_s=PATIENCE_S,
        )
        for question in ("what are you doing?", "how long will it take?"):
            told = (await home.say(question, "Kim")).message
            assert told.endswith("I am waiting before “elevator”: Lee goes first.")
        await home.say("go to the desk", "Lee")
        assert set(await home.done("Kim")) == {"finished"}
        assert _in_passage(home, "Kim")


async def test_who_waited_in_vain_is_told_when_the_place_is_free() -> None:
    world = WORLD.replace("name: passage, corners: [[5.5, 2.4], [6.5, 2.4], [6.5, 3.6], [5.5, 3.6]]", LIFT)
    async with halls(None, world) as (home, _):
        await home.say("go to the elevator", "Lee")
        assert set(await home.done("Lee")) == {"finished"}
        await home.say("go to the elevator", "Kim")
        assert "Lee is still in it" in (await home.question("Kim")).message
        home.observer.say("Lee, go to the desk", "Kim")  # who asks passes it on, and it need not wait
        told = "“elevator” is free now. Say “try again” and I go on."
        await home.observer.until(
            lambda: [said.message for said in home.observer.said if "Kim" in said.targets].count(told) == 1,
            timeout_s=PATIENCE_S,
        )
        assert not any("afterwards" in said.message for said in home.observer.said)
        await home.say("try again", "Kim")
        assert set(await home.done("Kim")) == {"finished"}
        assert _in_passage(home, "Kim")


def _in_passage(home: House, robot: str) -> bool:
    (passage,) = home.system.objects.areas
    pose = home.system.robots[robot].pose()
    return passage.holds(pose.x_m, pose.y_m)


def _waits(home: House, robot: str) -> bool:
    return any(robot in said.targets and "waiting before" in said.message for said in home.observer.said)
