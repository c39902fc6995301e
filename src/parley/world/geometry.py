"""Planar geometry in the map frame (REP 103: metres, radians, counter-clockwise)."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated

from pydantic import Field

__all__ = ["Extent", "Metres", "Pose2D", "Velocity", "wrap_angle"]

Metres = Annotated[float, Field(ge=-1e6, le=1e6, allow_inf_nan=False)]
"""A length or place in a file: what lies a thousand kilometres off is a mistake."""
Extent = Annotated[float, Field(ge=0, le=1e6, allow_inf_nan=False)]
"""The same, never below nothing."""


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


@dataclass(frozen=True, slots=True)
class Velocity:
    """Planar velocity in the robot's frame."""

    linear_mps: float = 0.0
    angular_radps: float = 0.0
    lateral_mps: float = 0.0
    """To the left; only an omnidirectional base can."""

    @property
    def speed_mps(self) -> float:
        """How fast it is, whichever way."""
        return math.hypot(self.linear_mps, self.lateral_mps)

    def slower(self, share: float) -> Velocity:
        """The same way and the same turn, at a share of the speed."""
        return Velocity(share * self.linear_mps, self.angular_radps, share * self.lateral_mps)


def wrap_angle(angle_rad: float) -> float:
    """The same angle in (-pi, pi]."""
    wrapped = math.remainder(angle_rad, math.tau)
    return math.pi if wrapped == -math.pi else wrapped
