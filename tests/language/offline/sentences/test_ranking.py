"""Stops whose order is said behind each of them."""

from __future__ import annotations

import pytest

from parley.language.offline.sentences.ranking import ranked_stops
from parley.language.offline.words.text import keys, tokens


@pytest.mark.parametrize(
    ("said", "read"),
    [
        (
            "The shed comes last, the gate first, the barn in the middle. Go to all three.",
            "go to the gate, then go to the barn, then go to the shed",
        ),
        ("The shed goes last and the gate first", "go to the gate, then go to the shed"),
        ("The gate first and the shed last.", "The gate first and the shed last."),
        ("The shed last, the gate first. Then wash both.", "The shed last, the gate first. Then wash both."),
    ],
)
def test_stops_are_put_in_the_order_that_is_said(said: str, read: str) -> None:
    assert keys(ranked_stops(tokens(said))) == keys(tokens(read))
