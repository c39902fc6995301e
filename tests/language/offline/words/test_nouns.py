"""Noun phrases: what is named, and where that is."""

from __future__ import annotations

import pytest

from parley.language.offline.words.nouns import beside_at, noun_phrase
from parley.language.offline.words.text import keys, plain, tokens


@pytest.mark.parametrize(
    ("text", "core", "relation", "anchor"),
    [
        ("the window furthest to the east", ("window",), "on", "east"),
        ("the window that is farthest east", ("window",), "on", "east"),
        ("the desk closest to the west side", ("desk",), "on", "west side"),
        ("the tank furthest to the left", ("tank",), "on", "far left"),
        ("the desk to your right", ("desk",), "on", "right"),
        ("the bin just behind the kiosk", ("bin",), "behind", "kiosk"),
        ("the tank that is right next to the pump", ("tank",), "next to", "pump"),
        ("the window furthest from the door", ("window",), "furthest from", "door"),
        ("the door to the left of the lift", ("door",), "to the left of", "lift"),
    ],
)
def test_where_something_is_is_told_apart_from_what_it_is(
    text: str, core: tuple[str, ...], relation: str, anchor: str
) -> None:
    noun = noun_phrase(tokens(text))
    assert (noun.core, noun.relation, [plain(one) for one in noun.anchors]) == (core, relation, [anchor])


def test_the_most_northern_is_the_northernmost() -> None:
    assert noun_phrase(tokens("the most northern gate")).core == ("northernmost", "gate")


@pytest.mark.parametrize(
    ("text", "end"), [("next to the door", 2), ("lying in the hall", 2), ("in the hall", 0)]
)
def test_what_only_tells_where_a_thing_is_is_found(text: str, end: int) -> None:
    assert beside_at(keys(tokens(text)), 0) == end
