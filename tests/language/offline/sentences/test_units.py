"""How a message falls into orders, names, what is told, asked and only explained."""

from __future__ import annotations

import pytest

from parley.language.offline.sentences.clauses import opens_command
from parley.language.offline.sentences.distilling import context, distilled
from parley.language.offline.sentences.units import Unit, units
from parley.language.offline.words.text import Phrase, keys, plain, tokens

NAMES = {"desk", "the desk", "the blue door", "blue door", "box 1", "box 2", "the hall", "hall", "the lift"}


def is_stop(words: Phrase) -> bool:
    return " ".join(keys(words)) in NAMES


def cut(text: str) -> list[Unit]:
    return units(tokens(text), is_stop, opens_command)


@pytest.mark.parametrize(
    ("text", "kinds"),
    [
        ("My back hurts, so please go to the desk", ["told", "order"]),
        ("go to the desk check the blue door", ["order", "order"]),
        ("Go to the desk because the guests are waiting", ["order", "reason"]),
        ("The hall first, then the desk", ["name"]),
        ("if the hall is empty go to the desk", ["order"]),
        ("Is the hall empty?", ["asked"]),
        ("The desk has to be checked.", ["wish"]),
        ("You will find the keys in the hall", ["told"]),
        ("I have been running between the desk and the hall", ["told"]),
        ("go to the desk the guests are waiting", ["order", "told"]),
        ("The guests arrive at noon, check the desk and the hall for leaks", ["told", "order"]),
        ("The desk and the hall were open, close them", ["told", "order"]),
        ("Your first stop is the desk", ["name"]),
    ],
)
def test_every_part_has_the_kind_that_its_beginning_shows(text: str, kinds: list[str]) -> None:
    assert [unit.kind for unit in cut(text)] == kinds


@pytest.mark.parametrize(
    ("text", "order"),
    [
        ("Would you mind going to the desk", "go to the desk"),
        ("I'd like you to look at the blue door", "look at the blue door"),
        ("so you'll have to check the hall", "check the hall"),
        ("I need you at the desk", "go to the desk"),
        ("I want the blue door checked", "check the blue door"),
        ("I don't want you to go to the hall", "do not go to the hall"),
        ("If the hall is empty look at the lift", "If the hall is empty, look at the lift"),
    ],
)
def test_an_order_comes_out_of_its_frame(text: str, order: str) -> None:
    assert [plain(unit.words) for unit in cut(text) if unit.kind == "order"] == [order]


def test_what_is_left_of_a_story_are_its_orders() -> None:
    found = distilled(
        cut("The lift was stuck again, two people called. Anyway, go to the desk and check the hall.")
    )
    assert found is not None
    assert plain(found) == "go to the desk. and check the hall"


def test_a_story_without_orders_leaves_nothing() -> None:
    assert distilled(cut("The lift was stuck again and the hall was full of people.")) is None


def test_what_a_story_names_may_be_meant_by_there() -> None:
    parts = cut("The guest in the hall says there was water, could you go there")
    assert [plain(phrase) for phrase in context(parts)] == ["the hall"]


def test_looking_in_there_is_going_there_first() -> None:
    found = distilled(cut("It was hot in the hall, look at the fan in there would you"))
    assert found is not None
    assert plain(found) == "go there. look at the fan"
