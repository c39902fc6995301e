"""Orders for all of a kind that are so: those that are remembered to be, else a look at each."""

from __future__ import annotations

import pytest

from parley.language.offline.facts.remembering import remembered
from parley.language.offline.scene.states import restricted
from parley.language.offline.sentences.clauses import opens_command
from parley.language.offline.words.text import plain, tokens
from parley.messages.memory import MemoryEntry
from parley.world.object_map import MapObject

DOORS = tuple(MapObject(f"d{n}", f"door {n}", float(n), 0.0, "door") for n in (1, 2))


def read(text: str, *facts: str) -> str | None:
    memory = [MemoryEntry(name=f"fact_{i}", data=fact) for i, fact in enumerate(facts)]
    found = restricted(tokens(text), DOORS, remembered(memory), lambda words: opens_command(words, ()))
    return None if found is None else plain(found.words)


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        (
            "inspect all doors that are wet",
            "check whether door 1 is wet. if so, inspect door 1. "
            "check whether door 2 is wet. if so, inspect door 2.",
        ),
        ("visit the doors that are wet", "check whether door 1 is wet. check whether door 2 is wet."),
    ],
)
def test_what_nobody_knows_is_looked_at_first(text: str, meant: str) -> None:
    assert read(text) == meant


def test_those_that_are_remembered_to_be_so_are_meant() -> None:
    memory = [MemoryEntry(name="wet", data="Door 2 is wet")]
    words = tokens("inspect all doors that are wet")
    found = restricted(words, DOORS, remembered(memory), lambda part: opens_command(part, ()))
    assert found is not None
    assert found.items == DOORS[1:]
    assert found.used


@pytest.mark.parametrize(
    "text",
    [
        "inspect all doors",
        "inspect all doors that are not 2",
        "all doors that are wet leak",
        "is the door wet",
    ],
)
def test_other_words_are_left_alone(text: str) -> None:
    assert read(text) is None
