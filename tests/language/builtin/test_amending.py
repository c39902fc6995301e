"""What is taken back, left out, or put in another order while somebody speaks; what only sounds like it."""

from __future__ import annotations

import pytest

from parley.cli.actions import catalogue_with
from parley.language.builtin.decision import Answer, Ask, Decision, Do
from parley.language.builtin.engine import BuiltinLanguage
from parley.world.object_map import MapObject
from tests.language.builtin.worlds import situation

ENGINE = BuiltinLanguage()
SHIPPED = catalogue_with(None)[0].for_robot(("drive", "camera")).infos()
PLACES = tuple(
    MapObject(name.replace(" ", "_"), name, x, y)
    for name, x, y in (
        ("bay A", 1.0, 1.0),
        ("dock", 8.0, 1.0),
        ("turning circle", 8.0, 9.0),
        ("press", 7.0, 2.0),
    )
)


def decided(said: str) -> Decision:
    return ENGINE.decide(situation(said, objects=PLACES, catalogue=SHIPPED))


def driven(said: str) -> list[str]:
    made = decided(said)
    assert isinstance(made, Do), made
    return [str(deed.arguments["target"]) for deed in made.deeds if deed.frame == "GO" and deed.arguments]


@pytest.mark.parametrize(
    "said",
    [
        "go to the dock, no, the press",
        "go to the dock, I mean the press",
        "go to the dock, or rather the press",
        "go to the dock, actually the press",
        "go to the dock. No wait, go to the press.",
        "could you go to the dock? Sorry, I meant the press",
        "go to the dock i mean the press",
        "go to the dock no wait the press",
        "check bay A and go to the dock, no, sorry, to the press",
    ],
)
def test_what_is_taken_back_is_not_done(said: str) -> None:
    assert driven(said)[-1] == "press"
    assert "dock" not in driven(said)


@pytest.mark.parametrize(
    "said",
    [
        "don't go to the dock, no, go to the press",
        "not that dock, go to the press",
        "go to the dock and check bay A. No wait, go to the press",
        "go to the dock, no, not yet",
        "bring the crate to the dock, no, the drum",
        "go to the dock, no, first to the press",
        "go to the dock, no need to hurry",
        "go to the dock, the north one I mean",
        "go to the dock and check the door. Sorry, I said dock but I meant press",
        "is the press open? yes - go to bay A, no - go to the dock",
    ],
)
def test_where_it_is_not_plain_what_is_taken_back_it_is_asked(said: str) -> None:
    assert isinstance(decided(said), Ask)


def test_what_is_added_takes_nothing_back() -> None:
    assert driven("go to the dock, actually also the press") == ["dock", "press"]


@pytest.mark.parametrize(
    "said",
    [
        "never mind the dock, go to the press",
        "forget that, go to the press",
        "go to the press, don't bother with the dock",
        "go to the press, skip the dock",
        "forget the dock, go to the press",
        "no need to check the dock, just go to the press",
        "it's really stuffy, go to the press",
        "the press needs checking",
        "you're needed at the press",
        "off you go to the press",
        "park yourself beside the press",
    ],
)
def test_only_what_is_wanted_is_done(said: str) -> None:
    assert driven(said) == ["press"]


@pytest.mark.parametrize(
    ("said", "order"),
    [
        ("check the dock, the press first", ["press", "dock"]),
        ("go to the dock last and to the press first", ["press", "dock"]),
        ("check the press, then the dock", ["press", "dock"]),
    ],
)
def test_first_and_last_are_an_order(said: str, order: list[str]) -> None:
    assert driven(said) == order


@pytest.mark.parametrize(
    "said", ["go to the bay, it's the second one", "the press needs no checking", "check it last"]
)
def test_words_that_change_what_is_meant_are_not_left_out(said: str) -> None:
    assert not isinstance(decided(said), Do)


@pytest.mark.parametrize(
    "said",
    [
        "check the dock, and if it's not there, check the press",
        "check the dock. If there is no crate, check the press",
        "go to the dock, make it quick, and then go to the press",
    ],
)
def test_words_that_only_look_so_take_nothing_back(said: str) -> None:
    made = decided(said)
    assert isinstance(made, Ask) or driven(said) == ["dock", "press"]


@pytest.mark.parametrize("said", ["go to the dock, never mind", "check the... no, forget it"])
def test_what_is_taken_back_as_a_whole_is_left(said: str) -> None:
    assert decided(said) == Answer("All right, then I leave it.")


@pytest.mark.parametrize(
    ("said", "where"),
    [
        ("go from bay A to the dock", ["bay A", "dock"]),
        ("patrol from the dock to the press and then back to bay A", ["dock", "press", "bay A"]),
        ("drive from here to the dock", ["dock"]),
        ("head on over to the press", ["press"]),
    ],
)
def test_a_way_leads_from_where_it_begins(said: str, where: list[str]) -> None:
    assert driven(said) == where


@pytest.mark.parametrize(
    ("said", "frames", "about"),
    [
        ("look behind you", ["TURN", "LOOK"], "180.0"),
        ("look to your left", ["TURN", "LOOK"], "left"),
        ("look ahead", ["LOOK"], "what can be seen here"),
        ("take a picture of whoever is at the dock", ["GO", "GO", "PHOTO"], "dock"),
        ("check the press's bolts", ["GO", "GO", "LOOK"], "press's bolts"),
    ],
)
def test_what_is_looked_at_is_turned_to(said: str, frames: list[str], about: str) -> None:
    made = decided(said)
    assert isinstance(made, Do), made
    assert [deed.frame for deed in made.deeds] == frames
    assert about in {str(value) for deed in made.deeds for value in deed.arguments.values()}


@pytest.mark.parametrize("where", ["at the gate", "by the gate", "behind you"])
@pytest.mark.parametrize("who", ["the person", "whoever is"])
def test_no_picture_is_taken_of_who_is_at_a_place_that_nobody_knows(who: str, where: str) -> None:
    assert isinstance(decided(f"take a picture of {who} {where}"), Ask)
