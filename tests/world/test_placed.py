"""What people put on a map, over what its object map says."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from parley.world.approach import approach_pose
from parley.world.geometry import Pose2D
from parley.world.object_map import PLACE, MapArea, MapObject, ObjectMap
from parley.world.occupancy import FREE, OCCUPIED, OccupancyMap
from parley.world.placed import Placed, new_id, same_name
from parley.world.whereabouts import Footprint, standing

BENCH = MapObject("bench_1", "bench", 3.0, 2.0, "bench", 1.0, 0.5, ("seat",))
HALL = MapArea("hall", ((0.0, 0.0), (4.0, 0.0), (4.0, 3.0)))
KNOWN = ObjectMap((BENCH,), (HALL,))
SPOT = MapObject("pump_1", "pump", 1.0, 1.0, PLACE, stand=Pose2D(1.0, 1.0, 1.5))


def test_what_was_put_changed_and_taken_off_is_so_and_applying_it_twice_changes_nothing() -> None:
    moved, yard = replace(BENCH, x_m=1.0), MapArea("yard", HALL.corners)
    placed = Placed().changed(BENCH, moved).changed(None, SPOT).changed(HALL, yard)
    after = placed.applied(KNOWN)
    assert after == ObjectMap((moved, SPOT), (yard,))
    assert placed.applied(after) == after
    assert placed.changed(moved, None).applied(after) == ObjectMap((SPOT,), (yard,))
    back = placed.changed(moved, None).changed(None, BENCH).changed(yard, HALL)
    assert {*back.applied(KNOWN).objects} == {BENCH, SPOT} and back.applied(KNOWN).areas == (HALL,)


def test_it_is_the_same_after_it_was_kept_as_json() -> None:
    placed = Placed().changed(None, SPOT).changed(BENCH, None).changed(None, MapArea("yard", HALL.corners))
    assert Placed.of_json(placed.to_json()) == placed
    assert Placed() == Placed.of_json(Placed().to_json())


def test_what_a_robot_saw_counts_until_a_person_says_something_about_just_that() -> None:
    seen = replace(BENCH, x_m=5.0, front_rad=None, found=True)
    placed = Placed().changed(None, SPOT)
    told = replace(KNOWN, objects=(seen,))
    assert seen in placed.applied(told).objects
    assert placed.changed(seen, replace(seen, found=False)).applied(told).objects[0] == replace(
        seen, found=False
    )
    gone = placed.changed(seen, None)
    assert gone.applied(told).objects == (SPOT,)
    elsewhere = replace(seen, x_m=6.0)
    assert gone.applied(replace(told, objects=(elsewhere,))).objects == (elsewhere, SPOT)


def test_a_whole_map_takes_the_place_of_all_that_is_known() -> None:
    whole = ObjectMap((SPOT,), (MapArea("yard", HALL.corners),))
    assert Placed().loaded(whole, KNOWN).applied(KNOWN) == whole


def test_names_are_the_same_whatever_their_article_and_letters() -> None:
    assert same_name(KNOWN, "the Bench") == same_name(KNOWN, "seat") == (BENCH,)
    assert same_name(KNOWN, "Hall") == (HALL,)
    assert same_name(KNOWN, "bench", BENCH) == same_name(KNOWN, "ben") == ()
    assert new_id("bench", KNOWN.objects) == "bench_2"


def test_a_robot_stands_where_it_was_told_to_unless_it_cannot() -> None:
    cells = np.full((60, 80), FREE, np.int8)
    floor = OccupancyMap(cells, 0.05, 0.0, 0.0)
    start = Pose2D(3.0, 1.5)
    assert approach_pose(floor, SPOT, start, radius_m=0.2) == SPOT.stand
    beside = approach_pose(floor, SPOT, start, radius_m=0.2, taken=[(1.0, 1.0, 0.2)])
    assert beside is not None and 0.5 < Pose2D(1.0, 1.0).distance_to(beside) < 1.5
    walled = cells.copy()
    walled[19:21, 19:21] = OCCUPIED
    other = approach_pose(OccupancyMap(walled, 0.05, 0.0, 0.0), SPOT, start, radius_m=0.2)
    assert other is not None and other != SPOT.stand


def test_a_mere_spot_reaches_two_metres_around() -> None:
    assert standing(Footprint(2.5, 1.0), SPOT) == "in"
    assert standing(Footprint(4.0, 1.0), SPOT) == "outside"
