"""People by what is remembered of them and of their things."""

from __future__ import annotations

import pytest

from parley.language.offline.facts.owning import with_owners_named
from parley.language.offline.facts.remembering import remembered
from parley.language.offline.words.text import plain, tokens
from parley.messages.memory import MemoryEntry

MEMORY = tuple(
    MemoryEntry(name=f"fact_{i}", data=text)
    for i, text in enumerate(
        [
            "The green van belongs to Mr Hill",
            "Ada has the key to the attic",
            "Ben is allergic to wasps",
            "Ada has a cat called Mimi",
            "Eve is Ada's boss",
            "The drill belongs to Ben",
        ]
    )
)


@pytest.mark.parametrize(
    ("said", "named"),
    [
        ("go to the owner of the green van", "go to Mr Hill"),
        ("where is the green van's owner", "where is Mr Hill"),
        ("go to whoever has the key to the attic", "go to Ada"),
        ("go to the guest who is allergic to wasps", "go to Ben"),
        ("find Ada's cat", "find Mimi"),
        ("go to Ada's boss", "go to Eve"),
        ("go to the thing that belongs to Ben", "go to the drill"),
        ("check the green van and go to its owner", "check the green van and go to Mr Hill"),
        ("bring the drill to the man it belongs to", "bring the drill to Ben"),
        ("go to the guest allergic to wasps", "go to Ben"),
        ("go to the guest with the drill", "go to Ben"),
        ("go to the owner of the red van", "go to the owner of the red van"),
        ("who is Ada's boss", "who is Ada's boss"),
    ],
)
def test_somebody_described_by_facts_gets_a_name(said: str, named: str) -> None:
    assert plain(with_owners_named(tokens(said), remembered(MEMORY))[0]) == named


def test_the_fact_that_was_used_comes_along() -> None:
    used = with_owners_named(tokens("go to the owner of the green van"), remembered(MEMORY))[1]
    assert [item.entry.name for item in used] == ["fact_0"]


def test_somebody_with_something_is_who_is_remembered_to_have_it() -> None:
    named = with_owners_named(tokens("go to the man with the key to the attic"), remembered(MEMORY))[0]
    assert plain(named) == "go to Ada"
    other = tokens("go to the man with the red hat")
    assert with_owners_named(other, remembered(MEMORY)) == (other, [])
