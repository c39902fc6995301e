"""MoveBy and TurnBy: the way that was said, stopped by what is in the way, held by a pause and a stop."""

from __future__ import annotations

import asyncio
import math
from collections.abc import Awaitable, Callable
from functools import partial

import pytest

from parley.actions.move_by import move_by
from parley.actions.turn_by import turn_by
from parley.errors import ActionFailure, FailureCode
from parley.umrf.action import Outcome
from tests.actions.room import Room, room
from tests.actions.test_navigate_to import eventually


async def _run(action: Awaitable[Outcome]) -> None:
    await action


def moved_m(here: Room, start: tuple[float, float, float]) -> float:
    pose = here.robot.pose()
    return (pose.x_m - start[0]) * math.cos(start[2]) + (pose.y_m - start[1]) * math.sin(start[2])


def has_turned(here: Room, since: float) -> bool:
    return abs(math.remainder(here.robot.pose().yaw_rad - since, math.tau)) > 0.2


def at(here: Room) -> tuple[float, float, float]:
    pose = here.robot.pose()
    return pose.x_m, pose.y_m, pose.yaw_rad


async def test_it_moves_forward_and_back_by_what_was_said() -> None:
    async with room() as here:
        start = at(here)
        outcome = await move_by(here.context, 0.6)
        assert moved_m(here, start) == pytest.approx(0.6, abs=0.05)
        assert outcome.facts["pose"].planar() == here.robot.pose()
        await move_by(here.context, 0.6, "back")
        assert moved_m(here, start) == pytest.approx(0.0, abs=0.08)
        assert here.run.steps[-1][0] == pytest.approx(1.0, abs=0.05)


async def test_it_stops_before_what_is_in_the_way_and_says_how_far_it_came() -> None:
    async with room() as here:
        start = at(here)
        with pytest.raises(ActionFailure) as failure:
            await move_by(here.context, 15.0)
        assert failure.value.code is FailureCode.BLOCKED
        assert f"I moved {moved_m(here, start):.1f} of 15 metres" in str(failure.value)
        assert here.robot.velocity().linear_mps == pytest.approx(0.0, abs=0.01)
        scan = here.robot.scan()
        assert scan.ranges_m.min() > here.robot.radius_m


@pytest.mark.parametrize(
    ("angle", "direction", "sign"), [(90, "left", 1), (270, "right", -1), (360, "left", 1)]
)
async def test_it_turns_by_what_was_said(angle: float, direction: str, sign: int) -> None:
    async with room() as here:
        start = at(here)
        await turn_by(here.context, angle, direction)  # type: ignore[arg-type]
        turned = math.remainder(here.robot.pose().yaw_rad - start[2] - sign * math.radians(angle), math.tau)
        assert turned == pytest.approx(0.0, abs=0.08)
        assert here.robot.pose().x_m == pytest.approx(start[0], abs=0.02)


async def test_a_pause_a_taken_permission_and_a_cancel_hold_it() -> None:
    async with room() as here:
        start = at(here)
        task = asyncio.create_task(_run(turn_by(here.context, 700.0)))
        await eventually(lambda: abs(here.robot.pose().yaw_rad - start[2]) > 0.3)
        holds: list[tuple[Callable[[], None], Callable[[], None]]] = [
            (partial(setattr, here.run, "paused", True), partial(setattr, here.run, "paused", False)),
            (here.run.motion.pause, here.run.motion.resume),
            (here.robot.halt, here.robot.release),
        ]
        for hold, let_go in holds:
            hold()
            await here.simulator.clock.sleep(1.0)
            rests = here.robot.pose().yaw_rad
            await here.simulator.clock.sleep(1.0)
            assert here.robot.pose().yaw_rad == pytest.approx(rests, abs=0.01)
            let_go()
            await eventually(partial(has_turned, here, rests))
        task.cancel()
        with pytest.raises(asyncio.CancelledError):
            await task
        await here.simulator.clock.sleep(1.0)
        assert here.robot.velocity().angular_radps == pytest.approx(0.0, abs=0.01)


@pytest.mark.parametrize("amount", [0.0, -1.0, 1e6])
async def test_an_amount_that_no_robot_drives_is_refused_before_it_moves(amount: float) -> None:
    async with room() as here:
        start = at(here)
        for action in (move_by, turn_by):
            with pytest.raises(ActionFailure) as failure:
                await action(here.context, amount)
            assert failure.value.code is FailureCode.NOT_CAPABLE
        assert at(here) == start
