"""No command and no way leads a robot into a zone that it must keep out of."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from parley.clock import SimClock
from parley.gate.book import RuleBook
from parley.gate.fence import Fence
from parley.gate.judge import RobotFacts
from parley.gate.shapes import Shape
from parley.gate.ways import way_planner
from parley.messages.rules import Rule, RuleSet
from parley.world.geometry import Pose2D, Velocity
from parley.world.occupancy import FREE, OccupancyMap

RADIUS_M, BRAKING, STEP_S = 0.2, 0.5, 0.05
SQUARE = ((-0.332, -2.331), (1.312, -2.331), (1.312, -1.003), (-0.332, -1.003))
L_SHAPE = ((0.0, 0.0), (2.0, 0.0), (2.0, 0.8), (0.8, 0.8), (0.8, 2.0), (0.0, 2.0))
FLOOR = OccupancyMap(np.full((80, 80), FREE, dtype=np.int8), 0.1, -4.0, -4.0)

STILL = Velocity()
MOVES = st.tuples(st.floats(-1, 1), st.floats(-2, 2), st.one_of(st.just(0.0), st.floats(-1, 1)))

near = st.floats(-3.0, 4.0)
shapes = st.one_of(
    st.just(L_SHAPE),
    st.tuples(near, near, st.floats(0.05, 2), st.floats(0.05, 2)).map(
        lambda r: ((r[0], r[1]), (r[0] + r[2], r[1]), (r[0] + r[2], r[1] + r[3]), (r[0], r[1] + r[3]))
    ),
)


def fence(*rules: dict[str, Any]) -> Fence:
    book = RuleBook(SimClock(), RuleSet(rules=tuple(Rule(**rule) for rule in rules)))
    book.know("Ada", RobotFacts("hall", RADIUS_M, 1.0))
    return Fence(book, "Ada", braking_mps2=BRAKING)


def zone(corners: Any, **more: Any) -> dict[str, Any]:
    return {"id": "z", "kind": "keep_out", "polygon": corners} | more


def towards(now: float, wanted: float, change: float) -> float:
    return now + max(-change, min(change, wanted - now))


@settings(max_examples=60, deadline=None)
@example(  # a turn that changes while it drives backwards out of an edge
    shape=L_SHAPE, at=(0.5, 0.0, 0.0), commands=[(0.0, 0.75), (0.0, -1.0), (-1.0, -1.5), (0.0, 0.0)]
)
@example(  # forwards as fast as it can, then back and aside: it rolls on for a while, the other way round
    shape=SQUARE, at=(0.143, 1.008, -0.308), commands=[(1.0, -0.104), (1.0, -2.0), (1.0, 0.0), (-1.0, 2.0)]
)
@example(  # to the left past a corner, still turning when it is told to come back
    shape=L_SHAPE,
    at=(2.39, 1.166, -1.152),
    commands=[(-1.0, 0.409, 1.0), (-1.0, 2.0, 1.0), (0.353, 0.0, -1.0), (-0.196, 2.0, -0.409)],
)
@given(
    shape=shapes,
    at=st.tuples(near, near, st.floats(-math.pi, math.pi)),
    commands=st.lists(MOVES, min_size=1, max_size=6),
)
def test_no_velocities_lead_inside_and_from_inside_none_lead_deeper(
    shape: Any, at: tuple[float, float, float], commands: list[tuple[float, ...]]
) -> None:
    guard, closed = fence(zone(shape)), Shape(shape)
    x, y, yaw = at
    speed = turn = left = 0.0
    start_m = least = closed.distance_to(x, y)
    keep_m = RADIUS_M if start_m >= RADIUS_M else start_m - RADIUS_M - 0.15
    for command in [command for command in commands for _ in range(20)]:
        allowed = guard.limit(Pose2D(x, y, yaw), Velocity(speed, turn, left), Velocity(*command))
        speed = towards(speed, allowed.linear_mps, BRAKING * STEP_S)
        turn = towards(turn, allowed.angular_radps, 3.0 * STEP_S)
        left = towards(left, allowed.lateral_mps, BRAKING * STEP_S)
        x += (speed * math.cos(yaw) - left * math.sin(yaw)) * STEP_S
        y += (speed * math.sin(yaw) + left * math.cos(yaw)) * STEP_S
        yaw += turn * STEP_S
        least = min(least, closed.distance_to(x, y))
    assert least >= keep_m


@settings(max_examples=40, deadline=None)
@given(shape=shapes, ends=st.tuples(near, near, near, near))
def test_no_planned_way_leads_inside_while_there_is_one_around(
    shape: Any, ends: tuple[float, float, float, float]
) -> None:
    closed = Shape(shape)
    start, goal = ends[:2], ends[2:]
    if min(closed.distance_to(*start), closed.distance_to(*goal)) < RADIUS_M + 0.25:
        return
    way = way_planner(FLOOR, [closed], radius_m=RADIUS_M)(start, goal)
    if way is not None and all(abs(value) < 3 for value in (*closed.box_m, *ends)):
        assert closed.distance_m(np.array(way)).min() >= RADIUS_M


def test_who_stands_inside_gets_out() -> None:
    inside = (0.4, 1.0)
    way = way_planner(FLOOR, [Shape(L_SHAPE)], radius_m=RADIUS_M)(inside, (-2.0, 1.0))
    assert way is not None and way[-1] == (-2.0, 1.0)
    depths = -Shape(L_SHAPE).distance_m(np.array(way))
    assert depths.max() <= depths[0] + 0.1
    guard = fence(zone(((-9, -9), (9, -9), (9, 9), (-9, 9))))
    for x in np.arange(8.0, 9.3, 0.05):
        assert guard.limit(Pose2D(float(x), 0, 0), STILL, Velocity(0.5)) == Velocity(0.5)
    assert guard.limit(Pose2D(9.22, 0, math.pi), STILL, Velocity(0.5)) == STILL


def test_who_stands_inside_gets_no_deeper_than_it_takes_to_turn_out() -> None:
    guard, x = fence(zone(((-9, -9), (9, -9), (9, 9), (-9, 9)))), 8.0
    while guard.limit(Pose2D(x, 0, math.pi), STILL, Velocity(0.5)).linear_mps > 0.1:
        x -= 0.01
    assert 8.0 - x <= RADIUS_M + 0.08


def test_turning_on_the_spot_is_always_free() -> None:
    assert fence(zone(L_SHAPE)).limit(Pose2D(-0.21, 1.0, 0.0), STILL, Velocity(1, 0.7)) == Velocity(0, 0.7)
    assert fence(zone(L_SHAPE)).limit(Pose2D(-3, 1.0, 0.0), STILL, Velocity(1, 0.7)) == Velocity(1, 0.7)


@pytest.mark.parametrize(("x", "expected"), [(-3.0, 1.0), (-1.3, 0.2), (1.0, 0.2), (2.5, 1.0)])
def test_a_slow_zone_is_slow_before_it_is_reached(x: float, expected: float) -> None:
    slow = {"id": "s", "kind": "slow", "rectangle": (0, -1, 2, 1), "max_speed_mps": 0.2}
    assert fence(slow).limit(Pose2D(x, 0, 0), Velocity(1), Velocity(1, 0.3)) == Velocity(expected, 0.3)
    assert fence(slow).limit(Pose2D(1.0, 0, 0), STILL, Velocity(-1)) == Velocity(-0.2)


def test_a_speed_limit_holds_everywhere_for_its_robots() -> None:
    limit = {"id": "v", "kind": "speed", "max_speed_mps": 0.3}
    assert fence(limit).limit(Pose2D(9, 9, 0), STILL, Velocity(1)) == Velocity(0.3)
    assert fence(limit | {"robots": ("Bob",)}).limit(Pose2D(9, 9, 0), STILL, Velocity(1)) == Velocity(1)
