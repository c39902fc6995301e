"""What becomes of a command on a slippery floor."""

from __future__ import annotations

import numpy as np

from parley.sim.entries import RobotEntry
from parley.world.geometry import Velocity

__all__ = ["slipped"]


def slipped(told: Velocity, robot: RobotEntry, rng: np.random.Generator) -> Velocity:
    """The velocity that is left: each side loses another share of it."""
    if not robot.slip or told == Velocity():
        return told
    left, right, aside = 1.0 - rng.uniform(0.0, 2 * robot.slip, 3)
    arm_m = robot.model.radius_m
    wheels = (
        (told.linear_mps - arm_m * told.angular_radps) * left,
        (told.linear_mps + arm_m * told.angular_radps) * right,
    )
    turn = (wheels[1] - wheels[0]) / (2 * arm_m)
    return Velocity(float(sum(wheels) / 2), float(turn), float(told.lateral_mps * aside))
