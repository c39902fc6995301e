"""Conditions put plainly: what is found or not found, and who is there."""

from __future__ import annotations

import pytest

from parley.language.offline.sentences.branching import branched
from parley.language.offline.sentences.clauses import clauses, opens_command
from parley.language.offline.words.nouns import bare
from parley.language.offline.words.text import Phrase, keys, plain, tokens

STOPS = {("gate",), ("hall",), ("press", "2")}


def is_stop(words: Phrase) -> bool:
    return keys(bare(words)) in STOPS and all(word.is_word for word in words)


@pytest.mark.parametrize("said", ["if nobody is there", "if there is no one there", "if not"])
def test_who_is_there_answers_a_question_before(said: str) -> None:
    words = tokens(f"is anyone in the hall? {said}, go to the gate")
    read = branched(words, is_stop, lambda asked: tokens("anyone is in the hall"))
    assert plain(read) == "check whether anyone is in the hall. if not, go to the gate."


@pytest.mark.parametrize(
    ("text", "condition"),
    [
        ("if there is milk in the fridge, go to the hall", "there is milk in the fridge"),
        ("if there is oil under press 2, go to the hall", "there is oil under press 2"),
        ("if somebody is in go away", "somebody is in"),
    ],
)
def test_a_noun_that_could_be_a_verb_does_not_end_a_condition(text: str, condition: str) -> None:
    assert plain(clauses(tokens(text), opens_command)[0].condition) == condition


@pytest.mark.parametrize(
    ("said", "meant"),
    [
        ("go to the hall, only if the door there is open",
         "go to the hall, only if the door at the hall is open"),
        ("if not, try the hall", "if not, go to the hall"),
        ("check the gate and, when its chain is off, go to the hall",
         "check the gate and, if its chain is off, go to the hall"),
        ("when the lamp in the hall is off, go to the gate",
         "if the lamp in the hall is off, go to the gate"),
        ("check the gate if it is open go to the hall", "check the gate. if it is open go to the hall"),
        ("check the gate if it is open", "check the gate if it is open"),
        ("when the guard leaves, go to the gate", "when the guard leaves, go to the gate"),
        ("look for the mop at the gate, if not, try the hall",
         "look for the mop at the gate, if not, check the hall"),
    ],
)  # fmt: skip
def test_what_is_pointed_at_in_a_condition_is_named(said: str, meant: str) -> None:
    assert plain(branched(tokens(said), is_stop)) == meant


def test_a_question_said_again_as_a_condition_is_not_asked_twice() -> None:
    words = tokens("is the gate shut? if it is open, go to the hall")
    read = branched(words, is_stop, lambda asked: tokens("the gate is shut"))
    assert plain(read) == "check whether the gate is shut. if not, go to the hall."
