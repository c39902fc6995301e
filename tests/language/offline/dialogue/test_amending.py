"""The last order with another value in it."""

from __future__ import annotations

import pytest

from parley.language.base import Situation, Turn
from parley.language.offline.dialogue.amending import amended
from parley.language.offline.words.text import plain, tokens
from parley.world.object_map import MapObject


def said(order: str, message: str) -> tuple[str, bool] | None:
    history = (Turn("operator", order), Turn("assistant", "All right."))
    change = amended(tokens(message), Situation(message=message, history=history))
    return None if change is None else (plain(change.words), change.instead)


@pytest.mark.parametrize(
    ("message", "order"),
    [
        ("make it 32", "Set oven 1 to 32 degrees"),
        ("no, 40 degrees", "Set oven 1 to 40 degrees"),
        ("sorry, oven 2", "Set oven 2 to 30 degrees"),
        ("oven 2, not 1, I meant", "Set oven 2 to 30 degrees"),
    ],
)
def test_a_correction_takes_the_place_of_the_last_order(message: str, order: str) -> None:
    assert said("Set oven 1 to 30 degrees.", message) == (order, True)


@pytest.mark.parametrize(
    ("message", "order"),
    [
        ("now the carrot bed, but only half as much", "Water the carrot bed with 10 litres"),
        ("twice as much on the bean bed too", "Water the bean bed with 40 litres"),
        ("another 5 litres please", "Water the tomato bed with 5 litres"),
    ],
)
def test_more_of_the_same_comes_on_top_of_it(message: str, order: str) -> None:
    assert said("Water the tomato bed with 20 litres.", message) == (order, False)


@pytest.mark.parametrize(
    "message",
    [
        "32",
        "is it 32 now?",
        "go to room 15 now",
        "thanks, now I am happy",
        "no, it is raining",
        "sorry",
        "no",
    ],
)
def test_other_messages_are_no_correction(message: str) -> None:
    assert said("Set oven 1 to 30 degrees.", message) is None


def test_an_answer_to_a_question_is_no_correction() -> None:
    history = (Turn("operator", "Set oven 1 to 30 degrees"), Turn("assistant", "For how many minutes?"))
    assert amended(tokens("rather 20"), Situation(message="rather 20", history=history)) is None


@pytest.mark.parametrize("message", ["and tank 2 for ten minutes", "now tank 2, ten minutes please"])
def test_another_thing_and_another_value_both_take_their_places(message: str) -> None:
    tanks = tuple(MapObject(f"t{n}", f"tank {n}", 3.0 * n, 1.0, "tank") for n in (1, 2))
    history = (Turn("operator", "Rinse tank 1 for 5 minutes."), Turn("assistant", "All right."))
    change = amended(tokens(message), Situation(message=message, history=history, objects=tanks))
    assert change is not None
    assert plain(change.words) == "Rinse tank 2 for ten minutes"
