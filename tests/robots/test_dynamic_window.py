"""Choosing the next velocity."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from parley.robots.base import DriveLimits, Velocity
from parley.robots.dynamic_window import choose_velocity

LIMITS = DriveLimits(0.26, 1.8, 0.5, 3.0, keep_out_m=0.22)
NOTHING = np.empty((0, 2))
CYCLE_S = 0.1

coordinates = st.floats(-2.0, 2.0)


@settings(deadline=None)
@given(
    target=st.tuples(coordinates, coordinates),
    obstacles=st.lists(st.tuples(coordinates, coordinates), max_size=8),
    speed=st.floats(0.0, 0.26),
    turn=st.floats(-1.8, 1.8),
)
def test_the_choice_is_always_within_the_limits_and_never_backwards(
    target: tuple[float, float], obstacles: list[tuple[float, float]], speed: float, turn: float
) -> None:
    chosen = choose_velocity(
        Velocity(speed, turn), target, np.array(obstacles).reshape(-1, 2), LIMITS, CYCLE_S
    )
    assert -1e-9 <= chosen.linear_mps <= LIMITS.max_speed_mps + 1e-9
    assert abs(chosen.angular_radps) <= LIMITS.max_turn_radps + 1e-9


def test_it_accelerates_towards_a_far_target() -> None:
    chosen = choose_velocity(Velocity(0.1, 0.0), (1.0, 0.0), NOTHING, LIMITS, CYCLE_S)
    assert chosen.linear_mps == pytest.approx(0.15)
    assert abs(chosen.angular_radps) < 0.1


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_it_turns_on_the_spot_towards_what_lies_aside(side: float) -> None:
    chosen = choose_velocity(Velocity(), (0.0, side), NOTHING, LIMITS, CYCLE_S)
    assert chosen.linear_mps == 0.0
    assert math.copysign(1.0, chosen.angular_radps) == side


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_an_omnidirectional_base_goes_aside_at_once_and_turns_meanwhile(side: float) -> None:
    able = replace(LIMITS, max_lateral_mps=0.2)
    chosen = choose_velocity(Velocity(), (0.3, side), NOTHING, able, CYCLE_S)
    assert math.copysign(1.0, chosen.lateral_mps) == math.copysign(1.0, chosen.angular_radps) == side
    assert 0.0 < abs(chosen.lateral_mps) <= 0.05 + 1e-9  # what it can reach within a cycle


def test_it_slows_down_before_the_target() -> None:
    chosen = choose_velocity(Velocity(0.1, 0.0), (0.01, 0.0), NOTHING, LIMITS, CYCLE_S)
    assert chosen.linear_mps < 0.1


def test_it_steers_around_what_stands_ahead() -> None:
    obstacle = np.array([[0.4, 0.05]])
    velocity = Velocity(0.2, 0.0)
    for _ in range(5):
        velocity = choose_velocity(velocity, (0.8, -0.1), obstacle, LIMITS, CYCLE_S)
    assert velocity.angular_radps < -0.05


def test_it_does_not_drive_into_a_wall() -> None:
    wall = np.array([[0.225, y] for y in np.arange(-1.0, 1.0, 0.02)])
    chosen = choose_velocity(Velocity(), (0.5, 0.0), wall, LIMITS, CYCLE_S)
    assert chosen.linear_mps == 0.0


def test_standing_too_close_to_something_it_may_still_drive_away() -> None:
    behind = np.array([[-0.2, 0.0]])
    chosen = choose_velocity(Velocity(), (1.0, 0.0), behind, LIMITS, CYCLE_S)
    assert chosen.linear_mps > 0.0
