"""Where to stand in front of something: free, reachable, near, with it in view."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from parley.world import grids
from parley.world.geometry import Pose2D, wrap_angle
from parley.world.object_map import MapArea, MapObject
from parley.world.occupancy import NO_MAP, OccupancyMap
from parley.world.planning import clearance_m, passable, travel_costs

__all__ = ["Spot", "approach_pose"]

Floats = NDArray[np.float64]
Spot = tuple[float, float, float]
"""A robot's place: x, y and its radius, in metres."""

_FARTHER_M = 0.7
"""How much further away than wished is still near."""
_MARGIN_M = 0.05
_BETWEEN_M = 0.25
"""What robots leave between them where they stand."""
_FRONT_HALF_ANGLE_RAD = math.radians(50)
# What one metre off the wished standoff, one metre off the middle of the front, and one metre of way weigh
# against each other: the right spot matters, a shorter way decides between equally good ones.
_STANDOFF_WEIGHT, _ASIDE_WEIGHT, _WAY_WEIGHT = 6.0, 4.0, 0.5


@dataclass(frozen=True, slots=True)
class _Candidates:
    cells: NDArray[np.intp]
    """Shape (n, 2): rows and columns."""
    x_m: Floats
    y_m: Floats
    gap_m: Floats
    """Distance to the object's bounding box."""


def approach_pose(
    occupancy: OccupancyMap,
    target: MapObject,
    start: Pose2D,
    *,
    radius_m: float,
    standoff_m: float = 0.45,
    taken: Sequence[Spot] = (),
) -> Pose2D | None:
    """A pose near an object, facing it, that the robot can drive to.

    Args:
        occupancy: The map. With `NO_MAP` whoever drives has to find out what is free.
        target: The object; with `front_rad`, only spots on that side count. With `stand`, that one, as long
            as it can be reached and nobody else is there. Of a room: a spot in it.
        start: Where the robot is; of equally good spots it gets the one with the shorter way.
        radius_m: Of the robot.
        standoff_m: Wished distance between the robot's edge and the object's bounding box.
        taken: Where others stand or are going to; as long as there is another spot, they are kept clear of.

    Returns:
        The pose, always the same for the same arguments; None if no such spot can be reached.
    """
    wished_m = radius_m + standoff_m
    if occupancy is NO_MAP:
        return target.stand or _before(target, start, wished_m)
    radius_m += _MARGIN_M
    clearance = clearance_m(occupancy)
    allowed = passable(occupancy, clearance, start, radius_m)
    row, column = occupancy.cell_of(start.x_m, start.y_m)
    if not occupancy.contains(row, column):
        return None
    allowed[row, column] = True
    near = _near(occupancy, target, allowed, 0.0 if target.area else wished_m + _FARTHER_M)
    if len(near.cells) == 0 and target.stand is None:
        return None
    near = _clear_of(taken, near, radius_m)
    way, _ = grids.MCP_Geometric(travel_costs(allowed, clearance, radius_m)).find_costs([(row, column)])
    if target.stand is not None and _is_free(target.stand, occupancy, way, taken, radius_m):
        return target.stand
    if target.area is not None:
        return _inside(near, target.area, target, start, np.isfinite(way[tuple(near.cells.T)]))
    score = (
        _STANDOFF_WEIGHT * np.abs(near.gap_m - wished_m)
        + _WAY_WEIGHT * way[tuple(near.cells.T)] * occupancy.resolution_m
        + _front_score(target, near)
    )
    for choice in np.argsort(score, kind="stable"):
        if not np.isfinite(score[choice]):
            return None
        spot = Pose2D(float(near.x_m[choice]), float(near.y_m[choice]))
        if _in_view(occupancy, spot, target):
            return Pose2D(spot.x_m, spot.y_m, spot.bearing_to(target.x_m, target.y_m))
    return None


def _is_free(
    stand: Pose2D, occupancy: OccupancyMap, way: Floats, taken: Sequence[Spot], radius_m: float
) -> bool:
    """Whether a robot gets to where it is to stand, and nobody else is there."""
    cell = occupancy.cell_of(stand.x_m, stand.y_m)
    others = (math.hypot(stand.x_m - x, stand.y_m - y) > radius_m + r + _BETWEEN_M for x, y, r in taken)
    return occupancy.contains(*cell) and bool(np.isfinite(way[cell])) and all(others)


