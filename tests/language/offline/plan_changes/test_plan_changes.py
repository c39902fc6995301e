"""Changes of what is pending, conditions, relative clauses, several robots, waiting: beyond the two sets."""

from __future__ import annotations

from typing import Any

import pytest

from parley.evaluation.steps import pending
from parley.language.base import Situation
from parley.language.offline import OfflineLanguage
from parley.language.offline.sentences.clauses import opens_command
from parley.language.offline.sentences.conditions import LAST, split_condition
from parley.language.offline.words.durations import duration_s
from parley.language.offline.words.text import plain, tokens
from parley.messages.chat import ActionCall, ChatAction, Flow, FlowIf
from parley.messages.pvf import Parameter
from tests.language.dev_set import plan, situation


def visit(place: str, **more: Any) -> tuple[ActionCall, ...]:
    target = {"target": Parameter("string", place)}
    return (
        ActionCall(name="GetCoordinates", input_parameters=target, **more),
        ActionCall(name="NavigateTo", **more),
    )


QUEUE = (*visit("area A"), *visit("area B"), *visit("area C"))


async def changed(
    message: str, queue: tuple[ActionCall, ...] = QUEUE, **more: Any
) -> tuple[Situation, ChatAction]:
    asked = situation("warehouse", message, queue=queue, status="running", **more)
    return asked, await OfflineLanguage().interpret(asked)


@pytest.mark.parametrize(
    ("message", "left"),
    [
        ("do area C before area B", ["go area A", "go area C", "go area B"]),
        ("visit area B last", ["go area A", "go area C", "go area B"]),
        ("swap area B and area C", ["go area A", "go area C", "go area B"]),
        ("go to the loading area instead of area B", ["go area A", "go loading area", "go area C"]),
        (
            "add a stop at the loading area before area C",
            ["go area A", "go area B", "go loading area", "go area C"],
        ),
        ("drop area B from the plan", ["go area A", "go area C"]),
        ("remove everything after area A", ["go area A"]),
    ],
)
async def test_pending_visits_are_put_in_the_order_asked_for(message: str, left: list[str]) -> None:
    asked, answer = await changed(message)
    assert plan(ChatAction(queue=tuple(pending(asked.queue, answer)))) == left


async def test_steps_that_depend_on_others_keep_their_order() -> None:
    condition = Flow(if_=FlowIf(step=1, result=True))
    queue = (*visit("area A"), *visit("area B"), *visit("area C", flow=condition))
    asked, answer = await changed("do area C before area B", queue)
    assert pending(asked.queue, answer) == list(queue)
    assert "depend" in answer.message_response


@pytest.mark.parametrize("message", ["remove everything after area D", "do area D before area B"])
async def test_a_change_that_is_not_understood_changes_nothing(message: str) -> None:
    asked, answer = await changed(message)
    assert pending(asked.queue, answer) == list(QUEUE)
    assert not answer.system_cmd


@pytest.mark.parametrize(("robot", "step"), [("Alpha", "go area A"), ("Beta", "go area B")])
async def test_each_robot_does_its_own_part(robot: str, step: str) -> None:
    message = "Alpha, go to area A. Beta, go to area B!"
    answer = await OfflineLanguage().interpret(situation("warehouse", message, robot=robot))
    assert plan(answer) == [step]
    assert answer.targets == (robot,)


@pytest.mark.parametrize(
    ("message", "steps"),
    [
        ("go to the sofa John is on", None),
        ("go to the table that the keys are on", ["go dining table"]),
        ("go to the chair that is nearest to the dining table", ["go chair_1"]),
        ("go to the sofa that is not small", ["go large sofa"]),
    ],
)
async def test_things_are_told_apart_by_what_is_remembered(message: str, steps: list[str] | None) -> None:
    memory = situation("home", "").memory
    keys_fact = memory[0].model_copy(
        update={"name": "keys_location", "data": "The keys are on the dining table"}
    )
    answer = await OfflineLanguage().interpret(situation("home", message, memory=(*memory, keys_fact)))
    # Where nothing remembered tells which of two it is, it is asked.
    assert plan(answer) == (steps or [])
    assert steps or "?" in answer.message_response


async def test_waiting_a_time_without_an_action_for_it_asks_the_operator() -> None:
    answer = await OfflineLanguage().interpret(
        situation("warehouse", "go to area A, wait ten minutes, then go to area B")
    )
    assert plan(answer) == ["go area A", "ask", "go area B"]
    assert answer.queue[2].reason.startswith("ask you")


@pytest.mark.parametrize(
    ("text", "span_s"),
    [
        ("10 seconds", 10),
        ("half a minute", 30),
        ("for two minutes", 120),
        ("an hour", 3600),
        ("a while", None),
    ],
)
def test_spans_of_time_are_read(text: str, span_s: float | None) -> None:
    assert duration_s(tokens(text)) == span_s


@pytest.mark.parametrize(
    ("text", "condition", "then", "otherwise"),
    [
        ("if the box is open go to the door", "the box is open", "go to the door", ""),
        ("go to the door unless the box is open", "the box is open", "", "go to the door"),
        ("when the box is empty, go to the door", "the box is empty", "go to the door", ""),
        ("otherwise go to the door", plain(LAST), "", "go to the door"),
        ("if there is water on it, go to the door", "there is water on it", "go to the door", ""),
        ("if there is, water it", plain(LAST), "water it", ""),
    ],
)
def test_conditions_are_taken_apart(text: str, condition: str, then: str, otherwise: str) -> None:
    parts = split_condition(tokens(text), opens_command)
    assert parts is not None
    said = [plain(p).strip(", ") for p in (parts.condition, parts.then, parts.otherwise)]
    assert said == [condition, then, otherwise]


@pytest.mark.parametrize("text", ["check if the box is open", "go to the door", "tell me if it is open"])
def test_what_is_no_condition_is_left_alone(text: str) -> None:
    assert split_condition(tokens(text), opens_command) is None


@pytest.mark.parametrize("word", ["chart", "cable", "plank", "shell"])
async def test_a_common_noun_is_no_typing_error_of_another(word: str) -> None:
    answer = await OfflineLanguage().interpret(situation("home", f"go to the {word}"))
    assert not answer.queue
    assert "?" in answer.message_response or "Tell me" in answer.message_response
