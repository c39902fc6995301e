"""Inspect: shows the picture, says what is there, and fails in the way that tells what help is needed."""

from __future__ import annotations

import math
from collections.abc import Awaitable, Callable
from contextlib import suppress
from dataclasses import replace
from typing import cast

import numpy as np
import pytest

from parley.actions.context import ActionContext
from parley.actions.inspect import FEED, inspect
from parley.actions.keep_picture import keep_picture
from parley.actions.take_picture import take_picture
from parley.errors import ActionFailure, FailureCode, LanguageError
from parley.language.base import InspectionReport
from parley.language.builtin.engine import BuiltinLanguage
from parley.messages.memory import MemoryEntry
from parley.robots.base import CameraImage, Detection, Robot
from parley.umrf.action import Outcome
from parley.world.geometry import Pose2D
from parley.world.object_map import MapObject, ObjectMap
from tests.actions.room import Room, room
from tests.memory.photos import opened
from tests.sim.worlds import box

SEEN = InspectionReport("I can see a green crate.", found=True, wanted="green crate")
MISSING = InspectionReport("I cannot see a cup.", found=False, wanted="cup")


class Eyes:
    """The simulated robot, but its camera saw what the test says."""

    def __init__(self, here: Room, *detections: Detection) -> None:
        self._robot = here.robot
        picture = np.zeros((100, 100, 3), np.uint8)
        self._image = CameraImage(100, 100, "rgb8", picture, 0.0, detections)

    def __getattr__(self, name: str) -> object:
        return getattr(self._robot, name)

    async def image(self) -> CameraImage:
        return self._image


class Faltering(Eyes):
    """Its base is silent from the picture on."""

    _silent = False

    async def image(self) -> CameraImage:
        self._silent = True
        return self._image

    def pose(self) -> Pose2D:
        if self._silent:
            raise ActionFailure(FailureCode.HARDWARE, "My base does not answer.")
        return self._robot.pose()


@pytest.mark.parametrize("look", [lambda ctx: inspect(ctx, "the crate"), keep_picture, take_picture])
async def test_a_base_that_is_silent_for_a_moment_spoils_no_picture(
    look: Callable[[ActionContext], Awaitable[object]],
) -> None:
    async with room() as here:
        here.script.will("inspect", SEEN)
        await look(replace(here.context, robot=cast("Robot", Faltering(here))))
        assert here.person.told


async def test_picture_is_shown_with_the_request_and_the_report_is_told_and_given_on() -> None:
    async with room() as here:
        here.script.will("inspect", SEEN)
        result = await inspect(here.context, "the crate")
        assert result == Outcome(
            True, {"inspection_result": "I can see a green crate."}, {"seen": ["green crate"]}
        )
        assert here.person.told == ["I can see a green crate."]
        ((feed, image, info),) = here.person.shown
        assert (feed, info) == (FEED, {"request": "the crate"})
        assert image.data.shape == (image.height, image.width, 3)
        assert here.person.told_with == [image]


async def test_what_was_found_is_remembered_for_all_with_where_the_robot_stood() -> None:
    async with room() as here:
        here.run.node = "Inspect_0"
        here.script.will("inspect", SEEN)
        await inspect(here.context, "the crate")
        entry, _ = here.person.memories
        assert (entry.name, entry.source, entry.scope) == ("green_crate_sighting", "A/Inspect", "")
        assert entry.info == "Where A saw the green crate"
        assert entry.data == f"I saw the green crate from where I stood, {here.context.whereabouts()}."


async def test_picture_of_what_was_found_is_kept_under_its_name() -> None:
    async with room() as here:
        here.run.node = "Inspect_0"
        here.script.will("inspect", SEEN)
        await inspect(here.context, "the crate")
        _, entry = here.person.memories
        assert (entry.name, entry.type, entry.source) == ("picture of the green crate", "image", "A/Inspect")
        assert entry.info == "The green crate, as A saw it"
        ((_, image, _),) = here.person.shown
        assert opened(entry.data).size == (image.width, image.height)


@pytest.mark.parametrize("report", [MISSING, InspectionReport("I can see a wall.")])
async def test_what_was_not_looked_for_or_not_found_is_not_remembered(report: InspectionReport) -> None:
    async with room() as here:
        here.script.will("inspect", report)
        with suppress(ActionFailure):
            await inspect(here.context, "the cup")
        assert here.person.memories == []


async def test_what_is_not_there_is_no_match_with_what_was_seen() -> None:
    async with room() as here:
        here.script.will("inspect", MISSING)
        context = replace(here.context, robot=Eyes(here, Detection("green crate", 5000, (0, 0, 9, 9), 2.0)))  # type: ignore[arg-type]
        with pytest.raises(ActionFailure) as caught:
            await inspect(context, "the cup")
        assert caught.value.code is FailureCode.NO_MATCH
        assert caught.value.details == {"wanted": "cup", "seen": ["green crate"]}


