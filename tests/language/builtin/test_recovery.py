"""Answers to questions about a failed step, and how answers are meant."""

from __future__ import annotations

from dataclasses import replace

import pytest

from parley.errors import FailureCode
from parley.language.base import ErrorSituation, ReplyReading
from parley.language.builtin.engine import BuiltinLanguage
from parley.messages.chat import ActionCall
from parley.messages.status import ActionInfo

ENGINE = BuiltinLanguage()
STEP = ActionCall.model_validate(
    {"GetCoordinates": {"input_parameters": {"target": {"pvf_type": "string", "pvf_value": "gate"}}}}
)
TWO = {"candidates": [{"id": "g1", "description": "north gate"}, {"id": "g2", "description": "south gate"}]}


def failure(reply: str | None, code: FailureCode = FailureCode.AMBIGUOUS) -> ErrorSituation:
    return ErrorSituation("It did not work.", STEP, code, TWO, reply=reply)


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
    ("reply", "success", "steps"),
    [
        ("try again", True, 1),
        ("skip it", True, 0),
        ("I moved it", True, 1),
        ("purple", None, 0),
        ("stop", True, 0),
    ],
)
async def test_a_failed_step_is_repeated_left_out_or_asked_about(
    reply: str, success: bool, steps: int
) -> None:
    answer = await ENGINE.resolve(failure(reply, FailureCode.BLOCKED))
    assert (answer.success, len(answer.queue)) == (success, steps)


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
