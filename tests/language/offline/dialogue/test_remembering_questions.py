"""Questions in other words that what is remembered, or the plan, answers."""

from __future__ import annotations

import pytest

from parley.evaluation.catalogues import CATALOGUES
from parley.evaluation.steps import write_calls
from parley.language.base import Situation
from parley.language.offline.engine import OfflineLanguage
from parley.messages.chat import ActionCall, ChatAction
from parley.messages.memory import MemoryEntry
from parley.world.object_map import MapObject

MAP = (
    MapObject(id="hall_1", description="hall", x_m=1.0, y_m=1.0, class_name="room"),
    MapObject(id="yard_1", description="yard", x_m=5.0, y_m=1.0, class_name="yard"),
    MapObject(id="van_1", description="green van", x_m=3.0, y_m=4.0, class_name="car"),
)
MEMORY = tuple(
    MemoryEntry(name=f"fact_{i}", data=text)
    for i, text in enumerate(
        [
            "The green van belongs to Mr Hill",
            "Mr Hill is in the hall",
            "Ada is allergic to wasps",
            "The ladder is in the yard",
        ]
    )
)


async def asked(message: str, *steps: str) -> ChatAction:
    catalogue = CATALOGUES["thesis"]
    queue = tuple(
        ActionCall.model_validate(call)
        for call in write_calls(steps, {item.id: item.description for item in MAP}, catalogue)
    )
    situation = Situation(
        message=message,
        objects=MAP,
        memory=MEMORY,
        queue=queue,
        status="running" if queue else "idle",
        catalogue=catalogue,
    )
    return await OfflineLanguage().interpret(situation)


@pytest.mark.parametrize(
    ("question", "answer"),
    [
        ("who owns the green van?", "Mr Hill"),
        ("whose van is that?", "Mr Hill"),
        ("where can I find the owner of the green van?", "hall"),
        ("who must not go near wasps?", "Ada"),
        ("where did I say the ladder was?", "yard"),
    ],
)
async def test_a_question_is_answered_by_the_fact_that_shares_most_with_it(
    question: str, answer: str
) -> None:
    action = await asked(question)
    assert answer in action.message_response
    assert not action.queue


async def test_what_no_fact_tells_is_not_made_up() -> None:
    action = await asked("who owns the red bus?")
    assert "Mr Hill" not in action.message_response


async def test_what_is_still_to_be_done_was_not_done_yet() -> None:
    action = await asked("have you been to the yard yet?", "go hall_1", "go yard_1")
    assert action.message_response.startswith("Not yet")
    assert not action.queue


async def test_looking_is_done_if_it_is_asked_for_although_a_fact_would_answer() -> None:
    action = await asked("is the ladder still in the yard? have a look please")
    assert action.queue
