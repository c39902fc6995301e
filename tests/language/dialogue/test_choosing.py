"""Which of several things is meant, once that was asked."""

from __future__ import annotations

import pytest

from parley.agents.chat.log import Log
from parley.language.builtin.decision import Do
from parley.language.builtin.engine import BuiltinLanguage
from parley.language.dialogue.state import Asked
from tests.language.builtin.worlds import THINGS, situation, thing

ENGINE = BuiltinLanguage()
OBJECTS = (*THINGS, thing("blue box", 20))


async def chosen(order: str, answer: str) -> list[str]:
    """What is done by an answer to "which one?"; empty if it is asked again."""
    asked, log = await ENGINE.interpret(situation(order, objects=OBJECTS)), Log()
    assert len(asked.choices) > 1
    log.on_asked(Asked(order, asked.choices))
    made = ENGINE.decide(situation(answer, objects=OBJECTS, dialogue=log.state(None, None, 1)))
    deeds = made.deeds if isinstance(made, Do) else ()
    return [str(value) for deed in deeds for value in deed.arguments.values()]


@pytest.mark.parametrize(
    ("order", "answer", "places"),
    [
        ("go to the box", "both", ["red box", "blue box"]),
        ("go to the box", "both of them, please", ["red box", "blue box"]),
        ("go to the box", "the blue one and the red one", ["blue box", "red box"]),
        ("go to the box and then go to the desk", "all of them", ["red box", "blue box", "desk"]),
        ("go to the box and look at the lamp from there", "both", ["red box", "lamp", "blue box", "lamp"]),
        ("go to the box", "the red one", ["red box"]),
        ("go to the box", "no, I meant the blue one", ["blue box"]),
        ("go to the box", "all right, the red one", ["red box"]),
        ("go to the box", "the one closest to the yard", ["red box"]),
        ("go to the box", "the one farthest from the yard", ["blue box"]),
        ("go to the box", "all but the red one", ["blue box"]),
        ("go to the box", "all except the first", ["blue box"]),
        ("go to the box", "both, the red one first", []),
        ("go to the box", "the blue box is full", []),
        ("go to the box", "box 2 is full", []),
        ("go to the box", "all three", []),
        ("go to the box", "not both", []),
        ("go to the box", "either", []),
    ],
)
async def test_several_are_meant_only_if_just_these_are_named(
    order: str, answer: str, places: list[str]
) -> None:
    assert await chosen(order, answer) == places
