"""Questions about what was told and taught before, and forgetting it."""

from __future__ import annotations

import pytest

from parley.evaluation.catalogues import CATALOGUES
from parley.language.base import Situation
from parley.language.offline import OfflineLanguage
from parley.messages.chat import ChatAction
from parley.messages.memory import MemoryEntry
from parley.world.object_map import MapObject

MAP = (
    MapObject(id="desk", description="desk", x_m=2.0, y_m=0.0, class_name="desk"),
    MapObject(id="shelf", description="shelf", x_m=6.0, y_m=0.0, class_name="shelf"),
)
TOLD = {
    "name": "You are called Dave",
    "leaks": "If you see a leak, stop and tell me",
    "ways": "When the way is blocked, wait a minute and try again",
    "key": "The key is on the desk",
    "key_2": "The key is now on the shelf",
    "taste": "I like tea",
}


async def answer(message: str) -> ChatAction:
    memory = tuple(MemoryEntry(name=name, data=text) for name, text in TOLD.items())
    return await OfflineLanguage().interpret(
        Situation(message, memory=memory, objects=MAP, catalogue=CATALOGUES["thesis"], robot="Rob")
    )


@pytest.mark.parametrize(
    ("question", "says", "says_not"),
    [
        ("what did I teach you?", "try again", "key"),
        ("which rules do you know?", "leak", "tea"),
        ("where was the key before?", "on the desk", ""),
        ("where did the key use to be?", "on the desk", ""),
        ("where is the key?", "shelf", "desk"),
        ("what do I like?", "You like tea", ""),
        ("do I like tea?", "You like tea", ""),
        ("what is your name?", "Dave", ""),
    ],
)
async def test_what_was_told_is_said(question: str, says: str, says_not: str) -> None:
    said = (await answer(question)).message_response
    assert says in said
    assert not says_not or says_not not in said


@pytest.mark.parametrize(
    ("order", "gone"),
    [
        ("forget the rule about the blocked way", ["ways"]),
        ("forget the rule about leaks", ["leaks"]),
        ("forget what to do when you see a leak", ["leaks"]),
    ],
)
async def test_a_rule_is_forgotten_by_what_it_is_about(order: str, gone: list[str]) -> None:
    assert [command.arguments["name"] for command in (await answer(order)).system_cmd] == gone


async def test_you_is_no_name_of_anything() -> None:
    assert len((await answer("can you go to the desk?")).queue) == 2
    assert "Dave" not in (await answer("tell me where you see a leak")).message_response


async def test_what_the_operator_likes_is_kept_in_their_words() -> None:
    action = await answer("I like coffee")
    assert [command.arguments["data"] for command in action.system_cmd] == ["I like coffee"]
    assert "you like coffee" in action.message_response
