"""Words that are said to people, and who is followed: literal words only, people only."""

from __future__ import annotations

import pytest

from parley.actions.builtin import BUILTIN_ACTIONS
from parley.language.base import Situation
from parley.language.builtin.engine import BuiltinLanguage
from parley.umrf.catalogue import Catalogue
from parley.world.object_map import MapObject

ENGINE = BuiltinLanguage()
CATALOGUE = Catalogue(BUILTIN_ACTIONS).infos()
THINGS = (
    MapObject("b", "box", 1.0, 1.0),
    MapObject("d", "desk", 2.0, 1.0),
    MapObject("k", "Kim", 4.0, 1.0, "person"),
)


async def done(message: str) -> list[tuple[str, dict[str, object]]]:
    situation = Situation(message, objects=THINGS, catalogue=CATALOGUE, robot="Rob", robots=("Rob", "Bo"))
    answer = await ENGINE.interpret(situation)
    return [
        (call.name, {name: item.value for name, item in call.input_parameters.items() if item.has_data})
        for call in answer.queue
    ]


@pytest.mark.parametrize(
    ("message", "deeds"),
    [
        ("say hello", [("Say", {"text": "hello"})]),
        ("say “the shop is closed” to Kim", [("Say", {"text": "the shop is closed", "to": "Kim"})]),
        ("let Kim know that the door is open", [("Say", {"text": "the door is open", "to": "Kim"})]),
        ("tell Kim to come here", [("Say", {"text": "come here", "to": "Kim"})]),
        ("greet Kim", [("Say", {"text": "hello", "to": "Kim"})]),
        ("follow Kim for five minutes", [("Follow", {"person": "Kim", "duration": 300.0})]),
        ("follow me until I say stop", [("Follow", {"person": "operator"})]),
        ("please follow that man", [("Follow", {"person": "man"})]),
    ],
)
async def test_words_are_said_as_they_are_and_people_are_followed(
    message: str, deeds: list[tuple[str, dict[str, object]]]
) -> None:
    assert await done(message) == deeds


@pytest.mark.parametrize(
    "message",
    [
        "say when you are there", "tell Kim where the box is", "tell Kim the time", "read the sign to me",
        "inform Kim that I am late", "remind Kim of the meeting", "say hello to the box",
        "announce that the shop closes in ten minutes", "say good evening in Italian",
        "tell the guests in the hall that dinner is served", "follow the line", "follow the box",
        "stop and have a look at the box",
    ],
)  # fmt: skip
async def test_what_is_not_told_word_for_word_or_is_nobody_is_asked_about(message: str) -> None:
    assert not {"Say", "Follow"} & {name for name, _ in await done(message)}
