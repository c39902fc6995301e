"""Remembering what the map does not know."""

from __future__ import annotations

import math

import numpy as np
import pytest

from parley.robots.base import LaserScan
from parley.robots.obstacles import ObservedObstacles, scan_points
from parley.world.geometry import Pose2D
from parley.world.occupancy import OCCUPIED, OccupancyMap

HERE = Pose2D(2.0, 2.0, math.pi / 2)


def ground() -> OccupancyMap:
    """4 x 4 m, free but for a wall along the upper border."""
    cells = np.zeros((80, 80), np.int8)
    cells[-2:] = OCCUPIED
    return OccupancyMap(cells, 0.05, 0.0, 0.0)


def scan(**ranges_m: float) -> LaserScan:
    """Four beams; `inf` where nothing is said."""
    order = ("ahead", "left", "behind", "right")
    values = np.array([ranges_m.get(name, math.inf) for name in order], dtype=np.float32)
    return LaserScan(0.0, math.pi / 2, values, 8.0, 0.0)


def test_beams_become_points_in_the_robots_frame() -> None:
    points = scan_points(scan(ahead=1.0, left=2.0, behind=7.0), within_m=3.0)
    assert points == pytest.approx(np.array([[1.0, 0.0], [0.0, 2.0]]), abs=1e-6)


def test_something_new_is_remembered_in_the_map_frame() -> None:
    seen = ObservedObstacles(ground())
    seen.update(scan(ahead=1.0), HERE)
    assert seen.points_m == pytest.approx(np.array([[2.0, 3.0]]), abs=0.05)


def test_what_the_map_knows_is_not_remembered() -> None:
    seen = ObservedObstacles(ground())
    seen.update(scan(ahead=1.88), HERE)
    assert len(seen) == 0


def test_it_is_remembered_while_nobody_looks() -> None:
    seen = ObservedObstacles(ground())
    seen.update(scan(ahead=1.0), HERE)
    seen.update(scan(), Pose2D(2.0, 2.0, math.pi / 4))  # no beam passes near it
    assert len(seen) == 1


def test_it_is_forgotten_when_a_beam_passes_through_its_place() -> None:
    seen = ObservedObstacles(ground())
    seen.update(scan(ahead=1.0), HERE)
    seen.update(scan(ahead=1.88), HERE)
    assert len(seen) == 0


def test_what_lies_far_away_is_not_remembered() -> None:
    seen = ObservedObstacles(ground(), within_m=0.5)
    seen.update(scan(ahead=1.0), HERE)
    assert len(seen) == 0
