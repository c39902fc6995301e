"""The simulated lidar: one sweep is one call that casts all beams."""

from __future__ import annotations

import math
from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray

from parley.sim.robot_model import LidarModel
from parley.world.geometry import Pose2D

__all__ = ["Sweep", "sweep"]


@dataclass(frozen=True, slots=True, eq=False)
class Sweep:
    """Ranges counter-clockwise from straight ahead; `inf` where nothing was in range."""

    ranges_m: NDArray[np.float32]
    range_max_m: float
    stamp_s: float

    @property
    def increment_rad(self) -> float:
        """Angle from one beam to the next."""
        return math.tau / len(self.ranges_m)


def sweep(
    model: mujoco.MjModel,
    data: mujoco.MjData,
    body_id: int,
    pose: Pose2D,
    lidar: LidarModel,
    noise_m: float,
    rng: np.random.Generator,
    stamp_s: float,
) -> Sweep:
    """Scan from above the robot's centre; `body_id` is the robot's own body, which it does not see."""
    angles = pose.yaw_rad + np.arange(lidar.beams) * (math.tau / lidar.beams)
    beams = np.stack([np.cos(angles), np.sin(angles), np.zeros_like(angles)], axis=1)
    geoms = np.empty(lidar.beams, dtype=np.int32)
    distances = np.empty(lidar.beams)
    mujoco.mj_multiRay(
        model, data, (pose.x_m, pose.y_m, lidar.mount_height_m), beams.ravel(), None, 1, body_id,
        geoms, distances, None, lidar.beams, lidar.range_m,
    )  # fmt: skip
    noisy = distances + rng.normal(0.0, noise_m, lidar.beams) if noise_m else distances
    hit = (geoms >= 0) & (distances <= lidar.range_m)
    ranges = np.where(hit, np.maximum(noisy, 0.0), np.inf).astype(np.float32)
    return Sweep(ranges, lidar.range_m, stamp_s)