def _clear_of(taken: Sequence[Spot], near: _Candidates, radius_m: float) -> _Candidates:
    """Those where nobody else stands; all if there are none."""
    clear = np.ones(len(near.x_m), dtype=np.bool_)
    for x_m, y_m, other_m in taken:
        clear &= np.hypot(near.x_m - x_m, near.y_m - y_m) > radius_m + other_m + _BETWEEN_M
    if not clear.any():
        return near
    return _Candidates(near.cells[clear], near.x_m[clear], near.y_m[clear], near.gap_m[clear])


def _inside(
    near: _Candidates, area: MapArea, target: MapObject, start: Pose2D, reached: NDArray[np.bool_]
) -> Pose2D | None:
    """The spot in a room that is nearest to its middle, looking on in the direction of the drive."""
    for choice in np.argsort(np.hypot(near.x_m - target.x_m, near.y_m - target.y_m), kind="stable"):
        x, y = float(near.x_m[choice]), float(near.y_m[choice])
        if reached[choice] and area.holds(x, y):
            return Pose2D(x, y, start.bearing_to(x, y))
    return None


def _before(target: MapObject, start: Pose2D, wished_m: float) -> Pose2D:
    """The spot so far in front of an object, or else on the side from which the robot comes."""
    if target.area is not None:
        return Pose2D(target.x_m, target.y_m, start.bearing_to(target.x_m, target.y_m))
    side = target.front_rad
    if side is None:
        side = math.atan2(start.y_m - target.y_m, start.x_m - target.x_m)
    cos, sin = math.cos(side), math.sin(side)
    away_m = (abs(cos) * target.width_m + abs(sin) * target.height_m) / 2 + wished_m
    return Pose2D(target.x_m + cos * away_m, target.y_m + sin * away_m, wrap_angle(side + math.pi))


def _near(
    occupancy: OccupancyMap, target: MapObject, allowed: NDArray[np.bool_], within_m: float
) -> _Candidates:
    cells = np.argwhere(allowed)
    x, y = np.round(occupancy.centers_of(cells), 4).T
    gap = np.hypot(
        np.maximum(np.abs(x - target.x_m) - target.width_m / 2, 0.0),
        np.maximum(np.abs(y - target.y_m) - target.height_m / 2, 0.0),
    )
    close = gap <= within_m
    return _Candidates(cells[close], x[close], y[close], gap[close])


def _front_score(target: MapObject, near: _Candidates) -> Floats:
    """Infinite where the object's front cannot be seen from, more the further off its middle line."""
    if target.front_rad is None:
        return np.zeros(len(near.gap_m))
    cos, sin = math.cos(target.front_rad), math.sin(target.front_rad)
    ahead = cos * (near.x_m - target.x_m) + sin * (near.y_m - target.y_m)
    aside = np.abs(cos * (near.y_m - target.y_m) - sin * (near.x_m - target.x_m))
    face = (abs(cos) * target.width_m + abs(sin) * target.height_m) / 2
    in_front = (ahead > face) & (np.arctan2(aside, ahead) <= _FRONT_HALF_ANGLE_RAD)
    return np.where(in_front, _ASIDE_WEIGHT * aside, np.inf)


def _in_view(occupancy: OccupancyMap, spot: Pose2D, target: MapObject) -> bool:
    """Whether only free floor lies between a spot and the nearest point of the object's bounding box."""
    x = float(np.clip(spot.x_m, target.x_m - target.width_m / 2, target.x_m + target.width_m / 2))
    y = float(np.clip(spot.y_m, target.y_m - target.height_m / 2, target.y_m + target.height_m / 2))
    # The map draws the object itself up to a cell beyond its box.
    length = max(0.0, math.hypot(x - spot.x_m, y - spot.y_m) - 1.5 * occupancy.resolution_m)
    bearing = spot.bearing_to(x, y)
    return all(
        occupancy.is_free(spot.x_m + math.cos(bearing) * step, spot.y_m + math.sin(bearing) * step)
        for step in np.arange(0.0, length, occupancy.resolution_m / 2)
    )
