"""Groups of things in a message: which they are, and that the sentence around them stays as it is."""

from __future__ import annotations

import pytest

from parley.language.offline.scene.groups import GroupReader
from parley.language.offline.scene.marks import members_of
from parley.language.offline.words.text import Phrase, plain, tokens
from parley.world.geometry import Pose2D
from parley.world.object_map import MapObject

GATES = tuple(MapObject(f"g{n}", f"gate {n}", float(n), 0.0, "gate") for n in range(1, 6))
TANKS = (
    MapObject("t1", "red tank", -4.0, 3.0, "tank"),
    MapObject("t2", "blue tank", 0.0, 3.0, "tank"),
    MapObject("t3", "green tank", 4.0, 3.0, "tank"),
)
HALL = MapObject("hall", "hall", 2.0, 8.0, "hall")
OBJECTS = (*GATES, *TANKS, HALL)


def read(text: str, named: tuple[MapObject, ...] = ()) -> Phrase:
    return GroupReader(OBJECTS, Pose2D(0.0, 0.0), (), lambda said: named).read(tokens(text))


def group(text: str, named: tuple[MapObject, ...] = ()) -> list[str]:
    return [item.id for item in members_of(read(text, named), OBJECTS)]


@pytest.mark.parametrize(
    ("text", "ids"),
    [
        ("check gates 2 to 4", ["g2", "g3", "g4"]),
        ("check gates 2 through 4 please", ["g2", "g3", "g4"]),
        ("check gates 1-3", ["g1", "g2", "g3"]),
        ("visit gates 4, 2 and 1", ["g4", "g2", "g1"]),
        ("the first two gates", ["g1", "g2"]),
        ("the last three gates", ["g3", "g4", "g5"]),
        ("the odd gates", ["g1", "g3", "g5"]),
        ("all even-numbered gates", ["g2", "g4"]),
        ("every other gate", ["g1", "g3", "g5"]),
        ("every second gate beginning with gate 2", ["g2", "g4"]),
        ("all gates from 4 upwards", ["g4", "g5"]),
        ("all gates above 3", ["g4", "g5"]),
        ("the gates below 3", ["g1", "g2"]),
        ("the gates with even numbers", ["g2", "g4"]),
        ("three of the gates, namely 1, 3 and 4", ["g1", "g3", "g4"]),
        ("every gate apart from gate 3", ["g1", "g2", "g4", "g5"]),
        ("all gates but 2 and 3", ["g1", "g4", "g5"]),
        ("all gates except the last", ["g1", "g2", "g3", "g4"]),
        ("each gate except the second", ["g1", "g3", "g4", "g5"]),
        ("all gates without 5", ["g1", "g2", "g3", "g4"]),
        ("the gates are to be seen, except for 1", ["g2", "g3", "g4", "g5"]),
        ("all tanks except the red one", ["t2", "t3"]),
        ("all tanks that are not blue", ["t1", "t3"]),
        ("all tanks, the red one last", ["t2", "t3", "t1"]),
        ("all tanks, starting with the green one", ["t3", "t1", "t2"]),
        ("two of the tanks, whichever are closest", ["t2", "t1"]),
        ("the outer two tanks", ["t1", "t3"]),
    ],
)
def test_a_group_is_what_its_words_say(text: str, ids: list[str]) -> None:
    assert group(text) == ids


@pytest.mark.parametrize(
    "text",
    [
        "go to gate 2",
        "check the hall",
        "not all tanks",
        "is it gate 2",
        "pick any tank and go there",
        "the two gates",
        "one of the gates is open",
    ],
)
def test_what_names_no_group_stays_as_it_is(text: str) -> None:
    assert plain(read(text)) == plain(tokens(text))


def test_the_others_are_those_that_were_not_named() -> None:
    assert group("check the other tanks", TANKS[:1]) == ["t2", "t3"]


def test_what_was_named_just_before_can_be_left_out() -> None:
    assert group("tank 1 leaks, so check all tanks but that one", TANKS[:1]) == ["t2", "t3"]


def test_so_many_are_those_that_were_named_before() -> None:
    assert group("check the two tanks", TANKS[1:]) == ["t2", "t3"]


def test_so_many_of_more_that_nothing_tells_are_noted() -> None:
    reader = GroupReader(OBJECTS, Pose2D(0.0, 0.0), (), lambda said: ())
    reader.read(tokens("check both gates"))
    assert reader.uncounted is not None
    assert reader.uncounted.items == GATES


def test_a_pronoun_stands_for_the_group_before_it() -> None:
    words = read("go round all tanks and see whether they are wet")
    assert [len(members_of((word,), OBJECTS)) for word in words].count(3) == 2


def test_one_of_several_is_put_by_its_name() -> None:
    assert plain(read("check one tank, the green one")) == "check the green tank"
    assert plain(read("go to the gate after gate 2")) == "go to gate 3"
    assert plain(read("paint the tank nearest to gate 4 white")) == "paint the green tank white"


def test_a_group_is_repeated_to_people_in_their_own_words() -> None:
    assert plain(read("the gates 2 to 4 are new")) == "the gates 2 to 4 are new"


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        ("check the tank, the blue one", "check the blue tank"),
        ("check the tank. not the red one, not the blue one!", "check the green tank.!"),
        ("the tank needs checking, the green one i mean", "the green tank needs checking"),
        ("check the tank marked green", "check the green tank"),
        ("one of the tanks leaks, the red one i think, go look", "the red tank leaks, go look"),
        ("the middle one of the tanks", "the blue tank"),
        ("the gate between 2 and 4", "gate 3"),
    ],
)
def test_what_is_said_behind_a_name_tells_which_of_its_kind_is_meant(text: str, meant: str) -> None:
    assert plain(read(text)) == meant


@pytest.mark.parametrize(
    "text",
    [
        "check the tank and the hall",
        "check the tank. go to the red one",
        "a tank is leaking, the hall is wet",
    ],
)
def test_what_is_said_behind_a_name_of_something_else_tells_nothing(text: str) -> None:
    assert plain(read(text)) == text
