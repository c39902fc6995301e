"""Every kind of robot that comes with Parley keeps the promises about its drive."""

from __future__ import annotations

import pytest

from parley.clock import SimClock
from parley.robots.check import PROMISES, Promise, commands_expire
from parley.robots.run_robot import RunRobot
from parley.robots.simulated import SimulatedRobot
from parley.robots.turn import Turn
from parley.sim.simulator import Simulator
from parley.umrf.motion import Motion
from tests.engine.rig import Nobody
from tests.sim.worlds import two_rooms


@pytest.mark.parametrize("promise", PROMISES, ids=lambda promise: promise.__name__)
async def test_a_simulated_robot_keeps_its_promises(promise: Promise) -> None:
    async with Simulator(two_rooms(), clock=SimClock(), speed=1.0) as simulator:
        await promise(SimulatedRobot(simulator, "A", simulator.occupancy("A")))


async def test_so_does_the_robot_that_an_action_gets() -> None:
    async with Simulator(two_rooms(), clock=SimClock(), speed=1.0) as simulator:
        robot = SimulatedRobot(simulator, "A", simulator.occupancy("A"))
        turn = Turn(robot, lambda: (), simulator.clock)
        await commands_expire(RunRobot(robot, Motion("Drive_0"), turn, Nobody()))
