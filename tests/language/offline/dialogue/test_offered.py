"""Answers to what the robot offered."""

from __future__ import annotations

import pytest

from parley.language.base import Situation, Turn
from parley.language.offline.dialogue.offered import accepted_offer, plain_answer
from parley.language.offline.words.text import plain, tokens
from parley.world.object_map import MapObject

ROOMS = tuple(MapObject(f"r{i}", f"room {i}", float(i), 0.0, "room") for i in (1, 2, 3))
WHICH = Turn("assistant", "Which room do you mean: room 1, room 2 or room 3?")


@pytest.mark.parametrize(
    ("answer", "meant"),
    [
        ("the last one", "room 3"),
        ("the second", "room 2"),
        ("all three please", "room 1, room 2 and room 3"),
        ("not room 2, the other two", "room 1 and room 3"),
        ("maybe in room 2", "in room 2"),
        ("no, the lobby", "the lobby"),
        ("room 1", "room 1"),
        ("all except the first", "room 2 and room 3"),
        ("anything but 1 or 3", "room 2"),
        ("all of them, room 3 first", "room 3, room 1 and room 2"),
        ("it is the cupboard beside room 2", "it is beside room 2"),
    ],
)
def test_an_answer_is_read_against_what_was_named(answer: str, meant: str) -> None:
    assert plain_answer(tokens(answer), WHICH, ROOMS) == meant


def offered(question: str, answer: str) -> str | None:
    situation = Situation(answer, history=(Turn("assistant", question),))
    found = accepted_offer(tokens(answer), situation)
    return None if found is None else plain(found)


def test_what_was_offered_is_done_if_it_is_agreed_to() -> None:
    assert offered("Hello! Would you like me to check the sauna?", "yes please do") == "check the sauna"
    assert offered("Should I go to the hall, or stop?", "yes") is None
    assert offered("Shall I check the sauna?", "no thanks") == ""
    assert offered("Shall I check the sauna?", "go to the hall") is None
