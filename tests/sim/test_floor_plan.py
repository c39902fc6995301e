"""The surveyed occupancy map."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from parley.clock import SimClock
from parley.sim.export import export_maps
from parley.sim.floor_plan import survey
from parley.sim.simulator import Simulator
from parley.world.object_map import ObjectMap
from parley.world.occupancy import OCCUPIED, UNKNOWN, OccupancyMap
from tests.sim.worlds import box, two_rooms

TABLE = [
    {"size_m": (1.0, 0.6, 0.04), "at_m": (0, 0, 0.6)},
    {"size_m": (0.04, 0.04, 0.6), "at_m": (0.45, 0.25, 0)},
]


def value(occupancy: OccupancyMap, x: float, y: float) -> int:
    return int(occupancy.cells[occupancy.cell_of(x, y)])


def test_walls_and_things_are_occupied_and_doorways_free() -> None:
    occupancy = survey(two_rooms(), 0.3)
    assert value(occupancy, 3.0, 2.0) == OCCUPIED
    assert value(occupancy, 5.2, 2.0) == OCCUPIED
    assert occupancy.is_free(3.0, 1.0)
    assert occupancy.is_free(1.0, 1.0)  # where the robot itself stands


def test_what_lies_outside_the_walls_is_unknown() -> None:
    occupancy = survey(two_rooms(), 0.3)
    assert value(occupancy, -0.15, -0.15) == UNKNOWN


def test_without_walls_the_floor_around_a_robot_is_free() -> None:
    occupancy = survey(two_rooms().model_copy(update={"walls": ()}), 0.3)
    assert occupancy.is_free(3.0, 2.0)
    assert not (occupancy.cells == UNKNOWN).any()


def test_low_robots_pass_under_tables_but_never_through_thin_legs() -> None:
    world = two_rooms({"add": [box("table", 1.5, 3.0, mapped=True, parts=TABLE)]})
    low, high = survey(world, 0.3), survey(world, 1.0)
    assert low.is_free(1.5, 3.0)
    assert value(high, 1.5, 3.0) == OCCUPIED
    assert value(low, 1.95, 3.25) == value(high, 1.95, 3.25) == OCCUPIED


def test_things_that_are_not_mapped_are_left_out() -> None:
    assert survey(two_rooms({"add": [box("new", 1.5, 3.0)]}), 0.3).is_free(1.5, 3.0)


@pytest.mark.parametrize("shape", ["box", "cylinder", "ellipsoid"])
def test_what_the_lidar_sees_is_on_the_map(shape: str) -> None:
    """The map is drawn from the world file, the lidar measures the physics: they must tell the same."""
    parts = [{"shape": shape, "size_m": (0.5, 0.5 if shape == "cylinder" else 0.3, 0.8)}]
    thing = box("thing", 1.6, 2.6, mapped=True, parts=parts) | {"pose": (1.6, 2.6, 0.7)}
    simulator = Simulator(two_rooms({"add": [thing]}), clock=SimClock(), seed=1)
    occupancy, pose, sweep = simulator.occupancy("A"), simulator.pose("A"), simulator.scan("A")
    near = occupancy.cells != 0
    for beam, distance in enumerate(sweep.ranges_m):
        if not np.isfinite(distance):
            continue
        angle = pose.yaw_rad + beam * sweep.increment_rad
        row, column = occupancy.cell_of(
            pose.x_m + float(distance) * math.cos(angle), pose.y_m + float(distance) * math.sin(angle)
        )
        assert near[row - 1 : row + 2, column - 1 : column + 2].any(), f"beam {beam} hit nothing mapped"


def test_exported_maps_load_again(tmp_path: Path) -> None:
    world = two_rooms()
    export_maps(world, tmp_path)
    assert ObjectMap.load(tmp_path / "object_map.json") == world.object_map()
    assert np.array_equal(OccupancyMap.load(tmp_path / "map.yaml").cells, survey(world, 0.3).cells)
