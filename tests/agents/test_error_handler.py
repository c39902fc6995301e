"""The error handler over a real local transport; the test plays the planner and the operator."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from dataclasses import dataclass, field
from typing import Any

import pytest

from parley.agents.base import Node
from parley.agents.recovery.error_handler import ErrorHandler
from parley.clock import WallClock
from parley.demos.observer import Observer
from parley.errors import FailureCode, LanguageError
from parley.language.llm.scripted import ScriptedLanguage
from parley.messages import topics
from parley.messages.chat import ActionCall, ChatAction, Flow, FlowIf
from parley.messages.failure import ErrorHandlingMessage
from parley.messages.incident import IncidentList
from parley.messages.pvf import Parameter
from parley.messages.ros import ChatRequest
from parley.messages.status import ActorStatus, PlanUpdate
from parley.messages.wire import decode
from parley.transport.local import LocalTransport
from tests.gate.test_cards import CATALOGUE, drive, find

ASK = ChatAction(success=False, message_response="Which box do you mean?", choices=("red box", "blue box"))


def look(what: str = "box") -> ActionCall:
    return ActionCall(
        name="Look", input_parameters={"what": Parameter("string", what)}, reason=f"look at {what}"
    )


SOLVED = ChatAction(success=True, message_response="I take the red box.", queue=(look("red box"),))


class Corrections(Node):
    """Collects what the error handler sends to the planner."""

    name = "corrections"

    def __init__(self, transport: LocalTransport) -> None:
        super().__init__(transport)
        self.seen: list[ChatAction] = []

    async def open(self) -> None:
        await self.subscribe(topics.UMRF_CORRECTION, ChatAction, self.seen.append)


@dataclass
class Room:
    language: ScriptedLanguage
    observer: Observer
    corrections: Corrections
    count: int = field(default=0)

    def fail(self, robot: str = "A", **changes: Any) -> None:
        self.count += 1
        message = ErrorHandlingMessage(
            error_message="There are two boxes.",
            action_called=look(),
            target=robot,
            code=FailureCode.AMBIGUOUS,
            failure_id=f"graph/Look_{self.count}",
        ).model_copy(update=changes)
        self.observer.publish(topics.ERROR_HANDLING, message)
        self.observer.publish(topics.PLAN, PlanUpdate(target=robot, state="held"))

    async def said(self, count: int = 1) -> list[str]:
        await self.observer.until(lambda: len(self.observer.said) >= count, timeout_s=5)
        return [said.message for said in self.observer.said]


@pytest.fixture
async def room() -> AsyncIterator[Room]:
    language = ScriptedLanguage()
    async with LocalTransport() as transport, Observer(transport, WallClock()) as observer:
        async with ErrorHandler(transport, language, WallClock()), Corrections(transport) as corrections:
            yield Room(language, observer, corrections)
        assert transport.handler_failures == 0


async def test_failure_that_can_be_repaired_alone_is_not_asked_about(room: Room) -> None:
    room.language.will("resolve", SOLVED)
    room.fail()
    await room.said()
    assert [said.type for said in room.observer.said] == ["info"]
    (correction,) = room.corrections.seen
    assert (correction.targets, correction.success) == (("A",), True)


async def test_question_carries_choices_and_the_answer_repairs(room: Room) -> None:
    room.language.will("resolve", ASK, SOLVED)
    room.fail()
    await room.said()
    question = room.observer.said[0]
    assert (question.type, question.choices) == ("request", ("red box", "blue box"))
    room.observer.say("the red one", "A", answer=True)
    assert (await room.said(2))[1] == "I take the red box."
    situation = room.language.asked[-1][1]
    assert situation.reply == "the red one"
    assert [turn.content for turn in situation.dialogue] == ["Which box do you mean?"]


@pytest.mark.spec("P18")
async def test_after_three_questions_the_robot_is_held_and_what_remains_is_said(room: Room) -> None:
    room.language.will("resolve", ASK, ASK, ASK, ASK)
    room.fail(umrf_queue=(look("door"),))
    for count in (1, 2, 3):
        await room.said(count)
        room.observer.say("purple", "A", answer=True)
    last = (await room.said(4))[3]
    assert "look at box; look at door" in last
    (correction,) = room.corrections.seen
    assert (correction.success, [c.command for c in correction.system_cmd]) == (False, ["stop"])


async def test_of_a_search_that_fails_people_read_the_step_that_it_is_made_for(room: Room) -> None:
    room.observer.publish(topics.ACTOR_STATUS, ActorStatus(actor="A", catalogue=CATALOGUE))
    search = find("box", "find the box")
    drives = drive(reason="go to the box").model_copy(update={"flow": Flow(if_=FlowIf(step=7))})
    room.language.will("resolve", ASK, ASK, ASK, ASK)
    room.fail(action_called=search, umrf_queue=(drives,))
    for count in (1, 2, 3):
        await room.said(count)
        room.observer.say("purple", "A", answer=True)
    assert "Left to do: go to the box." in (await room.said(4))[3]
    incident = await room.observer.transport.call(topics.GET_INCIDENTS, ChatRequest("{}"), timeout_s=5)
    (found,) = decode(IncidentList, incident.response).incidents
    assert found.label == "Go to “box”"


async def test_attempts_count_on_when_the_repaired_step_fails_in_the_same_way(room: Room) -> None:
    room.language.will("resolve", ASK, SOLVED, ASK, SOLVED, ASK, SOLVED, ASK)
    for count in (1, 2, 3):
        room.fail()
        await room.said(2 * count - 1)
        room.observer.say("red", "A", answer=True)
        await room.said(2 * count)
    room.fail()
    await room.said(7)
    assert room.corrections.seen[-1].success is False


@pytest.mark.spec("P8")
async def test_same_failure_reported_twice_is_handled_once(room: Room) -> None:
    room.language.will("resolve", ASK, ASK)
    room.fail()
    room.fail(failure_id="graph/Look_1")
    await room.said()
    await asyncio.sleep(0.05)
    assert len(room.observer.said) == 1


async def test_language_that_fails_asks_with_the_failures_own_sentence(room: Room) -> None:
    room.language.will("resolve", LanguageError("gone"))
    room.fail()
    assert "There are two boxes." in (await room.said())[0]


async def test_stop_ends_the_repair_and_a_late_answer_of_the_language_engine_moves_nobody(room: Room) -> None:
    hanging = asyncio.Event()
    room.language.will("resolve", ASK, hanging, SOLVED)
    room.fail()
    await room.said()
    room.observer.say("the red one", "A", answer=True)
    room.observer.say("stop", "A")
    await asyncio.sleep(0.05)
    hanging.set()
    await asyncio.sleep(0.05)
    assert room.corrections.seen == []


async def test_plan_that_goes_on_for_another_reason_withdraws_the_question(room: Room) -> None:
    room.language.will("resolve", ASK)
    room.fail()
    await room.said()
    await asyncio.sleep(0.01)
    room.observer.publish(topics.PLAN, PlanUpdate(target="A", state="running"))
    await room.said(2)
    assert room.observer.questions.newest("A") is None


@pytest.mark.spec("P18", "P20")
async def test_one_robots_hanging_repair_does_not_delay_another(room: Room) -> None:
    room.language.will("resolve", asyncio.Event(), SOLVED)
    room.language.will("resolve", SOLVED)
    room.fail("A")
    room.fail("B")
    await room.said()
    assert [said.targets for said in room.observer.said] == [("B",)]


async def test_operator_is_told_when_a_repair_takes_long_and_stop_lets_go_of_it() -> None:
    language = ScriptedLanguage()
    async with LocalTransport() as transport, Observer(transport, WallClock()) as observer:
        handler = ErrorHandler(transport, language, WallClock(), patience_s=0.0)
        async with handler, Corrections(transport) as corrections:
            room = Room(language, observer, corrections)
            language.will("resolve", asyncio.Event(), ASK)
            room.fail()
            assert "still working out" in (await room.said())[0]
            observer.say("stop", "A")
            room.fail()
            await observer.until(lambda: observer.questions.newest("A") is not None, timeout_s=5)
        assert transport.handler_failures == 0
