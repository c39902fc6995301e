"""A simulated robot drives, looks, waits and stops."""

from __future__ import annotations

import asyncio
import itertools
from collections.abc import AsyncIterator, Callable, Mapping
from contextlib import asynccontextmanager
from typing import Any

import pytest

from parley.clock import SimClock
from parley.errors import ActionFailure, FailureCode
from parley.robots.base import NavigationControl, Robot
from parley.robots.simulated import SimulatedRobot
from parley.sim.floor_plan import survey
from parley.sim.simulator import Simulator
from parley.world.geometry import Pose2D, wrap_angle
from tests.sim.worlds import box, two_rooms

GOAL = Pose2D(4.5, 3.0, 1.0)
NORTH_DOOR, SOUTH_DOOR = box("box_n", 3.0, 3.0), box("box_s", 3.0, 1.0)


@asynccontextmanager
async def robot_in(
    changes: Mapping[str, Any] | None = None, *, seed: int = 0
) -> AsyncIterator[tuple[SimulatedRobot, Simulator]]:
    """Robot "A" in two rooms with `changes`, none of which its map knows."""
    occupancy = survey(two_rooms(), 0.3)
    async with Simulator(two_rooms(changes), clock=SimClock(), speed=None, seed=seed) as simulator:
        yield SimulatedRobot(simulator, "A", occupancy), simulator


def control(
    on_progress: Callable[[float], None] = lambda remaining_m: None,
    paused: Callable[[], bool] = lambda: False,
) -> NavigationControl:
    return NavigationControl(on_progress, paused)


def is_at(pose: Pose2D, goal: Pose2D) -> bool:
    return pose.distance_to(goal) < 0.1 and abs(wrap_angle(pose.yaw_rad - goal.yaw_rad)) < 0.1


async def eventually(condition: Callable[[], bool]) -> None:
    async with asyncio.timeout(10):
        while not condition():  # noqa: ASYNC110 - what is awaited is a position, not an event
            await asyncio.sleep(0)


async def test_it_is_a_robot_with_drive_lidar_and_camera() -> None:
    async with robot_in() as (robot, _):
        as_seen_by_actions: Robot = robot
        assert as_seen_by_actions.capabilities == {"drive", "lidar", "camera", "sees_people"}
        assert as_seen_by_actions.radius_m == 0.2


@pytest.mark.parametrize("goal", [GOAL, Pose2D(1.0, 3.5, -2.0), Pose2D(5.5, 0.5, 3.1), Pose2D(1.0, 1.0, 1.5)])
async def test_it_arrives_with_the_wished_heading_and_at_rest(goal: Pose2D) -> None:
    async with robot_in() as (robot, simulator):
        end = await robot.navigate(goal, control(), timeout_s=90)
        assert is_at(end, goal)
        await simulator.clock.sleep(1.0)
        assert is_at(robot.pose(), goal)
        assert abs(robot.velocity().linear_mps) < 1e-3


async def test_progress_tells_the_shrinking_distance_along_the_path() -> None:
    told: list[float] = []
    async with robot_in() as (robot, _):
        await robot.navigate(GOAL, control(told.append), timeout_s=90)
    assert told[0] == pytest.approx(4.2, abs=0.8)
    assert told[-1] == 0.0
    assert all(later < earlier + 0.1 for earlier, later in itertools.pairwise(told))
    assert len(told) > 20


async def test_with_one_door_blocked_it_takes_the_other() -> None:
    async with robot_in({"add": [NORTH_DOOR], "move": {"A": (1.0, 3.0, 0.0)}}) as (robot, _):
        assert is_at(await robot.navigate(GOAL, control(), timeout_s=120), GOAL)


async def test_a_box_dropped_before_it_while_driving_is_driven_around() -> None:
    async with robot_in({"move": {"A": (1.0, 3.0, 0.0)}}) as (robot, simulator):
        drive = asyncio.create_task(robot.navigate(GOAL, control(), timeout_s=120))
        await eventually(lambda: robot.pose().x_m > 1.4)
        simulator.change({"add": [NORTH_DOOR]})
        assert is_at(await drive, GOAL)


async def test_with_all_doors_blocked_it_says_blocked_and_where() -> None:
    async with robot_in({"add": [NORTH_DOOR, SOUTH_DOOR]}) as (robot, _):
        with pytest.raises(ActionFailure) as caught:
            await robot.navigate(GOAL, control(), timeout_s=120)
        assert robot.pose().x_m < 3.0
    assert caught.value.code is FailureCode.BLOCKED
    assert caught.value.details["at"]["x"] == pytest.approx(2.65, abs=0.2)


