"""Driving without a goal on the map: straight on, back, or on the spot."""

from __future__ import annotations

import asyncio
import math
from collections.abc import Callable
from typing import Final

from parley.actions.context import ActionContext
from parley.errors import ActionFailure, FailureCode
from parley.robots.base import Velocity

__all__ = ["CYCLE_S", "PATIENCE_S", "steer"]

CYCLE_S: Final = 0.1
"""Robot time between two decisions."""
PATIENCE_S: Final = 6.0
"""Robot time in which it waits for what is in the way before it gives up."""

_HELD_POLL_S: Final = 0.02
_STILL_M, _STILL_RAD = 0.01, 0.02


async def steer(
    ctx: ActionContext, command: Callable[[], Velocity | None], in_vain: Callable[[], str]
) -> None:
    """Drive as `command` says until it says None; stands still while paused or stopped, and at the end.

    Args:
        ctx: Of the action.
        command: The next velocity; standing still is waiting for the way to be clear.
        in_vain: What people are told if it does not get on.

    Raises:
        ActionFailure: `blocked`.
    """
    was, waited_s = ctx.robot.pose(), 0.0
    try:
        while True:
            if ctx.run.paused or not ctx.run.motion.allowed:
                ctx.robot.drive(Velocity())
                await ctx.run.wait_while_paused()
                await asyncio.sleep(_HELD_POLL_S)  # how long a person holds a robot is not the robot's time
                continue
            velocity = command()
            if velocity is None:
                return
            ctx.robot.drive(velocity)
            await ctx.clock.sleep(CYCLE_S)
            here = ctx.robot.pose()
            waited_s += CYCLE_S
            if (
                here.distance_to(was) > _STILL_M
                or abs(math.remainder(here.yaw_rad - was.yaw_rad, math.tau)) > _STILL_RAD
            ):
                was, waited_s = here, 0.0
            if waited_s > PATIENCE_S:
                raise ActionFailure(FailureCode.BLOCKED, in_vain())
    finally:
        ctx.robot.drive(Velocity())
