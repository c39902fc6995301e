"""What is said around orders: who is speaking, moods, and the same thing at another place."""

from __future__ import annotations

import pytest

from parley.language.offline.sentences.briefly import briefly
from parley.language.offline.sentences.clauses import opens_command
from parley.language.offline.sentences.distilling import with_the_same
from parley.language.offline.sentences.talk import introduces, is_talk, without_talk
from parley.language.offline.sentences.units import Unit, units
from parley.language.offline.words.text import Phrase, keys, plain, tokens

NAMES = {"desk", "the desk", "the hall", "hall", "box 1", "box 2", "the lift"}


def is_stop(words: Phrase) -> bool:
    return " ".join(keys(words)) in NAMES


def cut(words: Phrase) -> list[Unit]:
    return units(words, is_stop, opens_command)


@pytest.mark.parametrize(
    "text",
    [
        "it is Ines on the front desk",
        "Sister Agnes here",
        "night watch speaking",
        "dock office here",
        "my name is Ute",
    ],
)
def test_who_is_calling_is_recognised(text: str) -> None:
    assert introduces(tokens(text))


@pytest.mark.parametrize(
    "text", ["stop here", "wait over here", "it is broken", "put the box here", "look here"]
)
def test_orders_and_reports_name_no_caller(text: str) -> None:
    assert not introduces(tokens(text))


def test_what_is_only_said_to_the_listener_is_a_mood() -> None:
    assert is_talk(tokens("bear with me"))
    assert not is_talk(tokens("go to the desk"))


def test_every_part_says_why_it_is_what_it_is() -> None:
    parts = cut(tokens("Sister Agnes here. Please go to the desk because it is late"))
    assert [(part.kind, part.why) for part in parts] == [
        ("who", "says who is speaking"),
        ("order", "“go” asks for something"),
        ("reason", "begins as a reason"),
    ]


def test_a_message_is_left_with_its_orders_and_what_else_may_matter() -> None:
    words = tokens(
        "Sister Agnes here. The lift is broken, bear with me, please go to the desk and wait there"
    )
    assert plain(without_talk(words, cut(words))) == (
        "The lift is broken. please go to the desk and wait there"
    )


def test_a_message_of_nothing_but_talk_is_left_alone() -> None:
    words = tokens("Hello there, bear with me, Sister Agnes here, well done for yesterday")
    assert without_talk(words, cut(words)) == words


@pytest.mark.parametrize(
    "text",
    [
        "Go to box 1 and look for oil, then box 2, same thing",
        "Go to box 1 and look for oil, then do the same at box 2",
    ],
)
def test_the_same_at_another_place_is_written_out(text: str) -> None:
    words = tokens(text)
    assert plain(with_the_same(words, cut(words))) == (
        "Go to box 1 and look for oil. go to box 2. look for oil."
    )


@pytest.mark.parametrize(
    ("text", "shorter"),
    [
        ("inspect the desk very well, then stop", "inspect the desk, then stop"),
        ("come to me at the desk", "come to the desk"),
        ("report back to me at the desk", "come to the desk"),
        (
            "Mr Ode, he is over by the lift, has left his hat on the desk",
            "Mr Ode is over by the lift. Mr Ode's hat is on the desk",
        ),
        (
            "I lost my hat near the desk. Look for it there",
            "I lost my hat near the desk. Look for the hat there",
        ),
        (
            "check if it is dry if it is go to the desk",
            "check if it is dry. if it is, go to the desk",
        ),
    ],
)
def test_what_is_meant_is_put_briefly(text: str, shorter: str) -> None:
    assert plain(briefly(tokens(text))) == shorter
