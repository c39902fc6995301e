"""A simulated robot that is asked into a zone which it must keep out of; measured along its whole way."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from typing import Any

import pytest

from parley.clock import SimClock
from parley.errors import ActionFailure, FailureCode
from parley.gate.book import RuleBook
from parley.gate.fence import Fence
from parley.gate.judge import RobotFacts
from parley.messages.rules import Rule, RuleSet
from parley.robots.base import NavigationControl, Velocity
from parley.robots.simulated import SimulatedRobot
from parley.sim.floor_plan import survey
from parley.sim.simulator import Simulator
from parley.world.geometry import Pose2D
from tests.sim.worlds import two_rooms

NORTH_DOOR = {"id": "north", "name": "north door", "kind": "keep_out", "rectangle": (2.6, 2.5, 3.4, 3.5)}
SOUTH_DOOR = NORTH_DOOR | {"id": "south", "name": "south door", "rectangle": (2.6, 0.5, 3.4, 1.5)}
GOAL = Pose2D(4.5, 3.0, 1.0)


class Run:
    """A robot in two rooms; every place at which it was is kept."""

    def __init__(self, simulator: Simulator, *rules: dict[str, Any]) -> None:
        self.simulator = simulator
        self.book = RuleBook(simulator.clock)
        model = simulator.model("A")
        self.book.know("A", RobotFacts("", model.radius_m, model.max_speed_mps))
        self.put(*rules)
        fence = Fence(self.book, "A", braking_mps2=model.max_acceleration_mps2)
        self.robot = SimulatedRobot(simulator, "A", survey(two_rooms(), 0.3), fence)
        self.speeds: list[float] = []
        self.depths: list[float] = []

    def put(self, *rules: dict[str, Any]) -> None:
        self.book.replace(RuleSet(rules=tuple(Rule(**rule) for rule in rules)))

    async def watch(self) -> None:
        """Measure at every step of the world."""
        while True:
            pose = self.robot.pose()
            closed = [rule for rule in self.book.rules.rules if rule.kind == "keep_out"]
            gaps = [self.book.shape(rule).distance_to(pose.x_m, pose.y_m) for rule in closed]
            self.depths.append(self.robot.radius_m - min(gaps, default=9.0))
            self.speeds.append(abs(self.robot.velocity().linear_mps))
            await self.simulator.clock.sleep(0.05)

    async def go(self, goal: Pose2D) -> Pose2D:
        control = NavigationControl(lambda _: None, lambda: False)
        return await self.robot.navigate(goal, control, timeout_s=120)


@asynccontextmanager
async def run(*rules: dict[str, Any]) -> AsyncIterator[Run]:
    async with Simulator(two_rooms(), clock=SimClock(), speed=None) as simulator:
        made = Run(simulator, *rules)
        watch = asyncio.create_task(made.watch())
        yield made
        watch.cancel()


async def test_it_drives_around_a_closed_door() -> None:
    async with run(NORTH_DOOR) as it:
        arrived = await it.go(GOAL)
    assert arrived.distance_to(GOAL) < 0.1
    assert max(it.depths) <= 0


async def test_it_refuses_a_way_that_leads_only_through_closed_doors_and_says_which() -> None:
    async with run(NORTH_DOOR, SOUTH_DOOR) as it:
        with pytest.raises(
            ActionFailure, match=r"The only way there leads through “(north|south) door”"
        ) as info:
            await it.go(GOAL)
    assert info.value.code is FailureCode.FORBIDDEN
    assert max(it.speeds) < 0.01


async def test_it_refuses_a_goal_inside() -> None:
    async with run(NORTH_DOOR) as it:
        with pytest.raises(ActionFailure, match="I must not go into “north door”") as info:
            await it.go(Pose2D(3.0, 3.0))
    assert info.value.code is FailureCode.FORBIDDEN


async def test_a_door_that_is_closed_while_it_drives_sends_it_around() -> None:
    async with run() as it:
        drive = asyncio.create_task(it.go(GOAL))
        while it.robot.pose().x_m < 1.6:
            await it.simulator.clock.sleep(0.05)
        it.depths.clear()
        it.put(NORTH_DOOR, SOUTH_DOOR | {"rectangle": (2.6, 0.5, 2.7, 0.6)})
        arrived = await drive
    assert arrived.distance_to(GOAL) < 0.1
    assert max(it.depths) <= 0


@pytest.mark.parametrize("turn", [0.0, 0.15, -0.4])
async def test_commanded_velocities_do_not_lead_inside_whoever_commands_them(turn: float) -> None:
    wall = NORTH_DOOR | {"rectangle": (1.6, -1.0, 9.0, 5.0)}
    async with run(wall) as it:
        for _ in range(200):
            it.robot.drive(Velocity(1.0, turn))
            it.simulator.command("A", Velocity(1.0, turn))
            await it.simulator.clock.sleep(0.05)
    assert max(it.depths) <= 0
    assert max(it.speeds) > 0.1


async def test_who_stands_inside_may_only_leave() -> None:
    async with run() as it:
        start = it.robot.pose()
        it.put(
            NORTH_DOOR | {"rectangle": (start.x_m - 0.5, start.y_m - 0.6, start.x_m + 0.7, start.y_m + 0.6)}
        )
        with pytest.raises(ActionFailure, match="I must not go into"):
            await it.go(Pose2D(start.x_m + 0.2, start.y_m))
        arrived = await it.go(GOAL)
    assert arrived.distance_to(GOAL) < 0.1
    assert max(it.depths) <= it.depths[0] + 0.1
    assert it.depths[-1] <= 0


async def test_a_slow_zone_slows_it_down() -> None:
    async with run({"id": "s", "kind": "slow", "rectangle": (-1, -1, 9, 9), "max_speed_mps": 0.1}) as it:
        await it.go(Pose2D(1.5, 1.5))
    assert 0.08 < max(it.speeds) <= 0.11
