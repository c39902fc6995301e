"""NavigateTo: drives, tells how far it is, stands still while paused, and says what is in the way."""

from __future__ import annotations

import asyncio
from collections.abc import Callable

import pytest

from parley.actions.context import ActionContext
from parley.actions.navigate_to import navigate_to
from parley.actions.pose import Orientation, Pose, Position
from parley.errors import ActionFailure, FailureCode
from tests.actions.room import room
from tests.sim.worlds import box

GOAL = Pose(Position(4.5, 3.0), Orientation(y=1.0))
DOORS = {"add": [box("box_n", 3.0, 3.0), box("box_s", 3.0, 1.0)]}


async def eventually(condition: Callable[[], bool]) -> None:
    async with asyncio.timeout(10):
        while not condition():  # noqa: ASYNC110 - a position is awaited, not an event
            await asyncio.sleep(0)


async def test_it_arrives_and_tells_where_it_ended() -> None:
    async with room() as here:
        outcome = await navigate_to(here.context, GOAL)
        assert outcome.facts["pose"].planar() == here.robot.pose()
        assert here.robot.pose().distance_to(GOAL.planar()) < 0.1


async def test_progress_rises_from_nothing_to_nearly_all_and_names_the_metres() -> None:
    async with room() as here:
        await navigate_to(here.context, GOAL)
        fractions = [fraction for fraction, _ in here.run.steps if fraction is not None]
        assert fractions[0] < 0.2
        assert fractions[-1] > 0.8
        assert all(0.0 <= fraction <= 1.0 for fraction in fractions)
        assert here.run.steps[-1][1].endswith(" m to go")


async def test_it_stands_still_while_paused_and_then_goes_on() -> None:
    async with room() as here:
        start = here.robot.pose()
        drive = asyncio.create_task(_drive(here.context))
        await eventually(lambda: here.robot.pose().distance_to(start) > 0.5)
        here.run.paused = True
        await here.simulator.clock.sleep(2.0)
        rests_at = here.robot.pose()
        await here.simulator.clock.sleep(3.0)
        assert here.robot.pose().distance_to(rests_at) < 0.01
        here.run.paused = False
        await drive
        assert here.robot.pose().distance_to(GOAL.planar()) < 0.1


async def test_cancelling_it_stops_the_robot() -> None:
    async with room() as here:
        start = here.robot.pose()
        drive = asyncio.create_task(_drive(here.context))
        await eventually(lambda: here.robot.pose().distance_to(start) > 0.5)
        drive.cancel()
        with pytest.raises(asyncio.CancelledError):
            await drive
        await here.simulator.clock.sleep(2.0)
        assert here.robot.velocity().linear_mps == pytest.approx(0.0, abs=0.01)


async def test_what_blocks_the_way_is_placed_by_what_people_know() -> None:
    async with room(DOORS) as here:
        with pytest.raises(ActionFailure) as caught:
            await navigate_to(here.context, GOAL)
        assert caught.value.code is FailureCode.BLOCKED
        assert caught.value.message.startswith("Something is in the way by the green crate")
        assert caught.value.details["near"] == "crate_1"


async def test_place_outside_the_map_is_unreachable() -> None:
    async with room() as here:
        with pytest.raises(ActionFailure) as caught:
            await navigate_to(here.context, Pose(Position(60.0, 60.0)))
        assert caught.value.code is FailureCode.UNREACHABLE


async def _drive(context: ActionContext) -> None:
    await navigate_to(context, GOAL)
