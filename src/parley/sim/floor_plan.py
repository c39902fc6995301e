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

__all__ = ["survey"]

_MARGIN_M = 0.25


def survey(world: WorldFile, height_m: float, resolution_m: float = 0.05) -> OccupancyMap:
    """Map what stands in the way of a robot of height `height_m`; it may pass under what is higher.

    A cell is occupied if any part of a solid touches it, so thin legs are never missed. Robots and things
    that are not `mapped` are left out. Floor connected to the map's border but to no robot is unknown.
    """
    solids = [solid for solid in _mapped(world) if solid.z_m < height_m]
    points = [(robot.pose[0], robot.pose[1]) for robot in world.robots]
    extents = [(x, y, x, y) for x, y in points] + [solid.extent_m() for solid in solids]
    x_min, y_min = (_snapped(min(e[i] for e in extents) - _MARGIN_M, resolution_m) for i in (0, 1))
    columns = math.ceil((max(e[2] for e in extents) + _MARGIN_M - x_min) / resolution_m)
    rows = math.ceil((max(e[3] for e in extents) + _MARGIN_M - y_min) / resolution_m)
    empty = OccupancyMap(np.zeros((rows, columns), np.int8), resolution_m, x_min, y_min, world.name)
    cells = np.full((rows, columns), FREE, dtype=np.int8)
    cells[_touched(empty, solids)] = OCCUPIED
    cells[_outside(cells == FREE, [empty.cell_of(x, y) for x, y in points])] = UNKNOWN
    return OccupancyMap(cells, resolution_m, x_min, y_min, world.name)


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
