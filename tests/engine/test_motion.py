"""The drive of a run can be taken away: an action that ignores a stop moves nothing any more."""

from __future__ import annotations

import asyncio
import time
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from types import SimpleNamespace
from typing import Any

from parley.clock import WallClock
from parley.errors import ActionFailure
from parley.gate.stop_line import StopLine
from parley.robots.base import Velocity
from parley.robots.run_robot import RunRobot
from parley.robots.turn import Turn
from parley.umrf.action import action
from parley.umrf.catalogue import Catalogue
from parley.umrf.motion import GRACE_S
from tests.umrf.spec_actions import chain

from .rig import KIM, DummyRobot, Nobody, Rig, rigged

FAST = Velocity(0.2)


@action(effects=("moves",))
async def shove(ctx: Any) -> None:
    """Drive on, whatever anybody says; cancelling is swallowed, too."""
    while True:
        try:
            await asyncio.sleep(0.005)
            ctx.robot.drive(FAST)
        except asyncio.CancelledError:
            continue
        except ActionFailure:
            ctx.robot.drive(Velocity())
            return


@action(effects=("moves",))
async def roll(ctx: Any) -> None:
    """Drive, and stand still when told to."""
    while True:
        await ctx.run.wait_while_paused()
        ctx.robot.drive(FAST)
        await asyncio.sleep(0.005)


@action(effects=("moves",))
def roll_in_a_thread(ctx: Any) -> None:
    """Drive without a look at the loop."""
    while not ctx.run.stop_requested:
        ctx.robot.drive(FAST)
        time.sleep(0.005)


@asynccontextmanager
async def driving(name: str) -> AsyncIterator[tuple[Rig, DummyRobot, StopLine]]:
    """One of the actions above, under way."""
    robot, line = DummyRobot(), StopLine()
    turn = Turn(robot, lambda: (), WallClock())
    async with rigged(
        robot,
        line=line,
        catalogue=Catalogue([shove.spec, roll.spec, roll_in_a_thread.spec]),
        make_context=lambda run: SimpleNamespace(run=run, robot=RunRobot(robot, run.motion, turn, Nobody())),
    ) as rig:
        rig.start(chain("g", [{"name": name, "type": "sync", "instance_id": 0}]))
        await rig.until_graph("g", "RUNNING")
        await moves(robot)
        yield rig, robot, line


async def moves(robot: DummyRobot) -> None:
    robot.told.clear()
    async with asyncio.timeout(5):
        while "drive 0.2" not in robot.told:  # noqa: ASYNC110 - a list of commands
            await asyncio.sleep(0.005)


async def test_an_action_that_ignored_the_stop_cannot_move_after_the_reset_and_is_named() -> None:
    async with driving("Shove") as (rig, robot, line):
        line.pull(by=KIM)
        robot.told.clear()
        await rig.until(lambda: any(item.problems[0].code == "ignores_stop" for item in rig.rejections))
        assert "Shove_0 goes on" in rig.rejections[0].problems[0].message
        line.reset(by=KIM)
        rig.resume("g")
        await rig.until(lambda: rig.graph_states("g")[-1:] != ["PAUSED"])
        assert "drive 0.2" not in robot.told


async def test_an_action_that_stood_still_goes_on_after_reset_and_carry_on_but_not_before() -> None:
    async with driving("Roll") as (rig, robot, line):
        line.pull(by=KIM)
        await rig.until_graph("g", "PAUSED")
        robot.told.clear()
        line.reset(by=KIM)
        await WallClock().sleep(0.05)
        assert "drive 0.2" not in robot.told
        rig.resume("g")
        await moves(robot)
        assert rig.rejections == []


async def test_what_swallows_the_end_of_its_graph_has_no_drive_any_more() -> None:
    async with driving("Shove") as (rig, robot, _):
        rig.stop("g")
        await rig.until_graph("g", "STOPPED")
        assert robot.told[-1] == "drive 0"


async def test_stop_and_reset_behind_the_back_of_a_blocked_loop_let_nothing_move() -> None:
    async with driving("RollInAThread") as (rig, robot, line):
        line.pull(by=KIM)
        line.reset(by=KIM)
        robot.told.clear()
        time.sleep(0.1)  # noqa: ASYNC251 - the loop learns of neither
        assert "drive 0" in robot.told
        assert "drive 0.2" not in robot.told
        await rig.until_graph("g", "PAUSED")
        await WallClock().sleep(GRACE_S + 0.1)
        assert any(item.problems[0].code == "ignores_stop" for item in rig.rejections)
        rig.stop("g")
