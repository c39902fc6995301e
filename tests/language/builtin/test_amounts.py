"""Numbers, units and directions in words."""

from __future__ import annotations

import pytest

from parley.language.builtin.amounts import amount_of, direction_of
from parley.language.builtin.lexicon import lexicon
from parley.language.builtin.tokens import spoken, tokenize

AMOUNTS = {
    "one hundred and fifty degrees": "150 degrees",
    "one eighty degrees": "180 degrees",
    "forty five degrees": "45 degrees",
    "at least two feet": "2 feet",
    "half a metre": "0.5 m",
    "a quarter turn": "90 degrees",
    "2.5m": "2.5 m",
    "one and a half metres": "1.5 m",
    "ninety": "90",
    "a couple of feet": "2 feet",
    "one two": "None",
    "the box": "None",
    "two feet three metres": "None",
}


@pytest.mark.parametrize(("words", "amount"), AMOUNTS.items())
def test_an_amount_is_read_or_not_at_all(words: str, amount: str) -> None:
    assert str(amount_of(words.split())) == amount


DIRECTIONS = {
    "to your left": "left",
    "straight ahead": "forward",
    "due north west": "northwest",
    "straight back": "back",
    "left or right": None,
    "the box": None,
}


@pytest.mark.parametrize(("words", "direction"), DIRECTIONS.items())
def test_a_direction_is_read_or_not_at_all(words: str, direction: str | None) -> None:
    assert direction_of(words.split(), lexicon()) == direction


def test_hums_and_false_starts_are_passed_over_and_words_keep_their_places() -> None:
    text = "uhh move move for forward t two feet"
    kept = spoken(tokenize(text))
    assert [token.text for token in kept] == ["move", "for", "forward", "two", "feet"]
    assert [text[token.start : token.end] for token in kept] == [token.text for token in kept]


def test_a_letter_that_names_a_place_is_no_false_start() -> None:
    kept = spoken(tokenize("is bay b by box B broken"))
    assert [token.text for token in kept] == ["is", "bay", "b", "by", "box", "B", "broken"]
