"""Follow: behind a person who walks, at a distance, until they are lost or its time is over."""

from __future__ import annotations

import asyncio
import math
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Any

import pytest

from parley.actions.builtin import BUILTIN_ACTIONS
from parley.actions.follow import LONGEST_S, follow
from parley.errors import ActionFailure, FailureCode
from parley.gate.book import RuleBook
from parley.gate.fence import Fence
from parley.gate.judge import RobotFacts
from parley.messages.rules import Rule, RuleSet
from parley.robots.simulated import SimulatedRobot
from parley.umrf.catalogue import Catalogue
from tests.actions.room import Room, room
from tests.actions.test_navigate_to import eventually


def somebody(name: str, x: float, y: float) -> dict[str, Any]:
    part = {"shape": "cylinder", "size_m": (0.4, 0.4, 1.7), "colour": "blue"}
    unknown = {"mapped": False, "listed": False}
    return {"name": name, "class": "person", "pose": (x, y, 0.0), "parts": [part], **unknown}


KIM = {"add": [somebody("Kim", 2.4, 1.0)]}


async def walk(here: Room, name: str, *points: tuple[float, float]) -> None:
    """Let somebody walk, at half a metre each second of robot time."""
    thing = here.simulator.world.thing(name)
    x, y, _ = thing.pose
    for to_x, to_y in points:
        steps = max(1, round(math.hypot(to_x - x, to_y - y) / 0.25))
        for step in range(1, steps + 1):
            at = (x + (to_x - x) * step / steps, y + (to_y - y) * step / steps, 0.0)
            here.simulator.change({"move": {name: at}})
            await here.simulator.clock.sleep(0.5)
        x, y = to_x, to_y


def away_m(here: Room, name: str) -> float:
    x, y, _ = here.simulator.world.thing(name).pose
    pose = here.robot.pose()
    return math.hypot(pose.x_m - x, pose.y_m - y)


async def _follow(here: Room, person: str, duration: float = 0.0) -> None:
    await follow(here.context, person, duration)


async def test_it_follows_through_a_door_and_keeps_its_distance_until_its_time_is_over() -> None:
    async with room(KIM) as here:
        began_s = here.simulator.clock.now_s()
        run = asyncio.create_task(_follow(here, "Kim", 25.0))
        near: list[float] = []
        here.run.steps.clear()
        await walk(here, "Kim", (3.6, 1.0), (4.4, 1.6), (4.4, 3.2))
        near.append(away_m(here, "Kim"))
        await run
        assert here.simulator.clock.now_s() - began_s == pytest.approx(25.0, abs=3.0)
        assert here.robot.pose().x_m > 3.0
        assert 0.7 < away_m(here, "Kim") < 1.8
        assert here.robot.velocity().linear_mps == pytest.approx(0.0, abs=0.02)


async def test_me_is_the_nearest_whom_it_sees_and_stays_that_one() -> None:
    async with room({"add": [somebody("Kim", 2.4, 1.0), somebody("Ada", 2.4, 2.6)]}) as here:
        run = asyncio.create_task(_follow(here, "operator", 12.0))
        await eventually(lambda: bool(here.run.steps))
        await walk(here, "Kim", (2.4, 0.6), (3.8, 1.0))
        await run
        assert here.run.steps[-1][1].endswith("behind Kim")
        assert away_m(here, "Kim") < 1.8


async def test_somebody_out_of_sight_is_looked_for_and_then_said_to_be_lost() -> None:
    async with room({"add": [somebody("Kim", 0.4, 3.0)]}) as here:
        run = asyncio.create_task(_follow(here, "Kim"))
        await eventually(lambda: bool(here.run.steps))  # behind the robot at first: it turned round
        here.simulator.change({"remove": ["Kim"]})
        with pytest.raises(ActionFailure) as lost:
            await run
        assert lost.value.code is FailureCode.NO_MATCH
        assert lost.value.message.startswith("I have lost Kim.")


@pytest.mark.parametrize(("person", "words"), [("operator", "I do not see you"), ("Bo", "I do not see Bo")])
async def test_nobody_to_follow_is_said(person: str, words: str) -> None:
    async with room({"add": [somebody("Kim", 2.4, 1.0)]} if person == "Bo" else None) as here:
        with pytest.raises(ActionFailure) as failure:
            await follow(here.context, person)
        assert failure.value.code is FailureCode.NO_MATCH
        assert words in failure.value.message


async def test_a_pause_and_a_stop_hold_it_and_a_cancel_ends_it() -> None:
    async with room(KIM) as here:
        run = asyncio.create_task(_follow(here, "Kim"))
        await eventually(lambda: bool(here.run.steps))
        holds: list[tuple[Callable[[], None], Callable[[], None]]] = [
            (partial(setattr, here.run, "paused", True), partial(setattr, here.run, "paused", False)),
            (here.robot.halt, here.robot.release),
        ]
        for at, (hold, let_go) in enumerate(holds):
            hold()
            await here.simulator.clock.sleep(1.0)
            rests = here.robot.pose()
            here.simulator.change({"move": {"Kim": (4.4 + at, 1.0, 0.0)}})
            await here.simulator.clock.sleep(2.0)
            assert here.robot.pose().distance_to(rests) < 0.02
            let_go()
            await eventually(lambda: here.robot.pose().distance_to(rests) > 0.3)  # noqa: B023
        run.cancel()
        with pytest.raises(asyncio.CancelledError):
            await run
        await here.simulator.clock.sleep(1.0)
        assert here.robot.velocity().linear_mps == pytest.approx(0.0, abs=0.02)


async def test_it_does_not_follow_into_a_closed_zone_and_names_the_rule() -> None:
    zone = {"id": "z", "name": "store", "kind": "keep_out", "rectangle": (3.4, 0.0, 6.0, 4.0)}
    async with room(KIM) as here:
        book, model = RuleBook(here.simulator.clock), here.simulator.model("A")
        book.know("A", RobotFacts("", model.radius_m, model.max_speed_mps))
        book.replace(RuleSet(rules=(Rule.model_validate(zone),)))
        fence = Fence(book, "A", braking_mps2=model.max_acceleration_mps2)
        fenced = SimulatedRobot(here.simulator, "A", here.view.occupancy, fence)
        run = asyncio.create_task(follow(replace(here.context, robot=fenced), "Kim"))
        await walk(here, "Kim", (5.4, 1.0))
        with pytest.raises(ActionFailure) as failure:
            await run
        assert failure.value.code is FailureCode.FORBIDDEN
        assert "store" in failure.value.message
        assert here.robot.pose().x_m + here.robot.radius_m <= 3.45


@pytest.mark.parametrize("duration", [-1.0, LONGEST_S + 1])
async def test_a_time_that_is_none_or_too_long_is_refused(duration: float) -> None:
    async with room(KIM) as here:
        with pytest.raises(ActionFailure) as failure:
            await follow(here.context, "Kim", duration)
        assert failure.value.code is FailureCode.NOT_CAPABLE


def test_a_robot_that_sees_nobody_does_not_offer_it() -> None:
    catalogue = Catalogue(BUILTIN_ACTIONS)
    infos = {info.name for info in catalogue.for_robot({"drive", "lidar", "camera"}).infos()}
    assert "Say" in infos and "Follow" not in infos
    assert "Follow" in {info.name for info in catalogue.for_robot({"drive", "lidar", "sees_people"}).infos()}
