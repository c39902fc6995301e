"""Things that are called by numbers, in all the ways in which people say a number."""

from __future__ import annotations

import pytest

from parley.language.builtin.numbering import with_numbers
from parley.world.object_map import MapObject

GATES = tuple(MapObject(f"g{n}", f"gate {n}", float(n), 1.0) for n in (1, 2, 3, 4))
BAYS = tuple(MapObject(f"b{n}", f"loading bay {n}", float(n), 2.0) for n in (7, 9))


@pytest.mark.parametrize(
    ("said", "meant"),
    [
        ("go to gate two", "go to gate 2"),
        ("go to the 2nd gate", "go to gate 2"),
        ("the third gate, then the first gate", "gate 3, then gate 1"),
        ("gate no. 4 and gate #1", "gate 4 and gate 1"),
        ("check gates one, two and number three", "check gates 1, 2 and 3"),
        ("gates one to four", "gates 1 to 4"),
        ("loading bay seven", "loading bay 7"),
        ("the second bay", "the second bay"),  # they are not numbered from 1 on
        ("gate nine", "gate nine"),
        ("check gate one more time", "check gate one more time"),
        ("wait at the gate two minutes", "wait at the gate two minutes"),
        ("first gate 3", "first gate 3"),
        ("the first crate", "the first crate"),
    ],
)
def test_a_number_is_said_as_the_map_has_it(said: str, meant: str) -> None:
    assert with_numbers(said, (*GATES, *BAYS)) == meant
