"""Situations as JSON lines."""

from __future__ import annotations

import json
from typing import Any

import jsonschema_rs
import pytest

from parley.errors import FailureCode, InvalidMessageError
from parley.evaluation.catalogues import CATALOGUES
from parley.evaluation.situations import interpret_lines, read_situation, schema
from parley.language.base import DraftHandler, ErrorSituation, Situation
from parley.language.builtin.engine import BuiltinLanguage
from parley.messages.chat import ChatAction
from parley.messages.pvf import read_parameters

OBJECTS = [
    {"id": "box_1", "description": "red box", "x": 1, "y": 2},
    {"id": "door_1", "description": "door", "x": 3, "y": 2},
]
FAILED = {"GetCoordinates": {"input_parameters": {"target": {"pvf_type": "string", "pvf_value": "box"}}}}


async def answers(*lines: Any) -> list[dict[str, Any]]:
    texts = [line if isinstance(line, str) else json.dumps(line) for line in lines]
    return [
        json.loads(line) async for line in interpret_lines(texts, BuiltinLanguage(), CATALOGUES["thesis"])
    ]


async def test_a_situation_gives_a_chat_action_with_its_id() -> None:
    (answer,) = await answers({"id": 7, "message": "go to the red box", "objects": OBJECTS, "robot": "A"})
    assert answer["id"] == 7 and answer["latency_s"] >= 0
    names = [next(iter(step)) for step in answer["output"]["queue"]]
    assert names == ["GetCoordinates", "NavigateTo"]
    target = answer["output"]["queue"][0]["GetCoordinates"]["input_parameters"]["target"]
    assert target == {"pvf_type": "string", "pvf_value": "red box"}
    for step in answer["output"]["queue"]:  # a graph of them can be carried out as it stands
        ((name, call),) = step.items()
        info = next(info for info in CATALOGUES["thesis"] if info.name == name)
        assert read_parameters(call["input_parameters"]).keys() == info.inputs.keys()
        assert read_parameters(call["output_parameters"]).keys() == info.outputs.keys()


async def test_a_catalogue_of_its_own_is_used() -> None:
    catalogue = [{"name": "a", "inputs": {"place": "string"}, "description": "Drive to a place."}]
    (answer,) = await answers({"message": "go to the door", "objects": OBJECTS, "catalogue": catalogue})
    assert [next(iter(step)) for step in answer["output"]["queue"]] == ["a"]


async def test_an_error_situation_is_resolved() -> None:
    (answer,) = await answers(
        {
            "kind": "error",
            "error_message": "two boxes",
            "failed_action": FAILED,
            "code": "ambiguous",
            "reply": "the red one",
            "details": {
                "candidates": [{"id": "a", "description": "red box"}, {"id": "b", "description": "blue box"}]
            },
        }
    )
    assert answer["output"]["success"] is True
    assert "id" not in answer


async def test_bad_lines_are_reported_and_stop_nothing() -> None:
    good = {"id": "ok", "message": "hello"}
    first, second, third, fourth = await answers("{", {"id": "x", "message": 5}, "[]", good)
    assert first["error"].startswith("line 1: not valid JSON")
    assert second == {"id": "x", "error": "line 2.message: Input should be a valid string"}
    assert third["error"] == "line 3: expected a JSON object"
    assert fourth["output"]["message_response"]


async def test_empty_lines_are_passed_over() -> None:
    assert await answers("", "  \n") == []


@pytest.mark.parametrize(
    ("change", "path"),
    [
        ({"status": "sleeping"}, "status"),
        ({"memory": [{"data": "x"}]}, "memory.0.name"),
        ({"objects": [{"description": "x"}]}, "objects.0.id"),
        ({"robot_pose": {"x": 1}}, "robot_pose.y"),
        ({"queue": [{"A": {}, "B": {}}]}, "queue.0"),
        ({"history": [{"role": "nobody", "content": ""}]}, "history.0.role"),
    ],
)
def test_the_wrong_field_is_named(change: dict[str, Any], path: str) -> None:
    with pytest.raises(InvalidMessageError) as caught:
        read_situation({"message": "hello", **change}, line=3)
    assert (caught.value.what, caught.value.path) == ("line 3", path)


def test_both_kinds_are_read_whole() -> None:
    situation = read_situation(
        {"message": "hi", "history": [{"role": "user", "content": "a"}], "robots": ["A", "B"]}
    )
    assert isinstance(situation, Situation)
    assert situation.history[0].role == "operator" and situation.robots == ("A", "B")
    error = read_situation({"kind": "error", "error_message": "x", "failed_action": FAILED})
    assert isinstance(error, ErrorSituation)
    assert (error.code, error.reply, error.failed_action.name) == (
        FailureCode.INTERNAL,
        None,
        "GetCoordinates",
    )


@pytest.mark.parametrize(
    ("written", "code"), [("Attention needed", FailureCode.ATTENTION), ("E42", FailureCode.INTERNAL)]
)
def test_code_is_read_as_others_write_it_and_an_unknown_one_is_none(written: str, code: FailureCode) -> None:
    error = read_situation({"kind": "error", "error_message": "x", "failed_action": FAILED, "code": written})
    assert isinstance(error, ErrorSituation)
    assert error.code is code


class Breaking(BuiltinLanguage):
    async def interpret(self, situation: Situation, *, on_draft: DraftHandler | None = None) -> ChatAction:
        if situation.message == "break":
            raise IndexError("a defect")
        return await super().interpret(situation)


async def test_a_line_on_which_the_engine_breaks_down_does_not_end_the_run() -> None:
    lines = ['{"id": 1, "message": "break"}', '{"id": 2, "message": "hello"}']
    first, second = [json.loads(line) async for line in interpret_lines(lines, Breaking())]
    assert "a defect" in first["error"] and first["id"] == 1
    assert "output" in second


@pytest.mark.parametrize(
    ("line", "place"),
    [
        ({"mesage": "go"}, "mesage"),
        ({"objects": [{"id": "a", "colour": "red"}]}, "objects.0.colour"),
        ({"catalogue": [{"name": "a", "phrase": []}]}, "catalogue.0.phrase"),
        ({"memory": [{"name": "a", "data": "b", "type": "text", "when": 1}]}, "memory.0.when"),
    ],
)
def test_a_key_that_nobody_knows_is_refused_with_its_place(line: dict[str, Any], place: str) -> None:
    with pytest.raises(InvalidMessageError, match=f"{place}: unknown key"):
        read_situation({"message": "go"} | line)


async def test_what_is_read_and_answered_is_as_the_schema_says() -> None:
    whole = schema()
    asked, answered = (jsonschema_rs.validator_for({"$ref": f"#/{part}", **whole}) for part in whole)
    message = {"id": 7, "message": "go to the red box", "objects": OBJECTS, "robot": "A"}
    failure = {"kind": "error", "error_message": "no way", "failed_action": FAILED}
    for line in (message, failure):
        assert asked.is_valid(line)
        (answer,) = await answers(line)
        assert answered.is_valid(answer)
    assert not asked.is_valid(message | {"mesage": ""})
    assert answered.is_valid((await answers({"message": 1}))[0])
    assert not answered.is_valid(
        {"output": {"queue": [{"Go": {"input_parameters": {"a": {"pvf_type": "x"}}}}]}}
    )
