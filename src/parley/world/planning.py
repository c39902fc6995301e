"""Paths for a round robot over an occupancy map, keeping clear of walls where there is room."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from parley.errors import ParleyError
from parley.world import grids
from parley.world.geometry import Pose2D
from parley.world.occupancy import FREE, OCCUPIED, OccupancyMap

__all__ = [
    "NO_OBSTACLES", "NoPathError", "Path", "clearance_m", "passable", "plan_path", "travel_costs",
    "way_lengths_m",
]  # fmt: skip

NO_OBSTACLES: NDArray[np.float64] = np.empty((0, 2))
"""Nothing seen that is not on the map."""

MAX_CELLS = 1_000_000
"""Larger maps are planned on coarser cells: the search costs grow faster than anybody needs the precision."""

_WALL_COST = 6.0
_WALL_DECAY_M = 0.15


class NoPathError(ParleyError):
    """No way leads to the goal.

    Attributes:
        obstructed: True if the map alone has a way, but what was seen stands in it.
        at: What obstructs that way first (map frame, metres); None if the map has no way.
    """

    def __init__(self, message: str, *, at: tuple[float, float] | None = None) -> None:
        self.obstructed, self.at = at is not None, at
        super().__init__(message)


@dataclass(frozen=True, slots=True, eq=False)
class Path:
    """A way from the start to the goal."""

    points_m: NDArray[np.float64]
    """Shape (n, 2), n >= 1: map-frame x and y, about a map cell apart."""

    @property
    def length_m(self) -> float:
        """Length of the whole way."""
        return self.remaining_m(0)

    def remaining_m(self, index: int) -> float:
        """Length of the way from point `index` to the end."""
        return float(np.linalg.norm(np.diff(self.points_m[index:], axis=0), axis=1).sum())

    def nearest(self, x_m: float, y_m: float, after: int = 0) -> int:
        """Index of the point nearest to a position, among those from index `after` on."""
        gaps = np.hypot(self.points_m[after:, 0] - x_m, self.points_m[after:, 1] - y_m)
        return after + int(np.argmin(gaps))

    def ahead(self, index: int, distance_m: float) -> tuple[float, float]:
        """The point about `distance_m` further along than point `index`, at most the end."""
        steps = np.linalg.norm(np.diff(self.points_m[index:], axis=0), axis=1).cumsum()
        further = int(np.searchsorted(steps, distance_m))
        x, y = self.points_m[min(index + further + 1, len(self.points_m) - 1)]
        return float(x), float(y)


def clearance_m(
    occupancy: OccupancyMap, obstacles: NDArray[np.float64] = NO_OBSTACLES
) -> NDArray[np.float64]:
    """Distance of every cell's centre from the nearest floor that is not known to be free.

    Args:
        occupancy: The map; what lies beyond its border counts as not free.
        obstacles: Shape (n, 2), points in the map frame that were seen besides.

    Returns:
        Shape of `occupancy.cells`, in metres.
    """
    free = np.pad(occupancy.free, 1)
    rows, columns = occupancy.cells_of(obstacles).T
    free[rows + 1, columns + 1] = False
    cells = np.asarray(grids.distance_transform_edt(free))[1:-1, 1:-1]
    # Measured from centre to centre; the obstacle begins half a cell earlier.
    return np.asarray(np.maximum(cells - 0.5, 0.0) * occupancy.resolution_m)


def passable(
    occupancy: OccupancyMap, clearance: NDArray[np.float64], start: Pose2D, radius_m: float
) -> NDArray[np.bool_]:
    """Cells on which a robot of that radius can stand.

    A robot that already stands closer to something than its radius (maps are coarser than the world) may move
    on as long as it comes no closer; otherwise it could never leave.
    """
    allowed = clearance >= radius_m
    row, column = occupancy.cell_of(start.x_m, start.y_m)
    if occupancy.contains(row, column) and not allowed[row, column]:
        reach = math.ceil((radius_m + 0.1) / occupancy.resolution_m)
        around = (
            slice(max(row - reach, 0), row + reach + 1),
            slice(max(column - reach, 0), column + reach + 1),
        )
        allowed[around] |= occupancy.free[around] & (clearance[around] >= clearance[row, column])
    return allowed


def travel_costs(
    allowed: NDArray[np.bool_], clearance: NDArray[np.float64], radius_m: float
) -> NDArray[np.float64]:
    """Cost of crossing each cell: 1 in the open, more near walls, infinite where the robot cannot stand."""
    near = _WALL_COST * np.exp(-np.maximum(clearance - radius_m, 0.0) / _WALL_DECAY_M)
    return np.where(allowed, 1.0 + near, np.inf)


def plan_path(
    occupancy: OccupancyMap,
    start: Pose2D,
    goal: Pose2D,
    *,
    radius_m: float,
    obstacles: NDArray[np.float64] = NO_OBSTACLES,
) -> Path:
    """Find a way for a round robot.

    Args:
        occupancy: The map.
        start: Where the robot is.
        goal: Where its centre shall come to; the yaw does not matter.
        radius_m: What it keeps from everything that is not free.
        obstacles: Shape (n, 2), points in the map frame that were seen and are not on the map.

    Raises:
        NoPathError: The map has no way, or (`obstructed`) it has one but the obstacles stand in it.
    """
    grid = _coarser(occupancy)
    points = _search(grid, clearance_m(grid, obstacles), start, goal, radius_m)
    if points is not None:
        return Path(points)
    way = _search(grid, clearance_m(grid), start, goal, radius_m) if len(obstacles) else None
    if way is None:
        raise NoPathError(f"the map has no way to ({goal.x_m:.2f}, {goal.y_m:.2f})")
    gaps = np.hypot(*(way[:, None, :] - obstacles[None, :, :]).transpose(2, 0, 1))
    first = int(np.argmax(gaps.min(axis=1) <= radius_m + grid.resolution_m))
    x, y = (float(value) for value in obstacles[np.argmin(gaps[first])])
    raise NoPathError(
        f"something stands in the way to ({goal.x_m:.2f}, {goal.y_m:.2f}), near ({x:.2f}, {y:.2f})", at=(x, y)
    )


def way_lengths_m(
    occupancy: OccupancyMap, start: Pose2D, goals: Sequence[tuple[float, float]], *, radius_m: float
) -> list[float]:
    """How long the ways to several goals are, by one search; infinite where the map has none."""
    grid = _coarser(occupancy)
    clearance = clearance_m(grid)
    allowed = passable(grid, clearance, start, radius_m)
    here, cells = grid.cell_of(start.x_m, start.y_m), [grid.cell_of(*goal) for goal in goals]
    inside = [grid.contains(*cell) and bool(allowed[cell]) for cell in cells]
    if not grid.contains(*here) or not any(inside):
        return [math.inf] * len(goals)
    allowed[here] = True  # wherever it stands, it stands there
    search = grids.MCP_Geometric(travel_costs(allowed, clearance, radius_m))
    costs, _ = search.find_costs([here], [cell for cell, known in zip(cells, inside, strict=True) if known])
    found: list[float] = []
    for cell, known in zip(cells, inside, strict=True):
        there = known and bool(np.isfinite(costs[cell]))
        found.append(Path(grid.centers_of(np.array(search.traceback(cell)))).length_m if there else math.inf)
    return found


def _search(
    grid: OccupancyMap, clearance: NDArray[np.float64], start: Pose2D, goal: Pose2D, radius_m: float
) -> NDArray[np.float64] | None:
    ends = grid.cell_of(start.x_m, start.y_m), grid.cell_of(goal.x_m, goal.y_m)
    if not all(grid.contains(*cell) for cell in ends):
        return None
    allowed = passable(grid, clearance, start, radius_m)
    if not allowed[ends[1]]:
        return None
    allowed[ends[0]] = True  # wherever it stands, it stands there
    try:
        cells, _ = grids.route_through_array(  # type: ignore[no-untyped-call]
            travel_costs(allowed, clearance, radius_m), *ends, fully_connected=True, geometric=True
        )
    except ValueError:  # how route_through_array says that no path exists
        return None
    points = grid.centers_of(np.array(cells))
    points[-1] = goal.x_m, goal.y_m
    return points


def _coarser(occupancy: OccupancyMap) -> OccupancyMap:
    """The same map with at most `MAX_CELLS` cells; a coarse cell is free if all of it is."""
    factor = math.ceil(math.sqrt(occupancy.cells.size / MAX_CELLS))
    if factor <= 1:
        return occupancy
    rows, columns = (math.ceil(size / factor) for size in occupancy.cells.shape)
    padded = np.zeros((rows * factor, columns * factor), dtype=np.bool_)
    padded[: occupancy.cells.shape[0], : occupancy.cells.shape[1]] = occupancy.free
    free = padded.reshape(rows, factor, columns, factor).all(axis=(1, 3))
    return OccupancyMap(
        np.where(free, FREE, OCCUPIED).astype(np.int8),
        occupancy.resolution_m * factor,
        occupancy.origin_x_m,
        occupancy.origin_y_m,
        occupancy.name,
    )
