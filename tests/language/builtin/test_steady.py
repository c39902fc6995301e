"""Words that would be something else behind a "please" are asked about."""

from __future__ import annotations

from dataclasses import replace

from parley.language.builtin.decision import Ask
from parley.language.builtin.engine import BuiltinLanguage
from parley.language.builtin.lexicon import lexicon
from parley.language.builtin.planner import doubt, orders_of
from parley.language.builtin.reading import Reading
from parley.language.builtin.steady import steadily
from parley.language.builtin.tagger import shipped_tagger
from parley.language.builtin.tokens import tokenize
from tests.language.builtin.worlds import situation


def reading(text: str) -> Reading:
    return steadily(shipped_tagger(), tokenize(text), lexicon())[1]


def test_a_steady_order_is_not_doubted_and_an_unsteady_one_is_asked_about_by_its_words() -> None:
    steady = reading("please take the red box")
    assert steady.unsteady == ()
    assert doubt(steady, orders_of(steady), lambda filler: True) is None
    asked = doubt(replace(steady, unsteady=("box",)), orders_of(steady), lambda filler: True)
    assert asked is not None and "box" in asked.question


def test_what_one_opener_alone_reads_otherwise_is_settled_by_most_of_them() -> None:
    lists = ["check Area A, Area B and Area C"]
    for text in [*lists, "peek into the cellar and report", "take the letter on the table down to Lena"]:
        assert reading(text).unsteady == (), text


def test_nonsense_is_not_steady() -> None:
    said = [
        "box the if turn",
        "up gate bring slowly of",
        "light dark open near run",
        "to to from please it on",
    ]
    assert any(reading(text).unsteady for text in said)


def test_words_behind_the_longest_that_is_read_break_nothing() -> None:
    assert all(reading("box the if turn up gate bring slowly of " * times).unsteady for times in (29, 30))


def test_to_wait_until_after_something_is_asked_about() -> None:
    assert isinstance(BuiltinLanguage().decide(situation("The office can wait until after the desk.")), Ask)
