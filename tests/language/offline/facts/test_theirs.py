"""Whose "his room" is, who "she" is, and what "it" is that somebody has."""

from __future__ import annotations

import pytest

from parley.language.base import Situation
from parley.language.offline.facts.owning import with_owners_named
from parley.language.offline.facts.theirs import with_their_names
from parley.language.offline.scene.scene import Scene
from parley.language.offline.sentences.lost import with_what_was_lost
from parley.language.offline.words.text import plain, tokens
from parley.messages.memory import MemoryEntry
from parley.world.object_map import MapObject

OBJECTS = (
    MapObject(id="c1", description="cabin 1", class_name="cabin", x_m=0.0, y_m=0.0),
    MapObject(id="c2", description="cabin 2", class_name="cabin", x_m=3.0, y_m=0.0),
    MapObject(id="bridge", description="bridge", class_name="bridge", x_m=6.0, y_m=0.0),
)
MEMORY = (
    "Mrs Dahl sleeps in cabin 2", "The night porter is Arvid", "Arvid is on the bridge",
    "Arvid has the torch",
    "The lamp oil belongs to Mrs Dahl",
)  # fmt: skip


def scene(message: str) -> Scene:
    memory = tuple(MemoryEntry(name=f"m{i}", data=text) for i, text in enumerate(MEMORY))
    return Scene.of(Situation(message=message, memory=memory, objects=OBJECTS))


@pytest.mark.parametrize(
    ("said", "meant"),
    [
        (
            "The family of Mrs Dahl is here. Please go to her cabin.",
            "The family of Mrs Dahl is here. Please go to Mrs Dahl's cabin.",
        ),
        ("Ole is in cabin 1. Go to his cabin.", "Ole is in cabin 1. Go to Ole's cabin."),
        ("Our guest is Kim Lund. She is on the bridge.", "Our guest is Kim Lund. Kim Lund is on the bridge."),
        ("Mrs Dahl wants her tea.", "Mrs Dahl wants her tea."),
        ("Go to his cabin.", "Go to his cabin."),
    ],
)
def test_the_last_one_who_has_such_a_thing_is_meant(said: str, meant: str) -> None:
    assert plain(with_their_names(tokens(said), scene(said))) == meant


@pytest.mark.parametrize(
    ("said", "meant"),
    [
        ("go to the night porter", "go to Arvid"),
        ("we need the torch, go to whoever has it", "we need the torch, go to Arvid"),
        ("I want the torch, go where it is", "I want the torch, go where the torch is"),
        ("go to the owner of the lamp oil", "go to Mrs Dahl"),
        (
            "The new night porter is Nils. Go to the night porter.",
            "The new night porter is Nils. Go to Nils.",
        ),
        ("Nils has the key. Go to whoever has the key.", "Nils has the key. Go to Nils."),
        ("remember that Nils is the night porter", "remember that Nils is the night porter"),
        ("remember that the night porter is Nils", "remember that the night porter is Nils"),
        ("is Nils the night porter?", "is Nils the night porter?"),
    ],
)
def test_roles_and_holders_get_their_names(said: str, meant: str) -> None:
    assert plain(with_owners_named(tokens(said), scene(said).facts)[0]) == meant


@pytest.mark.parametrize(
    ("said", "meant"),
    [
        ("We need the crane at berth 4, call it please", "call the crane at berth 4 please"),
        ("I want a tug at berth 2. Could you call one?", "call a tug at berth 2?"),
        ("Somebody needs the hatch open, please open it", "open the hatch"),
        ("How heavy is the blue crate? Weigh it.", "How heavy is the blue crate? Weigh the blue crate."),
        ("We need you to sail. Do it now.", "We need you to sail. Do it now."),
        ("I need a rest. Go on with it.", "I need a rest. Go on with it."),
    ],
)
def test_it_is_what_was_needed_or_asked_about(said: str, meant: str) -> None:
    assert plain(with_what_was_lost(tokens(said))) == meant
