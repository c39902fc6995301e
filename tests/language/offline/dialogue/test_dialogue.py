"""Messages that lean on what was said before: answers, pronouns, changes of the plan."""

from __future__ import annotations

from typing import Any

import pytest

from parley.language.offline import OfflineLanguage
from parley.messages.chat import ChatAction
from tests.language.dev_set import commands, plan, situation, turns

ENGINE = OfflineLanguage()


async def say(message: str, *before: str, world: str = "home", **changes: Any) -> ChatAction:
    return await ENGINE.interpret(situation(world, message, history=turns(*before), **changes))


async def reply_to(message: str, answer: str, world: str = "home") -> ChatAction:
    """Ask, then answer the question that comes back."""
    question = (await say(message, world=world)).message_response
    return await say(answer, message, question, world=world)


@pytest.mark.parametrize(
    ("message", "answer", "steps"),
    [
        ("go to the sofa", "the small one", ["go small sofa"]),
        ("go to the sofa", "the second", ["go large sofa"]),
        ("go to the sofa", "large sofa please", ["go large sofa"]),
        ("go to the sofa and then to the TV", "the small one", ["go small sofa", "go TV"]),
        ("inspect the plant", "the one near the TV", ["go plant near the TV", "look plant near the TV"]),
        ("go to the fridge or the TV", "the TV", ["go TV"]),
        ("has the TV been mended?", "yes", ["go TV", "look whether the TV has been mended"]),
        ("has the TV been mended?", "no", []),
        (
            "get John the newspaper",
            "it is on the bookshelf",
            ["go bookshelf", "look newspaper", "ask", "go sofa"],
        ),
        (
            "bring me the water",
            "at the dining table",
            ["go refrigerator", "look water bottle", "ask", "go dining table"],
        ),
        (
            "bring me the water",
            "I am at the dining table",
            ["go refrigerator", "look water bottle", "ask", "go dining table"],
        ),
        ("go to the elephant", "it is next to the TV", ["go TV"]),
        ("go to the sofa", "go to the fridge", ["go refrigerator"]),
    ],
)
async def test_an_answer_completes_the_request(message: str, answer: str, steps: list[str]) -> None:
    assert plan(await reply_to(message, answer)) == steps


async def test_a_place_told_in_an_answer_is_remembered() -> None:
    assert commands(await reply_to("get John the newspaper", "on the bookshelf")) == [
        "add newspaper_location"
    ]


async def test_two_questions_in_a_row_are_both_answered() -> None:
    first = await say("take the newspaper to the sofa")
    second = await say("on the bookshelf", "take the newspaper to the sofa", first.message_response)
    history = (
        "take the newspaper to the sofa",
        first.message_response,
        "on the bookshelf",
        second.message_response,
    )
    assert plan(await say("the small one", *history)) == [
        "go bookshelf",
        "look newspaper",
        "ask",
        "go small sofa",
    ]


@pytest.mark.parametrize(
    ("before", "message", "steps"),
    [
        ("go to the TV", "look at it", ["go TV", "look TV"]),
        ("go to the TV", "go there again", ["go TV"]),
        ("go to the small sofa", "go to the other one", ["go large sofa"]),
        ("look at the chair_1", "and now the other chair", ["go chair_2", "look chair_2"]),
        (
            "John is on the small sofa",
            "bring him the water",
            ["go refrigerator", "look water bottle", "ask", "go sofa"],
        ),
    ],
)
async def test_pronouns_point_back(before: str, message: str, steps: list[str]) -> None:
    assert plan(await say(message, before, "All right.")) == steps


async def test_a_pronoun_without_anything_before_is_asked_about() -> None:
    action = await say("look at it")
    assert plan(action) == [] and action.message_response.startswith("What do you mean")


@pytest.mark.parametrize(
    ("message", "short"),
    [
        ("drop the second step", ["pop 1"]),
        ("remove step 3", ["pop 2"]),
        ("cancel the last step", ["pop 5"]),
        ("skip the next one", ["pop 1"]),
        ("drop number two", ["pop 1"]),
        ("drop the ninth step", []),
        ("leave out the inspection", ["pop 2"]),
        ("don't go to the sofa", ["pop 5", "pop 4"]),
        ("skip it", ["skip"]),
        ("what is left?", []),
        ("instead of the sofa go to the TV", ["pop 5", "pop 4"]),
    ],
)
async def test_the_pending_plan_is_edited(message: str, short: list[str]) -> None:
    queue = (await say("John is thirsty, get him water")).queue
    assert commands(await say(message, queue=queue, status="running")) == short


async def test_questions_about_the_plan_are_answered_from_it() -> None:
    queue = (await say("go to the TV")).queue
    doing = await say("what are you doing?", queue=queue, status="running")
    left = await say("what is left?", queue=queue, status="running")
    assert "find out where the TV is" in doing.message_response
    assert left.message_response == "2 steps are left: find out where the TV is and then go to the TV."


async def test_nothing_is_planned_from_words_in_memory_or_map() -> None:
    action = await say("what do you remember?", world="warehouse")
    assert plan(action) == []
