"""What the speaker is going to do is no order."""

from __future__ import annotations

import pytest

from parley.language.offline.sentences.intentions import straight_on, without_own_plans
from parley.language.offline.words.text import plain, tokens


@pytest.mark.parametrize(
    ("said", "left"),
    [
        ("I'll go to the hall later and see whether it is clean", "I will go to the hall later"),
        ("I will check the hall and you go to the desk", "I will check the hall and you go to the desk"),
        ("I'll be in the hall and need a lamp", "I will be in the hall and need a lamp"),
        ("Who told you to go to the hall?", "Who told you that ?"),
        ("Go to the hall and look around", "Go to the hall and look around"),
        ("I was going to ask you to check the hall, but Ann did. Go home", "Ann did. Go home"),
        (
            "We wanted to check the hall but we are late, so please do it",
            "we are late, so please check the hall",
        ),
        (
            "I had planned to go to the hall, but I am late. Could you check it?",
            "I had planned to go to the hall, but I am late. Could you check it?",
        ),
        (
            "I was going to look at the hall myself but I am late. Could you do that?",
            "I was going to look at the hall myself but I am late. Could you look at the hall?",
        ),
    ],
)
def test_own_plans_are_left_out(said: str, left: str) -> None:
    assert plain(without_own_plans(tokens(said))) == plain(tokens(left))


@pytest.mark.parametrize(
    ("said", "meant"),
    [
        ("do not stop until you reach the hall", "go to the hall"),
        ("keep going until you get to the hall, then wait", "go to the hall, then wait"),
        ("if you pass the hall on the way, do not stop there", "do not go to the hall"),
        ("if you pass the hall, look at it", "if you pass the hall, look at it"),
    ],
)
def test_what_is_on_the_way_is_passed(said: str, meant: str) -> None:
    assert plain(straight_on(tokens(said))) == meant
