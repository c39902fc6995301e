"""What is remembered does not grow with the length of a run, nor with what is sent in."""

from __future__ import annotations

import asyncio
import gc
import json
from collections import deque
from types import FunctionType, ModuleType
from typing import Any

from parley.agents.planner.orders import MOST_STEPS, MOST_WAITING, MUCH_TO_DO
from parley.agents.planner.unattended import UnattendedPlans
from parley.agents.rules.lookout import Lookout
from parley.clock import WallClock
from parley.gate.heard import Heard
from parley.latest import KEPT
from parley.messages import topics
from parley.messages.chat import ChatAction, ChatFeedback, ChatInput
from parley.messages.status import GraphEvent
from tests.agents.crew import ENGINE, KIM, crew, look

MESSAGES = 6 * 2 * KEPT  # of each of five kinds more than may be kept
DOUBLES = ("Observer", "Wire", "ScriptedLanguage", "Body")


def largest(root: object) -> dict[str, int]:
    """Collections of our objects with more than the usual number of entries."""
    found: dict[str, int] = {}
    seen, left = {id(root)}, [root]
    while left:
        item = left.pop()
        if type(item).__name__ in DOUBLES:
            continue
        if type(item).__module__.startswith("parley.") and hasattr(item, "__dict__"):
            for name, value in vars(item).items():
                if isinstance(value, dict | list | set | deque) and len(value) > 2 * KEPT:
                    found[f"{type(item).__name__}.{name}"] = len(value)
        for other in gc.get_referents(item):
            if id(other) in seen or isinstance(other, type | ModuleType):
                continue
            seen.add(id(other))
            if isinstance(other, FunctionType):
                left += [cell.cell_contents for cell in other.__closure__ or ()]
            else:
                left.append(other)
    return found


def messages(number: int) -> list[tuple[Any, Any]]:
    """One of everything, each from and for somebody new."""
    name, key = f"R{number}", f"m{number}"
    yes = ChatInput(message="yes", targets=("A",), id=f"{key}a", type="response", reply_to=key)
    running = GraphEvent(actor=name, graph_name=key, kind="graph", state="RUNNING", sequence=number)
    return [
        (topics.CHAT_INPUT, ChatInput(message="look", targets=(name,), id=key, unattended="hold")),
        (topics.CHAT_INPUT, yes),
        (topics.CHAT_FEEDBACK, ChatFeedback(message="Who?", targets=("A",), type="request", id=f"{key}q")),
        (topics.CHAT_FEEDBACK, ChatFeedback(message="Well?", targets=(name,), type="request", id=f"{key}r")),
        (topics.GRAPH_EVENTS, running),
    ]


def order(number: int) -> ChatAction:
    call = look(f"box {number}")
    return ChatAction(
        queue=(call,), targets=("A",), message_response="ok", by=ENGINE, behalf=KIM, id=f"o{number}"
    )


async def test_a_long_run_is_remembered_by_its_end() -> None:
    async with crew("A", talking=True, ask_first=["A"]) as party:
        heard, told = Heard(), list[Any]()
        await party.transport.subscribe(topics.RULING, told.append, depth=MESSAGES)
        async with (
            UnattendedPlans(party.transport, WallClock(), "go_on", 60.0),
            Lookout(party.transport, WallClock()),
        ):
            party.transport.heard = heard  # type: ignore[attr-defined]
            for number in range(MESSAGES // 5):
                for topic, message in messages(number):
                    party.observer.publish(topic, message)
                    if isinstance(message, ChatInput):
                        heard.on_input(message)
                    await asyncio.sleep(0)
                party.observer.publish(topics.CHAT_ACTION, order(number))
                await asyncio.sleep(0)
            await party.settled()
            assert largest(party.transport) == {}
            rulings = [json.loads(ruling.data)["outcome"] for ruling in told]
            assert rulings == ["asked"] * MOST_WAITING + ["refused"] * (MESSAGES // 5 - MOST_WAITING)


async def test_a_plan_grows_no_longer_than_a_person_could_mean_and_that_is_told() -> None:
    async with crew("A") as party:
        party.body.gate("box 0")
        party.order(*(look(f"box {number}") for number in range(MOST_STEPS)))
        await party.until(lambda: len(party.steps()) == MOST_STEPS)
        party.order(look("box"))
        await party.hears(MUCH_TO_DO)
        assert len(party.steps()) == MOST_STEPS
