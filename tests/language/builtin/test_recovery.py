"""Answers to questions about a failed step, and how answers are meant."""

from __future__ import annotations

from dataclasses import replace

import pytest

from parley.errors import FailureCode
from parley.language.base import ErrorSituation, ReplyReading, Turn
from parley.language.builtin.engine import BuiltinLanguage
from parley.language.dialogue.replies import settled
from parley.messages.chat import ActionCall
from parley.messages.memory import MemoryEntry
from parley.messages.status import ActionInfo
from tests.language.builtin.worlds import CATALOGUE, THINGS

ENGINE = BuiltinLanguage()
STEP = ActionCall.model_validate(
    {"GetCoordinates": {"input_parameters": {"target": {"pvf_type": "string", "pvf_value": "gate"}}}}
)
TWO = {"candidates": [{"id": "g1", "description": "north gate"}, {"id": "g2", "description": "south gate"}]}


def target(step: ActionCall) -> str:
    """The words that a step is given."""
    return str(next(iter(step.input_parameters.values())).value)


def failure(reply: str | None, code: FailureCode = FailureCode.AMBIGUOUS) -> ErrorSituation:
    return ErrorSituation("It did not work.", STEP, code, TWO, reply=reply, objects=THINGS)


async def test_several_candidates_are_offered_and_the_chosen_one_is_taken() -> None:
    asked = await ENGINE.resolve(failure(None))
    assert (asked.success, asked.choices) == (False, ("north gate", "south gate"))
    solved = await ENGINE.resolve(failure("the southern one, I mean the south gate"))
    assert solved.success
    assert solved.queue[0].input_parameters["target"].value == "south gate"


@pytest.mark.parametrize(
    ("reply", "taken"),
    [
        ("go to the south gate", True),
        ("drive over to the south gate, please", True),
        ("go to the south gate and open it", None),
        ("take the box to the south gate", None),
    ],
)
async def test_an_order_to_go_where_the_plan_waits_to_go_is_the_answer(
    reply: str, taken: bool | None
) -> None:
    finds = (ActionInfo(name="GetCoordinates", effects=("locates",)),)
    answer = await ENGINE.resolve(replace(failure(reply), catalogue=finds))
    assert answer.success is taken
    assert (await ENGINE.resolve(failure(reply))).success is None  # a step that is more than a search


@pytest.mark.parametrize(
    "reply",
    [
        "Done, the box is gone. Go to the ramp.",
        "it's clear now, go to the ramp",
        "It is out of the way. Please drive home to the ramp.",
    ],
)
async def test_what_was_in_the_way_is_told_to_be_gone_and_the_order_behind_it_is_done(reply: str) -> None:
    known = replace(failure(reply, FailureCode.BLOCKED), catalogue=CATALOGUE, robot="Ada")
    answer = await ENGINE.resolve(known)
    assert answer.success
    assert answer.queue[:1] == (STEP,)
    assert [target(step) for step in answer.afterwards[:1]] == ["ramp"]
    assert (await ENGINE.resolve(replace(known, reply="the ramp is free"))).success is not True


@pytest.mark.parametrize("reply", ["use the ramp instead", "take the ramp", "no, the ramp"])
async def test_another_place_may_be_named_where_the_way_is_closed(reply: str) -> None:
    drives = ActionCall.model_validate(
        {"drive_to": {"input_parameters": {"place": {"pvf_type": "string", "pvf_value": "front gate"}}}}
    )
    closed = replace(failure(reply, FailureCode.UNREACHABLE), failed_action=drives, catalogue=CATALOGUE)
    answer = await ENGINE.resolve(closed)
    assert (answer.success, [target(step) for step in answer.queue]) == (True, ["ramp"])
    blind = ActionCall(name="drive_on", reason="go to the front gate")
    answer = await ENGINE.resolve(replace(closed, failed_action=blind))
    assert [(step.name, target(step)) for step in answer.queue] == [("drive_to", "ramp")]


