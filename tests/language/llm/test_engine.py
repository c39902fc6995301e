"""How a model is asked: parameters, pictures, every question, in every form of answer."""

from __future__ import annotations

import base64
import subprocess
import sys
from collections.abc import Mapping
from typing import Any

import numpy as np
import pytest

from parley.errors import FailureCode, LanguageError
from parley.language.base import ErrorSituation, InspectionReport, Picture, ReplyReading
from parley.language.llm.chain import BACK, GONE
from parley.language.llm.scripted_server import Say
from parley.messages.memory import MemoryEntry
from parley.robots.base import CameraImage, Detection
from tests.agents.crew import look
from tests.language.llm.rig import BOX, LOOK, LOOKS, model, situation


def picture() -> CameraImage:
    seen = (Detection("box", 40, (0, 0, 8, 5)),)
    return CameraImage(32, 24, "rgb8", np.zeros((24, 32, 3), np.uint8), 0.0, seen)


async def test_parameters_of_the_thesis_are_the_defaults() -> None:
    async with model() as asked:
        asked.will(LOOKS, Say(answer={"kind": "yes"}))
        await asked.language.interpret(situation())
        await asked.language.read_reply("Is it done?", "it is")
        plan, memory = (request.body for request in asked.server.requests)
        assert (plan["temperature"], plan["top_p"], plan["max_completion_tokens"]) == (0.1, 0.6, 2048)
        assert memory["max_completion_tokens"] == 1024


async def test_parameters_may_be_left_to_the_model() -> None:
    async with model(temperature=None, top_p=None) as asked:
        asked.will(LOOKS)
        await asked.language.interpret(situation())
        assert not {"temperature", "top_p"} & asked.server.requests[0].body.keys()


@pytest.mark.parametrize(
    ("form", "key"), [("tool", "tools"), ("native", "response_format"), ("prompted", "response_format")]
)
async def test_answer_is_asked_for_in_the_chosen_form(form: str, key: str) -> None:
    async with model(output=form) as asked:
        asked.will(LOOKS)
        assert (await asked.language.interpret(situation())).queue[0].name == "Look"
        assert key in asked.server.requests[0].body


async def test_picture_goes_along_with_what_the_robot_recognised() -> None:
    async with model() as asked:
        asked.will(Say(answer={"text": "There is a box.", "found": True, "wanted": "box"}))
        report = await asked.language.inspect(picture(), "is there a box?")
        assert report == InspectionReport("There is a box.", True, "box")
        parts: list[dict[str, Any]] = asked.server.requests[0].body["messages"][-1]["content"]
        assert parts[1]["image_url"]["url"].startswith("data:image/jpeg;base64,")
        assert '"box"' in parts[0]["text"]


def urls(body: Mapping[str, Any]) -> list[str]:
    content = body["messages"][-1]["content"]
    return [] if isinstance(content, str) else [p["image_url"]["url"] for p in content if "image_url" in p]


async def test_pictures_of_a_message_and_of_memory_go_along_in_their_order() -> None:
    pictures = (Picture("a.jpg", b"first", sent=True), Picture("desk", b"second"))
    async with model() as asked:
        asked.will(LOOKS)
        await asked.language.interpret(situation(pictures=pictures))
        data = [url.partition(",")[2] for url in urls(asked.server.requests[0].body)]
        assert data == [base64.b64encode(each.jpeg).decode() for each in pictures]


async def test_question_refused_with_its_pictures_is_asked_without_them_this_once() -> None:
    pictures = (Picture("a.jpg", b"first", sent=True),)
    async with model() as asked:
        asked.will(Say(status=400, body='{"error": {"message": "that picture is broken"}}'), LOOKS, LOOKS)
        for _ in range(2):
            assert (await asked.language.interpret(situation(pictures=pictures))).queue[0].name == "Look"
        bodies = [request.body for request in asked.server.requests]
        assert [len(urls(body)) for body in bodies] == [1, 0, 1]
        assert '"shown": false' in bodies[1]["messages"][-1]["content"]


async def test_pictures_may_be_kept_from_a_model() -> None:
    async with model(pictures=False) as asked:
        asked.will(LOOKS)
        await asked.language.interpret(situation(pictures=(Picture("a.jpg", b"first"),)))
        assert urls(asked.server.requests[0].body) == []


