"""Upright solids."""

from __future__ import annotations

import math

import pytest

from parley.sim.solids import Shape, Solid


def solid(shape: Shape, yaw_rad: float = 0.0) -> Solid:
    """2 m along its own x, 1 m along its own y, standing at (1, 0)."""
    return Solid(shape, (2.0, 1.0, 0.5), 1.0, 0.0, 0.0, yaw_rad, (0, 0, 0))


@pytest.mark.parametrize("shape", ["box", "ellipsoid"])
def test_the_extent_turns_with_it(shape: Shape) -> None:
    assert solid(shape).extent_m() == pytest.approx((0.0, -0.5, 2.0, 0.5))
    assert solid(shape, math.pi / 2).extent_m() == pytest.approx((0.5, -1.0, 1.5, 1.0))


def test_a_box_turned_halfway_reaches_further_than_an_ellipsoid() -> None:
    box, ellipsoid = (solid(shape, math.pi / 4).extent_m() for shape in ("box", "ellipsoid"))
    assert box[2] - box[0] == pytest.approx(3 / math.sqrt(2))
    assert ellipsoid[2] - ellipsoid[0] == pytest.approx(math.sqrt(2.5))


@pytest.mark.parametrize("shape", ["box", "cylinder", "ellipsoid"])
def test_inside_the_distance_is_zero(shape: Shape) -> None:
    assert solid(shape).distance_m(1.2, 0.1) == 0.0


def test_the_distance_from_a_box_is_to_its_nearest_side_or_corner() -> None:
    assert solid("box").distance_m(2.5, 0.0) == pytest.approx(0.5)
    assert solid("box").distance_m(2.3, 0.9) == pytest.approx(0.5)
    assert solid("box", math.pi / 2).distance_m(2.0, 0.0) == pytest.approx(0.5)


def test_the_distance_from_something_round_is_to_its_rim() -> None:
    drum = Solid("cylinder", (1.0, 1.0, 1.0), 0.0, 0.0, 0.0, 0.0, (0, 0, 0))
    assert drum.distance_m(0.9, 1.2) == pytest.approx(1.0)
