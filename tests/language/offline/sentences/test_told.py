"""What is told behind an order stands in a sentence of its own."""

from __future__ import annotations

import pytest

from parley.language.offline.sentences.clauses import opens_command
from parley.language.offline.sentences.told import told_apart, when_done
from parley.language.offline.sentences.units import units
from parley.language.offline.words.text import Phrase, keys, tokens


def _is_stop(words: Phrase) -> bool:
    return keys(words) in {("shed",), ("barn",)}


@pytest.mark.parametrize(
    ("said", "read"),
    [
        (
            "Check whether the shed is shut, I can not see it from here.",
            "Check whether the shed is shut. I can not see it from here.",
        ),
        (
            "See whether the door is open, since they can not get in, and then go to the barn.",
            "See whether the door is open, and then go to the barn.",
        ),
        ("Check the shed, if it is open go to the barn", "Check the shed, if it is open go to the barn"),
        ("I am late, check the shed", "I am late, check the shed"),
        ("Where is the saw, and can you check the shed?", "Where is the saw? can you check the shed?"),
    ],
)
def test_telling_behind_an_order_is_set_apart(said: str, read: str) -> None:
    words = tokens(said)
    assert keys(told_apart(words, units(words, _is_stop, opens_command))) == keys(tokens(read))


@pytest.mark.parametrize(
    ("said", "read"),
    [
        ("check the shed when you are through with the rest", "check the shed then"),
        ("when you are done with the shed go home", "when you are done with the shed go home"),
    ],
)
def test_being_done_with_the_rest_is_then(said: str, read: str) -> None:
    assert keys(when_done(tokens(said))) == keys(tokens(read))
