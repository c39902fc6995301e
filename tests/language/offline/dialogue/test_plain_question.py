"""Questions without a mark, in few words, in another order, and about what was told in other words."""

from __future__ import annotations

import pytest

from parley.evaluation.catalogues import CATALOGUES
from parley.evaluation.steps import write_calls
from parley.language.base import Situation
from parley.language.offline.dialogue.plain_question import plain_question
from parley.language.offline.engine import OfflineLanguage
from parley.language.offline.words.text import plain, tokens
from parley.messages.chat import ActionCall, ChatAction
from parley.messages.memory import MemoryEntry
from parley.world.object_map import MapObject

MAP = tuple(
    MapObject(id=name, description=said, x_m=x_m, y_m=0.0, class_name=kind)
    for name, said, kind, x_m in (("ramp", "ramp", "ramp", 2.0), ("lathe", "lathe", "machine", 6.0))
)
MEMORY = tuple(
    MemoryEntry(name=f"fact_{index}", data=data)
    for index, data in enumerate(
        ("Tea is served until six", "The lathe is out of order", "Mia moved in", "Mia is in charge of tools")
    )
)


async def asked(message: str, *short: str) -> ChatAction:
    catalogue = CATALOGUES["thesis"]
    calls = write_calls(short, {item.id: item.description for item in MAP}, catalogue)
    queue = tuple(ActionCall.model_validate(call) for call in calls)
    return await OfflineLanguage().interpret(
        Situation(message=message, objects=MAP, memory=MEMORY, queue=queue, catalogue=catalogue)
    )


@pytest.mark.parametrize(
    ("said", "meant"),
    [
        ("till when is tea served", "when is tea served"),
        ("after the ramp, where next", "where next after the ramp"),
        ("what can you actually do", "what can you do"),
        ("busy", "what are you doing"),
        ("and once you are through with the ramp", "what comes after ramp"),
        ("is the ramp free", "is the ramp free"),
    ],
)
def test_a_question_is_put_as_its_readers_expect_it(said: str, meant: str) -> None:
    assert plain(plain_question(tokens(said), marked=True)) == meant


@pytest.mark.parametrize(
    ("said", "told"),
    [
        ("is the lathe ok", "out of order"),
        ("does the lathe work again?", "out of order"),
        ("can I use the lathe?", "out of order"),
        ("till when do they serve tea", "six"),
        ("got anything on Mia?", "tools"),
    ],
)
async def test_what_was_told_answers_questions_in_other_words(said: str, told: str) -> None:
    action = await asked(said)
    assert told in action.message_response
    assert not action.queue


@pytest.mark.parametrize(
    ("said", "told"),
    [
        ("after the ramp, where next?", "lathe"),
        ("and once you're through with the ramp?", "lathe"),
        ("what do you do last", "lathe"),
        ("so that's the ramp and then what?", "lathe"),
    ],
)
async def test_a_question_about_the_plan_leaves_it_as_it_is(said: str, told: str) -> None:
    action = await asked(said, "go ramp", "go lathe")
    assert told in action.message_response
    assert not action.queue
    assert not action.system_cmd


async def test_a_question_about_somebody_else_is_no_order() -> None:
    assert not (await asked("Does Mia drive to the ramp?")).queue


@pytest.mark.parametrize(
    "said",
    [
        "what will you do after this",
        "and which step follows the current one",
        "what are you going to do once that is done",
        "after this step, what happens",
    ],
)
def test_what_comes_after_this_asks_for_what_is_left(said: str) -> None:
    assert plain(plain_question(tokens(said), marked=True)) == "what is left"


@pytest.mark.parametrize(
    "said", ["what did you see after that", "what is behind this one", "what is after the ramp"]
)
def test_what_asks_for_more_than_what_comes_next_does_not(said: str) -> None:
    assert plain(plain_question(tokens(said), marked=True)) == said
