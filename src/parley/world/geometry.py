"""Planar geometry in the map frame (REP 103: metres, radians, counter-clockwise)."""

from __future__ import annotations

import math
from dataclasses import dataclass

__all__ = ["Pose2D", "wrap_angle"]


@dataclass(frozen=True, slots=True)
class Pose2D:
    """A position and heading in the map frame."""

    x_m: float
    y_m: float
    yaw_rad: float = 0.0

    def distance_to(self, other: Pose2D) -> float:
        """Straight distance in metres."""
        return math.hypot(other.x_m - self.x_m, other.y_m - self.y_m)

    def bearing_to(self, x_m: float, y_m: float) -> float:
        """Map-frame direction from here to a point, in radians."""
        return math.atan2(y_m - self.y_m, x_m - self.x_m)


def wrap_angle(angle_rad: float) -> float:
    """The same angle in (-pi, pi]."""
    wrapped = math.remainder(angle_rad, math.tau)
    return math.pi if wrapped == -math.pi else wrapped
