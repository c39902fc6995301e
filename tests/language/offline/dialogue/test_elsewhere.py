"""Follow-ups that only name another thing."""

from __future__ import annotations

import pytest

from parley.evaluation.catalogues import CATALOGUES
from parley.language.base import Situation, Turn
from parley.language.offline.dialogue.elsewhere import elsewhere, in_place_of_misspelt
from parley.language.offline.engine import OfflineLanguage
from parley.language.offline.scene.scene import Scene
from parley.language.offline.words.text import plain, tokens
from parley.world.object_map import MapObject

MAP = (
    *(MapObject(f"gate_{n}", f"gate {n}", float(n), 0.0, class_name="gate") for n in (1, 2, 3)),
    MapObject("box_r", "red box", 0.0, 5.0, class_name="box"),
    MapObject("box_b", "blue box", 0.0, -5.0, class_name="box"),
    MapObject("hall", "hall", 4.0, 4.0, class_name="room"),
)


def meant(message: str, *said: str) -> str:
    """What a follow-up stands for, after what the operator and the robot said in turn."""
    turns = tuple(Turn(("operator", "assistant")[i % 2], text) for i, text in enumerate(said))
    return plain(elsewhere(tokens(message), Situation(message=message, history=turns, objects=MAP)))


@pytest.mark.parametrize(
    ("message", "order"),
    [
        ("and the other one?", "look for keys in the blue box"),
        ("now the same at the blue one", "look for keys in the blue box"),
        ("perhaps they are in the hall", "look for keys in the hall"),
        ("look again please", "look for keys in the red box"),
    ],
)
def test_another_thing_takes_the_place_of_the_last_one(message: str, order: str) -> None:
    assert meant(message, "look for keys in the red box", "There are no keys in the red box.") == order


def test_the_others_are_those_that_were_not_spoken_of() -> None:
    said = meant("now the remaining gates", "check gate 1 for leaves", "There are none.")
    assert said == "check gate 2 for leaves. check gate 3 for leaves"


def test_a_question_that_was_looked_into_becomes_a_look() -> None:
    said = meant(
        "what about gate 2?", "Is there anything on gate 1?", "I will look.", "thanks", "Gate 1 is free."
    )
    assert said.lower() == "check whether there is anything on gate 2"


@pytest.mark.parametrize(
    "message", ["go to gate 2", "the hall is locked and wet", "thanks", "no, but the hall", ""]
)
def test_whatever_says_more_is_no_such_follow_up(message: str) -> None:
    assert meant(message, "look for keys in the red box", "There are none.") == ""


def test_an_answer_to_a_question_is_no_such_follow_up() -> None:
    assert meant("the blue one too", "look into the box", "Which one do you mean?") == ""


@pytest.mark.parametrize("message", ["No, I meant gate 2", "not gate 1, gate 2", "gate 2, not gate 1"])
def test_what_was_meant_instead_takes_the_place_of_the_last_one(message: str) -> None:
    assert meant(message, "check gate 1 for leaves", "There are none.") == "check gate 2 for leaves"


def test_the_other_two_are_all_that_were_not_spoken_of() -> None:
    said = meant("and the other two as well", "check gate 1 for leaves", "There are none.")
    assert said == "check gate 2 for leaves. check gate 3 for leaves"


def test_another_thing_takes_the_place_of_a_misspelt_one_that_was_guessed_wrong() -> None:
    rooms = (MapObject("s", "sauna", 0.0, 0.0, "room"), MapObject("l", "lobby", 1.0, 0.0, "room"))
    scene = Scene.of(Situation("no, the lobby", objects=rooms))
    order = in_place_of_misspelt(tokens("the lobby"), tokens("Go to the saona"), scene)
    assert plain(order) == "Go to the lobby"
    assert not in_place_of_misspelt(tokens("the lobby"), tokens("Carry on"), scene)


def test_an_order_to_have_a_look_is_no_question() -> None:
    said = meant("and gate 2?", "Have a look whether gate 1 is shut", "It is shut.")
    assert said == "Have a look whether gate 2 is shut"


@pytest.mark.parametrize(
    "answer", ["none of them, I meant the hall", "neither, the hall please", "no, the hall"]
)
async def test_what_was_none_of_those_offered_takes_their_place(answer: str) -> None:
    turns = (
        Turn("operator", "Drive to the box."),
        Turn("assistant", "Which one do you mean: the red box or the blue box?"),
    )
    action = await OfflineLanguage().interpret(
        Situation(message=answer, history=turns, objects=MAP, catalogue=CATALOGUES["thesis"])
    )
    assert action.message_response == "I will go to the hall."
