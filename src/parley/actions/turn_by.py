"""TurnBy: turn on the spot."""

from __future__ import annotations

import math
from typing import Final, Literal

from parley.actions.context import ActionContext
from parley.actions.pose import Pose
from parley.actions.steering import steer
from parley.errors import ActionFailure, FailureCode
from parley.robots.base import Velocity
from parley.umrf.action import Outcome, action

__all__ = ["turn_by"]

_MOST_DEG: Final = 720.0
_RATE_RADPS: Final = 0.8
_ARRIVED_RAD: Final = 0.02


@action(
    label="Turn by {angle} degrees: {direction}",
    effects=("turns",),
    capabilities=("drive",),
    kinds={"angle": "angle", "direction": "direction"},
    units={"angle": "degrees"},
    tests={
        "turn left by ninety degrees": {"angle": 90, "direction": "left"},
        "rotate 45 degrees to the right": {"angle": 45, "direction": "right"},
        "don't turn left by ninety degrees": None,
    },
)
async def turn_by(ctx: ActionContext, angle: float, direction: Literal["left", "right"] = "left") -> Outcome:
    """Turn left or right on the spot by an angle.

    Args:
        angle: How far, in degrees.
        direction: Which way.
    """
    if not 0 < angle <= _MOST_DEG:
        text = f"I can turn by up to {_MOST_DEG:.0f} degrees at once, not by {angle:g}."
        raise ActionFailure(FailureCode.NOT_CAPABLE, text, {"angle": angle})
    sign, wanted = 1.0 if direction == "left" else -1.0, math.radians(angle)
    last, turned = ctx.robot.pose().yaw_rad, 0.0

    def command() -> Velocity | None:
        nonlocal last, turned
        yaw = ctx.robot.pose().yaw_rad
        turned += sign * math.remainder(yaw - last, math.tau)
        last = yaw
        left = wanted - turned
        ctx.run.progress(min(1.0, max(0.0, turned / wanted)))
        if abs(left) <= _ARRIVED_RAD:
            return None
        return Velocity(0.0, sign * max(-_RATE_RADPS, min(_RATE_RADPS, 2.0 * left)))

    await steer(
        ctx, command, lambda: f"I turned {math.degrees(turned):.0f} of {angle:g} degrees, then no further."
    )
    return Outcome(facts={"pose": Pose.of(ctx.robot.pose())})