async def test_a_goal_that_something_stands_on_is_blocked() -> None:
    async with robot_in({"add": [box("box", GOAL.x_m, GOAL.y_m)]}) as (robot, _):
        with pytest.raises(ActionFailure) as caught:
            await robot.navigate(GOAL, control(), timeout_s=120)
    assert caught.value.code is FailureCode.BLOCKED


async def test_after_the_door_is_cleared_in_time_it_goes_on() -> None:
    async with robot_in({"add": [NORTH_DOOR, SOUTH_DOOR]}) as (robot, simulator):
        drive = asyncio.create_task(robot.navigate(GOAL, control(), timeout_s=120))
        await simulator.clock.sleep(3.0)
        simulator.change({"remove": ["box_n", "box_s"]})
        assert is_at(await drive, GOAL)


async def test_what_the_lidar_cannot_see_blocks_it_too() -> None:
    low = box("low", 1.8, 2.0, (0.1, 4.0, 0.1))
    async with robot_in({"add": [low]}) as (robot, _):
        with pytest.raises(ActionFailure) as caught:
            await robot.navigate(GOAL, control(), timeout_s=120)
        assert robot.pose().x_m < 1.6
    assert caught.value.code is FailureCode.BLOCKED


async def test_put_elsewhere_while_driving_it_finds_its_way_from_there() -> None:
    async with robot_in() as (robot, simulator):
        drive = asyncio.create_task(robot.navigate(GOAL, control(), timeout_s=120))
        await eventually(lambda: robot.pose().x_m > 1.3)
        simulator.change({"move": {"A": (5.5, 0.6, 0.0)}})
        assert is_at(await drive, GOAL)


@pytest.mark.parametrize("goal", [Pose2D(5.2, 2.0), Pose2D(0.1, 0.1), Pose2D(20.0, 20.0)])
async def test_a_goal_without_a_way_on_the_map_is_unreachable(goal: Pose2D) -> None:
    async with robot_in() as (robot, _):
        before = robot.pose()
        with pytest.raises(ActionFailure) as caught:
            await robot.navigate(goal, control(), timeout_s=60)
        assert robot.pose() == before
    assert caught.value.code is FailureCode.UNREACHABLE


async def test_it_gives_up_after_its_time_counted_in_robot_time() -> None:
    async with robot_in() as (robot, simulator):
        with pytest.raises(ActionFailure) as caught:
            await robot.navigate(GOAL, control(), timeout_s=3.0)
        assert simulator.clock.now_s() == pytest.approx(3.0, abs=0.3)
        await simulator.clock.sleep(1.0)
        assert abs(robot.velocity().linear_mps) < 1e-3
    assert caught.value.code is FailureCode.TIMED_OUT


async def test_paused_it_stands_still_and_then_goes_on_to_the_goal() -> None:
    paused = False
    async with robot_in() as (robot, simulator):
        drive = asyncio.create_task(robot.navigate(GOAL, control(paused=lambda: paused), timeout_s=60))
        await eventually(lambda: robot.pose().x_m > 1.3)
        paused = True
        await simulator.clock.sleep(1.0)
        before = robot.pose()
        await simulator.clock.sleep(120.0)  # longer than the drive may take: held time does not count
        assert robot.pose().distance_to(before) < 1e-3
        paused = False
        assert is_at(await drive, GOAL)


async def test_stop_holds_a_drive_until_release_and_then_it_goes_on() -> None:
    async with robot_in() as (robot, simulator):
        drive = asyncio.create_task(robot.navigate(GOAL, control(), timeout_s=60))
        await eventually(lambda: robot.pose().x_m > 1.3)
        robot.halt()
        await simulator.clock.sleep(1.0)
        before = robot.pose()
        await simulator.clock.sleep(60.0)
        assert robot.pose().distance_to(before) < 1e-3
        assert not drive.done()
        robot.release()
        assert is_at(await drive, GOAL)


async def test_a_drive_ordered_while_stopped_waits_for_release() -> None:
    async with robot_in() as (robot, simulator):
        robot.halt()
        before = robot.pose()
        drive = asyncio.create_task(robot.navigate(GOAL, control(), timeout_s=60))
        await simulator.clock.sleep(5.0)
        assert robot.pose() == before
        robot.release()
        assert is_at(await drive, GOAL)