async def test_what_is_not_there_is_an_answer_where_the_plan_asks_for_it() -> None:
    async with room() as here:
        here.run.result_asked = True
        here.script.will("inspect", MISSING)
        answer = await inspect(here.context, "the cup")
        assert answer == Outcome(
            False, {"inspection_result": "I cannot see a cup."}, {"seen": ["green crate"]}
        )
        assert here.person.told == ["I cannot see a cup."]


async def test_what_nobody_can_tell_from_a_picture_decides_nothing() -> None:
    async with room() as here:
        here.run.result_asked = True
        here.script.will("inspect", InspectionReport("I can see a gate. Please judge whether it is open."))
        with pytest.raises(ActionFailure) as caught:
            await inspect(here.context, "whether the gate is open")
        assert caught.value.code is FailureCode.ATTENTION


async def test_what_may_be_hidden_is_no_answer_even_where_the_plan_asks_for_it() -> None:
    async with room() as here:
        here.run.result_asked = True
        here.script.will("inspect", MISSING)
        context = replace(here.context, robot=Eyes(here, Detection("carton", 500, (0, 0, 9, 9), 0.5)))  # type: ignore[arg-type]
        with pytest.raises(ActionFailure) as caught:
            await inspect(context, "the cup")
        assert caught.value.code is FailureCode.BLOCKED


async def test_large_stranger_in_the_picture_may_hide_what_is_looked_for() -> None:
    near, far = Detection("carton", 500, (0, 0, 9, 9), 0.5), Detection("curtain", 900, (0, 0, 9, 9), 3.0)
    async with room() as here:
        here.script.will("inspect", MISSING)
        context = replace(here.context, robot=Eyes(here, far, near))  # type: ignore[arg-type]
        with pytest.raises(ActionFailure) as caught:
            await inspect(context, "the cup")
        assert caught.value.code is FailureCode.BLOCKED
        assert caught.value.details["in_the_way"] == "carton"
        assert caught.value.message == "I cannot see the cup: a carton is in the way."


async def test_small_stranger_hides_nothing() -> None:
    async with room() as here:
        here.script.will("inspect", MISSING)
        context = replace(here.context, robot=Eyes(here, Detection("pen", 399, (0, 0, 9, 9), 0.5)))  # type: ignore[arg-type]
        with pytest.raises(ActionFailure) as caught:
            await inspect(context, "the cup")
        assert caught.value.code is FailureCode.NO_MATCH


async def test_what_a_person_should_decide_is_a_failure_of_its_own() -> None:
    async with room() as here:
        here.script.will("inspect", replace(SEEN, attention=True, text="The crate lies on its side."))
        with pytest.raises(ActionFailure) as caught:
            await inspect(here.context, "the crate")
        assert (caught.value.code, caught.value.message) == (
            FailureCode.ATTENTION, "The crate lies on its side.",
        )  # fmt: skip


async def test_looking_at_nothing_in_particular_never_misses_anything() -> None:
    async with room() as here:
        here.script.will("inspect", InspectionReport("I can see a wall."))
        looked = await inspect(here.context, "around")
        assert isinstance(looked, Outcome)
        assert (looked.result, looked.outputs) == (True, {"inspection_result": "I can see a wall."})


async def test_broken_camera_is_a_hardware_failure_and_nothing_is_shown() -> None:
    async with room({"robots": {"A": {"camera": "broken"}}}) as here:
        with pytest.raises(ActionFailure) as caught:
            await inspect(here.context, "the crate")
        assert caught.value.code is FailureCode.HARDWARE
        assert here.person.shown == []


async def test_language_engine_that_fails_leaves_the_picture_on_the_screen() -> None:
    async with room() as here:
        here.script.will("inspect", LanguageError("gone"))
        with pytest.raises(ActionFailure) as caught:
            await inspect(here.context, "the crate")
        assert caught.value.code is FailureCode.UNAVAILABLE
        assert len(here.person.shown) == 1


async def test_nothing_found_of_what_should_not_be_there_is_as_it_should_be() -> None:
    leak = InspectionReport("There is no leak.", found=False, wanted="leak", unwanted=True)
    async with room() as here:
        here.script.will("inspect", leak, replace(leak, found=True, text="There is a leak."))
        assert await inspect(here.context, "leaks") == Outcome(
            True, {"inspection_result": "There is no leak."}, {"seen": ["green crate"]}
        )
        with pytest.raises(ActionFailure) as caught:
            await inspect(here.context, "leaks")
        assert caught.value.code is FailureCode.ATTENTION


async def test_what_people_told_goes_along_and_a_rule_that_applies_needs_attention() -> None:
    rule = "Kui näed pragu, jää seisma."
    async with room() as here:
        here.person.memories[:] = [
            MemoryEntry(name="crack", data=rule, way="told"),
            MemoryEntry(name="seen", data="I saw a crack.", source="A/Inspect"),
        ]
        here.script.will("inspect", replace(SEEN, rules=(rule,)))
        with pytest.raises(ActionFailure, match="Kui näed pragu") as caught:
            await inspect(here.context, "the crate")
        assert caught.value.code is FailureCode.ATTENTION


