"""People who walk: round and round on a way of their own, and no further while a robot stands in it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Final

import mujoco
import numpy as np
from numpy.typing import NDArray

from parley.sim.build import thing_body
from parley.sim.entries import Thing
from parley.sim.world_file import WorldFile
from parley.world.geometry import Pose2D, wrap_angle

__all__ = ["Walk", "Walkers"]

_KEEPS_M: Final = 0.5
"""What somebody leaves between themselves and the edge of a robot ahead."""


class Walk:
    """Where somebody is who walks from where they stand over the points of their way and back.

    Args:
        thing: Who walks.
        late_s: So long after the world began they set off.
    """

    def __init__(self, thing: Thing, late_s: float) -> None:
        assert thing.walks is not None
        x, y, yaw = thing.pose
        self._points = [(x, y), *thing.walks.over]
        self._speed_mps, self._late_s, self._next = thing.walks.speed_mps, late_s, 1
        self.pose = Pose2D(x, y, yaw)

    def pass_time(self, seconds: float, robots: Sequence[tuple[Pose2D, float]]) -> None:
        """Walk on for so long, if no robot (where it is, its radius) is close ahead."""
        self._late_s -= seconds
        x, y = self._points[self._next % len(self._points)]
        left_m, way_m = math.hypot(x - self.pose.x_m, y - self.pose.y_m), self._speed_mps * seconds
        if self._late_s > 0 or any(self._is_ahead(pose, radius_m) for pose, radius_m in robots):
            return
        if left_m <= way_m:
            self._next += 1
            self.pose = Pose2D(x, y, self.pose.yaw_rad)
            return
        yaw = math.atan2(y - self.pose.y_m, x - self.pose.x_m)
        self.pose = Pose2D(self.pose.x_m + way_m * math.cos(yaw), self.pose.y_m + way_m * math.sin(yaw), yaw)

    def _is_ahead(self, robot: Pose2D, radius_m: float) -> bool:
        x, y = self._points[self._next % len(self._points)]
        way = math.atan2(y - self.pose.y_m, x - self.pose.x_m)
        aside = wrap_angle(self.pose.bearing_to(robot.x_m, robot.y_m) - way)
        return self.pose.distance_to(robot) < radius_m + _KEEPS_M and abs(aside) < math.pi / 2


class Walkers:
    """All who walk in a world.

    Args:
        seed: Chooses when they set off; with 0 all do at once.
    """

    def __init__(self, seed: int) -> None:
        self._seed = seed
        self._walks: dict[str, tuple[Walk, int]] = {}
        """By name, with their place among the bodies that are moved."""

    def enter(self, world: WorldFile, model: mujoco.MjModel, data: mujoco.MjData) -> None:
        """Take over a world that was changed: who is in it, and who was moved."""
        before, self._walks = self._walks, {}
        for thing in world.things:
            if thing.walks is not None:
                walk, _ = before.get(thing.name, (None, 0))
                if walk is None or Pose2D(*thing.pose) != walk.pose:
                    walk = Walk(thing, self._late_s(thing.name))
                self._walks[thing.name] = walk, int(model.body(thing_body(thing.name)).mocapid[0])
        self._arrange(data)

    def pass_time(
        self, seconds: float, robots: Sequence[tuple[Pose2D, float]], world: WorldFile, data: mujoco.MjData
    ) -> WorldFile:
        """Let them walk on; the world with them where they are now."""
        if not self._walks:
            return world
        for walk, _ in self._walks.values():
            walk.pass_time(seconds, robots)
        self._arrange(data)
        return world.with_poses({name: walk.pose for name, (walk, _) in self._walks.items()})

    def poses_of(self, data: mujoco.MjData) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Where they are, for whoever draws them."""
        return data.mocap_pos.copy(), data.mocap_quat.copy()

    def _arrange(self, data: mujoco.MjData) -> None:
        for walk, slot in self._walks.values():
            half = walk.pose.yaw_rad / 2
            data.mocap_pos[slot] = walk.pose.x_m, walk.pose.y_m, 0.0
            data.mocap_quat[slot] = math.cos(half), 0.0, 0.0, math.sin(half)

    def _late_s(self, name: str) -> float:
        rng = np.random.default_rng([self._seed, *name.encode()])
        return float(rng.uniform(0.0, 5.0)) if self._seed else 0.0
