"""What once led to a deed, a memory or a gap that nobody wanted: each is asked about, or done whole."""

from __future__ import annotations

from dataclasses import replace

import pytest

from parley.language.base import Situation
from parley.language.builtin.decision import Answer, Ask, Decision, Do, Forget, Remember
from parley.language.builtin.engine import BuiltinLanguage
from parley.language.builtin.judging import Asked, asked
from parley.messages.chat import ActionCall
from parley.messages.memory import MemoryEntry
from parley.messages.pvf import Parameter
from parley.world.object_map import MapObject
from tests.language.builtin.worlds import CATALOGUE, action, situation

ENGINE = BuiltinLanguage()
PLACES = tuple(
    MapObject(name.replace(" ", "_"), name, x, y)
    for name, x, y in (
        ("grey crane", 2.0, 1.0), ("white crane", 8.0, 1.0), ("silo", 1.0, 3.0), ("depot", 9.0, 3.0),
        ("bay 1", 1.0, 6.0), ("bay 2", 3.0, 6.0), ("bay 3", 5.0, 6.0), ("bathhouse", 7.0, 8.0),
    )
)  # fmt: skip


def decided(said: str, **more: object) -> Decision:
    return ENGINE.decide(situation(said, objects=PLACES, **more))


def places(said: str, **more: object) -> list[str]:
    made = decided(said, **more)
    assert isinstance(made, Do), made
    return [str(value) for deed in made.deeds for value in deed.arguments.values()]


@pytest.mark.parametrize(
    ("said", "about"),
    [
        ("the crane nearest to the depot, please go there", ["white crane"]),
        ("the crane near the silo, go to it", ["grey crane"]),
        ("look at the crane furthest from the silo", ["white crane"]),
        ("inspect bays 1 and 2, then both cranes", ["bay 1", "bay 2", "grey crane", "white crane"]),
        ("look at bay 1 and then the white one", ["bay 1", "white crane"]),
        ("check bay 1, then bay 2", ["bay 1", "bay 2"]),
        ("visit the grey crane, finish at the white crane", ["grey crane", "white crane"]),
        ("go to the silo the depot and bay 2", ["silo", "depot", "bay 2"]),
        ("finish at the depot but start at bay 1", ["bay 1", "depot"]),
    ],
)
def test_what_is_named_is_where_it_goes_and_none_is_lost(said: str, about: list[str]) -> None:
    assert list(dict.fromkeys(places(said))) == about


@pytest.mark.parametrize(
    "said",
    [
        "Thanks for checking the silo, that was very kind of you.",
        "Petra checked bay 1 and bay 2 an hour ago",
        "Can you open doors?",
        "Take Ms Kaur her keys.",
        "give the boy a bath",
        "actually leave bay 2",
        "we are closed. my shift ends in ten minutes and I promised to be home.",
    ],
)
def test_no_deed_comes_of(said: str) -> None:
    assert not isinstance(decided(said), Do)


def test_a_time_that_is_told_is_nothing_to_wait_for() -> None:
    assert places("My shift ends in ten minutes and I promised to be home. Would you go to the silo?") == [
        "silo"
    ]


def test_what_is_looked_for_before_an_order_is_not_lost() -> None:
    assert isinstance(decided("after you have checked the silo for mould come back to bay 1"), Ask)


def test_if_no_is_the_other_case() -> None:
    made = decided("check whether the silo is free, if yes go to bay 1, if no go to the depot")
    assert isinstance(made, Do)
    held = [(deed.arguments["place"], deed.holds) for deed in made.deeds if deed.check is not None]
    assert held == [("bay 1", True), ("depot", False)]


def test_an_exception_holds_for_an_action_of_ones_own_too() -> None:
    scrub = (*CATALOGUE, action("scrub", "Scrub the floor of a bay.", "bay"))
    made = decided("scrub every bay but bay 2", catalogue=scrub)
    assert isinstance(made, Ask) or "bay 2" not in [v for d in made.deeds for v in d.arguments.values()]  # type: ignore[union-attr]


@pytest.mark.parametrize(
    "said",
    [
        "Ada takes bays 1 and 2",
        "The last thing to visit is bay 1, the first is bay 2.",
        "Go to the silo, look for the red mug and pick it up if you find it.",
        "we put the jam next to the till this morning",
        "There's a spill at bay 1",
    ],
)
def test_neither_an_order_nor_half_a_sentence_is_remembered(said: str) -> None:
    assert not isinstance(decided(said), Remember)


@pytest.mark.parametrize(
    ("said", "kept"),
    [
        ("The drill is no longer in the silo; it is in the depot now.", "the drill is in the depot"),
        ("Otto isn't at the silo any more, he went to the depot", "Otto is at the depot"),
    ],
)
def test_where_something_is_now_is_remembered_and_not_where_it_was(said: str, kept: str) -> None:
    made = decided(said)
    assert isinstance(made, Remember) and [fact.text for fact in made.told] == [kept]


def planned(said: str) -> Situation:
    given = {"target": Parameter("string", "silo")}
    call = ActionCall(name="drive_to", input_parameters=given, reason="go to the silo")
    return replace(situation(said, objects=PLACES), queue=(call,), status="running")


@pytest.mark.parametrize("said", ["The silo has been done already.", "Petra has already checked the silo"])
def test_what_is_planned_and_done_by_others_is_asked_about(said: str) -> None:
    made = ENGINE.decide(planned(said))
    assert isinstance(made, Ask) and made.choices == ("leave out the silo",)


def test_a_question_what_it_can_do_is_answered() -> None:
    assert isinstance(decided("Can you open doors?"), Answer)


def test_who_forgets_where_a_thing_is_forgets_nothing_else() -> None:
    known = [
        MemoryEntry(name="chest_location", data="the chest is in the silo", info="Where the chest is"),
        MemoryEntry(name="wrench_location", data="the wrench is in the chest", info="Where the wrench is"),
    ]
    made = decided("Forget where the chest is.", memory=tuple(known))
    assert isinstance(made, Forget) and made.names == ("chest_location",)


@pytest.mark.parametrize(
    "said", ["verify the silo is clear", "check the silo is clear", "check if the silo is clear"]
)
def test_what_is_to_be_so_is_judged_without_a_word_that_asks(said: str) -> None:
    looked = places(said)[-1]
    assert (
        looked.startswith(("whether the silo is clear", "if the silo is clear"))
        and asked(looked).unwanted is False
    )
    assert asked(looked).kind == "room"


def test_half_a_list_is_not_even_offered() -> None:
    made = decided("I need bays 1, 2 and X checked. Divide them among yourselves.")
    assert isinstance(made, Ask) and not made.offer


@pytest.mark.parametrize(
    "said",
    [
        "whether there is anything lying around in bay 2",
        "whether anything is left in bay 2",
        "whether there is anything parked in bay 2",
        "whether anything has been left lying around in bay 2",
    ],
)
def test_how_something_lies_there_makes_no_other_place_of_it(said: str) -> None:
    assert asked(said) == Asked("thing", ("anything",), ("bay", "2"), unwanted=True)