async def test_what_should_not_be_there_is_an_alarm_and_then_on_the_map_where_it_was_seen() -> None:
    bag = box("bag_1", 2.2, 1.4, (0.4, 0.3, 0.3), label="bag")
    async with room({"add": [bag]}, BuiltinLanguage()) as here:
        with pytest.raises(ActionFailure) as caught:
            await inspect(here.context, "suspicious bags")
        assert (caught.value.code, caught.value.details["found"]) == (FailureCode.ATTENTION, ["bag"])
        (found,) = (item for item in here.view.objects.objects if item.class_name == "bag")
        assert math.dist((found.x_m, found.y_m), (2.2, 1.4)) < 0.2
        assert [entry.name for entry in here.person.memories] == ["bag_sighting", "picture of the bag"]
        assert "(2.2, 1.4)" in here.person.memories[0].data or "(2.1, 1.4)" in here.person.memories[0].data


async def test_a_look_at_nothing_in_particular_puts_all_that_stays_on_the_map() -> None:
    async with room() as here:
        sure, unsure = Detection("shelf", 400, (0, 0, 9, 9), None, 1.8, 1.2), 0.3
        doubtful = replace(sure, label="lamp", confidence=unsure)
        someone, nowhere = replace(sure, label="person"), replace(sure, label="cup", x_m=None)
        eyes = cast("Robot", Eyes(here, sure, doubtful, someone, nowhere))
        before = {item.description for item in here.context.world.objects.objects}
        here.script.will("inspect", InspectionReport("I can see a shelf."))
        await inspect(replace(here.context, robot=eyes), "what can be seen here")
        after = {item.description for item in here.context.world.objects.objects}
        assert after - before == {"shelf"}
        assert here.person.memories == []


async def test_what_is_moved_is_found_where_it_is_now() -> None:
    bag = box("bag_1", 2.2, 1.4, (0.4, 0.3, 0.3), label="bag")
    async with room({"add": [bag]}, BuiltinLanguage()) as here:
        for x, y in ((2.2, 1.4), (2.4, 0.4)):
            here.simulator.change({"move": {"bag_1": (x, y, 0.0)}})
            with pytest.raises(ActionFailure):
                await inspect(here.context, "suspicious bags")
            (found,) = (item for item in here.view.objects.objects if item.class_name == "bag")
            assert math.dist((found.x_m, found.y_m), (x, y)) < 0.3


async def test_what_only_looks_ahead_says_that_it_does_not_see_all_of_a_place() -> None:
    bay = MapObject("bay", "bay", 2.0, 1.0, "area", width_m=1.0, height_m=2.4)
    async with room(None, BuiltinLanguage()) as here:
        here.view = replace(here.view, base=ObjectMap((bay,)))
        await inspect(here.context, "whether the bay is clear")
        assert here.person.told[-1].endswith("I cannot see all of it from here.")
        here.run.result_asked = True
        with pytest.raises(ActionFailure) as caught:  # what depends on it is not done by guessing
            await inspect(here.context, "whether the bay is clear")
        assert caught.value.code is FailureCode.ATTENTION


async def test_what_was_found_and_is_gone_is_on_the_map_no_more() -> None:
    bay = MapObject("bay", "bay", 2.3, 1.0, "area", width_m=0.8, height_m=0.6)
    parcel = box("parcel", 2.3, 1.0, (0.2, 0.2, 0.3), label="parcel")
    async with room({"add": [parcel]}, BuiltinLanguage()) as here:
        here.view = replace(here.view, base=ObjectMap((bay,)))
        with pytest.raises(ActionFailure):
            await inspect(here.context, "whether the bay is clear")
        assert [item.description for item in here.view.objects.objects] == ["bay", "parcel"]
        here.simulator.change({"remove": ["parcel"]})
        await inspect(here.context, "whether the bay is clear")
        assert [item.description for item in here.view.objects.objects] == ["bay"]


async def test_of_two_places_with_one_name_the_one_is_meant_where_the_robot_is() -> None:
    near = MapObject("s1", "store 1", 2.3, 1.0, "area", width_m=0.8, height_m=0.6, aliases=("store",))
    far = MapObject("s2", "store 2", 2.3, 3.4, "area", width_m=0.8, height_m=0.6, aliases=("store",))
    parcel = box("parcel", 2.3, 1.0, (0.2, 0.2, 0.3), label="parcel")
    async with room({"add": [parcel]}, BuiltinLanguage()) as here:
        here.view = replace(here.view, base=ObjectMap((far, near)))
        await inspect(here.context, "whether the parcel is in the store")
        assert "in the store 1" in here.person.told[-1] or "in store 1" in here.person.told[-1]


async def test_nothing_amiss_is_no_failure_and_leaves_nothing_behind() -> None:
    async with room(None, BuiltinLanguage()) as here:
        looked = await inspect(here.context, "suspicious bags")
        assert isinstance(looked, Outcome) and looked.result
        assert here.person.memories == []
        assert here.person.told[0].startswith("I see no suspicious bags.")