async def test_while_it_is_stopped_robot_time_need_not_pass() -> None:
    async with robot_in() as (robot, simulator):
        drive = asyncio.create_task(robot.navigate(GOAL, control(), timeout_s=60))
        await eventually(lambda: robot.pose().x_m > 1.3)
        robot.halt()
        await simulator.clock.sleep(2.0)
        before_s = simulator.clock.now_s()
        await asyncio.sleep(0.05)
        assert simulator.clock.now_s() == before_s
        drive.cancel()
        with pytest.raises(asyncio.CancelledError):
            await drive


async def test_cancelling_a_drive_stops_the_robot() -> None:
    async with robot_in() as (robot, simulator):
        drive = asyncio.create_task(robot.navigate(GOAL, control(), timeout_s=60))
        await eventually(lambda: robot.pose().x_m > 1.3)
        drive.cancel()
        with pytest.raises(asyncio.CancelledError):
            await drive
        await simulator.clock.sleep(1.0)
        assert abs(robot.velocity().linear_mps) < 1e-3
        assert robot.pose().x_m < 1.6
        assert is_at(await robot.navigate(GOAL, control(), timeout_s=60), GOAL)


async def test_it_refuses_to_drive_to_two_places_at_once() -> None:
    async with robot_in() as (robot, _):
        drive = asyncio.create_task(robot.navigate(GOAL, control(), timeout_s=60))
        await asyncio.sleep(0)
        with pytest.raises(ActionFailure) as caught:
            await robot.navigate(Pose2D(1.0, 3.0), control(), timeout_s=60)
        assert caught.value.code is FailureCode.INTERNAL
        assert is_at(await drive, GOAL)


async def test_two_robots_pass_each_other() -> None:
    world = two_rooms()
    other = world.robot("A").model_copy(update={"name": "B", "pose": (5.0, 3.0, 3.14)})
    world = world.model_copy(update={"robots": (*world.robots, other)})
    occupancy = survey(world, 0.3)
    async with Simulator(world, clock=SimClock(), speed=None) as simulator:
        a, b = (SimulatedRobot(simulator, name, occupancy) for name in ("A", "B"))
        goals = Pose2D(4.5, 1.0), Pose2D(1.0, 3.0, 3.14)
        ends = await asyncio.gather(
            *(
                robot.navigate(goal, control(), timeout_s=120)
                for robot, goal in zip((a, b), goals, strict=True)
            )
        )
    assert all(is_at(end, goal) for end, goal in zip(ends, goals, strict=True))


async def test_the_same_seed_drives_the_same_way() -> None:
    async def end_of_drive() -> Pose2D:
        async with robot_in({"add": [NORTH_DOOR]}, seed=7) as (robot, _):
            return await robot.navigate(GOAL, control(), timeout_s=120)

    assert await end_of_drive() == await end_of_drive()


async def test_a_picture_comes_with_what_the_detector_saw() -> None:
    ball = box("ball", 1.8, 1.0, (0.1, 0.1, 0.3), label="blue ball")
    async with robot_in({"add": [ball]}) as (robot, _):
        image = await robot.image()
    assert image.data.shape == (image.height, image.width, 3) == (240, 320, 3)
    assert image.detections is not None
    seen = next(found for found in image.detections if found.label == "blue ball")
    assert seen.pixels > 100
    assert seen.distance_m == pytest.approx(0.67, abs=0.05)


async def test_robot_time_stands_still_while_a_picture_is_drawn() -> None:
    async with robot_in() as (robot, simulator):
        waiting = asyncio.create_task(simulator.clock.sleep(600.0))
        await asyncio.sleep(0)
        before_s = simulator.clock.now_s()
        image = await robot.image()
        assert image.stamp_s == before_s
        assert simulator.clock.now_s() - before_s < 1.0
        waiting.cancel()


async def test_a_broken_camera_is_a_hardware_failure_and_driving_still_works() -> None:
    async with robot_in({"robots": {"A": {"camera": "broken"}}}) as (robot, _):
        with pytest.raises(ActionFailure) as caught:
            await robot.image()
        assert caught.value.code is FailureCode.HARDWARE
        assert is_at(await robot.navigate(GOAL, control(), timeout_s=60), GOAL)


async def test_without_a_camera_it_cannot_take_pictures() -> None:
    world = two_rooms()
    entry = world.robot("A")
    blind = entry.model_copy(update={"model": entry.model.model_copy(update={"camera": None})})
    world = world.model_copy(update={"robots": (blind,)})
    async with Simulator(world, clock=SimClock(), speed=None) as simulator:
        robot = SimulatedRobot(simulator, "A", survey(world, 0.3))
        assert "camera" not in robot.capabilities
        with pytest.raises(ActionFailure) as caught:
            await robot.image()
    assert caught.value.code is FailureCode.NOT_CAPABLE
