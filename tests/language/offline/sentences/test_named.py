"""Stops with what is to be looked for there, in few words."""

from __future__ import annotations

import pytest

from parley.language.offline.sentences.named import verb_first
from parley.language.offline.words.nouns import bare
from parley.language.offline.words.text import Phrase, keys, plain, tokens


def is_stop(words: Phrase) -> bool:
    return keys(bare(words)) in {("hall",), ("gate", "2")}


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        ("the hall: inspect", "inspect the hall"),
        ("just gate 2, for the bag", "inspect gate 2 for the bag"),
        ("inspect gate 2: lights, hinges", "inspect gate 2 for lights, hinges"),
        ("go to the hall, for spills", "inspect the hall for spills"),
        ("gate 2, for five minutes", "gate 2, for five minutes"),
        ("inspect the hall: it is wet", "inspect the hall: it is wet"),
        ("gate 2: in use", "gate 2: in use"),
    ],
)
def test_what_is_looked_for_stands_behind_the_place(text: str, meant: str) -> None:
    assert plain(verb_first(tokens(text), is_stop)) == meant
