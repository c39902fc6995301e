"""A robot with ROS 1 and move_base, through a rosbridge; the simulator stands in for it."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from contextlib import AsyncExitStack, asynccontextmanager

import pytest

from parley.clock import SimClock, WallClock
from parley.errors import ActionFailure, FailureCode
from parley.robots.base import NavigationControl
from parley.robots.link import Link
from parley.robots.ros1 import Ros1Robot
from parley.robots.ros1_simulated import SimulatedMoveBase
from parley.sim.simulator import Simulator
from parley.transport.rosbridge import RosbridgeServer, RosbridgeTransport
from parley.world.geometry import Pose2D
from tests.sim.worlds import two_rooms
from tests.transport.backends import until

NOT_PAUSED = NavigationControl(lambda _: None, lambda: False)


@asynccontextmanager
async def stage(speed: float = 1.0) -> AsyncIterator[tuple[Ros1Robot, SimulatedMoveBase]]:
    """A robot of ours, and beyond a bridge what it drives, on a loop of its own."""
    far, ends = Link("peer"), AsyncExitStack()

    async def begin() -> tuple[str, SimulatedMoveBase]:
        bridge = await ends.enter_async_context(RosbridgeServer())
        transport = await ends.enter_async_context(RosbridgeTransport(bridge.address, ros=1))
        simulator = Simulator(two_rooms(), clock=SimClock(), speed=speed)
        await ends.enter_async_context(simulator)
        return bridge.address, await ends.enter_async_context(SimulatedMoveBase(simulator, "A", transport))

    address, peer = await far.run(begin())
    robot = Ros1Robot("A", address)
    try:
        await robot.open()
        robot.settle(robot.own_map, WallClock(), None)
        yield robot, peer
    finally:
        robot.close()
        await far.run(ends.aclose())
        far.end(asyncio.sleep(0), 5.0)


async def test_it_drives_to_a_place_and_says_where_no_way_leads() -> None:
    remaining: list[float] = []
    async with stage(speed=5.0) as (robot, peer):
        goal = Pose2D(1.8, 1.0, 0.0)
        control = NavigationControl(remaining.append, lambda: False)
        ended = await robot.navigate(goal, control, timeout_s=20)
        assert ended.distance_to(goal) < 0.1 and peer.robot.pose().distance_to(goal) < 0.1
        with pytest.raises(ActionFailure) as failed:
            await robot.navigate(Pose2D(40.0, 1.0), control, timeout_s=20)
    assert failed.value.code is FailureCode.UNREACHABLE
    assert "no way to" in failed.value.details["nav2_says"]
    assert 0 <= remaining[-1] < remaining[0] < 1


async def test_a_drive_that_is_cancelled_ends_there_too_and_the_next_one_drives() -> None:
    async with stage() as (robot, peer):
        drive = asyncio.create_task(robot.navigate(Pose2D(2.6, 1.0), NOT_PAUSED, timeout_s=20))
        await until(lambda: peer.robot.velocity().linear_mps > 0.2)
        drive.cancel()
        await until(lambda: peer.robot.velocity().linear_mps < 0.02 and not peer.robot.planned_path())
        await until(lambda: not peer.robot.stopped)
        again = asyncio.create_task(robot.navigate(Pose2D(2.6, 1.0), NOT_PAUSED, timeout_s=20))
        await until(lambda: peer.robot.velocity().linear_mps > 0.2)
        again.cancel()
