"""The robot is wanted somewhere, a place is neglected, a thing is sought, somebody does what is not usual."""

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
        ("pump", "water pump", "pump", 2.0),
        ("hall", "entrance hall", "room", 6.0),
        ("yard", "back yard", "yard", 12.0),
    )
)
MEMORY = (MemoryEntry(name="noor_location", data="Noor is in the entrance hall"),)


async def steps(message: str) -> list[str]:
    situation = Situation(message=message, objects=MAP, memory=MEMORY, catalogue=CATALOGUES["thesis"])
    action = await OfflineLanguage().interpret(situation)
    return [str(step) for step in read_steps(action.queue, situation.catalogue)]


@pytest.mark.parametrize(
    "message",
    [
        "they are asking for you in the entrance hall",
        "Noor is waiting for you, off you go",
        "Noor could use a hand",
        "you are urgently needed in the entrance hall",
        "you're keeping Noor waiting",
    ],
)
async def test_it_goes_where_it_is_wanted(message: str) -> None:
    assert await steps(message) == ["go ['entrance hall']"]


@pytest.mark.parametrize(
    "message",
    ["nobody is waiting for you in the entrance hall", "Noor was looking for you yesterday"],
)
async def test_it_goes_nowhere_where_it_is_not_wanted(message: str) -> None:
    assert await steps(message) == []


@pytest.mark.parametrize(
    "message",
    [
        "nobody has been at the water pump since this morning",
        "we haven't looked at the water pump for days",
        "it's a week since anybody checked the water pump",
        "the water pump is overdue for a check",
    ],
)
async def test_what_is_neglected_is_looked_at(message: str) -> None:
    assert await steps(message) == ["go ['water pump']", "look ['water pump']"]


async def test_what_has_not_been_done_otherwise_is_no_neglect() -> None:
    assert await steps("nobody has painted the water pump") == []


@pytest.mark.parametrize(
    "message",
    [
        "Where on earth is the ladder? It ought to be in the back yard.",
        "I can't find the ladder, maybe it's in the back yard",
        "I've lost the ladder. I think I left it in the back yard, can you look?",
    ],
)
async def test_what_is_sought_is_looked_for_where_it_may_be(message: str) -> None:
    assert await steps(message) == ["go ['back yard']", "look ['ladder']"]


async def test_what_a_stranger_does_is_looked_at_whatever_it_is() -> None:
    assert await steps("a man is breaking into the water pump") == ["go ['water pump']", "look ['man']"]
    assert await steps("a man is cleaning the water pump") == []
