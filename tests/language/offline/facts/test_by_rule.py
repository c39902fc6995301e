"""Where people are by rules, and facts with the time at which they hold."""

from __future__ import annotations

import pytest

from parley.language.offline.facts.by_rule import without_time
from parley.language.offline.facts.remembering import find_fact, remembered
from parley.language.offline.words.text import plain, tokens
from parley.messages.memory import MemoryEntry

RULE = "Whoever has the early shift sits in the gate house"


def place(*told: str) -> str:
    memory = tuple(MemoryEntry(name=f"m{i}", data=text) for i, text in enumerate(told))
    found, _ = find_fact(tokens("Ada"), remembered(memory))
    return "" if found is None else plain(found.fact.place)


def test_somebody_is_where_the_rule_for_their_work_says() -> None:
    assert place(RULE, "Ada has the early shift") == "gate house"


def test_a_rule_for_others_says_nothing() -> None:
    assert place(RULE, "Ada has the late shift") == ""


def test_what_was_told_of_them_counts_more_than_a_rule() -> None:
    assert place(RULE, "Ada has the early shift", "Ada is in the yard") == "yard"


@pytest.mark.parametrize(
    ("told", "kept"),
    [
        ("From today on, the keys are in the attic", "the keys are in the attic"),
        ("As of Monday the keys are in the attic", "the keys are in the attic"),
        ("Since yesterday Ada has been in the attic", "Ada has been in the attic"),
        ("Today is a holiday", "Today is a holiday"),
        ("In the hall there is a box", "In the hall there is a box"),
    ],
)
def test_when_something_holds_is_not_what_it_is_about(told: str, kept: str) -> None:
    assert plain(without_time(tokens(told))) == kept
