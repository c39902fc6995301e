"""Things by what is remembered to have to do with them."""

from __future__ import annotations

import pytest

from parley.language.base import Situation
from parley.language.offline import OfflineLanguage
from parley.language.offline.scene.scene import Scene, UnclearError
from parley.language.offline.words.text import tokens
from parley.messages.memory import MemoryEntry
from parley.world.object_map import MapObject

OBJECTS = tuple(
    MapObject(id=name.replace(" ", "_"), description=name, class_name=kind, x_m=float(i), y_m=3.0)
    for i, (name, kind) in enumerate(
        [
            ("rehearsal room 1", "room"), ("rehearsal room 2", "room"), ("rail 1", "rail"),
            ("rail 2", "rail"),
            ("grand piano", "piano"), ("minibus 4", "minibus"), ("minibus 5", "minibus"), ("foyer", "foyer"),
        ]
    )
)  # fmt: skip
MEMORY = (
    "The choir warms up in rehearsal room 1", "The choir warms up in rehearsal room 2",
    "Mr Vogel tunes the grand piano", "Piet is in the winter show", "The winter show uses rail 2",
    "Lone drives minibus 5", "Lone has the megaphone", "The posters are for the foyer",
    "The driver on duty is Lone", "Dr Bach looks after Mrs Berg", "Dr Bach is in the foyer",
)  # fmt: skip


def scene(message: str = "") -> Scene:
    memory = tuple(MemoryEntry(name=f"m{i}", data=text) for i, text in enumerate(MEMORY))
    return Scene.of(Situation(message=message, memory=memory, objects=OBJECTS))


@pytest.mark.parametrize(
    ("said", "meant"),
    [
        ("the room the choir warms up in", "rehearsal room 2"),
        ("the instrument Mr Vogel tunes", "grand piano"),
        ("the rail for the winter show", "rail 2"),
        ("Piet's rail", "rail 2"),
        ("the minibus Lone drives", "minibus 5"),
        ("the place the posters are for", "foyer"),
        ("the megaphone", "minibus 5"),
        ("Lone", "minibus 5"),
        ("where the megaphone is", "minibus 5"),
    ],
)
def test_facts_lead_to_the_one_thing(said: str, meant: str) -> None:
    assert scene().place(tokens(said)).value == meant


@pytest.mark.parametrize(
    "said", ["the rail for the summer show", "the room Piet likes", "the minibus Piet drives", "Vera's rail"]
)
def test_what_no_fact_connects_is_asked(said: str) -> None:
    with pytest.raises(UnclearError):
        scene().place(tokens(said))


@pytest.mark.parametrize(
    ("said", "meant"), [("the driver on duty", "minibus 5"), ("Mrs Berg's doctor", "foyer")]
)
async def test_who_is_only_called_by_what_they_are_is_found(said: str, meant: str) -> None:
    memory = tuple(MemoryEntry(name=f"m{i}", data=text) for i, text in enumerate(MEMORY))
    situation = Situation(message=f"Where is {said}?", memory=memory, objects=OBJECTS)
    answer = await OfflineLanguage().interpret(situation)
    assert meant in answer.message_response
