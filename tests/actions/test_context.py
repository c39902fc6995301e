"""What actions are told of their surroundings: where the robot stands, in words for people."""

from __future__ import annotations

from dataclasses import replace

import pytest

from parley.world.object_map import MapObject, ObjectMap
from tests.actions.room import room


@pytest.mark.parametrize(
    ("away_m", "words"),
    [(1.0, "near the red crate"), (2.6, "about 3 metres from the red crate")],
)
async def test_a_robot_stands_near_or_some_way_from_what_is_nearest(away_m: float, words: str) -> None:
    async with room() as here:
        pose = here.robot.pose()
        crate = MapObject(
            id="1", class_name="crate", description="red crate", x_m=pose.x_m + away_m, y_m=pose.y_m
        )
        farther = replace(crate, id="2", description="blue crate", x_m=pose.x_m - away_m - 1.0)
        here.view = replace(here.view, base=ObjectMap((farther, crate)))
        assert here.context.whereabouts() == words


async def test_a_robot_that_knows_no_object_says_the_metres_of_its_map() -> None:
    async with room() as here:
        here.view = replace(here.view, base=ObjectMap(()))
        pose = here.robot.pose()
        assert here.context.whereabouts() == f"at x {pose.x_m:.1f} m, y {pose.y_m:.1f} m"
