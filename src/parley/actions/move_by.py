"""MoveBy: drive a short way straight ahead or back, wherever that leads."""

from __future__ import annotations

import math
from typing import Final, Literal

import numpy as np

from parley.actions.context import ActionContext
from parley.actions.pose import Pose
from parley.actions.steering import steer
from parley.errors import ActionFailure, FailureCode
from parley.robots.base import Velocity
from parley.umrf.action import Outcome, action

__all__ = ["FARTHEST_M", "move_by"]

FARTHEST_M: Final = 20.0
"""Farther away is a place to go to."""
_SPEED_MPS, _SLOWEST_MPS, _BRAKING_MPS2 = 0.3, 0.05, 0.25
_MARGIN_M: Final = 0.05
_ARRIVED_M: Final = 0.01


@action(
    label="Move by {distance} metres: {direction}",
    effects=("moves",),
    capabilities=("drive", "lidar"),
    kinds={"distance": "distance", "direction": "direction"},
    units={"distance": "metres"},
    tests={
        "move forward two metres": {"distance": 2, "direction": "forward"},
        "back up half a metre": {"distance": 0.5, "direction": "back"},
        "don't move forward two metres": None,
    },
)
async def move_by(
    ctx: ActionContext, distance: float, direction: Literal["forward", "back"] = "forward"
) -> Outcome:
    """Move straight forward or back by a distance.

    Args:
        distance: How far, in metres.
        direction: Which way.
    """
    if not 0 < distance <= FARTHEST_M:
        text = f"I can move by up to {FARTHEST_M:.0f} metres at once, not by {distance:g}."
        raise ActionFailure(FailureCode.NOT_CAPABLE, text, {"distance": distance})
    start, sign = ctx.robot.pose(), 1.0 if direction == "forward" else -1.0
    cos, sin = math.cos(start.yaw_rad), math.sin(start.yaw_rad)

    def done_m() -> float:
        here = ctx.robot.pose()
        return sign * ((here.x_m - start.x_m) * cos + (here.y_m - start.y_m) * sin)

    def command() -> Velocity | None:
        left_m = distance - done_m()
        ctx.run.progress(min(1.0, max(0.0, 1.0 - left_m / distance)), f"{max(0.0, left_m):.1f} m to go")
        if left_m <= _ARRIVED_M:
            return None
        room_m = min(left_m, _gap_m(ctx, sign) - _MARGIN_M)
        if room_m <= 0:
            return Velocity()
        speed = min(_SPEED_MPS, max(_SLOWEST_MPS, math.sqrt(2 * _BRAKING_MPS2 * room_m) - _SLOWEST_MPS))
        astray = math.remainder(start.yaw_rad - ctx.robot.pose().yaw_rad, math.tau)
        return Velocity(sign * speed, max(-0.5, min(0.5, 2.0 * astray)))

    def in_vain() -> str:
        return f"I moved {max(0.0, done_m()):.1f} of {distance:g} metres, then the way was closed."

    await steer(ctx, command, in_vain)
    return Outcome(facts={"pose": Pose.of(ctx.robot.pose())})


def _gap_m(ctx: ActionContext, sign: float) -> float:
    """How far it is to what the lidar sees in the robot's way."""
    scan = ctx.robot.scan()
    angles = scan.angle_min_rad + np.arange(len(scan.ranges_m)) * scan.angle_increment_rad
    near = np.isfinite(scan.ranges_m)
    ahead = sign * scan.ranges_m[near] * np.cos(angles[near])
    aside = np.abs(scan.ranges_m[near] * np.sin(angles[near]))
    inside = (aside < ctx.robot.radius_m + _MARGIN_M / 2) & (ahead > 0)
    return float(ahead[inside].min(initial=np.inf)) - ctx.robot.radius_m
