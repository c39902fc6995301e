"""Orders that are not given as such: each shape means its order, and what else looks like one means none."""

from __future__ import annotations

import pytest

from parley.language.builtin.decision import Ask, Do
from parley.language.builtin.engine import BuiltinLanguage
from parley.language.builtin.lexicon import lexicon
from parley.language.builtin.tokens import tokenize
from parley.language.dialogue.indirect import meant_order
from parley.language.dialogue.questions import plain
from parley.language.lexicon import load_data
from tests.language.builtin.worlds import situation, thing

ENGINE = BuiltinLanguage()


@pytest.mark.parametrize(("said", "order"), load_data("indirect")["tests"].items())
def test_each_shape_means_its_order(said: str, order: str) -> None:
    assert meant_order(plain(tokenize(f"So {said} please"))) == (order, False)
    direct, indirect = ENGINE.decide(situation(order)), ENGINE.decide(situation(said))
    assert isinstance(direct, Do) and direct == indirect


@pytest.mark.parametrize(
    ("said", "asked"),
    [
        ("how about going to the desk?", "Shall I go to the desk?"),
        ("why don't you drive to the desk", "Shall I drive to the desk?"),
    ],
)
def test_what_may_be_a_question_is_offered(said: str, asked: str) -> None:
    made = ENGINE.decide(situation(said))
    assert isinstance(made, Ask) and made.question == asked
    assert [deed.arguments for deed in made.offer] == [{"place": "desk"}]


@pytest.mark.parametrize(
    "said",
    ["we need you in one piece", "somebody should call an ambulance", "what about you?", "why not?",
     "I'd be glad if you would not go to the desk", "somebody fell, somebody should help"],
)  # fmt: skip
def test_what_only_looks_like_one_is_not_done(said: str) -> None:
    assert not isinstance(ENGINE.decide(situation(said)), Do)


def test_what_an_order_said_round_about_leaves_open_is_asked() -> None:
    racks = (thing("tall rack", 1), thing("low rack", 2))
    made = ENGINE.decide(situation("I think you should go to the rack", objects=racks))
    assert isinstance(made, Ask) and made.choices and made.about == "go to the rack"


@pytest.mark.parametrize(
    ("typed", "frame"), [("moev", "GO"), ("tunr", "TURN"), ("stnad", "WAIT"), ("lamp", ""), ("form", "")]
)
def test_two_letters_the_wrong_way_round_are_one_verb(typed: str, frame: str) -> None:
    assert (frame in lexicon().exactly([typed])) if frame else not lexicon().exactly([typed])
