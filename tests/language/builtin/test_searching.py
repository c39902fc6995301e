"""What is sought in several places; how things are that nobody can know from afar."""

from __future__ import annotations

import pytest

from parley.cli.actions import catalogue_with
from parley.language.builtin.decision import Answer, Ask, Decision, Do
from parley.language.builtin.engine import BuiltinLanguage
from parley.world.object_map import MapArea, MapObject
from tests.language.builtin.worlds import situation

ENGINE = BuiltinLanguage()
SHIPPED = catalogue_with(None)[0].for_robot(("drive", "camera")).infos()
HALL, YARD = (
    MapArea("hall", ((0, 0), (4, 0), (4, 4), (0, 4))),
    MapArea("yard", ((5, 0), (9, 0), (9, 4), (5, 4))),
)
THINGS = (
    MapObject("crate_1", "crate by the press", 1.0, 1.0),
    MapObject("crate_2", "crate by the pump", 6.0, 1.0),
    MapObject("fan", "fan in the hall", 3.0, 3.0),
)


def decided(said: str) -> Decision:
    rooms = (HALL.goal, YARD.goal)
    return ENGINE.decide(situation(said, objects=THINGS, rooms=rooms, catalogue=SHIPPED))


@pytest.mark.parametrize(
    "said",
    [
        "look for my bag in the hall and the yard",
        "look for my bag in the hall, and also in the yard",
        "search the hall and the yard for my bag",
    ],
)
def test_what_is_sought_in_several_places_is_sought_in_each(said: str) -> None:
    made = decided(said)
    assert isinstance(made, Do), made
    shown = [deed for deed in made.deeds if deed.arguments]
    assert [deed.frame for deed in shown] == ["GO", "FIND", "GO", "FIND"]
    assert [str(value) for deed in shown for value in deed.arguments.values()] == [
        "hall",
        "bag",
        "yard",
        "bag",
    ]


def test_what_is_sought_in_one_place_before_another_deed_is_sought_there_alone() -> None:
    made = decided("look for my bag in the hall, then go to the yard")
    assert isinstance(made, Do), made
    assert [deed.frame for deed in made.deeds if deed.frame == "FIND"] == ["FIND"]


@pytest.mark.parametrize(
    "said", ["which crates are open?", "which crates need a label", "what crates look wet?"]
)
def test_how_things_are_is_not_answered_by_which_there_are(said: str) -> None:
    assert decided(said) == Answer("How that is now I only see when I look there.")


@pytest.mark.parametrize(
    ("said", "text"),
    [
        ("which crates are in the yard?", "On my map there is the crate by the pump."),
        (
            "which crates do you know?",
            "On my map there are 2: the crate by the press and the crate by the pump.",
        ),
    ],
)
def test_which_there_are_is_answered_by_the_map(said: str, text: str) -> None:
    assert decided(said) == Answer(text)


@pytest.mark.parametrize("said", ["is the fan on in the hall?", "is the fan still on in the hall?"])
def test_whether_something_is_on_is_looked_for_and_not_where_it_is(said: str) -> None:
    made = decided(said)
    assert isinstance(made, Ask), made
    assert "look" in made.question
