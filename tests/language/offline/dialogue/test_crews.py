"""Orders to robots by name, in other shapes than "A, V"."""

from __future__ import annotations

import pytest

from parley.language.base import Situation, Turn
from parley.language.offline.dialogue.addressing import addressed
from parley.language.offline.dialogue.crew_words import for_another
from parley.language.offline.dialogue.crews import plainly_called
from parley.language.offline.words.text import plain, tokens
from parley.world.object_map import MapObject

OBJECTS = (MapObject("gate", "gate", 1.0, 0.0, "gate"), MapObject("hall", "hall", 5.0, 0.0, "hall"))
CREW = Situation(message="", objects=OBJECTS, robot="Tim", robots=("Tim", "Sue", "Bobby"))


@pytest.mark.parametrize(
    ("message", "robots", "order"),
    [
        ("Sue should go to the gate", ("Sue",), "go to the gate"),
        ("both Tim and Sue to the gate", ("Tim", "Sue"), "go to the gate"),
        ("I want all three of you at the hall", ("Tim", "Sue", "Bobby"), "go to the hall"),
        ("send Bobby to the hall", ("Bobby",), "go to the hall"),
        ("Boby, check the hall", ("Bobby",), "check the hall"),
        ("not you, Tim: Sue takes the gate", ("Sue",), "visit the gate"),
        ("the hall needs a visit, Sue will do it", ("Sue",), "the hall needs a visit"),
        ("it is Sue's turn to check the gate", ("Sue",), "check the gate"),
        ("the others can stay, Sue goes to the gate", ("Sue",), "go to the gate"),
        ("everyone to the gate, except Sue", ("Tim", "Bobby"), "go to the gate"),
        ("Tim, tell Sue to go to the hall", ("Sue",), "go to the hall"),
        ("go to the gate, Sue, and look", ("Sue",), "go to the gate and look"),
        ("Tim you stay out of this one, Sue can go and check the gate", ("Sue",), "go and check the gate"),
        ("Sue, go to the gate. Bobby does not need to come", ("Sue",), "go to the gate"),
        ("nobody but Sue goes to the gate", ("Sue",), "go to the gate"),
        ("tell Sue that she should check the gate", ("Sue",), "check the gate"),
        ("let Sue deal with the gate", ("Sue",), "visit the gate"),
        ("Sue and Bobby both to the gate", ("Sue", "Bobby"), "go to the gate"),
        ("you other two, check the gate", ("Sue", "Bobby"), "check the gate"),
        ("I want all of you at the hall", ("Tim", "Sue", "Bobby"), "go to the hall"),
        ("Not you, Tim. Sue, check the gate", ("Sue",), "check the gate"),
        ("check the gate, all of you", ("Tim", "Sue", "Bobby"), "check the gate"),
        ("everyone who is free go to the gate", ("Tim", "Sue", "Bobby"), "go to the gate"),
        ("Sue, gate on your left", ("Sue",), "gate on your left"),
    ],
)
def test_the_robots_and_their_order_are_found(message: str, robots: tuple[str, ...], order: str) -> None:
    words, targets = addressed(plainly_called(tokens(message), CREW), CREW)
    assert set(targets) == set(robots)
    assert plain(words).strip(" ,.") == order


@pytest.mark.parametrize(
    ("message", "order"),
    [
        ("whoever is nearest, check the gate", "check the gate"),
        ("somebody check the gate", "check the gate"),
        ("could one of you check the gate?", "check the gate."),
    ],
)
def test_whoever_may_do_it_is_left_out(message: str, order: str) -> None:
    assert plain(plainly_called(tokens(message), CREW)) == order


@pytest.mark.parametrize("message", ["go to the gate", "Sue and I are at the gate", "where is Sue?"])
def test_what_calls_nobody_stays_as_it_is(message: str) -> None:
    assert plain(plainly_called(tokens(message), CREW)) == message


@pytest.mark.parametrize("message", ["let Sue do it", "no, I meant Sue", "that was for Sue", "and Sue too"])
def test_the_last_order_is_handed_to_another_robot(message: str) -> None:
    said = Situation(message, history=(Turn("operator", "Tim, go to the hall"),), robots=CREW.robots)
    assert plain(for_another(tokens(message), said)) == "go to the hall"


@pytest.mark.parametrize("message", ["Sue, go to the gate", "is that Sue?", "Sue found it in the hall"])
def test_what_says_more_hands_nothing_over(message: str) -> None:
    said = Situation(message, history=(Turn("operator", "Tim, go to the hall"),), robots=CREW.robots)
    assert for_another(tokens(message), said) == ()


def test_a_pronoun_stands_for_the_robot_that_was_spoken_of() -> None:
    order, robots = addressed(plainly_called(tokens("Sue is free. Send her to the gate"), CREW), CREW)
    assert robots == ("Sue",) and plain(order) == "go to the gate"
