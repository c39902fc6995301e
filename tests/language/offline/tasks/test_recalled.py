"""Inputs that nobody says: something remembered tells them."""

from __future__ import annotations

from typing import Any

import pytest

from parley.language.base import Situation
from parley.language.offline.interpreter import interpret
from parley.messages.memory import MemoryEntry
from parley.messages.status import ActionInfo
from parley.world.object_map import MapObject

ROWS = (
    MapObject("row_a", "tomato row", 0.0, 4.0, "row"),
    MapObject("row_b", "pepper row", 3.0, 4.0, "row"),
)
FACTS = (
    MemoryEntry(name="needs", data="The pepper row needs 12 litres of water"),
    MemoryEntry(name="needs_now", data="The pepper row needs 9 litres of water"),
    MemoryEntry(name="rake_location", data="The rake is at the pepper row"),
    MemoryEntry(name="trowel", data="The old trowel belongs at the tomato row"),
)
WATER = ActionInfo(name="waterPlants", inputs={"row": "string", "litres": "number"})
RETURN = ActionInfo(name="putBack", inputs={"tool": "string", "row": "string"})


def steps(say: str) -> list[tuple[str, dict[str, Any]]]:
    situation = Situation(
        message=say, catalogue=(WATER, RETURN), objects=ROWS, memory=FACTS, robot="Fern", robots=("Fern",)
    )
    return [
        (call.name, {name: p.value for name, p in call.input_parameters.items() if p.has_data})
        for call in interpret(situation).queue
    ]


def test_a_number_that_is_not_said_is_the_last_one_remembered_in_its_unit() -> None:
    right = [("waterPlants", {"row": "pepper row", "litres": 9.0})]
    assert steps("Water the pepper row with as much as it needs.") == right


def test_a_place_that_is_only_pointed_at_is_the_one_remembered() -> None:
    right = [("putBack", {"tool": "old trowel", "row": "tomato row"})]
    assert steps("Put the old trowel back where it belongs.") == right


@pytest.mark.parametrize("say", ["Water the tomato row.", "Put the new hoe back."])
def test_what_is_remembered_of_something_else_is_not_taken(say: str) -> None:
    assert steps(say) == []
