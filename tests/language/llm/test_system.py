"""A whole system on a scripted model: the plan is driven, and what a bad model says reaches no engine."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager

import pytest

from parley.config import SystemConfig
from parley.demos.catalogue import load_demo
from parley.language.llm.scripted_server import Say, ScriptedServer
from tests.agents.crew import Wire
from tests.demos.house import House, running


def going(place: str) -> Say:
    queue = [
        {"action": "GetCoordinates", "parameters": {"target": place}, "reason": f"find {place}"},
        {"action": "NavigateTo", "parameters": {}, "reason": f"go to {place}"},
    ]
    return Say(answer={"message_response": f"I am going to {place}.", "queue": queue})


GO = going("the fridge")


@asynccontextmanager
async def home(*fallback: str) -> AsyncIterator[tuple[House, ScriptedServer, Wire]]:
    async with ScriptedServer() as server:
        config = SystemConfig.model_validate(
            {
                "speed": None,
                "language": f"local:m@{server.url}",
                "language_fallback": fallback,
                "model": {"backoff_s": 0.01},
            }
        )
        async with (
            running(load_demo("nursing-home").system(config)) as house,
            Wire(house.system.transport) as wire,  # type: ignore[arg-type]
        ):
            yield house, server, wire


async def test_robot_drives_where_the_model_says() -> None:
    async with home() as (house, server, wire):
        server.will(GO)
        told = await house.say("I would love something cold, go and see")
        assert told.message == "I am going to the fridge."
        assert set(await house.done()) == {"finished"}
        assert house.distance_m("refrigerator_1") < 1.0
        assert wire.commands() == ["start"]
        assert house.system.usage.totals()["asked"] == 1


@pytest.mark.parametrize(
    "answers",
    [
        [Say(body="oops", status=500)] * 3,
        [Say(text="nonsense")] * 3,
        [Say(answer={"message_response": "Off I fly!", "queue": [{"action": "Fly"}]})] * 3,
        [Say(answer={"message_response": "I go.", "queue": [{"action": "NavigateTo"}]})] * 3,
        [Say(drop_after=0)] * 3,
        [Say(answer=GO.answer, drop_after=5)] * 3,
    ],
    ids=["broken", "nonsense", "unknown action", "no place to go to", "drops", "drops in mid-stream"],
)
async def test_bad_model_moves_no_robot(answers: list[Say]) -> None:
    async with home() as (house, server, wire):
        server.will(*answers)
        told = await house.say("go to the fridge")
        assert told.type == "error"
        assert "Nothing was started" in told.message
        await asyncio.sleep(0.05)
        assert wire.commands() == []
        assert house.observer.events == []


async def test_system_goes_on_with_the_builtin_engine_when_the_model_is_gone() -> None:
    async with home("builtin") as (house, server, _):
        server.always(Say(body="oops", status=500))
        assert "simpler one" in (await house.say("go to the fridge")).message
        assert set(await house.done()) == {"finished"}
        assert house.distance_m("refrigerator_1") < 1.0


async def test_failed_step_is_asked_about_and_repaired_by_the_model() -> None:
    def resolution(text: str, **changes: object) -> Say:
        return Say(answer={"message_response": text} | changes)

    small = [{"action": "GetCoordinates", "parameters": {"target": "the small sofa"}}]
    async with home() as (house, server, wire):
        server.will(
            going("the sofa"),
            resolution("Which sofa?", success=False, choices=["the large one", "the small one"]),
            resolution("I take the small one.", success=True, queue=small),
        )
        await house.say("go to the sofa")
        question = await house.question()
        assert (question.message, question.choices) == ("Which sofa?", ("the large one", "the small one"))
        house.observer.say("the small one", house.robot, answer=True)
        assert set(await house.done()) == {"finished"}
        assert house.distance_m("sofa_small") < 1.0
        assert set(wire.commands()) == {"start", "modify"}
        recovery = [request.texts[-1] for request in server.requests if "Which sofa?" in request.texts[-1]]
        assert '"the small one"\n</operator_message>' in recovery[0]
