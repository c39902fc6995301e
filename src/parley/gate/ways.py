"""How a robot would drive: around what it must keep out of, as if there were walls."""

from __future__ import annotations

import asyncio
from collections.abc import Iterable, Sequence

import numpy as np
from numpy.typing import NDArray

from parley.gate.book import RuleBook
from parley.gate.judge import Judgement, PlannedStep, WayPlanner
from parley.gate.shapes import Shape
from parley.messages.principal import Principal
from parley.messages.rules import Point
from parley.world.geometry import Pose2D
from parley.world.occupancy import OCCUPIED, OccupancyMap
from parley.world.planning import NoPathError, plan_path

__all__ = ["judge_with_ways", "way_planner", "with_walls"]

_EPS_M = 0.02
_MARGIN_M = 0.04


def with_walls(
    occupancy: OccupancyMap, zones: Iterable[Shape], start: Point | None = None, radius_m: float = 0.0
) -> OccupancyMap:
    """The map with zones drawn in as walls.

    Args:
        occupancy: The map.
        zones: What to keep out of.
        start: Where the robot is: in a zone in which it stands already, only what lies deeper is a wall, so
            that it can leave.
        radius_m: Of the robot; it is in a zone as soon as its edge is.
    """
    shapes = list(zones)
    if not shapes:
        return occupancy
    cells = np.array(occupancy.cells)
    for shape in shapes:
        depth_m = 0.0
        if start is not None:
            depth_m = radius_m - shape.distance_to(*start)
        _wall(occupancy, cells, shape, depth_m + _MARGIN_M + _EPS_M if depth_m > 0 else 0.0)
    return OccupancyMap(
        cells, occupancy.resolution_m, occupancy.origin_x_m, occupancy.origin_y_m, occupancy.name
    )


def _wall(occupancy: OccupancyMap, cells: NDArray[np.int8], shape: Shape, deeper_m: float) -> None:
    """Draw what of a shape lies deeper inside than `deeper_m`."""
    x1, y1, x2, y2 = shape.box_m
    (row1, column1), (row2, column2) = occupancy.cell_of(x1, y1), occupancy.cell_of(x2, y2)
    rows, columns = cells.shape
    part = np.s_[max(row1, 0) : min(row2, rows - 1) + 1, max(column1, 0) : min(column2, columns - 1) + 1]
    block = cells[part]
    if block.size == 0:
        return
    where = np.array([part[0].start, part[1].start]) + np.argwhere(np.ones(block.shape, dtype=bool))
    # Half a diagonal more, so that a cell is a wall as soon as a part of it lies in the zone.
    reach = occupancy.resolution_m * 0.71 if deeper_m == 0.0 else 0.0
    inside = shape.distance_m(occupancy.centers_of(where)) < reach - deeper_m
    block[inside.reshape(block.shape)] = OCCUPIED


def way_planner(occupancy: OccupancyMap, zones: Sequence[Shape], *, radius_m: float) -> WayPlanner:
    """How a robot of that radius would drive; blocks, so it belongs into a thread.

    Where no way leads around the zones, the way through them is given: whoever judges it sees that.
    """

    def plan(start: Point, goal: Point) -> Sequence[Point] | None:
        here, there = Pose2D(*start), Pose2D(*goal)
        for grid in (with_walls(occupancy, zones, start, radius_m), occupancy):
            try:
                found = plan_path(grid, here, there, radius_m=radius_m + _MARGIN_M)
            except NoPathError:
                continue
            return [(float(x), float(y)) for x, y in found.points_m]
        return None

    return plan


async def judge_with_ways(
    book: RuleBook,
    robot: str,
    steps: Sequence[PlannedStep],
    occupancy: OccupancyMap,
    *,
    by: Principal | None,
    pose: Pose2D | None,
    people: Sequence[Point] = (),
) -> Judgement:
    """What the rules say about a plan; its ways are planned beside the loop, around what is closed now."""
    zones = [book.shape(rule) for rule in book.closed_to(robot, by)]
    path = way_planner(occupancy, zones, radius_m=book.facts(robot).radius_m)
    now = book.now()
    return await asyncio.to_thread(
        lambda: book.judge_plan(robot=robot, steps=steps, by=by, pose=pose, now=now, path=path, people=people)
    )
