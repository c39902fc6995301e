"""Stops whose order is said behind each of them."""

from __future__ import annotations

import pytest

from parley.language.offline.sentences.ranking import all_of_those, named_first, ranked_stops
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


@pytest.mark.parametrize(
    ("said", "read"),
    [
        (
            "Look at the shed and the fuel pump, the pump first because of the risk, and then go home",
            "look at the fuel pump, then look at the shed because of the risk, and then go home",
        ),
        (
            "Check the shed and the old barn, the shed last please.",
            "check the old barn, then check the shed.",
        ),
        ("Check the shed and the barn. The barn first.", "check the barn, then check the shed."),
        ("Check the shed and the barn, the pond first.", "Check the shed and the barn, the pond first."),
        (
            "If the shed and the barn are shut, the gate first.",
            "If the shed and the barn are shut, the gate first.",
        ),
    ],
)
def test_one_of_a_list_that_is_to_come_first_or_last_is_moved(said: str, read: str) -> None:
    assert keys(named_first(tokens(said))) == tuple(key.lower() for key in keys(tokens(read)))


@pytest.mark.parametrize(
    ("said", "read"),
    [
        ("All pumps but the red one, please oil them", "please oil all pumps but the red one"),
        (
            "Every pump except pump 2, could you oil those? Thanks.",
            "could you oil every pump except pump 2? Thanks.",
        ),
        ("All pumps are old, oil them", "All pumps are old, oil them"),
        ("All pumps but one, I oiled them", "All pumps but one, I oiled them"),
    ],
)
def test_what_is_named_first_is_what_the_order_is_for(said: str, read: str) -> None:
    assert keys(all_of_those(tokens(said))) == keys(tokens(read))
