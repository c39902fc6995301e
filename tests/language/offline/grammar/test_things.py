"""What a message names."""

from __future__ import annotations

import pytest

from parley.language.offline.grammar.things import items_of
from parley.language.offline.scene.scene import Scene
from parley.language.offline.words.text import plain, tokens
from tests.language.offline.grammar.test_canonical import SCENE


def named(message: str) -> list[list[str]]:
    items = items_of(tokens(message), Scene.of(SCENE))
    return [[plain(member) for member in item.thing.members] for item in items if item.thing is not None]


@pytest.mark.parametrize(
    ("message", "expected"),
    [
        ("all three bays", [["bay 1", "bay 2", "bay 3"]]),
        ("bays 1 and 3", [["bay 1", "bay 3"]]),
        ("bays 3 down to 1", [["bay 3", "bay 2", "bay 1"]]),
        ("bay 1, then 3", [["bay 1"], ["bay 3"]]),
        ("bay 1's lamp", [["bay 1"]]),
        ("bring it to Ana", [["Ana"]]),
        ("any one of the bays", [["any bay"]]),
        ("a door", [["door"]]),
        ("nothing of the kind", []),
    ],
)
def test_names_are_found_with_what_belongs_to_them(message: str, expected: list[list[str]]) -> None:
    assert named(message) == expected


def test_a_verb_is_no_name_though_something_is_called_so() -> None:
    assert named("press the button") == []
