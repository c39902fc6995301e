"""Things that are named by the room in which they are, and all rooms."""

from __future__ import annotations

import pytest

from parley.cli.actions import catalogue_with
from parley.language.builtin.decision import Ask, Decision, Do
from parley.language.builtin.engine import BuiltinLanguage
from parley.world.object_map import MapArea, MapObject
from tests.language.builtin.worlds import situation

ENGINE = BuiltinLanguage()
SHIPPED = catalogue_with(None)[0].for_robot(("drive", "camera")).infos()
ROOMS = tuple(
    MapArea(name, ((x, 0.0), (x + 4.0, 0.0), (x + 4.0, 4.0), (x, 4.0)), capacity).goal
    for name, x, capacity in (
        ("yard", 0.0, None),
        ("tool store", 10.0, None),
        ("cellar", 20.0, None),
        ("narrow lift", 30.0, 1),
    )
)
THINGS = tuple(
    MapObject(name, name, x, 1.0)
    for name, x in (
        ("red crate", 1.0), ("blue crate", 2.0), ("ladder", 3.0), ("green crate", 11.0), ("lathe", 12.0),
        ("crate by the yard gate", 5.0),
    )
)  # fmt: skip


def decided(said: str) -> Decision:
    return ENGINE.decide(situation(said, objects=THINGS, rooms=ROOMS, catalogue=SHIPPED))


def visited(said: str) -> list[str]:
    made = decided(said)
    assert isinstance(made, Do), made
    return [str(deed.arguments["target"]) for deed in made.deeds if deed.hidden]  # finding where it is


@pytest.mark.parametrize(
    ("said", "where"),
    [
        ("check all crates in the yard", ["red crate", "blue crate"]),
        ("check the crates in the yard", ["red crate", "blue crate"]),
        ("go to every crate in the tool store", ["green crate"]),
        ("check the crate in the tool store", ["green crate"]),
        ("take a picture of everything in the tool store", ["green crate", "lathe"]),
        ("look at all the things in the yard except the ladder", ["red crate", "blue crate"]),
        ("check every room", ["yard", "tool store", "cellar"]),
        ("go to all rooms but not the yard", ["tool store", "cellar"]),
        ("visit all the rooms and take a picture in each", ["yard", "tool store", "cellar"]),
    ],
)
def test_a_room_tells_which_things_are_meant(said: str, where: list[str]) -> None:
    assert visited(said) == where


@pytest.mark.parametrize(
    ("said", "asked"),
    [
        ("check the crate in the yard", "Which one do you mean: the red crate or the blue crate?"),
        ("check the ladders in the cellar", "ladder"),
        ("check everything in the cellar", "My map has nothing in the cellar."),
        ("check all crates in the cellar", "My map has no “crates” in the cellar."),
    ],
)
def test_what_is_not_there_or_not_one_is_asked_about(said: str, asked: str) -> None:
    made = decided(said)
    assert isinstance(made, Ask) and asked in made.question


def test_each_room_is_pictured_where_it_is() -> None:
    made = decided("visit all the rooms and take a picture in each")
    assert isinstance(made, Do)
    frames = [deed.frame for deed in made.deeds if not deed.hidden]
    assert frames == ["GO", "PHOTO"] * 3


@pytest.mark.parametrize("said", ["get out of the yard", "leave the cellar", "go away from the ladder"])
def test_who_is_sent_away_asks_where_to(said: str) -> None:
    made = decided(said)
    assert isinstance(made, Ask) and made.question == "Where shall I go instead?" and not made.offer
