"""Where to stand in front of something."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from parley.world.approach import approach_pose
from parley.world.geometry import Pose2D, wrap_angle
from parley.world.object_map import MapArea, MapObject
from parley.world.occupancy import FREE, NO_MAP, OCCUPIED, OccupancyMap
from parley.world.planning import plan_path

RADIUS_M = 0.2
START = Pose2D(0.5, 0.5)


def ground(*blocks: MapObject, size_m: float = 5.0) -> OccupancyMap:
    """A square room in which each block stands."""
    cells = np.full((round(size_m / 0.05), round(size_m / 0.05)), FREE, np.int8)
    cells[[0, -1]] = cells[:, [0, -1]] = OCCUPIED
    occupancy = OccupancyMap(cells.copy(), 0.05, 0.0, 0.0)
    for block in blocks:
        lower, left = occupancy.cell_of(block.x_m - block.width_m / 2, block.y_m - block.height_m / 2)
        upper, right = occupancy.cell_of(block.x_m + block.width_m / 2, block.y_m + block.height_m / 2)
        cells[max(lower, 0) : upper + 1, max(left, 0) : right + 1] = OCCUPIED
    return OccupancyMap(cells, 0.05, 0.0, 0.0)


def block(
    x: float, y: float, width: float = 0.6, height: float = 0.4, front: float | None = None
) -> MapObject:
    return MapObject("box_1", "box", x, y, "box", width, height, front_rad=front)


def gap_m(pose: Pose2D, target: MapObject) -> float:
    return math.hypot(
        max(abs(pose.x_m - target.x_m) - target.width_m / 2, 0.0),
        max(abs(pose.y_m - target.y_m) - target.height_m / 2, 0.0),
    )


@settings(max_examples=40, deadline=None)
@given(
    x=st.floats(1.5, 4.0), y=st.floats(1.5, 4.0), width=st.floats(0.0, 1.2), height=st.floats(0.0, 1.2),
)  # fmt: skip
def test_the_pose_is_near_reachable_and_faces_the_object(
    x: float, y: float, width: float, height: float
) -> None:
    target = block(x, y, width, height)
    room = ground(target)
    pose = approach_pose(room, target, START, radius_m=RADIUS_M)
    assert pose is not None
    plan_path(room, START, pose, radius_m=RADIUS_M)
    assert RADIUS_M <= gap_m(pose, target) <= RADIUS_M + 0.5
    assert wrap_angle(pose.bearing_to(x, y) - pose.yaw_rad) == pytest.approx(0.0, abs=1e-9)
    assert approach_pose(room, target, START, radius_m=RADIUS_M) == pose


@pytest.mark.parametrize("front", [0.0, math.pi / 2, math.pi, -math.pi / 2])
def test_something_with_a_front_is_approached_from_there(front: float) -> None:
    target = block(2.5, 2.5, front=front)
    pose = approach_pose(ground(target), target, START, radius_m=RADIUS_M)
    assert pose is not None
    assert wrap_angle(Pose2D(2.5, 2.5).bearing_to(pose.x_m, pose.y_m) - front) == pytest.approx(0.0, abs=0.15)


def test_of_equal_spots_the_one_with_the_shorter_way_is_taken() -> None:
    target = block(2.5, 2.5, 0.4, 0.4)
    west = approach_pose(ground(target), target, Pose2D(0.5, 2.5), radius_m=RADIUS_M)
    east = approach_pose(ground(target), target, Pose2D(4.5, 2.5), radius_m=RADIUS_M)
    assert west is not None and east is not None
    assert west.x_m < 2.5 < east.x_m


@pytest.mark.parametrize(
    ("target", "x", "y"), [(block(2.5, 0.5), 1.55, 0.5), (block(2.5, 2.5, front=-math.pi / 2), 2.5, 1.65)]
)
def test_without_a_map_the_spot_is_before_it_and_whoever_drives_finds_out_whether_it_is_free(
    target: MapObject, x: float, y: float
) -> None:
    pose = approach_pose(NO_MAP, target, START, radius_m=RADIUS_M)
    assert pose is not None
    assert [pose.x_m, pose.y_m] == pytest.approx([x, y])
    assert wrap_angle(pose.bearing_to(target.x_m, target.y_m) - pose.yaw_rad) == pytest.approx(0.0, abs=1e-9)


def test_nobody_stands_behind_a_wall_looking_at_it() -> None:
    target = block(3.0, 2.4, 0.2, 0.2)
    wall = block(2.7, 2.5, 0.1, 3.0)  # the robot is west of it; the way around is far
    pose = approach_pose(ground(target, wall), target, Pose2D(2.0, 2.4), radius_m=RADIUS_M)
    assert pose is not None
    assert pose.x_m > 2.75


def test_a_front_against_a_wall_cannot_be_approached() -> None:
    target = block(2.5, 4.7, front=math.pi / 2)
    assert approach_pose(ground(target), target, START, radius_m=RADIUS_M) is None


def test_what_is_closed_in_cannot_be_approached() -> None:
    target = block(4.0, 4.0, 0.3, 0.3)
    fence = [block(4.0, 3.0, 2.2, 0.1), block(3.0, 4.0, 0.1, 2.2)]
    assert approach_pose(ground(target, *fence), target, START, radius_m=RADIUS_M) is None


def test_from_outside_the_map_nothing_can_be_approached() -> None:
    target = block(2.5, 2.5)
    assert approach_pose(ground(target), target, Pose2D(-3.0, 0.0), radius_m=RADIUS_M) is None


def test_in_a_room_the_robot_stands_inside_and_nowhere_else() -> None:
    corner = ((3.0, 0.0), (5.0, 0.0), (5.0, 5.0), (4.0, 5.0), (4.0, 2.0), (3.0, 2.0))
    area = MapArea("hall", corner)
    pose = approach_pose(ground(block(4.2, 2.6)), area.goal, START, radius_m=RADIUS_M)
    assert pose is not None and area.holds(pose.x_m, pose.y_m)
    assert pose.distance_to(Pose2D(4.0, 2.5)) < 0.7
    outside = MapArea("attic", ((9.0, 9.0), (9.5, 9.0), (9.5, 9.5)))
    assert approach_pose(ground(), outside.goal, START, radius_m=RADIUS_M) is None