@pytest.mark.parametrize(
    ("reply", "success", "steps"),
    [
        ("try again", True, 1),
        ("skip it", True, 0),
        ("I moved it", True, 1),
        ("go around it", True, 1),
        ("could you try it once more?", True, 1),
        ("leave it, it is not important", True, 0),
        ("I did it myself", True, 0),
        ("I moved it myself", True, 1),
        ("just do the rest", True, 0),
        ("forget the gate", True, 0),
        ("forget the printer", False, 0),
        ("purple", False, 0),
        ("don't try that again", False, 0),
        ("I'll move it", None, 0),
        ("why?", None, 0),
        ("look again at the printer", None, 0),
        ("stop", True, 0),
    ],
)
async def test_a_failed_step_is_repeated_left_out_or_asked_about(
    reply: str, success: bool, steps: int
) -> None:
    answer = await ENGINE.resolve(failure(reply, FailureCode.BLOCKED))
    assert (answer.success, len(answer.queue)) == (success, steps)


@pytest.mark.parametrize(
    ("reply", "delay_s"), [("try again in two minutes", 120.0), ("wait a minute, then try again", 60.0)]
)
async def test_a_wait_comes_before_the_next_attempt(reply: str, delay_s: float) -> None:
    answer = await ENGINE.resolve(failure(reply, FailureCode.BLOCKED))
    assert (answer.success, answer.delay_s, answer.queue) == (True, delay_s, (STEP,))


@pytest.mark.parametrize(
    ("reply", "commands", "now", "afterwards"),
    [
        ("the north one, then go to the desk", [], ["north gate"], ["desk"]),
        ("skip it and then go to the desk", [], [], ["desk"]),
        ("forget it and go to the desk", ["clear"], ["desk"], []),
    ],
)
async def test_an_order_behind_an_answer_is_kept_or_comes_instead(
    reply: str, commands: list[str], now: list[str], afterwards: list[str]
) -> None:
    answer = await ENGINE.resolve(replace(failure(reply), catalogue=CATALOGUE, robot="Ada"))
    assert answer.success
    assert [command.command for command in answer.system_cmd] == commands
    assert [[target(step) for step in steps] for steps in (answer.queue, answer.afterwards)] == [
        now,
        afterwards,
    ]


async def test_what_is_said_of_a_later_step_is_left_to_the_chat() -> None:
    later = STEP.model_copy(update={"reason": "go to the printer"})
    answer = await ENGINE.resolve(
        replace(failure("forget the printer", FailureCode.BLOCKED), pending=(later,))
    )
    assert (answer.success, answer.message_response) == (None, "")


async def test_where_a_thing_is_that_was_not_found_is_remembered_and_looked_at() -> None:
    look = ActionCall.model_validate(
        {"look": {"input_parameters": {"what": {"pvf_type": "string", "pvf_value": "the red key"}}}}
    )
    looks = tuple(i.model_copy(update={"effects": ("looks",)}) if i.name == "look" else i for i in CATALOGUE)
    failed = replace(failure("it is on the desk", FailureCode.NO_MATCH), failed_action=look, catalogue=looks)
    answer = await ENGINE.resolve(failed)
    assert [target(step) for step in answer.queue] == ["desk", "the red key"]
    (command,) = answer.system_cmd
    assert command.arguments["data"] == "the red key is on the desk"
    known = MemoryEntry(name="red_key_location", data="the red key is on the desk")
    alone = await ENGINE.resolve(replace(failed, reply=None, memory=(known,)))
    assert (alone.success, alone.sources, len(alone.queue)) == (True, ("red_key_location",), 2)


async def test_what_was_taught_for_a_failure_is_done_without_asking_once() -> None:
    rule = MemoryEntry(name="way_protocol", data="When the way is blocked, wait a minute and try again")
    other = MemoryEntry(name="lift_protocol", data="When the lift is stuck, go to the desk")
    known = replace(failure(None, FailureCode.BLOCKED), memory=(rule, other))
    answer = await ENGINE.resolve(known)
    assert (answer.success, answer.delay_s, answer.sources) == (True, 60.0, ("way_protocol",))
    assert (await ENGINE.resolve(replace(known, tried=((STEP,),)))).success is False
    assert (await ENGINE.resolve(replace(known, memory=(other,)))).success is False


