"""What a clause tells of a deed: left undone, expected, done, or usual."""

from __future__ import annotations

import pytest

from parley.language.offline.sentences.deeds import Deeds
from parley.language.offline.sentences.telling import is_usual, plainly_so, telling
from parley.language.offline.words.text import keys, plain, tokens

DEEDS = Deeds(frozenset({"mop", "empty", "feed", "close"}))


@pytest.mark.parametrize(
    ("said", "order"),
    [
        ("nobody has mopped the hall since noon", "mop the hall"),
        ("the bin has not been emptied yet", "empty the bin"),
        ("the goats have still not been fed", "feed the goats"),
        ("we forgot to empty the bin", "empty the bin"),
        ("the goats have had no feed today", "feed the goats"),
        ("the hall went unmopped", "mop the hall"),
        ("it is a week since anybody mopped the hall", "mop the hall"),
        ("I can not close the gate", "close the gate"),
    ],
)
def test_what_was_left_undone_is_an_order(said: str, order: str) -> None:
    found = telling(tokens(said), DEEDS)

    assert found is not None
    assert found.kind == "undone"
    assert plain(found.order) == order


@pytest.mark.parametrize(
    "said", ["the bin has been emptied", "the bin was emptied an hour ago", "Tom fed the goats this morning"]
)
def test_what_was_done_is_news(said: str) -> None:
    found = telling(tokens(said), DEEDS)

    assert found is not None
    assert found.kind == "done"


def test_what_should_be_so_by_now_is_looked_at() -> None:
    found = telling(tokens("the gate ought to be closed by now"), DEEDS)

    assert found is not None
    assert (found.kind, plain(found.order)) == ("expected", "check whether the gate is closed")


def test_what_goes_on_again_and_again_is_no_deed_that_is_due() -> None:
    found = telling(tokens("the bin is emptied every morning"), DEEDS)

    assert found is not None
    assert found.kind == "usual"


@pytest.mark.parametrize(
    ("said", "usual"),
    [("the vet comes on fridays", True), ("the gate must stay closed", True), ("the vet comes today", False)],
)
def test_habits_and_rules_are_told_from_what_is_so_today(said: str, *, usual: bool) -> None:
    assert is_usual(keys(tokens(said))) is usual


def test_what_nobody_of_the_robots_does_is_no_deed() -> None:
    assert telling(tokens("nobody has painted the hall yet"), Deeds(frozenset({"mop"}))) is None


def test_what_is_found_to_be_so_is_so() -> None:
    assert plain(plainly_so(tokens("The ladder has been found to be broken."))) == "The ladder is broken."
    assert plain(plainly_so(tokens("if only somebody would come"))) == "i wish somebody would come"
