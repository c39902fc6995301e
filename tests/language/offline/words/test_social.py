"""Small talk, of which nothing else was made."""

from __future__ import annotations

import pytest

from parley.language.offline.words.social import reply, small_talk
from parley.language.offline.words.text import tokens

LOST = "I am not sure what you mean by that."


@pytest.mark.parametrize(
    "said", ["well done mate", "my back hurts today", "happy birthday!", "haha very funny"]
)
def test_small_talk_of_which_nothing_was_made_is_answered(said: str) -> None:
    assert small_talk(tokens(said), LOST)


def test_what_was_understood_is_left_alone() -> None:
    assert small_talk(tokens("well done mate"), "I will go to the gate.") is None


def test_a_question_where_something_is_stays_one() -> None:
    assert small_talk(tokens("where is my husband"), "I do not know where your husband is.") is None


def test_only_the_robot_is_asked_for_its_age_for_fun() -> None:
    assert reply(tokens("how old are you"))
    assert reply(tokens("what is Peter's favourite drink")) is None


def test_this_morning_greets_nobody() -> None:
    assert small_talk(tokens("bring Ann the saw, she rang this morning"), "Where is the saw?") is None
    assert small_talk(tokens("good morning"), LOST)


@pytest.mark.parametrize("said", ["that was lovely of you", "thanks, how thoughtful of you"])
def test_thanks_have_any_words(said: str) -> None:
    assert small_talk(tokens(said), LOST) == "You are welcome."


@pytest.mark.parametrize("said", ["that is in front of you", "the box is one of you"])
def test_not_all_of_you_is_thanks(said: str) -> None:
    assert small_talk(tokens(said), LOST) is None
