"""What is said while a failed step is repaired: questions aside, orders, several robots, the record."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path

import pytest

from parley.agents.base import Node
from parley.agents.recovery.error_handler import ErrorHandler
from parley.agents.recovery.incident_log import UNSETTLED
from parley.agents.recovery.repair import MAX_NOTED
from parley.clock import SimClock, WallClock
from parley.demos.observer import Observer
from parley.errors import TransportError
from parley.language.llm.scripted import ScriptedLanguage
from parley.memory.incidents import IncidentStore
from parley.messages import topics
from parley.messages.chat import ChatAction, ChatImage, ChatInput, SystemCommand
from parley.messages.incident import GetIncidents, Incident, IncidentList
from parley.messages.memory import GetMemory, MemoryEntry, MemoryReply
from parley.messages.ros import ChatRequest, ChatResponse
from parley.messages.status import PlanStep, PlanUpdate, StopCommand, StopReport
from parley.messages.wire import decode, encode
from parley.transport.local import LocalTransport
from tests.agents.test_error_handler import ASK, SOLVED, Corrections, Room, look
from tests.memory.photos import photo

ASIDE = ChatAction(message_response="Because of the box.")
AGAIN = ChatAction(success=True, message_response="I try again.", queue=(look(),))


class Orders(Node):
    """Collects Chat Actions."""

    name = "orders"

    def __init__(self, transport: LocalTransport) -> None:
        super().__init__(transport)
        self.seen: list[ChatAction] = []

    async def open(self) -> None:
        await self.subscribe(topics.CHAT_ACTION, ChatAction, self.seen.append)


class Place(Room):
    """A room with more to look at."""

    transport: LocalTransport
    orders: Orders
    clock: SimClock

    async def incidents(self, robot: str = "", limit: int = 100) -> tuple[Incident, ...]:
        request = ChatRequest(encode(GetIncidents(robot=robot, limit=limit)))
        answer = await self.transport.call(topics.GET_INCIDENTS, request, timeout_s=5)
        return decode(IncidentList, answer.response).incidents

    async def endings(self) -> list[str]:
        return [incident.ending for incident in await self.incidents()]

    def answer(self, text: str, *targets: str, reply_to: str = "") -> None:
        said = ChatInput(message=text, targets=targets, type="response", reply_to=reply_to)
        self.observer.publish(topics.CHAT_INPUT, said)

    async def until(self, text: str) -> None:
        await self.observer.until(
            lambda: any(text in said.message for said in self.observer.said), timeout_s=5
        )

    async def corrected(self, count: int = 1) -> None:
        async with asyncio.timeout(5):
            while len(self.corrections.seen) < count:  # noqa: ASYNC110 - another node's list, not one event
                await asyncio.sleep(0.002)

    async def stopped(self, robot: str = "A") -> None:
        """The stop button, and its arrival everywhere."""
        self.observer.publish(topics.STOP, StopCommand(targets=(robot,)))
        self.observer.publish(topics.STOP_REPORT, StopReport(actor=robot, state="received"))
        for _ in range(20):
            await asyncio.sleep(0)

    def plan(self, state: str, *states: str, robot: str = "A") -> None:
        steps = tuple(PlanStep.model_validate({"action": look(), "state": item}) for item in states)
        update = PlanUpdate.model_validate(
            {"target": robot, "graph_name": "graph", "state": state, "steps": steps}
        )
        self.observer.publish(topics.PLAN, update)


@asynccontextmanager
async def opened(store: IncidentStore | None = None) -> AsyncIterator[Place]:
    language, clock = ScriptedLanguage(), SimClock()
    async with LocalTransport() as transport, Observer(transport, WallClock()) as observer:
        handler = ErrorHandler(transport, language, clock, incidents=store)
        async with handler, Corrections(transport) as corrections, Orders(transport) as orders:
            place = Place(language, observer, corrections)
            place.transport, place.orders, place.clock = transport, orders, clock
            yield place
        assert transport.handler_failures == 0


@pytest.fixture
async def place() -> AsyncIterator[Place]:
    async with opened() as found:
        yield found


# -- questions and orders in between --


async def test_question_is_answered_and_the_own_one_asked_again_without_counting(place: Place) -> None:
    place.language.will("resolve", ASK, *[ASIDE] * 5, SOLVED)
    place.fail()
    await place.said()
    for count in range(5):
        place.answer("why?", "A")
        await place.said(3 + 2 * count)
    place.answer("the red one", "A")
    await place.said(12)
    kinds = [said.type for said in place.observer.said]
    assert kinds == ["request", *["response", "request"] * 5, "info"]
    assert place.observer.said[2].message == ASK.message_response
    assert place.observer.said[2].choices == ASK.choices
    assert [correction.success for correction in place.corrections.seen] == [True]


async def test_after_an_answer_aside_the_question_is_put_as_at_first(place: Place) -> None:
    unclear = ASK.model_copy(update={"message_response": f"I did not understand. {ASK.message_response}"})
    place.language.will("resolve", ASK, unclear, ASIDE)
    place.fail()
    await place.said()
    for count, answer in enumerate(("hm", "why?")):
        place.answer(answer, "A")
        await place.said(2 + 2 * count)
    asked = [said.message for said in place.observer.said if said.type == "request"]
    assert asked == [ASK.message_response, unclear.message_response, ASK.message_response]


async def test_what_was_said_aside_is_part_of_the_dialogue(place: Place) -> None:
    place.language.will("resolve", ASK, ASIDE, SOLVED)
    place.fail()
    await place.said()
    place.answer("why?", "A")
    await place.said(3)
    place.answer("red", "A")
    await place.said(4)
    dialogue = [turn.content for turn in place.language.asked[-1][1].dialogue]
    assert dialogue == ["Which box do you mean?", "why?", "Because of the box."]


async def test_order_for_afterwards_goes_to_the_plan_and_the_question_stays_open(place: Place) -> None:
    later = ChatAction(message_response="I will do that afterwards.", queue=(look("door"),))
    place.language.will("resolve", ASK, later)
    place.fail()
    await place.said()
    place.answer("after that look at the door", "A")
    await place.said(3)
    (order,) = place.orders.seen
    assert (order.queue, order.targets) == ((look("door"),), ("A",))
    assert place.corrections.seen == []
    assert place.observer.questions.newest("A") is not None


async def test_order_behind_an_answer_is_handed_on_with_the_correction(place: Place) -> None:
    place.language.will("resolve", ASK, SOLVED.model_copy(update={"afterwards": (look("door"),)}))
    place.fail()
    await place.said()
    place.answer("the red one, then look at the door", "A")
    await place.corrected()
    await place.observer.until(lambda: bool(place.orders.seen), timeout_s=5)
    assert place.corrections.seen[0].afterwards == ()
    assert [(order.queue, order.targets) for order in place.orders.seen] == [((look("door"),), ("A",))]


async def test_other_order_instead_of_everything_is_recorded_as_that(place: Place) -> None:
    clear = SystemCommand(command="clear")
    place.language.will("resolve", ASK, ChatAction(success=True, queue=(look("door"),), system_cmd=(clear,)))
    place.fail()
    await place.said()
    place.answer("forget it, look at the door", "A")
    await place.corrected()
    assert await place.endings() == ["replaced"]


# -- alone --


@pytest.mark.parametrize("reason", ["", "another reason for the same"])
async def test_same_repair_is_not_tried_twice_without_asking(place: Place, reason: str) -> None:
    reworded = look().model_copy(update={"reason": reason})
    place.language.will("resolve", AGAIN, AGAIN.model_copy(update={"queue": (reworded,)}))
    place.fail()
    await place.corrected()
    place.fail()
    await place.until("What should I do?")
    assert len(place.corrections.seen) == 1
    assert place.language.asked[-1][1].tried == ((look(),),)


async def test_repairs_without_asking_come_to_an_end(place: Place) -> None:
    place.language.will(
        "resolve", *[ChatAction(success=True, queue=(look(), look(f"box {count}"))) for count in range(9)]
    )
    for count in range(1, 4):
        place.fail()
        await place.corrected(count)
    place.fail()
    await place.until("What should I do?")
    assert len(place.corrections.seen) == 3


async def test_repair_that_waits_is_carried_out_when_the_time_has_come(place: Place) -> None:
    place.language.will("resolve", AGAIN.model_copy(update={"delay_s": 60.0}))
    place.fail()
    await place.until("I try again.")
    assert place.corrections.seen == []
    place.clock.advance(59)
    await asyncio.sleep(0.02)
    assert place.corrections.seen == []
    place.clock.advance(2)
    await place.corrected()


@pytest.mark.parametrize("words", ["stop", "cancel everything", "skip it"])
async def test_repair_that_waits_is_dropped_when_the_operator_says_otherwise(
    place: Place, words: str
) -> None:
    place.language.will("resolve", AGAIN.model_copy(update={"delay_s": 60.0}))
    place.fail()
    await place.until("I try again.")
    place.observer.say(words, "A")
    await place.observer.until(
        lambda: any(incident.ending != "open" for incident in place.observer.incidents.values()), timeout_s=5
    )
    place.clock.advance(100)
    await asyncio.sleep(0.02)
    assert place.corrections.seen == []


async def test_stop_button_drops_a_repair_that_waits(place: Place) -> None:
    place.language.will("resolve", AGAIN.model_copy(update={"delay_s": 60.0}))
    place.fail()
    await place.until("I try again.")
    place.observer.publish(topics.STOP, StopCommand())
    await place.corrected()
    place.clock.advance(100)
    await asyncio.sleep(0.02)
    assert [correction.success for correction in place.corrections.seen] == [False]
    assert await place.endings() == ["held"]


async def test_open_question_is_asked_again_when_the_stop_is_released(place: Place) -> None:
    place.language.will("resolve", ASK, SOLVED)
    place.fail()
    await place.said()
    first = place.observer.said[0].id
    await place.stopped()
    place.answer("the red one", "A")
    await place.until("I was stopped for safety")
    assert place.corrections.seen == []
    place.observer.publish(topics.STOP_REPORT, StopReport(actor="A", state="reset"))
    await place.said(3)
    again = place.observer.said[2]
    assert (again.message, again.choices, again.closes) == (ASK.message_response, ASK.choices, first)
    place.answer("the red one", "A", reply_to=again.id)
    await place.corrected()
    assert place.corrections.seen[0].success is True


async def test_going_on_while_stopped_leaves_the_question_as_it_is(place: Place) -> None:
    place.language.will("resolve", ASK, SOLVED)
    place.fail()
    await place.said()
    await place.stopped()
    place.observer.say("carry on", "A")
    for _ in range(20):
        await asyncio.sleep(0)
    place.observer.publish(topics.STOP_REPORT, StopReport(actor="A", state="reset"))
    await place.said(2)
    place.answer("the red one", "A")
    await place.corrected()
    assert await place.endings() == ["open"]


async def test_nothing_is_tried_alone_while_stopped(place: Place) -> None:
    await place.stopped()
    place.language.will("resolve", AGAIN)
    place.fail()
    await place.said()
    assert place.observer.said[0].type == "request"
    assert place.corrections.seen == []


async def test_try_again_as_an_order_counts_on(place: Place) -> None:
    place.language.will("resolve", ASK, ASK, ASK, ASK)
    for count in (1, 2, 3):
        place.fail()
        await place.said(count)
        place.observer.say("try again", "A")
    place.fail()
    await place.until("I could not solve this")
    assert len(await place.incidents()) == 1


async def test_emergency_stop_during_a_repair_leaves_the_plan_for_the_next_order(place: Place) -> None:
    place.language.will("resolve", ASK)
    place.fail()
    await place.said()
    place.observer.say("emergency stop", "A")
    await place.corrected()
    assert place.corrections.seen[0].success is False


# -- several robots --


async def two_waiting(place: Place) -> tuple[str, str]:
    place.language.will("resolve", ASK, ASK)
    place.fail("A")
    place.fail("B")
    await place.said(2)
    ids = {said.targets[0]: said.id for said in place.observer.said}
    return ids["A"], ids["B"]


async def test_answer_goes_to_the_question_that_it_names(place: Place) -> None:
    _, second = await two_waiting(place)
    place.language.will("resolve", SOLVED)
    place.answer("the red one", "A", "B", reply_to=second)
    await place.corrected()
    assert place.corrections.seen[0].targets == ("B",)


async def test_answer_goes_to_the_robot_that_it_is_for(place: Place) -> None:
    await two_waiting(place)
    place.language.will("resolve", SOLVED)
    place.answer("the red one", "b")
    await place.corrected()
    assert place.corrections.seen[0].targets == ("B",)


@pytest.mark.parametrize("words", ["B, the red one", "the red one, B"])
@pytest.mark.parametrize("targets", [(), ("A",), ("A", "B")])
async def test_robot_that_is_called_by_name_gets_the_answer(
    place: Place, words: str, targets: tuple[str, ...]
) -> None:
    await two_waiting(place)
    place.language.will("resolve", SOLVED)
    place.answer(words, *targets)
    await place.corrected()
    assert [correction.targets for correction in place.corrections.seen] == [("B",)]


async def test_answer_for_nobody_is_asked_about_and_then_delivered(place: Place) -> None:
    await two_waiting(place)
    place.language.will("resolve", SOLVED)
    place.answer("the red one")
    await place.said(3)
    which = place.observer.said[2]
    assert (which.type, which.choices, which.message) == (
        "request", ("A", "B"), "Which robot do you mean, A or B?",
    )  # fmt: skip
    place.answer("B", reply_to=which.id)
    await place.corrected()
    assert place.corrections.seen[0].targets == ("B",)
    assert place.language.asked[-1][1].reply == "the red one"


async def test_kept_answer_is_forgotten_when_something_else_is_said(place: Place) -> None:
    await two_waiting(place)
    place.language.will("resolve", SOLVED)
    place.answer("the red one")
    await place.said(3)
    place.answer("the blue one", "A")
    await place.corrected()
    place.answer("B")
    await asyncio.sleep(0.02)
    assert [correction.targets for correction in place.corrections.seen] == [("A",)]


async def test_answer_for_nobody_is_for_the_only_robot_that_waits(place: Place) -> None:
    place.language.will("resolve", ASK, SOLVED)
    place.fail("A")
    await place.said()
    place.answer("the red one")
    await place.corrected()


# -- records --


async def test_record_says_what_happened_was_asked_answered_and_tried(place: Place) -> None:
    place.language.will("resolve", ASK, SOLVED)
    place.fail()
    await place.said()
    place.answer("the red one", "A")
    await place.corrected()
    (incident,) = await place.incidents()
    assert (incident.robot, incident.graph_name, incident.step, incident.code.value, incident.message) == (
        "A", "graph", look(), "ambiguous", "There are two boxes.",
    )  # fmt: skip
    (attempt,) = incident.attempts
    assert (attempt.kind, attempt.asked, attempt.answered, attempt.tried) == (
        "asked", "Which box do you mean?", "the red one", "I take the red box.",
    )  # fmt: skip
    assert (incident.ending, incident.closed_unix_ms) == ("open", 0)
    assert incident.opened_unix_ms > 0


async def test_record_is_solved_only_when_the_corrected_step_has_ended(place: Place) -> None:
    place.language.will("resolve", SOLVED)
    place.fail()
    await place.corrected()
    place.plan("running", "running", "queued")
    await asyncio.sleep(0.02)
    assert await place.endings() == ["open"]
    place.plan("running", "finished", "running")
    await place.observer.until(
        lambda: [i.ending for i in place.observer.incidents.values()] == ["solved"], timeout_s=5
    )
    assert (await place.incidents())[0].closed_unix_ms > 0


async def test_repeated_failure_goes_on_in_the_same_record(place: Place) -> None:
    place.language.will("resolve", AGAIN, ASK)
    place.fail()
    await place.corrected()
    place.fail()
    await place.until("Which box")
    (incident,) = await place.incidents()
    assert [attempt.kind for attempt in incident.attempts] == ["alone", "asked"]


async def test_failure_of_another_step_is_another_record(place: Place) -> None:
    place.language.will("resolve", AGAIN, ASK)
    place.fail()
    await place.corrected()
    place.fail(action_called=look("door"))
    await place.until("Which box")
    assert await place.endings() == ["open", "solved"]


@pytest.mark.parametrize(
    ("words", "ending"), [("stop", "held"), ("cancel everything", "cancelled"), ("skip it", "skipped")]
)
async def test_record_ends_as_the_operator_ends_it(place: Place, words: str, ending: str) -> None:
    place.language.will("resolve", ASK)
    place.fail()
    await place.said()
    place.observer.say(words, "A", answer=True)
    await place.observer.until(
        lambda: [i.ending for i in place.observer.incidents.values()] == [ending], timeout_s=5
    )
    assert await place.endings() == [ending]


async def test_record_of_one_robot_can_be_asked_for(place: Place) -> None:
    await two_waiting(place)
    assert [incident.robot for incident in await place.incidents("b")] == ["B"]
    assert len(await place.incidents(limit=1)) == 1


async def test_request_that_cannot_be_read_is_refused(place: Place) -> None:
    with pytest.raises(TransportError):
        await place.transport.call(topics.GET_INCIDENTS, ChatRequest('{"limit": 0}'), timeout_s=5)
    await place.observer.until(lambda: bool(place.observer.refusals), timeout_s=5)


async def test_what_an_earlier_process_left_open_is_closed_with_a_note(tmp_path: Path) -> None:
    async with await IncidentStore.open(tmp_path / "incidents.db", WallClock()) as store:
        await store.save(Incident(id="old", robot="A", step=look(), message="A box."))
    async with (
        await IncidentStore.open(tmp_path / "incidents.db", WallClock()) as store,
        opened(store) as place,
    ):
        (incident,) = await place.incidents()
        assert (incident.ending, incident.note) == ("cancelled", UNSETTLED)


async def test_everything_is_written_when_the_node_closes(tmp_path: Path) -> None:
    async with await IncidentStore.open(tmp_path / "incidents.db", WallClock()) as store:
        async with opened(store) as place:
            place.language.will("resolve", ASK)
            place.fail()
            await place.said()
            place.observer.say("cancel everything", "A", answer=True)
            await place.observer.until(
                lambda: [i.ending for i in place.observer.incidents.values()] == ["cancelled"], timeout_s=5
            )
        assert [incident.ending for incident in await store.newest()] == ["cancelled"]


# -- the same thing at once, twice, too late --


async def test_of_two_answers_to_one_question_the_first_counts(place: Place) -> None:
    place.language.will("resolve", ASK, ASK, SOLVED)
    place.fail()
    await place.said()
    first = place.observer.said[0].id
    place.answer("the second one", "A", reply_to=first)
    place.answer("skip it", "A", reply_to=first)
    await place.said(2)
    assert [incident.ending for incident in await place.incidents()] == ["open"]
    place.answer("the red one", "A", reply_to=first)
    place.answer("the blue one", "A", reply_to=place.observer.said[1].id)
    await place.corrected()
    replies = [asked.reply for question, asked in place.language.asked if question == "resolve"]
    assert replies == [None, "the second one", "the blue one"]


async def test_answer_sent_twice_is_no_answer_to_the_next_question(place: Place) -> None:
    place.language.will("resolve", ASK, ASK, SOLVED)
    place.fail()
    await place.said()
    said = ChatInput(message="the second one", targets=("A",), type="response", id="x1")
    place.observer.publish(topics.CHAT_INPUT, said)
    await place.said(2)
    place.observer.publish(topics.CHAT_INPUT, said)
    place.answer("the red one", "A")
    await place.corrected()
    replies = [asked.reply for question, asked in place.language.asked if question == "resolve"]
    assert replies == [None, "the second one", "the red one"]


async def test_question_of_a_handler_that_was_started_anew_is_closed(tmp_path: Path) -> None:
    path = tmp_path / "incidents.db"
    async with await IncidentStore.open(path, WallClock()) as store, opened(store) as place:
        place.language.will("resolve", ASK)
        place.fail()
        await place.said()
        asked = place.observer.said[0].id
    async with (
        await IncidentStore.open(path, WallClock()) as store,
        LocalTransport() as transport,
        Observer(transport, WallClock()) as observer,
        ErrorHandler(transport, ScriptedLanguage(), WallClock(), incidents=store),
    ):
        await observer.until(lambda: bool(observer.said), timeout_s=5)
        assert (observer.said[0].closes, observer.said[0].targets) == (asked, ("A",))
        assert "started anew" in observer.said[0].message


async def test_record_of_an_endless_talk_stays_bounded(place: Place) -> None:
    place.language.will("resolve", ASK, *[ASIDE] * MAX_NOTED)
    place.fail()
    await place.said()
    for count in range(MAX_NOTED):
        place.answer("why?", "A")
        await place.said(3 + 2 * count)
    (incident,) = await place.incidents()
    assert (len(incident.attempts), incident.questions) == (MAX_NOTED, MAX_NOTED + 1)


async def test_picture_in_an_answer_goes_along_with_it(place: Place) -> None:
    place.language.will("resolve", ASK, ASIDE, SOLVED)
    place.fail()
    await place.said()
    image = ChatImage(name="here.jpg", data=photo())
    for text in ("", "this one"):
        said = ChatInput(message=text, targets=("A",), type="response", images=(image,))
        place.observer.publish(topics.CHAT_INPUT, said)
        if not text:
            await place.said(3)  # the answer aside, and the question again
    await place.corrected()
    bare, worded = (situation for _, situation in place.language.asked[-2:])
    assert (bare.reply, worded.reply) == ("", "this one")
    for situation in (bare, worded):
        (picture,) = situation.pictures
        assert (picture.name, picture.sent) == ("here.jpg", True)
        assert picture.jpeg.startswith(b"\xff\xd8")
    assert worded.dialogue[1].content == "(a picture)"
    (incident,) = await place.incidents()
    assert [attempt.answered for attempt in incident.attempts][-1] == "this one"


async def test_memory_is_asked_again_with_the_answer(place: Place) -> None:
    asked: list[str] = []
    known = MemoryEntry(name="key_location", data="Kim has the key.", info="where the key is")

    async def remember(request: ChatRequest) -> ChatResponse:
        asked.append(decode(GetMemory, request.message).request)
        return ChatResponse(encode(MemoryReply.of([known] if "key" in asked[-1] else [])))

    server = await place.transport.serve(topics.GET_MEMORY, remember)
    place.language.will("resolve", ASK, SOLVED)
    place.fail()
    await place.said()
    place.answer("the one whose key we lost", "A")
    await place.corrected()
    await server.close()
    before, after = (situation for _, situation in place.language.asked[-2:])
    assert "There are two boxes." in asked[0] and "key" not in asked[0]
    assert "There are two boxes." in asked[1] and "the one whose key we lost" in asked[1]
    assert (before.memory, [entry.name for entry in after.memory]) == ((), ["key_location"])
