"""The simulator: time, drive, senses, changes."""

from __future__ import annotations

import asyncio
import math
from collections.abc import AsyncIterator

import numpy as np
import pytest

from parley.clock import SimClock
from parley.errors import FileFormatError
from parley.sim.simulator import COMMAND_LIFETIME_S, Simulator
from parley.sim.world_file import WorldFile
from parley.world.geometry import Velocity
from tests.sim.worlds import box, two_rooms


@pytest.fixture
def clock() -> SimClock:
    return SimClock()


@pytest.fixture
async def simulator(clock: SimClock) -> AsyncIterator[Simulator]:
    async with Simulator(two_rooms(), clock=clock, speed=None, seed=3) as opened:
        yield opened


async def drive(simulator: Simulator, seconds: float, linear: float, angular: float) -> None:
    """Repeat a command for a while, as a controller does."""
    end_s = simulator.clock.now_s() + seconds
    while simulator.clock.now_s() < end_s - 1e-6:
        simulator.command("A", Velocity(linear, angular))
        await simulator.clock.sleep(0.1)


async def test_a_commanded_robot_moves_at_that_speed(simulator: Simulator) -> None:
    await drive(simulator, 2.0, 0.2, 0.0)
    assert simulator.velocity("A").linear_mps == pytest.approx(0.2, abs=0.01)
    before = simulator.pose("A")
    await drive(simulator, 2.0, 0.2, 0.0)
    assert simulator.pose("A").distance_to(before) == pytest.approx(0.4, abs=0.01)


@pytest.mark.parametrize(("able_mps", "gone_m"), [(0.0, 0.0), (0.1, 0.2)])
async def test_only_an_omnidirectional_base_goes_aside(
    clock: SimClock, able_mps: float, gone_m: float
) -> None:
    world = two_rooms()
    robot = world.robot("A")
    able = robot.model_copy(update={"model": robot.model.model_copy(update={"max_lateral_mps": able_mps})})
    async with Simulator(world.model_copy(update={"robots": (able,)}), clock=clock, speed=None) as simulator:
        start = simulator.pose("A")
        for _ in range(20):
            simulator.command("A", Velocity(lateral_mps=0.2))
            await clock.sleep(0.1)
        end = simulator.pose("A")
    aside = math.cos(start.yaw_rad) * (end.y_m - start.y_m) - math.sin(start.yaw_rad) * (end.x_m - start.x_m)
    assert aside == pytest.approx(gone_m, abs=0.02)


async def test_turning_is_counter_clockwise(simulator: Simulator) -> None:
    await drive(simulator, 1.0, 0.0, 1.0)
    assert 0.5 < simulator.pose("A").yaw_rad < 1.05


async def test_an_arc_is_driven_without_slipping_sideways(simulator: Simulator) -> None:
    await drive(simulator, 1.0, 0.2, 0.5)
    start = simulator.pose("A")
    centre = start.x_m - 0.4 * math.sin(start.yaw_rad), start.y_m + 0.4 * math.cos(start.yaw_rad)
    await drive(simulator, 4.0, 0.2, 0.5)
    end = simulator.pose("A")
    assert math.dist(centre, (end.x_m, end.y_m)) == pytest.approx(0.4, abs=0.03)


async def test_commands_beyond_its_limits_are_cut(simulator: Simulator) -> None:
    await drive(simulator, 2.0, 9.0, 0.0)
    assert simulator.velocity("A").linear_mps <= simulator.model("A").max_speed_mps + 1e-3


async def test_a_robot_whose_controller_died_stops(simulator: Simulator) -> None:
    await drive(simulator, 2.0, 0.2, 0.0)
    await simulator.clock.sleep(COMMAND_LIFETIME_S + 1.0)
    before = simulator.pose("A")
    await simulator.clock.sleep(1.0)
    assert simulator.pose("A").distance_to(before) < 1e-3


async def test_nobody_drives_through_a_wall(simulator: Simulator) -> None:
    simulator.change({"move": {"A": (2.0, 2.0, 0.0)}})
    await drive(simulator, 10.0, 0.26, 0.0)
    assert simulator.pose("A").x_m < 3.0 - 0.05 - simulator.model("A").radius_m + 0.01


async def test_robots_do_not_pass_through_each_other(clock: SimClock) -> None:
    world = two_rooms()
    other = world.robot("A").model_copy(update={"name": "B", "pose": (2.0, 1.0, 0.0)})
    world = world.model_copy(update={"robots": (*world.robots, other)})
    async with Simulator(world, clock=clock, speed=None) as simulator:
        await drive(simulator, 6.0, 0.26, 0.0)
        assert simulator.pose("A").distance_to(simulator.pose("B")) > 0.39


async def test_a_stopped_robot_ignores_commands_until_it_is_let_go(simulator: Simulator) -> None:
    simulator.set_stopped("A", True)
    before = simulator.pose("A")
    await drive(simulator, 1.0, 0.2, 0.0)
    assert simulator.pose("A") == before
    simulator.set_stopped("A", False)
    await drive(simulator, 1.0, 0.2, 0.0)
    assert simulator.pose("A").distance_to(before) > 0.1


