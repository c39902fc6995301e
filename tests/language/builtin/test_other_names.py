"""What a thing is called besides, orders in the form of questions, and what opposite actions are."""

from __future__ import annotations

import pytest

from parley.language.builtin.decision import Ask, Do
from parley.language.builtin.engine import BuiltinLanguage
from parley.language.builtin.lexicon import lexicon
from parley.language.builtin.things import link
from parley.language.builtin.tokens import tokenize
from tests.language.builtin.worlds import action, situation, thing

ENGINE = BuiltinLanguage()
HOUSE = tuple(
    thing(name, at) for at, name in enumerate(("closet", "glasses", "glass", "laptop", "couch", "van"))
)


def linked(words: str) -> list[str]:
    low = words.split()
    return [item.description for item in link(low, len(low) - 1, HOUSE, lexicon()).things]


@pytest.mark.parametrize(
    ("said", "meant"),
    [
        ("the big wardrobe", ["closet"]),
        ("the settees", ["couch"]),
        ("reading glasses", ["glasses"]),  # and not the glass
        ("the glass", ["glass"]),
        ("the spectacles", ["glasses"]),
        ("the automobile", []),  # a van is no car for sure
    ],
)
def test_a_thing_is_found_by_its_other_names(said: str, meant: list[str]) -> None:
    assert linked(said) == meant


def test_things_of_one_kind_are_all_meant_wherever_their_name_says_they_stand() -> None:
    objects = (thing("tall plant", 1), thing("plant by the door", 2))
    assert len(link(["the", "plant"], 1, objects, lexicon()).things) == 2


def test_a_name_on_the_map_comes_before_another_name_of_a_thing() -> None:
    objects = (thing("closet", 1), thing("wardrobe", 2))
    found = link(["the", "wardrobe"], 1, objects, lexicon())
    assert [item.id for item in found.things] == ["wardrobe_2"]


def test_special_kinds_are_called_by_the_general_name_and_not_the_other_way_round() -> None:
    synonyms = lexicon().synonyms
    assert ("book",) in synonyms[("paperback",)]
    assert ("paperback",) not in synonyms.get(("book",), ())


@pytest.mark.parametrize(
    "asked",
    [
        "can you open the front gate",
        "do you think you could open the front gate",
        "could you open the front gate",
        "can you open the front gate?",
        "Ada, can you open the front gate?",
    ],
)
def test_an_order_may_have_the_form_of_a_question(asked: str) -> None:
    decision = ENGINE.decide(situation(asked))
    assert isinstance(decision, Do)
    assert [deed.frame for deed in decision.deeds][-1] == "OPEN"


@pytest.mark.parametrize(
    "asked", ["can you swim", "can you tell me where the red box is", "can you see the red box"]
)
def test_a_question_stays_one(asked: str) -> None:
    assert not isinstance(ENGINE.decide(situation(asked)), Do)


@pytest.mark.parametrize("said", ["to the left thirty degrees", "thirty degrees to the left"])
def test_a_side_and_an_angle_are_an_order(said: str) -> None:
    decision = ENGINE.decide(situation(said))
    assert isinstance(decision, Do)
    assert {str(value) for value in decision.deeds[0].arguments.values()} == {"left", "30 degrees"}


def test_an_angle_alone_is_asked_about() -> None:
    assert isinstance(ENGINE.decide(situation("thirty degrees")), Ask)


def test_both_of_two_things_are_meant_wherever_they_stand() -> None:
    decision = ENGINE.decide(situation("take the red box and the blue crate on the desk"))
    named = (
        {str(value) for deed in decision.deeds for value in deed.arguments.values()}
        if isinstance(decision, Do)
        else set()
    )
    assert "desk" not in {
        value for deed in getattr(decision, "deeds", ()) for value in [deed.arguments.get("item")]
    }
    assert named >= {"red box", "blue crate"} or isinstance(decision, Ask)


def test_an_action_is_not_taken_for_its_opposite() -> None:
    actions = (action("tie", "Make a connection to something; it may be connected to the robot.", "item"),)
    assert isinstance(ENGINE.decide(situation("disconnect the pump", catalogue=actions)), Ask)


def test_all_groups_of_names_can_be_read() -> None:
    for name, others in lexicon().synonyms.items():
        assert name not in others
        assert all(token.is_word for token in tokenize(" ".join(name)))


FINDERS = (
    action("detect_item", "Look around for an item.", "item"),
    action("detect_person", "Look around for a person.", "who"),
)


@pytest.mark.parametrize(
    ("said", "done"),
    [
        ("find the wrench", "detect_item"),
        ("find Kim", "detect_person"),
        ("find the visitor", "detect_person"),
    ],
)
def test_a_thing_is_not_given_to_an_action_for_persons(said: str, done: str) -> None:
    for catalogue in (FINDERS, FINDERS[::-1]):
        decision = ENGINE.decide(situation(said, catalogue=catalogue, objects=()))
        assert isinstance(decision, Do)
        assert [deed.skill.action.name for deed in decision.deeds] == [done]


def test_who_can_only_find_persons_does_not_look_for_things() -> None:
    asked = situation("find the wrench", catalogue=FINDERS[1:], objects=())
    assert isinstance(ENGINE.decide(asked), Ask)
