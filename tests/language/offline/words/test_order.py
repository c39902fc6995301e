"""What says when something is due."""

from __future__ import annotations

import pytest

from parley.language.offline.words.order import due, phrases_due


@pytest.mark.parametrize(
    ("kind", "said"),
    [
        ("earlier", "but before you do that"),
        ("following", "when you are done there"),
        ("following", "and as soon as that has been done"),
        ("late", "at the very end"),
        ("early", "before anything else"),
        ("kept", "until last"),
    ],
)
def test_the_one_list_knows_all_ways_to_say_it(kind: str, said: str) -> None:
    assert due(kind).match(tuple(said.split())) == (len(said.split()), said)


def test_no_phrase_says_two_opposite_things() -> None:
    front, back = set(phrases_due("early", "opening", "earlier")), set(phrases_due("late", "closing", "kept"))
    assert not front & back
