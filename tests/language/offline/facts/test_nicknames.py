"""Things by the names that people give them."""

from __future__ import annotations

import pytest

from parley.language.base import Situation
from parley.language.offline.facts.nicknames import by_their_real_names, nicknames, remembered_plainly
from parley.language.offline.scene.scene import Scene
from parley.language.offline.words.text import plain, tokens
from parley.messages.memory import MemoryEntry
from parley.world.object_map import MapObject

OBJECTS = (
    MapObject(id="crane", description="north crane", class_name="crane", x_m=0.0, y_m=0.0),
    MapObject(id="area", description="area A", class_name="area", x_m=3.0, y_m=0.0),
)


def scene(told: str) -> Scene:
    memory = (MemoryEntry(name="told", data=told),)
    return Scene.of(Situation(message="", memory=memory, objects=OBJECTS))


@pytest.mark.parametrize(
    "told",
    [
        "The men call the north crane Big Bertha",
        "Our name for the north crane is Big Bertha",
        "Big Bertha is our nickname for the north crane",
        "Big Bertha is what we call the north crane",
        "The north crane is also known as Big Bertha",
        "Big Bertha means the north crane",
    ],
)
def test_a_thing_is_known_by_its_other_name(told: str) -> None:
    known = scene(told)
    assert plain(by_their_real_names(tokens("go to Big Bertha now"), known)) == "go to the north crane now"
    assert known.sources == ["told"]


@pytest.mark.parametrize(
    "message", ["what do we call the crane", "forget the name Big Bertha", "Big Bertha is broken"]
)
def test_what_is_about_the_name_or_only_told_keeps_it(message: str) -> None:
    known = scene("The men call the north crane Big Bertha")
    assert plain(by_their_real_names(tokens(message), known)) == message
    assert known.sources == []


@pytest.mark.parametrize(
    "told", ["The crane is north of area A", "Call me at noon", "Bertha likes the north crane"]
)
def test_other_facts_name_nothing(told: str) -> None:
    memory = (MemoryEntry(name="told", data=told),)
    assert nicknames(memory, OBJECTS) == []


@pytest.mark.parametrize(
    ("told", "said", "meant"),
    [
        ("The ladle is in the drawer", "ladle. Bring it.", "the ladle. Bring it."),
        (
            "The kettle is on the stove",
            "wipe the stove with the kettle on it",
            "wipe the stove where the kettle is",
        ),
        (
            "The wasps are in the shed",
            "go to the shed with the wasps in it now",
            "go to the shed where the wasps is now",
        ),
    ],
)
def test_what_is_remembered_is_named_as_the_rest_reads_it(told: str, said: str, meant: str) -> None:
    assert plain(remembered_plainly(tokens(said), scene(told))) == meant


@pytest.mark.parametrize(
    "said",
    ["ladle. I am hungry.", "spoon. Bring it.", "put the ladle on it", "wipe the stove with the spoon on it"],
)
def test_what_is_not_remembered_or_not_meant_stays_as_it_is(said: str) -> None:
    assert plain(remembered_plainly(tokens(said), scene("The ladle is in the drawer"))) == said
