"""Conditions that are told."""

from __future__ import annotations

import pytest

from parley.language.offline.sentences.expecting import with_looks
from parley.language.offline.words.nouns import bare
from parley.language.offline.words.text import Phrase, keys, plain, tokens

STOPS = {("gate",), ("hall",), ("yard",)}


def is_stop(words: Phrase) -> bool:
    return keys(bare(words)) in STOPS and all(word.is_word for word in words)


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        (
            "the gate ought to be shut; if it isn't, go to the hall",
            "check whether the gate is shut. if not, go to the hall",
        ),
        (
            "I think the gate is locked, but if not, go to the hall",
            "check whether the gate is locked. if not, go to the hall",
        ),
        (
            "the gate should be shut. if it is still open, go to the hall",
            "if the gate is open, go to the hall",
        ),
        (
            "depending on whether the gate is shut, go to the hall if so and to the yard if not",
            "check whether the gate is shut. if so, go to the hall. if not, go to the yard",
        ),
        (
            "go to the hall and unless you find anybody there go to the yard",
            "go to the hall and unless somebody is there, go to the yard",
        ),
        (
            "see that the gate is shut. is it not, then come back",
            "see that the gate is shut. if not, come back",
        ),
        (
            "if you see oil on the floor in the hall, go to the yard",
            "if there is oil on the floor in the hall, go to the yard",
        ),
        ("if you find the gate open, go to the yard", "if the gate is open, go to the yard"),
        ("if you see that the gate is open, go to the yard", "if the gate is open, go to the yard"),
        (
            "check if the gate is shut, otherwise go to the yard",
            "check if the gate is shut. if not, go to the yard",
        ),
        (
            "from now on, if you see oil in the hall, come back",
            "from now on, if you see oil in the hall, come back",
        ),
        ("the gate should be shut", "the gate should be shut"),
        ("if you see a leak, stop", "if you see a leak, stop"),
    ],
)
def test_what_orders_hang_on_is_said_as_a_look(text: str, meant: str) -> None:
    assert plain(with_looks(tokens(text), is_stop)).lower() == meant.lower()


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        ("look for the mug in the hall and take it if you find it",
         "look for the mug in the hall. if so, take it"),
        ("check the hall for bags and come back if there are none",
         "check the hall for bags. if not, come back"),
        ("look for a mop in the hall. if you can't find one, go to the yard",
         "look for a mop in the hall. if not, go to the yard"),
        ("see whether the van is in the yard. if it is gone, go to the gate",
         "see whether the van is in the yard. if not, go to the gate"),
        ("check whether the gate is shut. if so, go to the hall, otherwise leave it",
         "check whether the gate is shut. if so, go to the hall"),
    ],
)  # fmt: skip
def test_what_hangs_on_finding_something_hangs_on_the_look_for_it(text: str, meant: str) -> None:
    assert plain(with_looks(tokens(text), is_stop)) == meant


@pytest.mark.parametrize(
    "text", ["go to the hall if there is one", "tell me if you see it", "go to the gate if it is open"]
)
def test_a_condition_without_a_search_before_it_stays(text: str) -> None:
    assert plain(with_looks(tokens(text), is_stop)) == text


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        (
            "if you find oil at the gate, go to the hall. if there is none, go to the yard",
            "if there is oil at the gate, go to the hall. if not, go to the yard",
        ),
        (
            "if you see keys in the hall, come back, otherwise go to the gate",
            "if there are keys in the hall, come back. if not, go to the gate",
        ),
        ("if you see smoke, go to the gate", "if you see smoke, go to the gate"),
        ("if you see smoke at the gate, stop", "if you see smoke at the gate, stop"),
    ],
)
def test_what_is_done_otherwise_makes_a_rule_something_to_look_at(text: str, meant: str) -> None:
    assert plain(with_looks(tokens(text), is_stop)) == meant
