"""Whoever breaks a promise is found out; and robots of one's own obey the rules of the house."""

from __future__ import annotations

import importlib.util
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from parley.cli import command_line
from parley.clock import WallClock
from parley.errors import ActionFailure, FailureCode
from parley.gate.book import RuleBook
from parley.gate.fence import Fence
from parley.gate.judge import RobotFacts
from parley.messages.rules import Rule, RuleSet
from parley.robots.base import NavigationControl, Velocity
from parley.robots.check import (
    BrokenError,
    Promise,
    a_drive_can_be_held_and_cancelled,
    a_halt_holds,
    commands_expire,
    it_measures,
    its_pose_follows,
)
from parley.robots.own import RobotBase
from parley.world.geometry import Pose2D
from parley.world.occupancy import FREE, OccupancyMap

EXAMPLE = Path(__file__).parent.parent.parent / "examples" / "own_robot.py"
FLOOR = OccupancyMap(np.full((80, 120), FREE, np.int8), 0.05, 0.0, 0.0, "floor")
CONTROL = NavigationControl(lambda _: None, lambda: False)


def example() -> type[RobotBase]:
    spec = importlib.util.spec_from_file_location("own_robot", EXAMPLE)
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    cart: type[RobotBase] = module.Cart
    return cart


Cart = example()


class NeverExpires(Cart):  # type: ignore[misc, valid-type]
    def drive(self, velocity: Velocity) -> None:
        self.send(velocity)


class DeafToHalt(Cart):  # type: ignore[misc, valid-type]
    def halt(self) -> None:
        pass


class Backwards(Cart):  # type: ignore[misc, valid-type]
    def pose(self) -> Pose2D:
        here = super().pose()
        return Pose2D(-here.x_m, here.y_m, here.yaw_rad)


class Rolls(Cart):  # type: ignore[misc, valid-type]
    def velocity(self) -> Velocity:
        return Velocity(0.2)


class DrivesByItself(Cart):  # type: ignore[misc, valid-type]
    """Finds its way by itself, and looks at nothing else."""

    async def go(self, goal: Pose2D, control: NavigationControl, *, timeout_s: float) -> Pose2D:
        clock = WallClock()
        while self.pose().distance_to(goal) > 0.1:
            self.send(Velocity(0.5))
            await clock.sleep(0.05)
        return goal


@pytest.mark.parametrize(
    ("robot", "promise"),
    [
        (NeverExpires, commands_expire),
        (DeafToHalt, a_halt_holds),
        (Backwards, its_pose_follows),
        (Rolls, it_measures),
        (DrivesByItself, a_drive_can_be_held_and_cancelled),
    ],
    ids=lambda item: item.__name__,
)
async def test_whoever_breaks_a_promise_is_found_out(
    robot: Callable[[str], RobotBase], promise: Promise
) -> None:
    broken = robot("A")
    broken.settle(FLOOR, WallClock(), None)
    try:
        with pytest.raises(BrokenError):
            await promise(broken)
    finally:
        broken.send(Velocity())
        broken.close()


def test_the_example_keeps_them_all_and_is_forty_lines() -> None:
    result = CliRunner().invoke(command_line(), ["robot", "check", f"{EXAMPLE}:Cart", "--yes"])
    assert result.exit_code == 0, result.output
    assert "BROKEN" not in result.output
    assert result.output.count("kept") == 5
    assert len(EXAMPLE.read_text(encoding="utf-8").splitlines()) <= 40


def fenced(robot: RobotBase) -> RobotBase:
    """At (1, 1), with a zone ahead of it that begins at x = 1.8."""
    zone = Rule.model_validate({"id": "z", "name": "bay", "kind": "keep_out", "rectangle": (1.8, 0, 3, 2)})
    book = RuleBook(WallClock())
    book.know(robot.name, RobotFacts("", robot.radius_m, robot.limits.max_speed_mps))
    book.replace(RuleSet(rules=(zone,)))
    robot.settle(FLOOR, WallClock(), Fence(book, robot.name, braking_mps2=0.5))
    return robot


async def test_no_drive_enters_a_closed_zone() -> None:
    robot = fenced(Cart("A"))
    clock = WallClock()
    for _ in range(40):
        robot.drive(Velocity(0.4))
        await clock.sleep(0.05)
    robot.close()
    assert robot.pose().x_m > 1.2 and robot.pose().x_m + robot.radius_m < 1.8


async def test_a_robot_that_finds_its_way_itself_is_stopped_at_a_closed_zone() -> None:
    robot = fenced(DrivesByItself("A"))
    with pytest.raises(ActionFailure) as refused:
        await robot.navigate(Pose2D(2.5, 1.0), CONTROL, timeout_s=10)
    assert refused.value.code is FailureCode.FORBIDDEN
    with pytest.raises(ActionFailure) as stopped:
        await robot.navigate(Pose2D(5.0, 1.0), CONTROL, timeout_s=10)
    assert stopped.value.code is FailureCode.FORBIDDEN
    assert robot.velocity() == Velocity()
    assert robot.pose().x_m < 1.8
    robot.close()
