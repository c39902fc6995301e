"""What the lidar saw that is not on the map, remembered until it is seen to be gone."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from parley.robots.base import LaserScan
from parley.world import grids
from parley.world.geometry import Pose2D
from parley.world.occupancy import FREE, OccupancyMap

__all__ = ["ObservedObstacles", "scan_points"]

Floats = NDArray[np.float64]

_KNOWN_WITHIN_M = 0.15
_GONE_BEHIND_M = 0.12


def scan_points(scan: LaserScan, within_m: float) -> Floats:
    """End points of the beams that hit something within a distance; shape (n, 2), in the robot's frame."""
    angles = scan.angle_min_rad + np.arange(len(scan.ranges_m)) * scan.angle_increment_rad
    near = scan.ranges_m < min(within_m, scan.range_max_m)
    ranges = scan.ranges_m[near].astype(np.float64)
    return np.stack([ranges * np.cos(angles[near]), ranges * np.sin(angles[near])], axis=1)


class ObservedObstacles:
    """Cells of a map in which something stands that the map does not know; its length is their number."""

    def __init__(self, occupancy: OccupancyMap, *, within_m: float = 3.0) -> None:
        """Start with nothing seen.

        Args:
            occupancy: The map.
            within_m: What is seen further away is not remembered: there, beams lie too far apart.
        """
        self._map, self._within_m = occupancy, within_m
        reach = round(_KNOWN_WITHIN_M / occupancy.resolution_m)
        self._known = grids.binary_dilation(occupancy.cells != FREE, iterations=max(1, reach))
        self._seen = np.zeros(occupancy.cells.shape, dtype=np.bool_)

    def __len__(self) -> int:
        return int(np.count_nonzero(self._seen))

    @property
    def points_m(self) -> Floats:
        """Shape (n, 2): middles of the cells, in the map frame."""
        return self._map.centers_of(np.argwhere(self._seen))

    def update(self, scan: LaserScan, pose: Pose2D) -> None:
        """Take in a sweep made at `pose`."""
        self._forget_what_is_gone(scan, pose)
        cos, sin = np.cos(pose.yaw_rad), np.sin(pose.yaw_rad)
        turned = scan_points(scan, self._within_m) @ np.array([[cos, sin], [-sin, cos]])
        points = turned + np.array([pose.x_m, pose.y_m])
        self._seen[tuple(self._map.cells_of(points).T)] = True
        self._seen &= ~self._known

    def _forget_what_is_gone(self, scan: LaserScan, pose: Pose2D) -> None:
        """Forget every cell through which a beam passed and hit something well behind it."""
        if len(self) == 0:
            return
        cells = np.argwhere(self._seen)
        offsets = self._map.centers_of(cells) - (pose.x_m, pose.y_m)
        bearings = np.arctan2(offsets[:, 1], offsets[:, 0]) - pose.yaw_rad - scan.angle_min_rad
        beams = np.round(bearings / scan.angle_increment_rad).astype(int)
        distances = np.hypot(offsets[:, 0], offsets[:, 1])
        aside = np.abs(bearings - beams * scan.angle_increment_rad) * distances
        ranges = scan.ranges_m[beams % len(scan.ranges_m)]
        gone = (
            (distances < self._within_m)
            & (aside <= self._map.resolution_m)
            & (ranges > distances + _GONE_BEHIND_M)
        )
        self._seen[tuple(cells[gone].T)] = False
