"""Clauses that say where somebody is, or that somebody is helped, and verbs that the lexicon settles."""

from __future__ import annotations

import pytest

from parley.language.builtin.decision import Do
from tests.language.builtin.test_sights import ABLE, ENGINE, done
from tests.language.builtin.worlds import situation


@pytest.mark.parametrize(
    ("said", "deeds"),
    [
        ("follow Lena, she's at the desk", "drive_to desk, go_along Lena"),
        ("Follow Lena, she is at the desk", "drive_to desk, go_along Lena"),
        ("go with Lena who's at the desk", "drive_to desk, go_along Lena"),
        ("tell Lena the day, you will find her in the yard", "drive_to yard, inform the day"),
        ("answer a question for somebody who you will find in the yard", "drive_to yard, reply"),
        ("bring me the mug that is on the desk", "drive_to desk, carry mug operator"),
        ("bring Lena the stapler, she's in the yard", "search stapler, drive_to yard, carry stapler Lena"),
        ("tell Lena what day it is, she is in the yard", "drive_to yard, inform what day it is"),
    ],
)
def test_where_somebody_is_said_to_be_is_the_place_of_the_order(said: str, deeds: str) -> None:
    assert done(said) == deeds


@pytest.mark.parametrize(
    ("said", "deeds"),
    [
        ("help me get the stapler", "search stapler, carry stapler"),
        ("help Lena get to the yard", "lead Lena yard"),
        ("help Lena find her way from the desk to the yard", "drive_to desk, lead Lena yard"),
    ],
)
def test_to_help_somebody_is_no_cry_for_help(said: str, deeds: str) -> None:
    assert done(said) == deeds


def test_a_cry_for_help_stays_one() -> None:
    assert done("help Lena get out of the fire in the yard") == "Ask"
    assert done("help, Lena fell in the yard") == "Ask"


@pytest.mark.parametrize(
    ("said", "deeds"),
    [
        ("go to the desk, meet Lena and follow her to the yard", "drive_to desk, search Lena, go_along Lena"),
        ("meet Lena at the desk, and go to the yard with her", "drive_to desk, search Lena, go_along Lena"),
        ("find a person in the yard to answer their question", "drive_to yard, search person, reply"),
        ("answer Lena's question at the desk", "drive_to desk, reply"),
        ("answer the question of a girl in the yard", "drive_to yard, reply"),
        ("meet robin at the desk and lead them to the yard", "drive_to desk, search robin, lead robin yard"),
        ("lead Lena from the desk back to here", "drive_to desk, lead Lena operator"),
        ("grab the red box from the yard and bring to the desk", "grab red box yard, carry red box desk"),
        ("move the red box and bring it to the desk", "grab red box, carry red box desk"),
        ("bring me the stapler from the desk there", "drive_to desk, carry stapler operator"),
    ],
)
def test_words_that_others_settle_are_not_asked_about(said: str, deeds: str) -> None:
    assert done(said) == deeds


def test_somebody_who_was_met_is_led_and_not_picked_up() -> None:
    assert done("meet Lena in the yard and take them") == "Ask"
    assert done("meet Lena in the yard and bring her back") == "Ask"
    assert (
        done("meet Lena in the yard and bring her to me") == "drive_to yard, search Lena, lead Lena operator"
    )


@pytest.mark.parametrize(
    ("said", "deeds"),
    [
        ("bring the stapler to Lena over at the yard", "search stapler, drive_to yard, carry stapler Lena"),
        (
            "go to the yard and when you find a girl tell her what day it is",
            "drive_to yard, search girl, inform what day it is",
        ),
        ("trail behind Lena", "go_along Lena"),
        ("go to the desk to meet Lena, and follow her", "drive_to desk, search Lena, go_along Lena"),
        (
            "Tell Lena the day of the week you will find her in the yard.",
            "drive_to yard, inform the day of the week",
        ),
    ],
)
def test_somebody_is_found_where_and_when_it_is_said(said: str, deeds: str) -> None:
    assert done(said) == deeds


def test_a_name_in_small_letters_gets_no_article() -> None:
    made = ENGINE.decide(situation("meet robin at the desk and lead them to the yard", catalogue=ABLE))
    assert isinstance(made, Do)
    assert "the robin" not in " ".join(text for deed in made.deeds for text in deed.said.values())
