"""What was taught for the case that something is seen happens when an action tells of it."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Sequence
from contextlib import AsyncExitStack, asynccontextmanager
from dataclasses import dataclass, field
from typing import Any

import pytest

from parley.agents.base import Node
from parley.agents.memory import MemoryNode
from parley.agents.rules.lookout import Lookout
from parley.clock import SimClock
from parley.language.llm.scripted import ScriptedLanguage
from parley.memory.store import MemoryStore
from parley.messages import topics
from parley.messages.chat import ActionCall, ChatAction, ChatFeedback, ChatInput
from parley.messages.memory import AddToMemory, MemoryBody, MemoryEntry, MemoryEvent, RemoveMemory
from parley.messages.principal import Principal, person
from parley.messages.pvf import Parameter
from parley.messages.status import GraphEvent, PlanStep, PlanUpdate
from parley.transport.base import Transport
from parley.transport.local import LocalTransport

RULE = "If you see a crack, stop and tell me"


class Others(Node):
    """Engine, planner and operator."""

    name = "others"

    def __init__(self, transport: Transport) -> None:
        super().__init__(transport)
        self.orders: list[ChatAction] = []
        self.said: list[ChatFeedback] = []
        self.asked: list[ChatInput] = []
        self.kept: list[MemoryEvent] = []

    async def open(self) -> None:
        await self.subscribe(topics.CHAT_ACTION, ChatAction, self.orders.append)
        await self.subscribe(topics.CHAT_FEEDBACK, ChatFeedback, self.said.append)
        await self.subscribe(topics.CHAT_INPUT, ChatInput, self.asked.append)
        await self.subscribe(topics.MEMORY_EVENT, MemoryEvent, self.kept.append)


@dataclass
class Rig:
    others: Others
    clock: SimClock
    count: int = field(default=0)

    @property
    def commands(self) -> list[str]:
        return [command.command for order in self.others.orders for command in order.system_cmd]

    @property
    def told(self) -> list[str]:
        return [said.message for said in self.others.said]

    async def teach(self, sentence: str, name: str = "protocol_1", **where: str) -> None:
        """Returns when the rule is known."""
        body = MemoryBody(data=sentence, info=sentence, by=person("Kim"), **where)
        self.others.publish(topics.ADD_TO_MEMORY, AddToMemory({name: body}))
        await self.until(lambda: any(event.name == name for event in self.others.kept))
        await self.settled()

    def plan(self, *states: str, robot: str = "A") -> None:
        steps = [
            PlanStep.model_validate({"action": ActionCall(name="Look"), "node": f"Look_{n}", "state": state})
            for n, state in enumerate(states)
        ]
        self.others.publish(topics.PLAN, PlanUpdate(target=robot, state="running", steps=tuple(steps)))

    def event(self, robot: str = "A", **of: Any) -> None:
        self.count += 1
        event = GraphEvent(actor=robot, graph_name="g", sequence=self.count, **{"kind": "node", **of})
        self.others.publish(topics.GRAPH_EVENTS, event)

    def ended(self, *texts: str, result: str = "on_true", node: str = "Look_0", robot: str = "A") -> None:
        outputs = {f"text_{n}": Parameter("string", text) for n, text in enumerate(texts)}
        self.event(robot, state="FINISHED", node=node, result=result, outputs=outputs)

    async def until(self, condition: Any) -> None:
        async with asyncio.timeout(5):
            while not condition():  # noqa: ASYNC110 - several parties' states are awaited, not one event
                await asyncio.sleep(0.002)

    async def settled(self) -> None:
        await asyncio.sleep(0.05)


@asynccontextmanager
async def rig(known: Sequence[MemoryEntry] = ()) -> AsyncIterator[Rig]:
    async with AsyncExitStack() as stack:
        transport, clock = await stack.enter_async_context(LocalTransport()), SimClock()
        store = await stack.enter_async_context(await MemoryStore.open(":memory:"))
        for entry in known:
            await store.add(entry)
        await stack.enter_async_context(MemoryNode(transport, store, ScriptedLanguage()))
        others = await stack.enter_async_context(Others(transport))
        await stack.enter_async_context(Lookout(transport, clock))
        here = Rig(others, clock)
        await here.settled()
        yield here


async def test_result_that_tells_of_it_stops_the_robot_and_tells_the_operator() -> None:
    async with rig() as here:
        await here.teach(RULE)
        here.plan("running", "queued")
        here.ended("I can see a wall. There is a crack in it.")
        await here.until(lambda: here.told and here.commands)
        assert here.commands == ["stop"]
        assert here.others.orders[0].targets == ("A",)
        assert here.told == [
            f"There is a crack in it. You told me: “{RULE}”. So I have stopped. Say “carry on” when I should"
            " go on, or tell me what to do."
        ]
        assert here.others.said[0].sources == ("protocol_1",)


async def test_what_is_told_on_the_way_counts_and_is_acted_on_once_in_a_step() -> None:
    async with rig() as here:
        await here.teach(RULE)
        here.plan("running", "queued")
        for text in ("3 m to go", "2 m to go, I see a crack on the left", "1 m to go, I see a crack"):
            here.event(kind="progress", node="Drive_0", progress_text=text)
        here.ended("passed a crack", node="Drive_0")
        await here.until(lambda: here.told)
        await here.settled()
        assert here.commands == ["stop"]
        here.event(state="RUNNING", node="Drive_1")
        here.event(kind="progress", node="Drive_1", progress_text="another crack")
        await here.until(lambda: len(here.told) == 2)
        assert here.commands == ["stop", "stop"]


async def test_labels_of_what_was_recognised_count() -> None:
    async with rig() as here:
        await here.teach(RULE)
        seen = {"seen": Parameter("strings", ["wall", "large crack"])}
        here.event(state="FINISHED", node="Look_0", result="on_true", outputs=seen)
        await here.until(lambda: here.told)
        assert here.told[0].startswith("I see: large crack. You told me:")


@pytest.mark.parametrize(
    ("report", "tells"), [("I can see a visitor.", True), ("I can see nobody.", False), ("All done.", False)]
)
async def test_a_rule_about_anybody_is_about_every_person(report: str, tells: bool) -> None:
    async with rig() as here:
        await here.teach("tell me if you see anybody")
        here.ended(report)
        await here.settled()
        assert bool(here.told) is tells


async def test_what_an_action_remembers_counts() -> None:
    async with rig() as here:
        await here.teach(RULE)
        here.plan("running", robot="B")
        robot = Principal(kind="robot", name="B")
        body = MemoryBody(data="I saw a crack near the door.", info="crack", source="B/Patrol", by=robot)
        here.others.publish(topics.ADD_TO_MEMORY, AddToMemory({"sighting": body}))
        await here.until(lambda: here.told)
        assert here.others.said[0].targets == ("B",)


@pytest.mark.parametrize(
    "report",
    [
        "I cannot see a crack. I can see a wall.",
        "There is no crack.",
        "The wall is without a crack!",
        "I looked at the wall.",
    ],
)
async def test_that_something_is_not_there_is_no_sighting(report: str) -> None:
    async with rig() as here:
        await here.teach(RULE)
        here.ended(report)
        await here.settled()
        assert (here.told, here.commands) == ([], [])


async def test_failure_is_the_error_handlers() -> None:
    async with rig() as here:
        await here.teach(RULE)
        here.ended("I see a crack.", result="on_error")
        await here.settled()
        assert here.told == []


async def test_rule_that_only_asks_to_be_told_stops_nobody() -> None:
    async with rig() as here:
        await here.teach("Whenever you notice a crack, let me know")
        here.plan("running", "queued")
        here.ended("a crack")
        await here.until(lambda: here.told)
        assert here.told == ["a crack. You told me: “Whenever you notice a crack, let me know”."]
        assert here.commands == []


async def test_rule_may_order_something() -> None:
    async with rig() as here:
        await here.teach("If you see a crack, go to the desk")
        here.ended("a crack")
        await here.until(lambda: here.others.asked)
        asked = here.others.asked[0]
        assert (asked.message, asked.targets, here.told[0][-12:]) == (
            "go to the desk",
            ("A",),
            "I do so now.",
        )


async def test_rule_may_make_it_wait_unless_somebody_says_something() -> None:
    async with rig() as here:
        await here.teach("If you see a crack, wait two minutes")
        here.plan("running", "queued")
        here.ended("a crack")
        await here.until(lambda: here.told)
        here.clock.advance(119.0)
        await here.settled()
        assert here.commands == ["stop"]
        here.clock.advance(2.0)
        await here.until(lambda: here.commands == ["stop", "start"])
        here.event(state="RUNNING", node="Look_1")
        here.plan("finished", "running", "queued")
        here.ended("a crack", node="Look_1")
        await here.until(lambda: here.commands == ["stop", "start", "stop"])
        here.others.publish(topics.CHAT_INPUT, ChatInput(message="cancel everything", targets=("A",)))
        await here.settled()
        here.clock.advance(500.0)
        await here.settled()
        assert here.commands == ["stop", "start", "stop"]


async def test_when_nothing_is_left_to_do_the_robot_says_that_it_waits() -> None:
    async with rig() as here:
        await here.teach(RULE)
        here.plan("finished", "running")
        here.ended("a crack", node="Look_1")
        await here.until(lambda: here.told)
        assert here.told[0].endswith("So I wait here. Please tell me what to do.")


async def test_rules_of_one_robot_are_that_robots_and_forgotten_ones_are_over() -> None:
    async with rig() as here:
        await here.teach(RULE, scope="B")
        here.ended("a crack")
        await here.settled()
        assert here.told == []
        here.ended("a crack", robot="B")
        await here.until(lambda: here.told)
        here.others.publish(topics.REMOVE_MEMORY, RemoveMemory({"protocol_1": {}}))
        await here.until(lambda: here.others.kept[-1].kind == "removed")
        here.event("B", state="RUNNING", node="Look_1")
        here.ended("a crack", robot="B", node="Look_1")
        await here.settled()
        assert len(here.told) == 1


async def test_rules_of_earlier_days_are_known_and_changed_ones_replaced() -> None:
    long_ago = [MemoryEntry(name="rule", data=RULE, info=RULE, source="Kim")]
    others = [MemoryEntry(name=f"m{n}", data=f"I see box {n} every day.", info="x") for n in range(50)]
    async with rig([*long_ago, *others]) as here:
        here.ended("a crack")
        await here.until(lambda: here.told)
        await here.teach("If you see a puddle, tell me", name="rule")
        here.event(state="RUNNING", node="Look_1")
        here.ended("a crack", node="Look_1")
        await here.settled()
        assert len(here.told) == 1
        here.ended("a puddle", node="Look_1")
        await here.until(lambda: len(here.told) == 2)


@pytest.mark.parametrize(
    "sentence",
    [
        "When the way is blocked, wait a minute and try again.",
        "If anything fails, tell me.",
        "The crack is old.",
    ],
)
async def test_rules_about_failures_and_facts_are_no_rules_about_sights(sentence: str) -> None:
    async with rig() as here:
        await here.teach(sentence)
        here.ended("The way is blocked by a crack, anything fails.")
        await here.settled()
        assert here.told == []


async def test_what_a_robot_remembers_teaches_nothing() -> None:
    async with rig() as here:
        await here.teach(RULE, source="A/Read")
        await here.settled()
        here.ended("a crack")
        await here.settled()
        assert (here.commands, here.told) == ([], [])
