"""A room of which only names of things tell is a place to look in, too; "me" is a goal behind any order."""

from __future__ import annotations

import pytest

from parley.language.base import Situation
from parley.language.builtin.engine import BuiltinLanguage
from parley.world.object_map import MapObject
from tests.language.builtin.worlds import CATALOGUE

ENGINE = BuiltinLanguage()
NAMES = ("fern by the north door", "fern in the pantry", "round desk in the reading nook", "small bench")
THINGS = tuple(MapObject(f"t{at}", name, 2.0 * at, 1.0) for at, name in enumerate(NAMES))


@pytest.mark.parametrize(
    ("message", "goals"),
    [
        ("look for the blue jar in the reading nook", ["round desk in the reading nook", "blue jar"]),
        ("check the fern in the pantry", ["fern in the pantry"]),
        ("check the small bench and come to me", ["small bench", "operator"]),
        ("take a look at the bench in the pantry", []),
    ],
)
async def test_where_it_is_looked(message: str, goals: list[str]) -> None:
    made = await ENGINE.interpret(Situation(message, objects=THINGS, robot="Ada", catalogue=CATALOGUE))
    assert [str(value.value) for call in made.queue for value in call.input_parameters.values()] == goals
