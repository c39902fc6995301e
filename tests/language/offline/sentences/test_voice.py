"""What is wanted in the passive."""

from __future__ import annotations

import pytest

from parley.language.offline.sentences.voice import in_active
from parley.language.offline.words.text import Phrase, keys, plain, tokens


def is_stop(words: Phrase) -> bool:
    return keys(words) in {("the", "gate"), ("gate",), ("room", "4")}


@pytest.mark.parametrize(
    ("said", "order"),
    [
        ("the gate could be checked", "check the gate"),
        ("a kettle were brought to room 4", "bring a kettle to room 4"),
        ("the bin in room 4 was emptied by somebody", "empty the bin in room 4"),
        ("room 4 could be aired", "air room 4"),
        ("the gate be seen to", "see to the gate"),
    ],
)
def test_what_is_wished_in_the_passive_is_an_order(said: str, order: str) -> None:
    found = in_active(tokens(said), is_stop, wished=True)
    assert found is not None and plain(found) == order


def test_behind_a_word_for_having_no_form_of_be_is_needed() -> None:
    found = in_active(tokens("towels delivered to room 4"), is_stop, getting=True)
    assert found is not None and plain(found) == "deliver towels to room 4"


@pytest.mark.parametrize("said", ["you were a bit quicker", "the gate could not be checked", "it was open"])
def test_what_names_no_deed_is_left_as_it_is(said: str) -> None:
    assert in_active(tokens(said), is_stop, wished=True) is None
