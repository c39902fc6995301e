"""What is done about failures, with and without the operator's answer."""

from __future__ import annotations

from dataclasses import replace

import pytest

from parley.errors import FailureCode
from parley.language.base import ErrorSituation
from parley.language.offline import OfflineLanguage
from parley.messages.chat import ChatAction
from parley.messages.memory import MemoryEntry
from tests.language.dev_set import commands, plan, situation, turns

HOME = situation("home", "John is thirsty, get him water.")
CANDIDATES = {
    "candidates": [
        {"id": "sofa_1", "description": "small sofa"},
        {"id": "sofa_2", "description": "large sofa"},
    ]
}


async def failing(step: int, code: FailureCode, **changes: object) -> ErrorSituation:
    queue = (await OfflineLanguage().interpret(HOME)).queue
    base = ErrorSituation(
        "It did not work.",
        queue[step],
        code,
        memory=HOME.memory,
        objects=HOME.objects,
        robot="Rob",
        completed=queue[:step],
        pending=queue[step + 1 :],
        catalogue=HOME.catalogue,
        robot_pose=HOME.robot_pose,
    )
    return replace(base, **changes)  # type: ignore[arg-type]


async def answered(step: int, code: FailureCode, reply: str | None, **changes: object) -> ChatAction:
    return await OfflineLanguage().resolve(await failing(step, code, reply=reply, **changes))


async def ambiguous(reply: str | None, **changes: object) -> ChatAction:
    return await answered(4, FailureCode.AMBIGUOUS, reply, details=CANDIDATES, **changes)


async def test_an_ambiguity_is_asked_naming_all_candidates() -> None:
    action = await ambiguous(None)
    assert (action.success, action.queue, action.choices) == (False, (), ("small sofa", "large sofa"))
    assert "small sofa" in action.message_response and "large sofa" in action.message_response


@pytest.mark.parametrize(
    "reply",
    [
        "the small one",
        "small",
        "first",
        "1",
        "smal sofa",
        "the one near the fridge",
        "not the large one",
        "He's on the small one.",
    ],
)
async def test_an_answer_corrects_the_failed_step(reply: str) -> None:
    action = await ambiguous(reply)
    failed = (await failing(4, FailureCode.AMBIGUOUS)).failed_action
    assert (action.success, plan(action)) == (True, ["GetCoordinates(small sofa)"])
    assert action.queue[0].output_parameters == failed.output_parameters


async def test_equal_descriptions_are_told_apart_by_id() -> None:
    chairs = {
        "candidates": [{"id": "chair_1", "description": "chair"}, {"id": "chair_2", "description": "chair"}]
    }
    action = await answered(4, FailureCode.AMBIGUOUS, "the second", details=chairs)
    assert plan(action) == ["GetCoordinates(chair_2)"]


async def test_nonsense_is_asked_again_in_other_words() -> None:
    first = await ambiguous(None)
    dialogue = turns("", first.message_response)[1:]
    again = await ambiguous("bananas", dialogue=dialogue)
    assert (again.success, again.choices) == (False, ("small sofa", "large sofa"))
    assert again.message_response != first.message_response


async def test_another_object_of_the_map_is_accepted_as_an_answer() -> None:
    assert plan(await ambiguous("go to the TV instead")) == ["GetCoordinates(TV)"]


async def test_memory_decides_only_if_it_singles_one_out() -> None:
    told = (*HOME.memory[1:], MemoryEntry(name="john_location", data="John is on the large sofa"))
    action = await ambiguous(None, memory=told)
    assert (action.success, plan(action), action.sources) == (
        True,
        ["GetCoordinates(large sofa)"],
        ("john_location",),
    )


async def test_memory_about_somebody_else_does_not_decide() -> None:
    told = (*HOME.memory, MemoryEntry(name="mary_location", data="Mary is on the large sofa"))
    assert (await ambiguous(None, memory=told)).success is False


@pytest.mark.parametrize("code", list(FailureCode))
@pytest.mark.parametrize("step", [0, 1, 2, 3])
async def test_every_failure_is_asked_about_without_technical_words(code: FailureCode, step: int) -> None:
    action = await answered(step, code, None, error_message="[Errno 5] /navigate_to_pose: GOAL_ABORTED::7")
    assert action.success is False and action.message_response.endswith("?") and not action.queue
    assert not any(mark in action.message_response for mark in ("_", "::", "/", "[", "Errno"))


async def test_a_plain_sentence_of_the_failure_is_passed_on() -> None:
    action = await answered(1, FailureCode.BLOCKED, None, error_message="A box stands in the doorway.")
    assert "A box stands in the doorway." in action.message_response


@pytest.mark.parametrize(
    ("step", "code", "reply", "steps"),
    [
        (2, FailureCode.NO_MATCH, "try again", ["look water bottle"]),
        (2, FailureCode.NO_MATCH, "look again please", ["look water bottle"]),
        (2, FailureCode.NO_MATCH, "go on without it", []),
        (2, FailureCode.NO_MATCH, "never mind", []),
        (2, FailureCode.NO_MATCH, "I did it myself", []),
        (2, FailureCode.NO_MATCH, "it's done", []),
        (2, FailureCode.NO_MATCH, "it is on the bookshelf", ["go bookshelf", "look water bottle"]),
        (2, FailureCode.BLOCKED, "I moved it away", ["look water bottle"]),
        (1, FailureCode.BLOCKED, "I moved it", ["NavigateTo()"]),
        (1, FailureCode.BLOCKED, "the way is free now", ["NavigateTo()"]),
        (1, FailureCode.UNREACHABLE, "I opened the door", ["NavigateTo()"]),
        (1, FailureCode.UNREACHABLE, "skip it", []),
        (1, FailureCode.TIMED_OUT, "yes", ["NavigateTo()"]),
        (1, FailureCode.HARDWARE, "I fixed it, try again", ["NavigateTo()"]),
        (3, FailureCode.DECLINED, "go on", []),
        (3, FailureCode.NOT_UNDERSTOOD, "done", []),
    ],
)
async def test_answers_that_repair(step: int, code: FailureCode, reply: str, steps: list[str]) -> None:
    action = await answered(step, code, reply)
    assert (action.success, plan(action)) == (True, steps)


async def test_a_new_place_is_remembered() -> None:
    action = await answered(2, FailureCode.NO_MATCH, "it is on the bookshelf")
    assert commands(action) == ["add water_bottle_location"]


@pytest.mark.parametrize("reply", ["stop", "cancel", "cancel everything", "give up"])
async def test_the_operator_can_end_it(reply: str) -> None:
    action = await answered(2, FailureCode.NO_MATCH, reply)
    assert (action.success, action.queue, commands(action)) == (True, (), ["clear"])


@pytest.mark.parametrize("reply", ["hmm", "what?", "the weather is nice", ""])
async def test_what_does_not_help_is_asked_again(reply: str) -> None:
    action = await answered(1, FailureCode.BLOCKED, reply)
    assert (action.success, action.queue, action.choices) == (
        False,
        (),
        ("try again", "go on without it", "stop"),
    )


async def test_a_place_that_the_map_lacks_can_be_named_otherwise() -> None:
    action = await answered(0, FailureCode.NO_MATCH, "I mean the bookshelf")
    assert (action.success, plan(action)) == (True, ["GetCoordinates(bookshelf)"])
