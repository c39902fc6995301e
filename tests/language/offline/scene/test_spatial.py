"""Across from, between and beside, where several things are called alike."""

from __future__ import annotations

import math

import pytest

from parley.language.offline.scene.floating import with_how_many
from parley.language.offline.scene.grounding import ground
from parley.language.offline.words.text import plain, tokens
from parley.world.geometry import Pose2D
from parley.world.object_map import MapObject

STALLS = tuple(
    MapObject(f"stall_{1 + i + 3 * row}", f"stall {1 + i + 3 * row}", 4.0 * i, 6.0 * row, "stall")
    for row in (0, 1)
    for i in range(3)
)
"""Stalls 1 to 3 in one row, 4 to 6 over against them; the next of a row is nearer than what faces it."""
OBJECTS = (
    *STALLS,
    MapObject("gym", "gym", -20.0, 0.0, "room"),
    MapObject("hall_a", "classroom A", -20.0, 8.0, "classroom"),
    MapObject("hall_b", "classroom B", -20.0, 16.0, "classroom"),
    MapObject("staff", "staff room", -5.0, -9.0, "staff room"),
    MapObject("cask", "cask", -20.0, 4.0, "cask"),
    MapObject("tub_1", "tub", 30.0, 1.0, "tub"),
    MapObject("tub_2", "tub", 50.0, 1.0, "tub"),
    MapObject("hose_1", "hose", 31.0, 2.0, "hose"),
    MapObject("hose_2", "hose", 60.0, 9.0, "hose"),
)
POSE = Pose2D(4.0, 3.0, math.pi / 2)


@pytest.mark.parametrize(
    ("said", "meant"),
    [
        ("the stall across from stall 2", "stall_5"),
        ("the stall opposite stall 4", "stall_1"),
        ("the stall facing stall 3", "stall_6"),
        ("the stall on the other side of stall 6", "stall_3"),
        ("the stall across the aisle from stall 1", "stall_4"),
        ("the stall next to stall 1", "stall_2"),
    ],
)
def test_what_faces_a_thing_is_not_the_next_in_its_row(said: str, meant: str) -> None:
    found = ground(said, OBJECTS, POSE)
    assert [item.id for item in found.candidates] == [meant]


@pytest.mark.parametrize(
    ("said", "meant"),
    [
        ("the room between the gym and classroom B", "hall_a"),
        ("the thing between the gym and classroom A", "cask"),
        ("the stall between stall 1 and stall 3", "stall_2"),
    ],
)
def test_between_two_things_is_in_the_gap_whatever_it_is_called(said: str, meant: str) -> None:
    found = ground(said, OBJECTS, POSE)
    assert [item.id for item in found.candidates] == [meant]


def test_where_nothing_stands_between_nothing_is_guessed() -> None:
    assert ground("the thing between stall 1 and stall 2", OBJECTS, POSE).outcome == "ambiguous"


@pytest.mark.parametrize(
    ("said", "meant"), [("the tub next to the hose", "tub_1"), ("the hose by the tubs", "hose_1")]
)
def test_of_two_kinds_those_are_meant_that_stand_together(said: str, meant: str) -> None:
    found = ground(said, OBJECTS, POSE)
    assert [item.id for item in found.candidates] == [meant]


@pytest.mark.parametrize(
    ("said", "meant"),
    [
        ("check the tubs for leaks, all of them.", "check all the tubs for leaks."),
        ("look at the tubs for me, both please", "look at both the tubs for me please"),
        ("check the tubs for leaks, all right?", "check the tubs for leaks, all right?"),
        ("look under the tubs, both sides", "look under the tubs, both sides"),
    ],
)
def test_how_many_are_meant_may_be_said_last(said: str, meant: str) -> None:
    assert plain(with_how_many(tokens(said), {"tub"}.__contains__)) == meant


def test_a_letter_of_an_identifier_is_no_article() -> None:
    assert tokens("tub_a")[-1].raw == "A"
    assert tokens("a tub")[0].raw == "a"
