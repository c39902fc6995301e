"""Path planning for a round robot."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from parley.world import planning
from parley.world.geometry import Pose2D
from parley.world.occupancy import FREE, OCCUPIED, OccupancyMap
from parley.world.planning import NoPathError, Path, clearance_m, plan_path

RADIUS_M = 0.2


def room(*walls: tuple[float, float, float, float], size_m: float = 4.0) -> OccupancyMap:
    """A square room; walls are x_min, y_min, x_max, y_max."""
    cells = np.full((round(size_m / 0.05), round(size_m / 0.05)), FREE, np.int8)
    for x_min, y_min, x_max, y_max in walls:
        left, lower, right, upper = (round(value / 0.05) for value in (x_min, y_min, x_max, y_max))
        cells[lower:upper, left:right] = OCCUPIED
    return OccupancyMap(cells, 0.05, 0.0, 0.0)


def closest_m(occupancy: OccupancyMap, path: Path) -> float:
    clearance = clearance_m(occupancy)
    return min(float(clearance[occupancy.cell_of(x, y)]) for x, y in path.points_m)


WALL_WITH_DOOR = (2.0, 0.0, 2.1, 1.5), (2.0, 2.4, 2.1, 4.0)


def test_the_path_leads_through_the_door_and_keeps_its_distance() -> None:
    ground = room(*WALL_WITH_DOOR)
    path = plan_path(ground, Pose2D(0.5, 0.5), Pose2D(3.5, 0.5), radius_m=RADIUS_M)
    assert path.points_m[-1] == pytest.approx((3.5, 0.5))
    assert closest_m(ground, path) >= RADIUS_M
    x, y = path.points_m[:, 0], path.points_m[:, 1]
    assert np.all((y[(x > 2.0) & (x < 2.1)] > 1.7) & (y[(x > 2.0) & (x < 2.1)] < 2.2))


def test_where_there_is_room_the_path_stays_away_from_walls() -> None:
    ground = room((1.0, 0.0, 3.0, 1.0))
    path = plan_path(ground, Pose2D(0.5, 0.5), Pose2D(3.5, 0.5), radius_m=RADIUS_M)
    middle = path.points_m[(path.points_m[:, 0] > 1.2) & (path.points_m[:, 0] < 2.8)]
    assert middle[:, 1].min() > 1.0 + RADIUS_M + 0.1


def test_a_closed_wall_leaves_no_path() -> None:
    with pytest.raises(NoPathError) as caught:
        plan_path(room((2.0, 0.0, 2.1, 4.0)), Pose2D(1, 1), Pose2D(3, 1), radius_m=RADIUS_M)
    assert not caught.value.obstructed


@pytest.mark.parametrize("goal", [Pose2D(2.05, 1.0), Pose2D(9.0, 9.0), Pose2D(3.95, 3.95)])
def test_a_goal_where_the_robot_cannot_stand_has_no_path(goal: Pose2D) -> None:
    with pytest.raises(NoPathError) as caught:
        plan_path(room(*WALL_WITH_DOOR), Pose2D(1, 1), goal, radius_m=RADIUS_M)
    assert not caught.value.obstructed


def test_a_door_narrower_than_the_robot_leaves_no_path() -> None:
    ground = room((2.0, 0.0, 2.1, 1.5), (2.0, 1.8, 2.1, 4.0))
    with pytest.raises(NoPathError):
        plan_path(ground, Pose2D(1, 1), Pose2D(3, 1), radius_m=RADIUS_M)


def across(x: float, y_min: float, y_max: float) -> NDArray[np.float64]:
    y = np.arange(y_min, y_max, 0.05)
    return np.stack([np.full_like(y, x), y], axis=1)


def test_seen_obstacles_are_driven_around() -> None:
    obstacles = across(2.0, 0.0, 2.0)
    path = plan_path(room(), Pose2D(1, 1), Pose2D(3, 1), radius_m=RADIUS_M, obstacles=obstacles)
    gaps = np.hypot(*(path.points_m[:, None] - obstacles[None]).transpose(2, 0, 1))
    assert gaps.min() >= RADIUS_M
    assert path.points_m[:, 1].max() > 2.0


def test_obstacles_in_the_only_door_are_told_from_a_missing_way() -> None:
    with pytest.raises(NoPathError) as caught:
        plan_path(
            room(*WALL_WITH_DOOR),
            Pose2D(1, 2),
            Pose2D(3, 2),
            radius_m=RADIUS_M,
            obstacles=across(2.05, 1.6, 2.3),
        )
    assert caught.value.obstructed
    assert caught.value.at is not None
    assert caught.value.at[0] == pytest.approx(2.05)


def test_a_robot_standing_too_close_to_a_wall_may_leave() -> None:
    ground = room((0.0, 0.0, 1.0, 4.0))
    path = plan_path(ground, Pose2D(1.12, 2.0), Pose2D(3.0, 2.0), radius_m=RADIUS_M)
    assert path.length_m == pytest.approx(1.9, abs=0.1)


def test_a_robot_at_its_goal_has_a_path_of_no_length() -> None:
    path = plan_path(room(), Pose2D(1, 1), Pose2D(1, 1), radius_m=RADIUS_M)
    assert path.length_m == pytest.approx(0.0, abs=0.05)
    assert path.ahead(0, 1.0) == (1.0, 1.0)


def test_large_maps_are_planned_coarsely_and_still_keep_their_distance(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(planning, "MAX_CELLS", 1000)
    ground = room(*WALL_WITH_DOOR)
    path = plan_path(ground, Pose2D(0.5, 0.5), Pose2D(3.5, 0.5), radius_m=RADIUS_M)
    assert len(path.points_m) < 40
    assert closest_m(ground, path) >= RADIUS_M


def test_positions_along_a_path() -> None:
    path = Path(np.array([[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [2.0, 1.0]]))
    assert path.length_m == 3.0
    assert path.nearest(1.1, 0.4) == 1
    assert path.nearest(0.0, 0.0, after=1) == 1
    assert path.remaining_m(2) == 1.0
    assert path.ahead(0, 1.5) == (2.0, 0.0)
    assert path.ahead(2, 9.0) == (2.0, 1.0)