async def test_time_stands_still_while_the_clock_is_held(simulator: Simulator, clock: SimClock) -> None:
    waiting = asyncio.create_task(clock.sleep(1.0))
    with clock.hold():
        await asyncio.sleep(0.02)
        before_s = clock.now_s()
        await asyncio.sleep(0.02)
        assert clock.now_s() == before_s
        assert not waiting.done()
    await waiting


async def test_time_stands_still_while_nobody_waits_and_nothing_moves(
    simulator: Simulator, clock: SimClock
) -> None:
    await clock.sleep(1.0)
    before_s = clock.now_s()
    await asyncio.sleep(0.02)
    assert clock.now_s() == before_s
    simulator.command("A", Velocity(0.2))
    await asyncio.sleep(0.02)
    assert clock.now_s() > before_s


async def test_who_waited_may_act_before_time_moves_on(simulator: Simulator, clock: SimClock) -> None:
    async def chained(depth: int) -> float:
        return clock.now_s() if depth == 0 else await asyncio.create_task(chained(depth - 1))

    await clock.sleep(1.0)
    woken_s = clock.now_s()
    assert await chained(3) == woken_s


async def test_at_a_given_speed_time_follows_the_wall_clock(clock: SimClock) -> None:
    async with Simulator(two_rooms(), clock=clock, speed=20.0):
        began_s = clock.wall_s()
        await clock.sleep(2.0)
        assert clock.wall_s() - began_s >= 0.08


@pytest.mark.parametrize("speed", [0.0, -1.0])
def test_a_speed_that_is_not_positive_is_refused(speed: float, clock: SimClock) -> None:
    with pytest.raises(ValueError, match="speed"):
        Simulator(two_rooms(), clock=clock, speed=speed)


async def test_the_lidar_measures_distances_around_the_robot(simulator: Simulator) -> None:
    ranges = simulator.scan("A").ranges_m
    west, south = ranges[180], ranges[270]  # the robot stands at (1, 1) looking east
    assert (west, south) == pytest.approx((0.95, 0.95), abs=0.05)


async def test_the_lidar_does_not_see_beyond_its_range(clock: SimClock) -> None:
    async with Simulator(two_rooms().model_copy(update={"walls": ()}), clock=clock, speed=None) as simulator:
        simulator.change({"move": {"A": (-30.0, 0.0, 0.0)}})
        assert np.isinf(simulator.scan("A").ranges_m).all()


async def test_noise_is_the_same_for_the_same_seed(clock: SimClock) -> None:
    first, again, other = (
        Simulator(two_rooms(), clock=clock, seed=seed).scan("A").ranges_m for seed in (5, 5, 6)
    )
    assert np.array_equal(first, again)
    assert not np.array_equal(first, other)


async def test_a_sweep_lasts_until_time_moves_on(simulator: Simulator, clock: SimClock) -> None:
    first = simulator.scan("A")
    assert simulator.scan("A") is first
    await clock.sleep(0.1)
    assert simulator.scan("A") is not first


async def test_a_dropped_box_is_there_at_once_and_motion_goes_on(simulator: Simulator) -> None:
    await drive(simulator, 1.0, 0.2, 0.0)
    before, speed = simulator.pose("A"), simulator.velocity("A")
    simulator.change({"add": [box("dropped", 2.2, 1.0)]})
    assert simulator.pose("A") == before
    assert simulator.velocity("A") == speed
    assert simulator.scan("A").ranges_m[0] == pytest.approx(2.2 - 0.35 - before.x_m, abs=0.05)
    simulator.change({"remove": ["dropped"]})
    assert simulator.scan("A").ranges_m[0] > 2.0


async def test_an_impossible_change_changes_nothing(simulator: Simulator) -> None:
    world = simulator.world
    with pytest.raises(FileFormatError):
        simulator.change({"remove": ["crate_1", "ghost"]})
    assert simulator.world is world


async def test_a_broken_camera_gives_no_picture_until_it_is_mended(simulator: Simulator) -> None:
    simulator.change({"robots": {"A": {"camera": "broken"}}})
    assert not simulator.camera_works("A")
    with pytest.raises(RuntimeError, match="camera"):
        await simulator.photograph("A")
    simulator.change({"robots": {"A": {"camera": "working"}}})
    assert (await simulator.photograph("A")).frame.rgb.shape == (240, 320, 3)


async def test_pictures_can_only_be_taken_while_it_is_open(clock: SimClock) -> None:
    simulator = Simulator(two_rooms(), clock=clock)
    with pytest.raises(RuntimeError, match="not open"):
        await simulator.photograph("A")


async def test_the_same_commands_lead_to_the_same_place() -> None:
    async def run(world: WorldFile) -> object:
        async with Simulator(world, clock=SimClock(), speed=None) as simulator:
            await drive(simulator, 3.0, 0.2, 0.3)
            return simulator.pose("A")

    assert await run(two_rooms()) == await run(two_rooms())
