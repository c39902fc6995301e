"""Things and people that are described by what was told of them."""

from __future__ import annotations

import pytest

from parley.evaluation.catalogues import CATALOGUES
from parley.evaluation.steps import read_steps
from parley.language.base import Situation
from parley.language.offline.engine import OfflineLanguage
from parley.messages.memory import MemoryEntry
from parley.world.object_map import MapObject

MAP = tuple(
    MapObject(id=name, description=said, x_m=x_m, y_m=0.0, class_name=kind)
    for name, said, kind, x_m in (
        ("dock_1", "dock 1", "dock", 2.0),
        ("dock_2", "dock 2", "dock", 6.0),
        ("pump", "water pump", "pump", 9.0),
        ("loft", "loft", "room", 14.0),
    )
)
MEMORY = tuple(
    MemoryEntry(name=f"fact_{index}", data=data)
    for index, data in enumerate(
        (
            "The wallet that Eva lost was found at dock 2",
            "The lamp at dock 1 is broken",
            "The captain is called Mr Sund",
            "Mr Sund is in the loft this morning",
            "Noor runs the water pump",
            "Dock 2 is closed",
        )
    )
)


async def places(message: str) -> list[tuple[str, ...]]:
    catalogue = CATALOGUES["thesis"]
    situation = Situation(message=message, objects=MAP, memory=MEMORY, catalogue=catalogue)
    action = await OfflineLanguage().interpret(situation)
    return [step.arguments for step in read_steps(action.queue, catalogue) if step.verb == "go"]


@pytest.mark.parametrize(
    ("said", "place"),
    [
        ("go to the place where the wallet turned up", "dock 2"),
        ("go to the dock with the broken lamp", "dock 1"),
        ("go to the mooring that has the broken lamp", "dock 1"),
        ("go and see the captain", "loft"),
        ("find Noor", "water pump"),
        ("get yourself over to where Mr Sund is", "loft"),
    ],
)
async def test_the_fact_that_says_most_of_a_description_names_the_place(said: str, place: str) -> None:
    assert await places(said) == [(place,)]


async def test_what_is_denied_of_a_thing_never_leads_to_it() -> None:
    assert ("dock 2",) not in await places("go to the dock that is not closed")
