"""What a simulated robot does with what a world file breaks in it, and that it is sound again afterwards."""

from __future__ import annotations

import asyncio
from typing import Any

import pytest

from parley.config import SystemConfig
from parley.errors import ActionFailure, FailureCode
from parley.system import System
from parley.world.geometry import Pose2D
from tests.demos.house import running
from tests.robots.test_simulated import GOAL, control, eventually, is_at, robot_in
from tests.sim.worlds import box, two_rooms


def fault(**state: Any) -> dict[str, Any]:
    return {"robots": {"A": state}}


async def drive_s(changes: dict[str, Any] | None = None, seed: int = 1) -> float:
    """How long it takes to `GOAL`, where it arrives."""
    async with robot_in(changes, seed=seed) as (robot, simulator):
        await robot.navigate(GOAL, control(), timeout_s=120)
        assert is_at(robot.pose(), GOAL)
        return simulator.clock.now_s()


async def test_slipping_wheels_and_a_noisy_lidar_cost_time_not_the_goal_and_the_seed_decides() -> None:
    sound, slips = await drive_s(), await drive_s(fault(slip=0.3))
    assert sound * 1.1 < slips < sound * 3
    assert slips == await drive_s(fault(slip=0.3)) != await drive_s(fault(slip=0.3), seed=2)
    assert await drive_s(fault(lidar_noise_m=0.1)) < sound * 2


async def test_a_lidar_is_as_noisy_as_its_world_says() -> None:
    async with robot_in(fault(lidar_noise_m=0.2)) as (robot, simulator):
        noisy = robot.scan().ranges_m
        simulator.change(fault(lidar_noise_m=0.0))
        exact = robot.scan().ranges_m
        assert 0.15 < float((noisy - exact).std()) < 0.25


async def test_a_lost_robot_stops_says_so_and_drives_again_once_it_knows_where_it_is() -> None:
    async with running(System(two_rooms(), SystemConfig(speed=None))) as house:
        simulator, clock = house.system.simulator, house.system.clock
        house.observer.say("go to the green crate", "A")
        await eventually(lambda: simulator.pose("A").x_m > 1.3)
        simulator.change(fault(localisation="lost"))
        asked = await house.question()
        assert "I do not know where I am" in asked.message
        await clock.sleep(1)
        assert simulator.velocity("A").speed_mps < 0.01
        simulator.change(fault(localisation="working"))
        house.observer.say("try again", "A", answer=True)
        assert await house.done() == ["finished", "finished"]
        assert house.distance_m("crate_1") < 1.0


async def test_what_is_put_in_its_way_while_it_drives_is_seen_and_driven_around() -> None:
    async with robot_in() as (robot, simulator):
        drive = asyncio.ensure_future(robot.navigate(GOAL, control(), timeout_s=120))
        await eventually(lambda: simulator.pose("A").x_m > 1.5)
        x, y = robot.planned_path()[-60]
        simulator.change({"add": [box("dropped", x, y, (0.4, 0.4, 0.5))]})
        await drive
        assert is_at(robot.pose(), GOAL)


async def test_without_sight_of_itself_it_has_no_place_to_keep_clear_of() -> None:
    """One lost robot does not keep the others from finding a place to stand."""
    world = two_rooms()
    second = world.robots[0].model_copy(update={"name": "B", "pose": (1.0, 3.0, 0.0), "localisation": "lost"})
    both = world.model_copy(update={"robots": (*world.robots, second)})
    async with running(System(both, SystemConfig(speed=None))) as house:
        with pytest.raises(ActionFailure) as failed:
            house.system.robots["B"].pose()
        assert failed.value.code is FailureCode.HARDWARE
        await house.say("go to the green crate", "A")
        assert await house.done("A") == ["finished", "finished"]
        assert house.system.robots["A"].pose().distance_to(Pose2D(5.2, 2.0)) < 1.5
