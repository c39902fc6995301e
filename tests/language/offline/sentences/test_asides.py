"""What only surrounds an order is left out before it is read."""

from __future__ import annotations

import pytest

from parley.language.offline.sentences.asides import without_asides
from parley.language.offline.words.text import keys, tokens


@pytest.mark.parametrize(
    ("said", "left"),
    [
        ("check the shed for me, would you, and then go home", "check the shed, and then go home"),
        ("look for the cat if you can, and go home", "look for the cat, and go home"),
        ("but do check the shed", "but check the shed"),
        ("go to the shed, where she had lunch.", "go to the shed."),
        ("my brother, who never listens, has gone home", "my brother has gone home"),
        ("so before it gets dark check the shed and the barn", "so check the shed and the barn"),
        ("before the guests arrive, check the shed", "check the shed"),
        ("check the shed for him.", "check the shed."),
    ],
)
def test_what_says_nothing_of_its_own_is_left_out(said: str, left: str) -> None:
    assert keys(without_asides(tokens(said))) == keys(tokens(left))


@pytest.mark.parametrize(
    "said",
    [
        "open the shed if you can, otherwise go home",
        "do you check the shed?",
        "look for him",
        "go to the man, who is in the shed",
        "before it closes the shed, the barn",
        "where would you go, if you can say?",
        "do the same at the shed",
    ],
)
def test_what_hangs_together_is_left(said: str) -> None:
    assert keys(without_asides(tokens(said))) == keys(tokens(said))
