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


@pytest.mark.parametrize(
    ("said", "read"),
    [
        (
            "Ann needs her nails. Fetch them and bring them to the barn.",
            "Fetch the nails and bring them to the barn.",
        ),
        ("Bring the saw to Ann, she asked for it this morning.", "Bring the saw to Ann."),
        ("Sweep the barn. Ann ordered it.", "Sweep the barn."),
        (
            "The roofers left the saw in the barn. Take it to the shed.",
            "The roofers left the saw in the barn. Take the saw from the barn to the shed.",
        ),
        ("The roofers left bay 2 dirty. Sweep it.", "The roofers left bay 2 dirty. Sweep bay 2."),
        (
            "Somebody forgot a hat in the barn. Look for it.",
            "Somebody forgot a hat in the barn. Look for the hat in the barn.",
        ),
        ("Look for the saw. Ann wants it.", "Look for the saw. Ann wants it."),
        ("The nails are in the shed. Ann ordered them.", "The nails are in the shed. Ann ordered them."),
        ("Ann left the barn. Say that it is locked.", "Ann left the barn. Say that it is locked."),
        ("Ann left for the barn. Follow her.", "Ann left for the barn. Follow her."),
    ],
)
def test_it_is_what_others_left_and_who_wanted_it_asks_for_nothing(said: str, read: str) -> None:
    assert keys(with_what_was_lost(tokens(said))) == keys(tokens(read))
