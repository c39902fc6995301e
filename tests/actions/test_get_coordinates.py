"""GetCoordinates: from words to a free spot in front of what is meant, or to a failure that says why not."""

from __future__ import annotations

from dataclasses import replace

import pytest

from parley.actions.get_coordinates import get_coordinates
from parley.actions.navigate_to import navigate_to
from parley.errors import ActionFailure, FailureCode, LanguageError
from parley.language.base import Grounding
from parley.language.builtin.engine import BuiltinLanguage
from parley.world.object_map import MapArea, MapObject
from tests.actions.room import room
from tests.sim.worlds import box

CHAIRS = (MapObject("chair_1", "red chair", 5.0, 2.0), MapObject("chair_2", "blue chair", 5.0, 3.0))


async def test_spot_is_free_near_the_thing_and_faces_it() -> None:
    async with room(language=BuiltinLanguage()) as here:
        found = await get_coordinates(here.context, "the green crate")
        spot, crate = found.pose.planar(), here.view.objects.objects[0]
        assert here.view.occupancy.is_free(spot.x_m, spot.y_m)
        assert 0.2 < ((spot.x_m - crate.x_m) ** 2 + (spot.y_m - crate.y_m) ** 2) ** 0.5 < 1.3
        assert spot.bearing_to(crate.x_m, crate.y_m) == pytest.approx(spot.yaw_rad, abs=0.3)


async def test_a_room_leads_into_it() -> None:
    hall = MapArea("packing hall", ((4.0, 1.0), (6.0, 1.0), (6.0, 3.0), (4.0, 3.0)))
    async with room(language=BuiltinLanguage()) as here:
        here.view = replace(here.view, base=replace(here.view.base, areas=(hall,)))
        spot = (await get_coordinates(here.context, "packing hall")).pose.planar()
        assert hall.holds(spot.x_m, spot.y_m) and here.view.occupancy.is_free(spot.x_m, spot.y_m)


async def test_robot_can_really_stand_there() -> None:
    async with room(language=BuiltinLanguage()) as here:
        found = await get_coordinates(here.context, "green crate")
        await navigate_to(here.context, found.pose)
        assert here.robot.pose().distance_to(found.pose.planar()) < 0.2


async def test_where_another_robot_stands_or_goes_to_is_left_to_it() -> None:
    async with room(language=BuiltinLanguage()) as here:
        best = (await get_coordinates(here.context, "green crate")).pose.planar()
        here.view.taken = ((best.x_m, best.y_m, 0.2),)
        other = (await get_coordinates(here.context, "green crate")).pose.planar()
        assert best.distance_to(other) > 0.2 + here.robot.radius_m
        assert here.view.claimed == [best, other]  # and the others learn of it


async def test_equals_are_named_and_told_to_the_recovery() -> None:
    async with room() as here:
        here.script.will("ground", Grounding("ambiguous", CHAIRS))
        with pytest.raises(ActionFailure) as caught:
            await get_coordinates(here.context, "chair")
        assert caught.value.code is FailureCode.AMBIGUOUS
        assert caught.value.message == "Several places fit “chair”: red chair and blue chair."
        assert caught.value.details["target"] == "chair"
        assert [item["id"] for item in caught.value.details["candidates"]] == ["chair_1", "chair_2"]


async def test_unknown_thing_is_said_to_be_unknown_with_the_nearest_misses() -> None:
    async with room() as here:
        here.script.will("ground", Grounding("none", CHAIRS[:1]))
        with pytest.raises(ActionFailure) as caught:
            await get_coordinates(here.context, "boat")
        assert (caught.value.code, caught.value.message) == (
            FailureCode.NO_MATCH, "I do not know any “boat” here.",
        )  # fmt: skip
        assert [item["id"] for item in caught.value.details["candidates"]] == ["chair_1"]


async def test_thing_without_free_floor_around_is_unreachable() -> None:
    walled_in = MapObject("lamp_1", "lamp", 40.0, 40.0)
    async with room() as here:
        here.script.will("ground", Grounding("match", (walled_in,)))
        with pytest.raises(ActionFailure) as caught:
            await get_coordinates(here.context, "lamp")
        assert caught.value.code is FailureCode.UNREACHABLE
        assert caught.value.details == {"target": "lamp", "object": "lamp_1"}
        assert "lamp" in caught.value.message


async def test_language_engine_that_fails_is_an_unavailable_service() -> None:
    async with room({"add": [box("box", 1.0, 3.0)]}) as here:
        here.script.will("ground", LanguageError("gone"))
        with pytest.raises(ActionFailure) as caught:
            await get_coordinates(here.context, "crate")
        assert caught.value.code is FailureCode.UNAVAILABLE
        assert "gone" not in caught.value.message
