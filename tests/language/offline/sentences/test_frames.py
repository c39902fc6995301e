"""What people feel about something, read as the order that it is."""

from __future__ import annotations

import pytest

from parley.language.offline.sentences.frames import unframed
from parley.language.offline.words.text import Phrase, keys, plain, tokens

NAMES = {("gate",), ("yard",)}


def is_stop(words: Phrase) -> bool:
    flat = keys(words)
    return (flat[1:] if flat[:1] == ("the",) else flat) in NAMES


@pytest.mark.parametrize(
    ("said", "meant"),
    [
        ("I would feel a lot better if someone had a look at the gate", "inspect the gate"),
        ("it would put my mind at rest if you checked the gate", "check the gate"),
        ("there is no harm in taking a look at the gate", "inspect the gate"),
        ("is there any way you could get to the gate", "get to the gate"),
        ("would you be up for a trip to the yard", "go to the yard"),
        ("I can not tell from here whether the gate is open", "check whether the gate is open"),
        ("any chance of you being at the gate soon", "go to the gate"),
        ("would you say the gate is open?", "is the gate open?"),
    ],
)
def test_an_attitude_to_an_order_is_that_order(said: str, meant: str) -> None:
    assert plain(unframed(tokens(said), is_stop)) == plain(tokens(meant))


@pytest.mark.parametrize(
    "said",
    [
        "it would be a disaster if you went to the gate",
        "there is no point in going to the gate",
        "why are you not at the gate",
        "the boss wants to look at the gate",
        "I heard somebody had a look at the gate",
        "I would rather you did not go to the gate",
    ],
)
def test_what_is_not_wanted_of_the_robot_stays_as_it_is(said: str) -> None:
    assert plain(unframed(tokens(said), is_stop)) == plain(tokens(said))


def test_a_remark_behind_a_report_is_dropped() -> None:
    said = "there is a bag at the gate. that makes me nervous"
    assert plain(unframed(tokens(said), is_stop)) == "there is a bag at the gate."
