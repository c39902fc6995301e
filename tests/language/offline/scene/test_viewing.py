"""Choosing among like things by where they are."""

from __future__ import annotations

import math

import pytest

from parley.language.offline.scene.grounding import ground
from parley.world.geometry import Pose2D
from parley.world.object_map import MapObject

ROW = tuple(MapObject(f"chair_{i}", "chair", 2.0 + 2 * i, 5.0, "chair") for i in range(3))
OBJECTS = (
    *ROW,
    MapObject("lamp_n", "lamp", 5.0, 20.0, "lamp"),
    MapObject("lamp_s", "lamp", 0.0, -20.0, "lamp"),
    MapObject("wall", "wall", 30.0, 20.0, "wall"),
    MapObject("post", "post", 0.0, 0.0, "post"),
)
NORTHWARD = Pose2D(4.0, 0.0, math.pi / 2)


@pytest.mark.parametrize(
    ("said", "meant"),
    [
        ("the chair on the left", "chair_0"),
        ("the rightmost chair", "chair_2"),
        ("the second chair from the left", "chair_1"),
        ("the third chair from the right", "chair_0"),
        ("the second chair from the east", "chair_1"),
        ("the middle chair", "chair_1"),
        ("the chair in the middle", "chair_1"),
        ("the northern lamp", "lamp_n"),
        ("the lamp on the south side", "lamp_s"),
        ("the easternmost chair", "chair_2"),
        ("the lamp behind you", "lamp_s"),
        ("the lamp in front of you", "lamp_n"),
        ("the closer lamp", "lamp_n"),
        ("the lamp in the corner", "lamp_s"),
    ],
)
def test_a_place_in_view_or_on_the_map_chooses(said: str, meant: str) -> None:
    found = ground(said, OBJECTS, NORTHWARD)
    assert found.outcome == "match"
    assert found.candidates[0].id == meant


def test_left_and_right_turn_with_the_robot() -> None:
    southward = Pose2D(4.0, 10.0, -math.pi / 2)
    assert ground("the leftmost chair", OBJECTS, southward).candidates[0].id == "chair_2"


def test_without_a_pose_the_map_has_left_in_the_west() -> None:
    assert ground("the leftmost chair", OBJECTS).candidates[0].id == "chair_0"


def test_a_middle_of_two_is_asked_about() -> None:
    assert ground("the middle lamp", OBJECTS, NORTHWARD).outcome == "ambiguous"


def test_a_rank_beyond_the_row_is_asked_about() -> None:
    assert ground("the fifth chair from the left", OBJECTS, NORTHWARD).outcome != "match"
