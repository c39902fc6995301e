"""What "it" is in an order, where the telling before it names the thing."""

from __future__ import annotations

import pytest

from parley.language.offline.sentences.lost import with_what_was_lost
from parley.language.offline.words.text import keys, tokens


@pytest.mark.parametrize(
    ("said", "read"),
    [
        ("I dropped my ring in the hall. Look for it.", "I dropped my ring in the hall. Look for the ring."),
        (
            "Ann needs the saw. Get it from the shed and bring it to her in the barn.",
            "Get the saw from the shed and bring it to Ann in the barn.",
        ),
        ("I need the saw from the shed. Take it to the barn.", "Take the saw from the shed to the barn."),
        (
            "I need the saw. It is in the shed, unless it was lent. Bring it to me.",
            "the saw is in the shed,. Bring the saw to me.",
        ),
        (
            "We are out of nails in the barn. There are some in the shed. Bring some to the barn.",
            "the nails are in the shed. Bring the nails to the barn.",
        ),
        (
            "There is something wrong with the pump, have a look at it.",
            "the pump is not right, have a look at it.",
        ),
        ("Something is wrong with the pump, look at it.", "the pump is not right, look at it."),
        ("I need the saw. Get it from the shed.", "Get the saw from the shed and bring it to me."),
    ],
)
def test_the_thing_that_was_lost_or_needed_takes_the_place_of_it(said: str, read: str) -> None:
    assert keys(with_what_was_lost(tokens(said))) == keys(tokens(read))


@pytest.mark.parametrize(
    "said",
    [
        "I need you in the barn. Take it easy.",
        "Ann needs the saw. Check the shed.",
        "Bring it to Ann.",
        "Is something wrong?",
    ],
)
def test_orders_about_something_else_are_left(said: str) -> None:
    assert keys(with_what_was_lost(tokens(said))) == keys(tokens(said))
