"""Planar geometry."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from parley.world.geometry import Pose2D, wrap_angle


@given(st.floats(-1e4, 1e4))
def test_a_wrapped_angle_is_the_same_direction_within_one_turn(angle: float) -> None:
    wrapped = wrap_angle(angle)
    assert -math.pi < wrapped <= math.pi
    assert math.cos(wrapped) == pytest.approx(math.cos(angle), abs=1e-9)
    assert math.sin(wrapped) == pytest.approx(math.sin(angle), abs=1e-9)


def test_distance_and_bearing_between_poses() -> None:
    here = Pose2D(1.0, 1.0, 2.0)
    assert here.distance_to(Pose2D(4.0, 5.0)) == 5.0
    assert here.bearing_to(1.0, 3.0) == pytest.approx(math.pi / 2)
