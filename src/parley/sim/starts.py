"""Where robots begin in another run of the same world: a little aside of where its file puts them."""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from parley.sim.entries import RobotEntry
from parley.sim.world_file import WorldFile

__all__ = ["started"]

_ASIDE_M: Final = 0.15
_TURNED_RAD: Final = 0.25
_TRIES: Final = 20
_ROOM_M: Final = 0.1
"""What is left free around a robot that stands where no file says."""


def started(world: WorldFile, seed: int) -> WorldFile:
    """The world as a run with this seed begins it; with seed 0 as its file says."""
    if not seed:
        return world
    robots = [*world.robots]
    for place, robot in enumerate(world.robots):
        rng = np.random.default_rng([seed, place])
        others = [other for other in robots if other.name != robot.name]
        robots[place] = _aside(world, robot, others, rng)
    return world.model_copy(update={"robots": tuple(robots)})


def _aside(
    world: WorldFile, robot: RobotEntry, others: list[RobotEntry], rng: np.random.Generator
) -> RobotEntry:
    """The robot where it has room to begin; where its file says if there is none nearby."""
    x, y, yaw = robot.pose
    for _ in range(_TRIES):
        east, north = rng.uniform(-_ASIDE_M, _ASIDE_M, 2)
        pose = (x + float(east), y + float(north), yaw + float(rng.uniform(-_TURNED_RAD, _TURNED_RAD)))
        moved = robot.model_copy(update={"pose": pose})
        apart = all(
            math.dist(pose[:2], other.pose[:2]) > robot.model.radius_m + other.model.radius_m + _ROOM_M
            for other in others
        )
        if apart and not world.in_the_way(moved, _ROOM_M):
            return moved
    return robot
