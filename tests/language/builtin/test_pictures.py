"""What the built-in engine says of a picture: what is there, never how it is."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from parley.language.base import InspectionReport
from parley.language.builtin.pictures import inspect
from parley.robots.base import CameraImage, Detection
from parley.world.object_map import MapArea, MapObject, ObjectMap

BOX = Detection("red box", 400, (0, 0, 9, 9), 1.2)
PERSON = Detection("person", 900, (0, 0, 9, 9), 2.0)


@pytest.mark.parametrize(
    ("request_", "found"),
    [
        ("box", True),
        ("the red box", True),
        ("crate", False),
        ("whether there is a box on the desk", True),
        ("whether the box is there", True),
        ("whether there is a crate", False),
        ("whether there is no crate", True),
        ("whether somebody is in the office", True),
        ("whether the box is open", None),
        ("whether Kim wants tea", None),
        ("what you see", None),
    ],
)
def test_whether_something_is_there_is_seen_and_how_it_is_is_not(request_: str, found: bool | None) -> None:
    picture = CameraImage(10, 10, "rgb8", np.zeros((10, 10, 3), np.uint8), 0.0, (BOX, PERSON))
    assert inspect(picture, request_).found is found


BAYS = ObjectMap(
    (
        MapObject("bay_1", "bay 1", 0.0, 0.0, "area", width_m=2.0, height_m=2.0),
        MapObject("bay_2", "bay 2", 6.0, 0.0, "area", width_m=2.0, height_m=2.0),
        MapObject("cup", "cup", 3.0, 0.0, "cup", width_m=0.1, height_m=0.1),
    ),
    (MapArea("yard", ((10, 0), (14, 0), (14, 4))),),
)


def at(label: str, x_m: float, y_m: float = 0.0, confidence: float = 0.9) -> Detection:
    return Detection(label, 400, (0, 0, 9, 9), 2.0, x_m, y_m, (0.4, 0.4), confidence)


def report(request: str, *seen: Detection) -> InspectionReport:
    return inspect(CameraImage(10, 10, "rgb8", np.zeros((10, 10, 3), np.uint8), 0.0, seen), request, BAYS)


@pytest.mark.parametrize(
    ("request_", "needed"),
    [
        ("bay 1 for any suspicious bags", False),
        ("bay 1 for bags", False),
        ("whether there are suspicious bags in bay 1", False),
        ("suspicious bag", False),
        ("bay 1 for leaks", False),
        ("anything unusual in bay 1", False),
        ("whether anybody left a bag lying about", False),
        ("whether something has been left behind in bay 1", False),
        ("if a bag was left there", False),
        ("fire extinguisher", True),
        ("bay 1 for the bags", True),
        ("bay 1 for my key", True),
        ("whether the parcel is in bay 1", True),
        ("the broken cup", True),
    ],
)
def test_what_should_not_be_there_is_told_from_what_is_needed(request_: str, needed: bool) -> None:
    looked = report(request_)
    assert (looked.found, looked.attention, looked.unwanted) == (False, False, not needed)


@pytest.mark.parametrize(
    ("request_", "seen", "alarm", "words"),
    [
        ("bay 1 for suspicious bags", at("black bag", 0.2), True, "a black bag in bay 1"),
        ("bay 1 for suspicious bags", at("black bag", 6.0), True, "bay 1, but a black bag"),
        ("bay 1 for suspicious bags", at("crate", 0.2), False, "no suspicious bags in bay 1"),
        ("bay 1 for suspicious bags", at("bag", 0.2, confidence=0.6), True, "what may be a bag"),
        ("bay 1 for suspicious bags", at("bag", 0.2, confidence=0.4), False, "no suspicious bags"),
        ("anything unusual in bay 1", at("crate", 0.2), True, "a crate in bay 1"),
        ("there are no bags in bay 1", at("bag", 0.2), True, "a bag in bay 1"),
        ("whether anybody left a bag lying about", at("black bag", 0.2), True, "a black bag"),
        ("whether someone dumped rubbish in bay 1", at("crate", 0.2), False, "no rubbish in bay 1"),
        ("whether someone left something in bay 1", at("cup", 3.0), False, "I see nothing in bay 1"),
        ("nobody left a bag in bay 1", at("bag", 0.2), True, "a bag in bay 1"),
        ("whether bay 1 is clear", at("blue cylinder", 1.0), True, "a blue cylinder at the edge of bay 1"),
        ("whether bay 1 is clear", at("bay 1", 0.0), False, "nothing standing in bay 1"),
        ("whether bay 1 is clear", at("crate", 1.6), False, "nothing standing in bay 1"),
        ("anything unusual in the yard", at("crate", 13.0, 1.0), True, "a crate in the yard"),
        ("whether bay 1 is blocked", at("crate", 0.0), True, "a crate in bay 1"),
    ],
)  # fmt: skip
def test_what_is_amiss_is_an_alarm_with_its_place_and_what_is_well_is_none(
    request_: str, seen: Detection, alarm: bool, words: str
) -> None:
    looked = report(request_, seen)
    assert (looked.attention or bool(looked.found and looked.unwanted), words in looked.text) == (alarm, True)
    assert looked.things == ((seen,) if alarm else ())


def test_what_is_needed_in_one_place_is_not_found_in_another() -> None:
    assert report("whether the parcel is in bay 1", at("parcel", 0.0)).found is True
    looked = report("whether the parcel is in bay 1", at("parcel", 6.0))
    assert (looked.found, looked.unwanted) == (False, False)
    assert "by bay 2" in looked.text


@pytest.mark.parametrize("what", ["the ramp is clear", "the yard is empty", "the cup is full"])
def test_what_no_map_knows_and_what_is_only_seen_in_part_is_left_to_a_person(what: str) -> None:
    looked = report(f"whether {what}")
    assert (looked.found, "Please look" in looked.text) == (None, True)


def test_what_was_found_before_is_still_unusual() -> None:
    crate = MapObject("crate_1", "crate", 0.2, 0.0, found=True)
    known = replace(BAYS, objects=(*BAYS.objects, crate))
    picture = CameraImage(10, 10, "rgb8", np.zeros((10, 10, 3), np.uint8), 0.0, (at("crate", 0.2),))
    assert inspect(picture, "bay 1 for anything unusual", known).unwanted
    assert inspect(picture, "bay 1 for anything unusual", known).found


def test_the_answer_to_a_question_is_whether_it_is_so() -> None:
    clear, taken = report("whether bay 1 is clear"), report("whether bay 1 is clear", at("crate", 0.0))
    assert (clear.found, taken.found) == (True, False)
    free, blocked = report("whether bay 1 is blocked"), report("whether bay 1 is blocked", at("crate", 0.0))
    assert (free.found, blocked.found) == (False, True)


def test_who_looks_at_a_part_of_the_floor_is_told_what_stands_on_it() -> None:
    told = report("bay 1", at("bay 1", 0.0), at("red box", 0.5), at("crate", 6.0))
    assert told.text == "I can see bay 1, about 2.0 m away. There is a red box in bay 1, about 2.0 m away."
    assert [thing.label for thing in told.things] == ["bay 1", "red box"]
    assert not told.attention