async def test_a_second_answer_that_says_nothing_is_told_so() -> None:
    first = await ENGINE.resolve(failure("purple", FailureCode.BLOCKED))
    again = replace(
        failure("bananas", FailureCode.BLOCKED), dialogue=(Turn("assistant", first.message_response),)
    )
    assert "did not understand" in first.message_response
    assert "still do not" in (await ENGINE.resolve(again)).message_response


@pytest.mark.parametrize(
    ("reply", "kind"),
    [
        ("yes", "yes"), ("no", "no"), ("I have put it on you", "yes"), ("stop", "control"),
        ("where is the gate?", "aside"),
        ("the north one", "choice"), ("go to the south gate and open it", "aside"), ("", "unclear"),
        ("not the north one", "choice"),
    ],
)  # fmt: skip
async def test_an_answer_is_read_as_what_it_is(reply: str, kind: str) -> None:
    choices = ("north gate", "south gate") if kind in ("choice",) or "not" in reply else ()
    assert (await ENGINE.read_reply("Which one?", reply, choices)).kind == ReplyReading(kind).kind  # type: ignore[arg-type]


async def test_a_choice_that_is_tapped_is_that_choice() -> None:
    for tapped in (choices := ("It is on you", "I can't", "not the north gate", "the north gate")):
        reading = await ENGINE.read_reply("Which one?", tapped, choices)
        assert (reading.kind, reading.choice) == ("choice", tapped)


@pytest.mark.parametrize(
    ("reply", "frames"),
    [
        ("go to the blue crate and look at it more closely", 2),
        ("go there and inspect it further", 2),
        ("have a closer look at it", 1),
        ("carry on", 0),
        ("go on", 0),
        ("look again", 1),
        ("try again", 1),
    ],
)
async def test_after_an_alarm_an_order_about_what_was_found_is_done_at_once(reply: str, frames: int) -> None:
    alarm = ErrorSituation(
        "I can see a blue crate.", STEP, FailureCode.ATTENTION, {"found": ["blue crate"]}, reply=reply,
        objects=THINGS, catalogue=CATALOGUE,
    )  # fmt: skip
    answer = await ENGINE.resolve(alarm)
    assert (answer.success, len(answer.queue)) == (True, frames)
    found = {target(step) for step in answer.queue}
    assert found == {"blue crate"} or "again" in reply or not frames


async def test_after_an_alarm_an_order_about_something_else_leaves_it_open() -> None:
    alarm = failure("go to the office", FailureCode.ATTENTION)
    answer = await ENGINE.resolve(replace(alarm, details={"found": ["blue crate"]}, catalogue=CATALOGUE))
    assert answer.success is None


async def test_what_somebody_has_done_is_remembered_and_the_robot_looks_again() -> None:
    reply = "The front gate has been cleared. Please go to the office."
    alarm = ErrorSituation(
        "The front gate is not clear.", STEP, FailureCode.ATTENTION, {}, reply=reply, objects=THINGS,
        catalogue=CATALOGUE,
    )  # fmt: skip
    answer = await ENGINE.resolve(alarm)
    assert (answer.success, answer.queue) == (True, (STEP,))
    assert [target(step) for step in answer.afterwards] == ["office"]
    assert [command.arguments["data"] for command in answer.system_cmd] == ["The front gate has been cleared"]
    denied = await ENGINE.resolve(replace(alarm, reply="The front gate has not been cleared."))
    assert not denied.success


@pytest.mark.parametrize("reply", ["go and charge", "drive and look at the ramp", "put the lamp on"])
def test_an_order_is_no_word_that_it_is_done(reply: str) -> None:
    assert settled(reply, ()) is None
