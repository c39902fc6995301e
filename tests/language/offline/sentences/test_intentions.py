"""What the speaker is going to do is no order."""

from __future__ import annotations

import pytest

from parley.language.offline.sentences.intentions import without_own_plans
from parley.language.offline.words.text import plain, tokens


@pytest.mark.parametrize(
    ("said", "left"),
    [
        ("I'll go to the hall later and see whether it is clean", "I will go to the hall later"),
        ("I will check the hall and you go to the desk", "I will check the hall and you go to the desk"),
        ("I'll be in the hall and need a lamp", "I will be in the hall and need a lamp"),
        ("Who told you to go to the hall?", "Who told you that ?"),
        ("Go to the hall and look around", "Go to the hall and look around"),
    ],
)
def test_own_plans_are_left_out(said: str, left: str) -> None:
    assert plain(without_own_plans(tokens(said))) == plain(tokens(left))
