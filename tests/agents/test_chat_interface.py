"""The chat interface over a real local transport; the test plays the operator, the robots and the memory."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from dataclasses import dataclass
from typing import Any

import pytest

from parley.agents.base import Node
from parley.agents.chat.chat_interface import ChatInterface
from parley.agents.chat.texts import MAX_CHARS, is_never_mind
from parley.clock import WallClock
from parley.demos.observer import Observer
from parley.errors import FailureCode, LanguageError
from parley.language.llm.scripted import ScriptedLanguage
from parley.messages import topics
from parley.messages.chat import (
    ActionCall,
    Aside,
    ChatAction,
    ChatFeedback,
    ChatInput,
    ChatRead,
    LeftOpen,
    ReplyDraft,
    SystemCommand,
)
from parley.messages.failure import ErrorHandlingMessage
from parley.messages.memory import MemoryEvent
from parley.messages.pvf import Parameter
from parley.messages.status import (
    ActionInfo,
    ActorStatus,
    GraphEvent,
    PlanDecision,
    PlanProposal,
    PlanStep,
    PlanUpdate,
    StopCommand,
)
from parley.messages.wire import decode
from parley.transport.local import LocalTransport
from tests.transport.backends import until

LOOK = ActionInfo(name="Look", inputs={"what": "string"}, description="Look at something.")


class Listener(Node):
    """Collects what the chat interface sends to the planner and to the engines."""

    name = "listener"

    def __init__(self, transport: LocalTransport) -> None:
        super().__init__(transport)
        self.orders: list[ChatAction] = []
        self.stops: list[StopCommand] = []
        self.arrived = asyncio.Event()

    async def open(self) -> None:
        await self.subscribe(topics.CHAT_ACTION, ChatAction, self._on_order)
        await self.subscribe(topics.STOP, StopCommand, self._on_stop)

    def _on_order(self, order: ChatAction) -> None:
        self.orders.append(order)
        self.arrived.set()

    def _on_stop(self, stop: StopCommand) -> None:
        self.stops.append(stop)
        self.arrived.set()


@dataclass
class Room:
    """Everything a test needs."""

    language: ScriptedLanguage
    observer: Observer
    planner: Listener
    transport: LocalTransport

    def robot(self, name: str) -> None:
        self.observer.publish(topics.ACTOR_STATUS, ActorStatus(actor=name, catalogue=(LOOK,)))

    async def reply(self, count: int = 1) -> str:
        await self.observer.until(lambda: len(self.observer.said) >= count, timeout_s=5)
        return self.observer.said[count - 1].message

    async def orders(self) -> list[ChatAction]:
        async with asyncio.timeout(5):
            await self.planner.arrived.wait()
        return self.planner.orders


@pytest.fixture
async def room() -> AsyncIterator[Room]:
    async with opened() as found:
        yield found


@asynccontextmanager
async def opened(**settings: Any) -> AsyncIterator[Room]:
    language = ScriptedLanguage()
    async with LocalTransport() as transport, Observer(transport, WallClock()) as observer:
        chat = ChatInterface(transport, language, WallClock(), **settings)
        async with chat, Listener(transport) as planner:
            room = Room(language, observer, planner, transport)
            room.robot("A")
            room.robot("B")
            await observer.until(lambda: {"A", "B"} <= observer.robots, timeout_s=5)
            yield room
        assert transport.handler_failures == 0


def look(what: str = "box") -> ActionCall:
    return ActionCall(name="Look", input_parameters={"what": Parameter("string", what)})


async def test_order_is_answered_and_handed_to_the_planner(room: Room) -> None:
    room.language.will("interpret", ChatAction(message_response="I will look.", queue=(look(),)))
    room.observer.say("look at the box", "A")
    assert await room.reply() == "I will look."
    (order,) = await room.orders()
    assert (order.targets, [call.name for call in order.queue]) == (("A",), ["Look"])


@pytest.mark.spec("P20")
async def test_history_reaches_the_next_question(room: Room) -> None:
    room.language.will(
        "interpret", ChatAction(message_response="Which?"), ChatAction(message_response="Fine.")
    )
    room.observer.say("look at the box", "A")
    await room.reply()
    room.observer.say("the red one", "A")
    await room.reply(2)
    situation = room.language.asked[-1][1]
    assert [turn.content for turn in situation.history] == ["look at the box", "Which?"]


@pytest.mark.spec("P21")
async def test_what_is_still_to_be_done_is_known_when_the_next_message_is_understood(room: Room) -> None:
    steps = (
        PlanStep(action=look("box"), id="one", state="running"),
        PlanStep(action=look("chair"), id="two"),
    )
    room.observer.publish(topics.PLAN, PlanUpdate(target="A", state="running", steps=steps))
    pop = SystemCommand(command="pop", arguments={"parameters": 1})
    room.language.will("interpret", ChatAction(message_response="Fine.", system_cmd=(pop,)))
    room.observer.say("and not the chair", "A")
    await room.reply()
    situation = room.language.asked[-1][1]
    assert [call.input_parameters["what"].value for call in situation.queue] == ["box", "chair"]
    assert situation.status == "running"
    (order,) = await room.orders()
    assert order.system_cmd[0].arguments == {"parameters": 1, "step": "two"}  # whatever ends meanwhile


async def test_of_what_is_said_meanwhile_only_what_a_step_tells_belongs_to_it(room: Room) -> None:
    publish = room.observer.publish
    begun = GraphEvent(actor="A", graph_name="g", sequence=0, kind="node", state="RUNNING", node="Look_0")
    publish(topics.GRAPH_EVENTS, begun)
    steps = (PlanStep(action=look(), id="one", node="Look_0", state="running"),)
    publish(topics.PLAN, PlanUpdate(target="A", graph_name="g", state="running", steps=steps))
    for text, by_step in (("I see a box.", True), ("Nobody is connected any more.", False)):
        said = ChatFeedback(message=text, targets=("A",), type="info", by_step=by_step)
        publish(topics.CHAT_FEEDBACK, said)
    room.language.will("interpret", ChatAction(message_response="Fine."))
    room.observer.say("what did you do?", "A")
    await room.reply(3)
    (deed,) = room.language.asked[-1][1].dialogue.deeds
    assert deed.told == ("I see a box.",)


@pytest.mark.parametrize("text", ["", "   ", "\n"])
async def test_empty_message_is_answered_without_asking_anybody(room: Room, text: str) -> None:
    room.observer.say(text, "A")
    assert "words" in await room.reply()
    assert room.language.asked == []


async def test_overlong_message_is_answered_without_asking_anybody(room: Room) -> None:
    room.observer.say("word " * (MAX_CHARS // 4), "A")
    assert "too long" in await room.reply()
    assert room.language.asked == []


async def test_hundred_kilobytes_are_refused_in_one_short_sentence(room: Room) -> None:
    room.observer.say("x" * 100_000, "A")
    assert len(await room.reply()) < 200


async def test_unknown_robot_is_named_with_those_that_exist(room: Room) -> None:
    room.observer.say("look", "Z")
    reply = await room.reply()
    assert "Z" in reply
    assert "A, B" in reply
    assert room.planner.orders == []


async def test_who_was_not_heard_of_yet_just_after_a_start_is_held_and_then_gets_what_was_said(
    room: Room,
) -> None:
    room.observer.publish(topics.CHAT_INPUT, ChatInput(message="stop", targets=("Z",), id="m1"))
    room.observer.publish(topics.CHAT_INPUT, ChatInput(message="stop", targets=("A",), id="m2"))
    await room.planner.arrived.wait()
    assert [(stop.command, stop.targets) for stop in room.planner.stops][:1] == [("hold", ("Z",))]
    room.robot("Z")
    async with asyncio.timeout(5):
        while len(room.planner.orders) < 2:
            room.planner.arrived.clear()
            await room.planner.arrived.wait()
    assert [order.targets for order in room.planner.orders] == [("Z",), ("A",)], "in their order"


async def test_message_without_an_addressee_moves_nobody(room: Room) -> None:
    room.observer.publish(topics.CHAT_INPUT, ChatInput(message="look"))
    assert "Which robot" in await room.reply()
    assert room.planner.orders == []


async def test_stop_goes_ahead_of_a_language_call_that_hangs(room: Room) -> None:
    room.language.will("interpret", asyncio.Event())
    room.observer.say("look at the box", "A")
    await room.observer.until(lambda: True)
    room.observer.say("stop", "A")
    (order,) = await room.orders()
    assert [command.command for command in order.system_cmd] == ["stop"]


async def test_order_that_is_still_being_understood_when_stop_comes_moves_nobody(room: Room) -> None:
    hanging = asyncio.Event()
    room.language.will("interpret", hanging, ChatAction(message_response="I will look.", queue=(look(),)))
    room.observer.say("look at the box", "A")
    room.observer.say("stop", "A")
    await room.reply()
    hanging.set()
    assert "told me to stop" in await room.reply(2)
    assert [order.queue for order in room.planner.orders] == [()]


async def test_carry_on_after_an_emergency_stop_says_what_to_do_first(room: Room) -> None:
    room.observer.publish(topics.ACTOR_STATUS, ActorStatus(actor="A", state="stopped", catalogue=(LOOK,)))
    room.observer.say("carry on", "A")
    assert "Release the stop first" in await room.reply()
    assert room.planner.orders == []


async def test_one_robots_hanging_language_call_does_not_delay_another(room: Room) -> None:
    hanging = asyncio.Event()
    room.language.will("interpret", hanging, ChatAction(message_response="late"))
    room.language.will("interpret", ChatAction(message_response="I will look.", queue=(look(),)))
    room.observer.say("look at the box", "A")
    room.observer.say("look at the door", "B")
    await room.reply()
    assert [said.targets for said in room.observer.said] == [("B",)]
    hanging.set()
    await room.reply(2)
    assert [said.targets for said in room.observer.said] == [("B",), ("A",)]


async def test_robot_named_in_a_stop_wins_over_the_selected_one(room: Room) -> None:
    room.observer.say("B, stop!", "A")
    (order,) = await room.orders()
    assert order.targets == ("B",)


async def test_what_is_said_to_two_robots_for_both_moves_each_of_them_once(room: Room) -> None:
    both = ChatAction(message_response="I will look.", queue=(look(),), targets=("A", "B"))
    room.language.will("interpret", both, both)
    room.observer.publish(topics.CHAT_INPUT, ChatInput(message="both, look at the box", targets=("A", "B")))
    await room.reply(2)
    assert sorted(order.targets for order in room.planner.orders) == [("A",), ("B",)]


async def test_what_is_said_to_two_robots_for_one_moves_only_that_one(room: Room) -> None:
    one = ChatAction(message_response="I will look.", queue=(look(),), targets=("B",))
    room.language.will("interpret", one, one)
    room.observer.publish(topics.CHAT_INPUT, ChatInput(message="B, look at the box", targets=("A", "B")))
    await room.reply(2)
    assert sorted(said.message for said in room.observer.said) == ["I will look.", "That is for B."]
    assert [order.targets for order in room.planner.orders] == [("B",)]


@pytest.mark.parametrize(
    ("called", "heard"), [(("B",), ["I will look.", "That is for B."]), (("A", "B"), ["I will look."])]
)
async def test_those_who_will_do_it_say_so_whoever_heard_it(
    room: Room, called: tuple[str, ...], heard: list[str]
) -> None:
    room.language.will(
        "interpret", ChatAction(message_response="I will look.", queue=(look(),), targets=called)
    )
    room.observer.publish(
        topics.CHAT_INPUT, ChatInput(message=f"{' and '.join(called)}, look at the box", targets=("A",))
    )
    await room.reply(len(heard))
    assert sorted(said.message for said in room.observer.said) == heard
    assert [said.targets for said in room.observer.said if said.message == "I will look."] == [called]


async def test_a_question_about_what_another_robot_is_told_is_asked_by_that_one(room: Room) -> None:
    room.language.will(
        "interpret", ChatAction(message_response="Which box?", choices=("red", "blue"), targets=("B",))
    )
    room.observer.say("B, look at the box", "A")
    await room.reply(2)
    asked = {said.targets: (said.message, said.choices) for said in room.observer.said}
    assert asked == {("A",): ("That is for B.", ()), ("B",): ("Which box?", ("red", "blue"))}


async def test_emergency_stop_goes_straight_to_the_engines(room: Room) -> None:
    room.observer.say("emergency stop", "A")
    await room.orders()
    assert room.planner.stops[0].targets == ("A",)


@pytest.mark.spec("P20")
async def test_language_that_fails_ends_in_a_plain_sentence(room: Room) -> None:
    room.language.will("interpret", LanguageError("the model is gone"))
    room.observer.say("look at the box", "A")
    assert "try again" in await room.reply()
    assert room.planner.orders == []


async def test_defect_of_the_language_engine_ends_in_a_plain_sentence(room: Room) -> None:
    room.language.will("interpret", ZeroDivisionError())
    room.observer.say("look at the box", "A")
    assert "went wrong" in await room.reply()
    assert room.planner.orders == []


@pytest.mark.parametrize(
    "call",
    [
        ActionCall(name="Fly"),
        ActionCall(name="Look", input_parameters={"where": Parameter("string", "here")}),
        ActionCall(name="Look", input_parameters={"what": Parameter("number", 3.0)}),
        ActionCall(name="Look"),
    ],
    ids=["unknown action", "unknown parameter", "wrong type", "missing value"],
)
@pytest.mark.spec("P12")
async def test_plan_that_the_robot_cannot_carry_out_never_leaves(room: Room, call: ActionCall) -> None:
    room.language.will("interpret", ChatAction(message_response="Sure.", queue=(call,)))
    room.observer.say("do something", "A")
    assert "cannot carry out" in await room.reply()
    assert room.planner.orders == []


async def test_memory_is_acknowledged_only_after_it_is_stored(room: Room) -> None:
    command = SystemCommand(command="add_memory", arguments={"data": "the key is red", "info": "key"})
    room.language.will("interpret", ChatAction(message_response="Noted.", system_cmd=(command,)))
    room.observer.say("the key is red", "A")
    (order,) = await room.orders()
    await asyncio.sleep(0.05)
    assert room.observer.said == []
    name = order.system_cmd[0].arguments["name"]
    room.observer.publish(topics.MEMORY_EVENT, MemoryEvent(kind="added", name=name))
    assert await room.reply() == "Noted."


async def test_memory_that_could_not_be_stored_is_not_acknowledged(room: Room) -> None:
    command = SystemCommand(command="add_memory", arguments={"data": "the key is red", "name": "key"})
    room.language.will("interpret", ChatAction(message_response="Noted.", system_cmd=(command,)))
    room.observer.say("the key is red", "A")
    await room.orders()
    room.observer.publish(
        topics.MEMORY_EVENT, MemoryEvent(kind="failed", name="key", message="The disk is full.")
    )
    assert "could not store" in await room.reply()


async def test_of_several_who_are_told_the_same_each_acknowledges_it_when_it_is_stored(room: Room) -> None:
    command = SystemCommand(command="add_memory", arguments={"data": "the key is red", "name": "key"})
    understood = ChatAction(message_response="Noted.", system_cmd=(command,))
    room.language.will("interpret", understood, understood)
    said = ChatInput(message="the key is red", targets=("A", "B"), id="both")
    room.observer.publish(topics.CHAT_INPUT, said)
    await until(lambda: len(room.planner.orders) == 2)
    for _ in range(2):
        room.observer.publish(topics.MEMORY_EVENT, MemoryEvent(kind="added", name="key"))
    assert {await room.reply(1), await room.reply(2)} == {"Noted."}


async def test_each_message_is_said_to_be_read_also_one_that_is_known_already(room: Room) -> None:
    read: list[str] = []
    await room.transport.subscribe(topics.CHAT_READ, lambda m: read.append(decode(ChatRead, m.data).id))
    await until(lambda: read == [""])  # who comes late learns that messages are read here
    room.language.will("interpret", ChatAction(message_response="Fine."))
    for _ in range(2):
        room.observer.publish(topics.CHAT_INPUT, ChatInput(message="look", targets=("A",), id="m1"))
    await until(lambda: read == ["", "m1", "m1"])


async def test_message_sent_twice_is_handled_once(room: Room) -> None:
    room.language.will("interpret", ChatAction(message_response="1"), ChatAction(message_response="2"))
    said = ChatInput(message="look", targets=("A",), id="same")
    room.observer.publish(topics.CHAT_INPUT, said)
    room.observer.publish(topics.CHAT_INPUT, said)
    await room.reply()
    await asyncio.sleep(0.05)
    assert len(room.observer.said) == 1


async def test_what_a_program_says_on_and_on_is_done_once_and_told_once_but_stop_counts_each_time(
    room: Room,
) -> None:
    room.language.will("interpret", ChatAction(message_response="I will look.", queue=(look(),)))
    for _ in range(4):
        room.observer.publish(topics.CHAT_INPUT, ChatInput(message="look", targets=("A",)))
    await room.observer.until(lambda: len(room.observer.said) == 2, timeout_s=5)
    for _ in range(3):
        room.observer.publish(topics.CHAT_INPUT, ChatInput(message="stop", targets=("A",)))
    await room.observer.until(lambda: len(room.planner.orders) == 4, timeout_s=5)
    told = sorted(feedback.message for feedback in room.observer.said[:2])
    assert told == ["I will look.", "The same comes again and again. I take it as said once."]
    assert [len(order.queue) for order in room.planner.orders] == [1, 0, 0, 0]


async def test_what_a_robot_says_was_no_answer_is_read_in_the_persons_words_or_not_at_all(room: Room) -> None:
    said = ChatInput(message="what is it for?", targets=("A",), type="response", id="m1", reply_to="q1")
    question = ChatFeedback(message="Is it done?", targets=("A",), type="request", id="q1")
    room.observer.publish(topics.CHAT_FEEDBACK, question)
    room.observer.publish(topics.CHAT_INPUT, said)
    aside = Aside(actor="A", reply_to="q1", id="m1", message="come here")
    room.observer.publish(topics.ASIDE, aside.model_copy(update={"id": "invented"}))
    room.observer.publish(topics.ASIDE, aside)
    room.language.will("interpret", ChatAction(message_response="For the desk."))
    await until(lambda: any(feedback.message == "For the desk." for feedback in room.observer.said))
    assert [asked.message for what, asked in room.language.asked if what == "interpret"] == [
        "what is it for?"
    ]


async def test_answer_that_nobody_waits_for_is_taken_as_an_order(room: Room) -> None:
    room.language.will("interpret", ChatAction(message_response="I will look."))
    room.observer.publish(topics.CHAT_INPUT, ChatInput(message="look", targets=("A",), type="response"))
    assert await room.reply() == "I will look."


async def test_draft_of_a_reply_is_published_for_the_message_it_answers(room: Room) -> None:
    drafts: list[ReplyDraft] = []
    await room.observer.subscribe(topics.REPLY_DRAFT, ReplyDraft, drafts.append)
    room.language.will("interpret", "I will", "I will look", ChatAction(message_response="I will look."))
    room.observer.publish(topics.CHAT_INPUT, ChatInput(message="look", targets=("A",), id="m1"))
    assert await room.reply() == "I will look."
    assert drafts[0] == ReplyDraft(reply_to="m1", targets=("A",), message="I will")
    assert len(drafts) == 1  # the second came too soon after the first


async def test_message_without_an_id_gets_no_drafts(room: Room) -> None:
    drafts: list[ReplyDraft] = []
    await room.observer.subscribe(topics.REPLY_DRAFT, ReplyDraft, drafts.append)
    room.language.will("interpret", "I will", ChatAction(message_response="I will look."))
    room.observer.publish(topics.CHAT_INPUT, ChatInput(message="look", targets=("A",)))
    assert await room.reply() == "I will look."
    assert drafts == []


@pytest.mark.parametrize(
    ("message", "targets"),
    [("look", ("A",)), ("stop", ("A",)), ("look", ("Nobody",)), ("look", ()), (" ", ("A",))],
    ids=["plan", "stop", "unknown robot", "no robot", "no words"],
)
async def test_every_reply_names_the_message_it_answers(
    room: Room, message: str, targets: tuple[str, ...]
) -> None:
    room.language.will("interpret", ChatAction(message_response="Yes."))
    room.observer.publish(topics.CHAT_INPUT, ChatInput(message=message, targets=targets, id="m7"))
    await room.reply()
    assert room.observer.said[0].reply_to == "m7"


async def test_reason_of_the_language_engine_is_told_in_its_plain_words(room: Room) -> None:
    room.language.will("interpret", LanguageError("HTTP 500", plain="My helper is asleep."))
    room.observer.publish(topics.CHAT_INPUT, ChatInput(message="look", targets=("A",)))
    assert await room.reply() == "My helper is asleep. Nothing was started; please try again."


async def test_operator_is_told_when_understanding_takes_long() -> None:
    async with opened(patience_s=0.0) as room:
        gate = asyncio.Event()
        room.language.will("interpret", gate, ChatAction(message_response="At last."))
        room.observer.say("look at the box", "A")
        assert "I am still thinking about “look at the box”" in await room.reply()
        assert room.observer.said[0].type == "info"
        gate.set()
        assert await room.reply(2) == "At last."


async def test_stop_lets_go_of_a_message_that_takes_long_and_the_next_one_is_heard() -> None:
    async with opened(patience_s=0.0) as room:
        never = asyncio.Event()
        room.language.will("interpret", never, ChatAction(message_response="Here I am."))
        room.observer.say("look at the box", "A")
        await room.reply()
        room.observer.say("stop", "A")
        assert "so I leave this: “look at the box”" in await room.reply(3)
        room.observer.say("hello", "A")
        assert await room.reply(4) == "Here I am."
        assert [order.queue for order in room.planner.orders] == [()]


async def test_question_during_a_repair_is_understood_with_the_failure(room: Room) -> None:
    failure = ErrorHandlingMessage(
        error_message="There are two boxes.", action_called=look(), target="A", code=FailureCode.AMBIGUOUS
    )
    room.observer.publish(topics.ERROR_HANDLING, failure)
    room.observer.publish(topics.PLAN, PlanUpdate(target="A", state="held"))
    ask = ChatFeedback(message="Which box?", targets=("A",), type="request", id="q1")
    room.observer.publish(topics.CHAT_FEEDBACK, ask)
    await room.reply()
    room.language.will("interpret", ChatAction(message_response="Because there are two."))
    room.observer.say("why?", "A")
    assert await room.reply(2) == "Because there are two."
    situation = room.language.asked[-1][1]
    assert situation.failure.error_message == "There are two boxes."
    assert situation.question == "Which box?"
    room.observer.publish(topics.PLAN, PlanUpdate(target="A", state="running"))
    room.language.will("interpret", ChatAction(message_response="Fine."))
    room.observer.say("hello", "A")
    await room.reply(3)
    assert room.language.asked[-1][1].failure is None


@pytest.mark.parametrize("words", ["the red one", "skip it", "try again"])
async def test_answer_to_a_settled_question_is_neither_an_order_nor_a_control(room: Room, words: str) -> None:
    ask = ChatFeedback(message="Which box?", targets=("A",), type="request", id="q1")
    room.observer.publish(topics.CHAT_FEEDBACK, ask)
    room.observer.publish(topics.CHAT_FEEDBACK, ChatFeedback(message="Ok.", targets=("A",), closes="q1"))
    await room.reply(2)
    answer = ChatInput(message=words, targets=("A",), type="response", reply_to="q1")
    room.observer.publish(topics.CHAT_INPUT, answer)
    assert await room.reply(3) == f"My question is settled already, so I leave this: “{words}”"
    assert (room.language.asked, room.planner.orders) == ([], [])


async def test_stop_stops_whatever_it_answers(room: Room) -> None:
    ask = ChatFeedback(message="Which box?", targets=("A",), type="request", id="q1")
    room.observer.publish(topics.CHAT_FEEDBACK, ask)
    room.observer.publish(topics.CHAT_FEEDBACK, ChatFeedback(message="Ok.", targets=("A",), closes="q1"))
    await room.reply(2)
    answer = ChatInput(message="stop", targets=("A",), type="response", reply_to="q1")
    room.observer.publish(topics.CHAT_INPUT, answer)
    (order,) = await room.orders()
    assert [command.command for command in order.system_cmd] == ["stop"]


async def test_newer_message_is_told_that_it_waits_and_the_older_one_can_be_let_go_without_stopping() -> None:
    async with opened(patience_s=0.0) as room:
        never = asyncio.Event()
        room.language.will("interpret", never, ChatAction(message_response="Here I am."))
        room.observer.say("look at the box", "A")
        assert "say “never mind”" in await room.reply()
        room.observer.say("where are you?", "A")
        text = "I am still thinking about “look at the box”. “where are you?” comes next."
        assert text in await room.reply(2)
        assert [said.choices for said in room.observer.said] == [("never mind",)] * 2
        room.observer.say("Never mind!", "A")
        await room.reply(5)
        said = [each.message for each in room.observer.said[2:5]]
        assert said[:2] == ["All right.", "I leave this: “look at the box”"]
        assert room.planner.orders == [], "nobody said stop"
        await room.observer.until(
            lambda: any(each.message == "Here I am." for each in room.observer.said), timeout_s=5
        )


async def test_never_mind_is_an_ordinary_message_while_nothing_takes_long(room: Room) -> None:
    room.language.will("interpret", ChatAction(message_response="Fine."))
    room.observer.say("never mind", "A")
    assert await room.reply() == "Fine."


@pytest.mark.parametrize(
    ("state", "words", "reply"),
    [
        ("paused", "she has left", "Hm? I go on when you say “carry on”."),
        ("paused", "how far is it?", "Hm?"),
        ("paused", "stop there is a cat!", "I am standing still. I go on when you say “carry on”."),
        ("idle", "stop there is a cat!", "I am standing still."),
        ("idle", "she has left", "Hm?"),
    ],
)
async def test_who_says_something_to_a_robot_that_stands_hears_that_it_does(
    room: Room, state: str, words: str, reply: str
) -> None:
    steps = [{"action": look().model_dump(), "state": state}] if state != "idle" else []
    update = {"target": "A", "graph_name": "g", "state": state, "steps": steps}
    room.observer.publish(topics.PLAN, PlanUpdate.model_validate(update))
    room.language.will("interpret", ChatAction(message_response="Hm?"))
    room.observer.say(words, "A")
    assert await room.reply() == reply


async def test_letting_go_concerns_one_robot() -> None:
    async with opened(patience_s=0.0) as room:
        gate = asyncio.Event()
        room.language.will("interpret", gate, ChatAction(message_response="I see."))
        room.observer.say("look at the box", "A")
        await room.reply()
        room.language.will("interpret", ChatAction(message_response="Hm?"))
        gate.set()
        await room.reply(2)
        room.observer.say("never mind", "B")
        await room.observer.until(lambda: any(s.targets == ("B",) for s in room.observer.said), timeout_s=5)
        assert "All right." not in [said.message for said in room.observer.said]


@pytest.mark.parametrize(
    "text", ["never mind", "Nevermind.", "leave it", "please forget that", "drop it!", "Jäta see!"]
)
def test_words_that_let_go_are_known(text: str) -> None:
    assert is_never_mind(text)


@pytest.mark.parametrize("text", ["forget the box", "never mind the dog, go on", "mind the step", ""])
def test_words_that_mean_more_do_not_let_go(text: str) -> None:
    assert not is_never_mind(text)


@pytest.mark.parametrize(
    ("words", "state"),
    [("no, leave it", "running"), ("no, not that one", "running"),
     ("actually no, forget it, stay", "running"),
     ("ok leave it", "awaiting_approval"), ("skip it", "awaiting_approval")],
)  # fmt: skip
async def test_a_no_in_any_words_goes_to_the_plan_that_waits_before_any_step(
    room: Room, words: str, state: str
) -> None:
    heard: asyncio.Queue[PlanDecision] = asyncio.Queue()
    await room.transport.subscribe(
        topics.PLAN_DECISION, lambda said: heard.put_nowait(PlanDecision.model_validate_json(said.data))
    )
    room.observer.publish(topics.PLAN, PlanProposal(id="p1", target="A", steps=(look(),), digest="d"))
    steps = running("A", waits=("p1",)).model_copy(
        update={} if state == "running" else {"steps": (), "state": state}
    )
    room.observer.publish(topics.PLAN, steps)
    await room.observer.until(lambda: "A" in room.observer.plans)
    room.observer.say(words, "A")
    async with asyncio.timeout(5):
        decided = await heard.get()
    assert (decided.id, decided.decision, room.planner.orders) == ("p1", "reject", [])


@pytest.mark.parametrize("words", ["actually no, forget it, stay", "no, never mind", "leave it"])
async def test_a_no_to_a_robot_that_asked_nothing_holds_it(room: Room, words: str) -> None:
    room.observer.publish(topics.PLAN, running("A"))
    await room.observer.until(lambda: "A" in room.observer.plans)
    room.observer.say(words, "A")
    (order,) = await room.orders()
    assert [command.command for command in order.system_cmd] == ["stop"]


async def test_a_no_to_one_by_name_lets_the_other_drive_on(room: Room) -> None:
    for robot in ("A", "B"):
        room.observer.publish(topics.PLAN, running(robot))
    await room.observer.until(lambda: {"A", "B"} <= set(room.observer.plans))
    room.observer.say("B, never mind", "A", also=("B",))
    (order,) = await room.orders()
    assert order.targets == ("B",)
    assert len(room.planner.orders) == 1


@pytest.mark.parametrize("words", ["never mind", "the left box, oh never mind", "cancel", "no"])
async def test_a_no_to_which_one_is_meant_leaves_that_and_nothing_else(room: Room, words: str) -> None:
    asks = ChatAction(message_response="Which one?", choices=("left box", "right box"))
    room.language.will("interpret", asks)
    room.observer.say("go to the box", "A")
    await room.reply()
    room.observer.say(words, "A")
    assert await room.reply(2) == "All right, then I leave it."
    room.language.will("interpret", ChatAction(queue=(look(),)))
    room.observer.say("the left box", "A")
    (order,) = await room.orders()
    assert order.words == "the left box", "the order was given up, so this is a new one"


@pytest.mark.parametrize(
    "reply, asks",
    [
        (ChatAction(message_response="I do not know where you are. Which place is it near?"), True),
        (ChatAction(message_response="Which one?", choices=("left box", "right box")), True),
        (ChatAction(message_response="Tell me where that is.", left_open=LeftOpen(where="the cup")), True),
        (ChatAction(message_response="I know of no “cup”. Please tell me where to find it."), True),
        (ChatAction(message_response="Hello. What can I do for you?"), False),
        (ChatAction(message_response="They asked “where?”"), False),
        (ChatAction(message_response="I look. What else?", queue=(look(),)), False),
    ],
)
async def test_a_reply_that_lacks_words_says_that_it_asks(room: Room, reply: ChatAction, asks: bool) -> None:
    room.language.will("interpret", reply)
    room.observer.say("come to me", "A")
    await room.reply()
    assert room.observer.said[-1].asks_back is asks


async def test_a_reply_says_of_what_was_asked_before_that_it_may_be_answered_yet(room: Room) -> None:
    asks = ChatAction(message_response="Which one?", choices=("left box", "right box"))
    room.language.will("interpret", asks)
    asked_in = room.observer.say("go to the box", "A")
    await room.reply()
    room.language.will("interpret", ChatAction(message_response="I see a door."))
    room.observer.say("what do you see?", "A")
    assert await room.reply(2) == "I see a door."
    assert room.observer.said[-1].still_asks == asked_in
    room.language.will("interpret", ChatAction(message_response="I look.", queue=(look(),)))
    room.observer.say("left box", "A")
    assert await room.reply(3) == "I look."
    assert not room.observer.said[-1].still_asks


async def test_never_mind_lets_go_also_of_what_was_asked_a_while_ago(room: Room) -> None:
    asks = ChatAction(message_response="Which one?", choices=("left box", "right box"))
    room.language.will("interpret", asks)
    room.observer.say("go to the box", "A")
    await room.reply()
    room.language.will("interpret", ChatAction(message_response="I see a door."))
    room.observer.say("what do you see?", "A")
    await room.reply(2)
    room.observer.say("never mind", "A")
    assert await room.reply(3) == "All right, then I leave it."
    assert not room.observer.said[-1].still_asks


async def test_what_is_said_in_the_place_of_a_question_is_none(room: Room) -> None:
    room.language.will("interpret", ChatAction(message_response="What shall I do with Ruth?"))
    room.observer.say("no wait, Ruth shall stay where she is", "A")
    assert "I am standing still" in await room.reply()
    assert not room.observer.said[-1].asks_back


async def test_never_mind_lets_go_of_what_a_reply_asked_for_and_not_of_the_drive(room: Room) -> None:
    room.observer.publish(topics.PLAN, running("A"))
    await room.observer.until(lambda: "A" in room.observer.plans)
    room.language.will("interpret", ChatAction(message_response="What do you mean by “it”?"))
    room.observer.say("put it down", "A")
    await room.reply()
    room.observer.say("never mind", "A")
    assert await room.reply(2) == "All right, then I leave it."
    assert not room.planner.orders
    room.observer.say("never mind", "A")  # now that means the drive
    (order,) = await room.orders()
    assert [command.command for command in order.system_cmd] == ["stop"]


async def test_an_order_is_called_by_its_words_and_not_by_the_answer_to_which_one(room: Room) -> None:
    asks = ChatAction(message_response="Which one?", choices=("left box", "right box"))
    room.language.will("interpret", asks)
    room.observer.say("go to the box", "A")
    await room.reply()
    room.language.will("interpret", ChatAction(queue=(look(),)))
    room.observer.say("Left box.", "A")
    (order,) = await room.orders()
    assert order.words == "go to the box"


@pytest.mark.parametrize("order, goes", [("B, go to the box", True), ("go to the box", False)])
async def test_an_answer_sets_whom_the_order_named_in_motion_and_nobody_else(
    room: Room, order: str, *, goes: bool
) -> None:
    room.language.will(
        "interpret", ChatAction(message_response="Which one?", choices=("left box", "right box"))
    )
    room.observer.say(order, "A")
    await room.reply()
    room.language.will("interpret", ChatAction(queue=(look(),), targets=("B",)))
    room.observer.say("left box", "A")
    if goes:
        (given,) = await room.orders()
        assert given.targets == ("B",)
    else:
        assert "I leave the other robot alone" in await room.reply(2)
        assert not room.planner.orders


def running(robot: str, **more: Any) -> PlanUpdate:
    """A plan under way."""
    return PlanUpdate(
        target=robot, state="running", steps=(PlanStep(action=look(), state="running"),), **more
    )
