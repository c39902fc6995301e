"""What understanding costs: the built-in engine, and what is added to a model's own time."""

from __future__ import annotations

import time
from collections.abc import Awaitable, Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final

from parley.actions.builtin import BUILTIN_ACTIONS
from parley.agents.planner.check import plan_problems
from parley.config import ModelSettings
from parley.language.base import Situation
from parley.language.builtin.engine import BuiltinLanguage
from parley.language.llm import build_language
from parley.language.llm.answers import PlanAnswer
from parley.language.llm.reading import read_plan
from parley.language.llm.scripted_server import Say, ScriptedServer
from parley.language.prompts import compose_interpret
from parley.messages.memory import MemoryEntry
from parley.umrf.catalogue import Catalogue
from parley.world.geometry import Pose2D
from parley.world.object_map import MapObject

__all__ = ["LanguageFigures", "measure_language"]

MESSAGES: Final = (
    "go to box {n}",
    "look at box {n}",
    "go to box {n}, then inspect it",
    "where is box {n}?",
    "remember that box {n} is empty",
    "what can you do?",
)
OBJECTS: Final = 40
MEMORIES: Final = 20
WARM_UP: Final = 5


@dataclass(frozen=True, slots=True)
class LanguageFigures:
    """What messages took, in milliseconds."""

    case: str
    latency_ms: tuple[float, ...]
    """Wall time of each."""
    cpu_ms: float
    """Time of the processor for one, on average; says more than wall time while the machine is busy."""


async def measure_language(times: int) -> list[LanguageFigures]:
    """Answer `times` messages each: built in, and by a model that answers at once (whole, and streamed).

    What the model cases take is what is added to a model's own time, and what the scripted server itself
    takes. Beside them stands what their parts take alone: the same requests sent by nothing but an HTTP
    client, and by the provider's client, and Parley's own share: composing what a model is told, and checking
    its answer. The rest is the library that runs the model's agents.
    """
    situations = [_situation(number) for number in range(WARM_UP + times)]
    async with BuiltinLanguage() as builtin:
        figures = [await _measure("builtin", builtin.interpret, situations)]
    async with ScriptedServer() as server:
        server.always(Say(answer=_PLAN, pieces=20))
        settings = ModelSettings(max_tokens_per_hour=None)
        language = build_language([f"local:scripted@{server.url}"], settings, check=plan_problems)
        async with language:  # type: ignore[attr-defined]
            figures.append(await _measure("model_overhead", language.interpret, situations))
            bodies = [request.body for request in server.requests]

            async def streamed(situation: Situation) -> None:
                await language.interpret(situation, on_draft=lambda _: None)

            figures.append(await _measure("model_overhead_streamed", streamed, situations))
        figures.append(await _measure("of_it_own_work", _own_work, situations))
        figures += await _measure_clients(server, bodies)
    return figures


async def _measure_clients(
    server: ScriptedServer, bodies: Sequence[Mapping[str, Any]]
) -> list[LanguageFigures]:
    """The same questions without anything of Parley around them."""
    import httpx2

    from parley.language.llm.models import ModelSpec, make_model

    model: Any = make_model(ModelSpec.parse(f"local:scripted@{server.url}"), "")
    async with httpx2.AsyncClient() as bare, model:

        async def post(body: Mapping[str, Any]) -> None:
            (await bare.post(f"{server.url}/chat/completions", json=body)).json()

        async def create(body: Mapping[str, Any]) -> None:
            await model.client.chat.completions.create(**body)

        return [
            await _measure("of_it_server_and_http", post, bodies),
            await _measure("of_it_server_and_providers_client", create, bodies),
        ]


async def _own_work(situation: Situation) -> None:
    compose_interpret(situation)
    read_plan(PlanAnswer.model_validate(_PLAN), situation, plan_problems)


async def _measure(
    case: str, ask: Callable[[Any], Awaitable[object]], questions: Sequence[object]
) -> LanguageFigures:
    taken_ms: list[float] = []
    cpu_s = 0.0
    for number, question in enumerate(questions):
        if number == WARM_UP:
            cpu_s = time.process_time()
        start_s = time.perf_counter()
        await ask(question)
        taken_ms.append(1000 * (time.perf_counter() - start_s))
    cpu_ms = 1000 * (time.process_time() - cpu_s) / (len(questions) - WARM_UP)
    return LanguageFigures(case, tuple(taken_ms[WARM_UP:]), cpu_ms)


_PLAN: Final = {
    "message_response": "I will go to the box and look at it.",
    "queue": [
        {"action": "GetCoordinates", "parameters": {"target": "box 1"}, "reason": "find the box"},
        {"action": "NavigateTo", "parameters": {}, "reason": "go to the box"},
        {"action": "Inspect", "parameters": {"inspect": "box 1"}, "reason": "look at the box"},
    ],
}


def _situation(number: int) -> Situation:
    message = MESSAGES[number % len(MESSAGES)].format(n=1 + number % OBJECTS)
    things = tuple(MapObject(f"box_{n}", f"box {n}", float(n), 1.0, "box") for n in range(1, OBJECTS + 1))
    known = tuple(
        MemoryEntry(name=f"fact_{n}", data=f"Box {n} belongs to room {n}.") for n in range(MEMORIES)
    )
    return Situation(
        message,
        memory=known,
        objects=things,
        robot_pose=Pose2D(0.0, 0.0, 0.0),
        robot="Robot",
        robots=("Robot",),
        catalogue=Catalogue(BUILTIN_ACTIONS).infos(),
    )
