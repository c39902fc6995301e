"""The occupancy map that a perfect survey of a world would give a robot of a certain height."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import label

from parley.sim.solids import Solid
from parley.sim.world_file import WorldFile
from parley.world.occupancy import FREE, OCCUPIED, UNKNOWN, OccupancyMap

__all__ = ["bounds_m", "survey"]

_MARGIN_M = 0.25


def survey(world: WorldFile, height_m: float, resolution_m: float = 0.05) -> OccupancyMap:
    """Map what stands in the way of a robot of height `height_m`; it may pass under what is higher.

    A cell is occupied if any part of a solid touches it, so thin legs are never missed. Robots and things
    that are not `mapped` are left out. Floor connected to the map's border but to no robot is unknown.
    """
    x_min, y_min, x_max, y_max = bounds_m(world)
    x_min, y_min = _snapped(x_min, resolution_m), _snapped(y_min, resolution_m)
    columns, rows = (math.ceil(size / resolution_m) for size in (x_max - x_min, y_max - y_min))
    empty = OccupancyMap(np.zeros((rows, columns), np.int8), resolution_m, x_min, y_min, world.name)
    cells = np.full((rows, columns), FREE, dtype=np.int8)
    cells[_touched(empty, (solid for solid in _mapped(world) if solid.z_m < height_m))] = OCCUPIED
    robots = [empty.cell_of(robot.pose[0], robot.pose[1]) for robot in world.robots]
    cells[_outside(cells == FREE, robots)] = UNKNOWN
    return OccupancyMap(cells, resolution_m, x_min, y_min, world.name)


def bounds_m(world: WorldFile) -> tuple[float, float, float, float]:
    """x_min, y_min, x_max, y_max of everything mapped and all robots' starts, with a margin around."""
    extents = [solid.extent_m() for solid in _mapped(world)]
    extents += [(*robot.pose[:2], *robot.pose[:2]) for robot in world.robots]
    x_min, y_min, x_max, y_max = zip(*extents, strict=True)
    return (
        min(x_min) - _MARGIN_M, min(y_min) - _MARGIN_M, max(x_max) + _MARGIN_M, max(y_max) + _MARGIN_M,
    )  # fmt: skip


def _mapped(world: WorldFile) -> Iterator[Solid]:
    for wall in world.walls:
        yield from wall.solids()
    for thing in world.things:
        if thing.mapped:
            yield from thing.solids(world.base_of(thing))


def _touched(grid: OccupancyMap, solids: Iterable[Solid]) -> NDArray[np.bool_]:
    rows, columns = grid.cells.shape
    half = grid.resolution_m / 2
    x = grid.origin_x_m + (np.arange(columns) + 0.5) * grid.resolution_m
    y = grid.origin_y_m + (np.arange(rows) + 0.5) * grid.resolution_m
    touched = np.zeros((rows, columns), dtype=np.bool_)
    for solid in solids:
        x_min, y_min, x_max, y_max = solid.extent_m()
        across = slice(*np.searchsorted(x, (x_min - half, x_max + half)))
        along = slice(*np.searchsorted(y, (y_min - half, y_max + half)))
        east, north = x[None, across] - solid.x_m, y[along, None] - solid.y_m
        cos, sin = math.cos(solid.yaw_rad), math.sin(solid.yaw_rad)
        # A cell turned by the solid's yaw reaches this far along the solid's own axes.
        reach = half * (abs(cos) + abs(sin)) - 1e-3
        own_x, own_y = np.abs(cos * east + sin * north), np.abs(cos * north - sin * east)
        half_x, half_y = solid.size_m[0] / 2 + reach, solid.size_m[1] / 2 + reach
        if solid.shape == "box":
            touched[along, across] |= (own_x <= half_x) & (own_y <= half_y)
        else:
            touched[along, across] |= (own_x / half_x) ** 2 + (own_y / half_y) ** 2 <= 1.0
    return touched


def _outside(free: NDArray[np.bool_], inside: Iterable[tuple[int, int]]) -> NDArray[np.bool_]:
    regions, _ = label(free)
    border = {*regions[0], *regions[-1], *regions[:, 0], *regions[:, -1]}
    outer = border - {regions[cell] for cell in inside} - {0}
    return np.asarray(np.isin(regions, list(outer)))


def _snapped(value_m: float, resolution_m: float) -> float:
    """The next multiple of the resolution below, so that walls on round coordinates fill whole cells."""
    return round(math.floor(value_m / resolution_m) * resolution_m, 6)
