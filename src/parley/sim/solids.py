"""The bodies of a world as upright solids in the map frame: physics, camera and map are made of them."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

__all__ = ["Shape", "Solid"]

Shape = Literal["box", "cylinder", "ellipsoid"]


@dataclass(frozen=True, slots=True)
class Solid:
    """One upright box, cylinder or ellipsoid."""

    shape: Shape
    size_m: tuple[float, float, float]
    """Full extents along its own x, y and z (a cylinder: diameter, diameter, height)."""
    x_m: float
    y_m: float
    z_m: float
    """Height of its lowest point above the floor."""
    yaw_rad: float
    rgb: tuple[int, int, int]

    def extent_m(self) -> tuple[float, float, float, float]:
        """x_min, y_min, x_max, y_max of its shadow on the floor."""
        length, width, _ = self.size_m
        if self.shape == "box":
            cos, sin = abs(math.cos(self.yaw_rad)), abs(math.sin(self.yaw_rad))
            half_x, half_y = (length * cos + width * sin) / 2, (length * sin + width * cos) / 2
        else:
            half_x = math.hypot(length * math.cos(self.yaw_rad), width * math.sin(self.yaw_rad)) / 2
            half_y = math.hypot(length * math.sin(self.yaw_rad), width * math.cos(self.yaw_rad)) / 2
        return self.x_m - half_x, self.y_m - half_y, self.x_m + half_x, self.y_m + half_y

    def distance_m(self, x_m: float, y_m: float) -> float:
        """How far a point on the floor is from its shadow; 0 inside, for flat ellipses a little too near."""
        east, north = x_m - self.x_m, y_m - self.y_m
        cos, sin = math.cos(self.yaw_rad), math.sin(self.yaw_rad)
        own_x, own_y = abs(cos * east + sin * north), abs(cos * north - sin * east)
        half_x, half_y = self.size_m[0] / 2, self.size_m[1] / 2
        if self.shape == "box":
            return math.hypot(max(own_x - half_x, 0.0), max(own_y - half_y, 0.0))
        return max(math.hypot(own_x / half_x, own_y / half_y) - 1.0, 0.0) * min(half_x, half_y)