async def test_description_is_grounded_on_the_map() -> None:
    async with model() as asked:
        asked.will(
            Say(answer={"outcome": "match", "ids": ["box_9"]}),
            Say(answer={"outcome": "match", "ids": ["box_1"]}),
        )
        found = await asked.language.ground("where the parcels go", [BOX])
        assert (found.outcome, found.candidates) == ("match", (BOX,))


async def test_reply_is_read() -> None:
    async with model() as asked:
        asked.will(Say(answer={"kind": "choice", "choice": "red"}))
        assert await asked.language.read_reply("Which?", "that red one", ["red", "blue"]) == ReplyReading(
            "choice", "red"
        )


async def test_failure_is_resolved() -> None:
    async with model() as asked:
        asked.will(Say(answer={"message_response": "Which one?", "success": False, "choices": ["a", "b"]}))
        failure = ErrorSituation("Several fit.", look("box"), FailureCode.AMBIGUOUS, catalogue=(LOOK,))
        asks = await asked.language.resolve(failure)
        assert (asks.success, asks.choices) == (False, ("a", "b"))


async def test_nothing_is_asked_where_there_is_nothing_to_pick_from() -> None:
    async with model() as asked:
        assert await asked.language.select_memories("box", []) == []
        assert (await asked.language.ground("box", [])).outcome == "none"
        assert asked.server.requests == []


async def test_memories_are_not_waited_for_as_long_as_plans() -> None:
    async with model("builtin", memory_timeout_s=4.0) as asked:
        asked.will(Say(drop_after=0))
        entries = [MemoryEntry(name="box", data="The box is red.")]
        assert await asked.language.select_memories("the box", entries) == ["box"]


async def test_chain_answers_with_the_first_engine_that_can() -> None:
    async with model("local:other@http://127.0.0.1:9/v1", "builtin", retries=0) as asked:
        asked.will(Say(body="oops", status=500))
        order = await asked.language.interpret(situation(objects=(BOX,)))
        assert order.queue[-1].name == "Look"
        assert "built-in" in asked.language.label


async def test_change_of_engine_is_told_when_it_comes_and_when_it_is_over() -> None:
    async with model("builtin", retries=0, breaker_failures=9) as asked:
        gone = Say(body="oops", status=500)
        asked.will(LOOKS, gone, gone, LOOKS, LOOKS)
        told = [
            (await asked.language.interpret(situation(objects=(BOX,)))).message_response for _ in range(5)
        ]
    assert [GONE in text for text in told] == [False, True, False, False, False]
    assert [BACK in text for text in told] == [False, False, False, True, False]


async def test_failure_of_every_engine_is_that_of_the_first() -> None:
    async with model("local:other@http://127.0.0.1:9/v1", retries=0) as asked:
        asked.will(Say(body="{}", status=401))
        with pytest.raises(LanguageError) as caught:
            await asked.language.interpret(situation())
        assert "key" in caught.value.plain


def test_libraries_for_models_are_not_loaded_for_the_builtin_engine() -> None:
    code = (
        "import sys, parley.system, parley.cli; parley.cli.command_line();"
        "print('pydantic_ai' in sys.modules, 'openai' in sys.modules)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["False", "False"]


async def test_pictures_of_an_answer_go_along_when_a_failure_is_resolved() -> None:
    answer = Say(answer={"message_response": "I take that one.", "success": True})
    failure = ErrorSituation(
        "Several fit.", look("box"), FailureCode.AMBIGUOUS, catalogue=(LOOK,), reply="this one",
        pictures=(Picture("a.jpg", b"first", sent=True),),
    )  # fmt: skip
    async with model() as asked:
        asked.will(answer, Say(status=400, body='{"error": {"message": "no pictures"}}'), answer)
        for _ in range(2):
            assert (await asked.language.resolve(failure)).success
        bodies = [request.body for request in asked.server.requests]
        assert [len(urls(body)) for body in bodies] == [1, 1, 0]
        assert '"from": "the operator\'s message"' in bodies[0]["messages"][-1]["content"][0]["text"]
        assert '"shown": false' in bodies[2]["messages"][-1]["content"]
