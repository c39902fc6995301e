"""Local first: who answers what, and what happens where two understand a thing differently."""

from __future__ import annotations

from collections.abc import AsyncIterator
from contextlib import asynccontextmanager

from parley.agents.planner.check import plan_problems
from parley.config import ModelSettings
from parley.errors import FailureCode
from parley.language.base import ErrorSituation, ReplyReading
from parley.language.llm import build_language
from parley.language.llm.auto import AutoLanguage
from parley.language.llm.chain import GONE
from parley.language.llm.scripted_server import Say, ScriptedServer
from parley.messages.status import ActionInfo
from parley.world.object_map import MapObject
from tests.language.llm.rig import LOOK_PLAN, situation

GATE, BOX = MapObject("gate_1", "gate", 1.0, 2.0, "gate"), MapObject("box_1", "red box", 3.0, 2.0, "box")
LOOK = ActionInfo(
    name="Look", inputs={"what": "string"}, description="Look at a thing.", phrases=("look at {what}",),
    effects=("looks",),
)  # fmt: skip
BURN = LOOK.model_copy(update={"effects": ("cannot_be_undone",)})


def plan(what: str) -> Say:
    return Say(
        answer=LOOK_PLAN
        | {"queue": [{"action": "Look", "parameters": {"what": what}, "reason": f"see {what}"}]}
    )


@asynccontextmanager
async def auto() -> AsyncIterator[tuple[AutoLanguage, ScriptedServer]]:
    async with ScriptedServer() as server:
        language = build_language(
            [f"auto:local:m@{server.url}"], ModelSettings(retries=0), check=plan_problems
        )
        assert isinstance(language, AutoLanguage)
        async with language:
            yield language, server


async def test_certain_order_needs_no_model_and_the_rest_goes_to_it() -> None:
    async with auto() as (language, server):
        server.will(plan("red box"))
        known = {"catalogue": (LOOK,), "objects": (GATE, BOX)}
        sure = await language.interpret(situation("look at the red box", **known))
        assert (sure.queue[0].name, len(server.requests)) == ("Look", 0)
        asked = await language.interpret(
            situation("kindly acquaint yourself with whatever parcels use", **known)
        )
        assert (asked.queue[0].name, len(server.requests)) == ("Look", 1)
        assert "no language model" in sure.engine
        assert asked.engine == "language model local:m"


async def test_what_cannot_be_undone_is_put_to_both_and_to_the_person_if_they_differ() -> None:
    async with auto() as (language, server):
        server.will(plan("the red box"), plan("gate"))
        known = {"catalogue": (BURN,), "objects": (GATE, BOX)}
        same = await language.interpret(situation("look at the red box", **known))
        assert (same.queue[0].name, len(server.requests)) == ("Look", 1)
        other = await language.interpret(situation("look at the red box", **known))
        assert (other.queue, len(other.choices)) == ((), 2)
        assert all(choice in other.message_response for choice in other.choices)
        server.will(Say(answer={"message_response": "Which box do you mean?"}))
        asks = await language.interpret(situation("look at the red box", **known))
        assert (asks.queue, asks.message_response) == ((), "Which box do you mean?")


async def test_model_that_is_gone_leaves_the_local_question() -> None:
    async with auto() as (language, server):
        server.always(Say(status=500, body="oops"))
        answer = await language.interpret(
            situation("kindly acquaint yourself with parcels", catalogue=(LOOK,))
        )
        assert not answer.queue
        assert "no language model" in answer.engine
        assert answer.message_response.startswith(GONE)


async def test_choice_that_was_offered_is_taken_without_a_model() -> None:
    async with auto() as (language, server):
        assert await language.read_reply("Which?", "The red box.", ["red box"]) == ReplyReading(
            "choice", "red box"
        )
        details = {
            "candidates": [{"id": "a", "description": "red box"}, {"id": "b", "description": "blue box"}]
        }
        failed = ErrorSituation(
            "Several fit.", (await language.interpret(
                situation("look at the gate", catalogue=(LOOK,), objects=(GATE,)))).queue[0],
            FailureCode.AMBIGUOUS, details, reply="the red box", robot="A",
        )  # fmt: skip
        solved = await language.resolve(failed)
        assert (solved.success, solved.queue[0].input_parameters["what"].value) == (True, "red box")
        assert server.requests == []


async def test_danger_and_standing_still_wait_for_no_model() -> None:
    async with auto() as (language, server):
        for words in ("somebody fell down the stairs!", "there is smoke in the hall"):
            answer = await language.interpret(situation(words, question="Which box?", catalogue=(LOOK,)))
            assert answer.alarm, words
        assert server.requests == []
