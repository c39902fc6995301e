"""Which people a simulated robot's camera sees, and where they are: what a person detector would tell."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Final

import mujoco
import numpy as np

from parley.sim.entries import Thing
from parley.sim.robot_model import CameraModel
from parley.sim.world_file import WorldFile
from parley.world.geometry import Pose2D, wrap_angle

__all__ = ["PERSON", "people_in_sight"]

PERSON: Final = "person"
"""The class of things that are people."""
_SIGHT_M: Final = 8.0
_AT: Final = (0.9, 0.5)
"""At which shares of their height people are looked for: one that is not hidden is enough."""


def people_in_sight(
    world: WorldFile,
    model: mujoco.MjModel,
    data: mujoco.MjData,
    bodies: Mapping[int, tuple[str, str]],
    robot: int,
    pose: Pose2D,
    camera: CameraModel,
) -> tuple[tuple[str, float, float], ...]:
    """What each is called and where they stand, the nearest first.

    Args:
        world: Who is there.
        model: Of the world.
        data: Arranged as it is now.
        bodies: Name and label by body.
        robot: The body of who looks.
        pose: Where that is.
        camera: Through which it looks.
    """
    ahead, height = camera.mount_forward_m, camera.mount_height_m
    eye = (pose.x_m + ahead * math.cos(pose.yaw_rad), pose.y_m + ahead * math.sin(pose.yaw_rad), height)
    found: list[tuple[float, str, float, float]] = []
    for thing in world.things:
        if thing.class_name != PERSON:
            continue
        base = world.base_of(thing)
        away_m = math.hypot(base.x_m - eye[0], base.y_m - eye[1])
        aside = wrap_angle(math.atan2(base.y_m - eye[1], base.x_m - eye[0]) - pose.yaw_rad)
        tall_m = max(part.at_m[2] + part.size_m[2] for part in thing.parts)
        if away_m <= _SIGHT_M and abs(aside) <= camera.fov_rad / 2:
            points = [(base.x_m, base.y_m, thing.z_m + share * tall_m) for share in _AT]
            if any(_hit(model, data, eye, point, robot, bodies) == thing.name for point in points):
                found.append((away_m, _called(thing), base.x_m, base.y_m))
    return tuple((name, x, y) for _, name, x, y in sorted(found))


def _called(thing: Thing) -> str:
    return thing.label or thing.words


def _hit(
    model: mujoco.MjModel,
    data: mujoco.MjData,
    eye: tuple[float, float, float],
    point: tuple[float, float, float],
    robot: int,
    bodies: Mapping[int, tuple[str, str]],
) -> str:
    """What stands first between the eye and a point, or at it."""
    start = np.array(eye)
    ray = np.array(point) - start
    geom = np.array([-1], dtype=np.int32)
    mujoco.mj_ray(model, data, start, ray / np.linalg.norm(ray), None, 1, robot, geom)
    return bodies.get(int(model.geom_bodyid[geom[0]]), ("", ""))[0] if geom[0] >= 0 else ""
