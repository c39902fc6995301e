"""Pictures and reasons in the chat: the real chat interface, planner, memory node and display interface."""

from __future__ import annotations

import asyncio
import base64
import re
from collections.abc import AsyncIterator, Sequence
from contextlib import asynccontextmanager
from dataclasses import dataclass, field

import pytest

from parley.agents.chat.chat_interface import ChatInterface
from parley.agents.chat.recollections import FEED
from parley.agents.display.display_interface import DisplayInterface
from parley.agents.memory import MemoryNode
from parley.agents.planner.umrf_planner import UmrfPlanner
from parley.clock import WallClock
from parley.demos.observer import Observer
from parley.gate.rule_talk import RuleTalk
from parley.language.base import Language, Picture, Situation
from parley.language.builtin.engine import BuiltinLanguage
from parley.language.llm.scripted import ScriptedLanguage
from parley.memory.store import MemoryStore
from parley.messages import topics
from parley.messages.chat import ChatAction, ChatFeedback, ChatImage, ChatInput, SystemCommand
from parley.messages.display import DisplayFeed
from parley.messages.memory import MemoryEntry
from parley.messages.ros import CompressedImage, String
from parley.messages.status import ActorStatus
from parley.messages.wire import decode
from parley.transport.local import LocalTransport
from parley.world.object_map import MapObject
from tests.memory.photos import opened, photo
from tests.transport.backends import until

CLOCK = r"\d\d:\d\d"


@dataclass
class House:
    """Two robots, and an operator who writes and looks."""

    transport: LocalTransport
    store: MemoryStore
    language: ScriptedLanguage
    observer: Observer
    shown: list[DisplayFeed] = field(default_factory=list)
    count: int = 0

    async def say(
        self, text: str, *pictures: str, targets: Sequence[str] = ("A",), author: str = "", file: str = "",
        answers: str = "",
    ) -> ChatFeedback:  # fmt: skip
        """Write something, with pictures, and return what is said next."""
        self.count += 1
        heard = len(self.observer.said)
        said = ChatInput(
            message=text,
            targets=tuple(targets),
            id=f"said-{self.count}",
            author=author,
            images=tuple(ChatImage(name=file, data=data) for data in pictures),
            type="response" if answers else "request",
            reply_to=answers,
        )
        self.observer.publish(topics.CHAT_INPUT, said)
        await self.observer.until(lambda: len(self.observer.said) > heard, timeout_s=10)
        return self.observer.said[heard]

    async def names(self, kind: str = "image") -> list[str]:
        """What is remembered."""
        return [entry.name for entry in await self.store.all(kind=kind)]

    def remembers(self, reply: str, **arguments: str) -> None:
        """The language engine will keep a fact."""
        command = SystemCommand(command="add_memory", arguments=dict(arguments))
        self.language.will("interpret", ChatAction(message_response=reply, system_cmd=(command,)))


@pytest.fixture
async def house() -> AsyncIterator[House]:
    async with opened_house() as found:
        yield found


@asynccontextmanager
async def opened_house(
    engine: Language | None = None, objects: Sequence[MapObject] = (), rules: RuleTalk | None = None
) -> AsyncIterator[House]:
    language, clock = ScriptedLanguage(engine), WallClock()
    async with (
        LocalTransport() as transport,
        await MemoryStore.open(":memory:") as store,
        MemoryNode(transport, store, language),
        DisplayInterface(transport, clock, min_interval_s=0.0),
        UmrfPlanner(transport, clock),
        ChatInterface(transport, engine or language, clock, objects=lambda _: objects, rules=rules),
        Observer(transport, clock, lambda _: None) as observer,
    ):
        house = House(transport, store, language, observer)

        def on_picture(message: String) -> None:
            house.shown.append(decode(DisplayFeed, message.data))

        await transport.subscribe(topics.DISPLAY_FEED, on_picture)
        for name in "AB":
            observer.publish(topics.ACTOR_STATUS, ActorStatus(actor=name))
        yield house


# Pictures that come


async def test_picture_with_its_name_is_kept_small_with_the_author_and_confirmed(house: House) -> None:
    reply = await house.say("This is my desk.", photo(3000, 1500), author="Kim")
    assert (reply.type, reply.message) == ("response", "I will remember what you showed me as “desk”.")
    assert reply.reply_to == "said-1"
    entry = await house.store.get("desk")
    assert entry is not None
    assert (entry.type, entry.source, entry.info, entry.scope) == ("image", "Kim", "This is my desk.", "")
    assert opened(entry.data).size == (1280, 640)
    assert house.language.asked == []


async def test_picture_without_words_is_kept_and_its_name_asked_for(house: House) -> None:
    question = await house.say("", photo(), file="IMG_0001.jpg")
    assert (question.type, question.targets) == ("request", ("A",))
    assert "What does the picture show?" in question.message
    (spare,) = await house.names()
    assert spare.startswith("picture 2")
    reply = await house.say("my desk", answers=question.id)
    assert reply.message == "Thank you. I will remember it as “desk”."
    await house.observer.until(lambda: any(e.kind == "removed" for e in house.observer.memory_events))
    assert await house.names() == ["desk"]


async def test_question_about_a_picture_is_asked_beside_the_answer_to_the_words(house: House) -> None:
    house.language.will("interpret", ChatAction(message_response="I cannot tell."))
    question = await house.say("what is that?", photo())
    assert question.type == "request"
    await house.observer.until(lambda: len(house.observer.said) == 2)
    assert house.observer.said[1].message == "I cannot tell."


async def test_file_that_a_person_named_names_the_picture(house: House) -> None:
    assert "“loading dock”" in (await house.say("", photo(), file="loading_dock.jpg")).message
    assert await house.names() == ["loading dock"]


async def test_picture_for_several_robots_is_kept_once_and_answered_once(house: House) -> None:
    reply = await house.say("this is the dock", photo(), targets=("A", "B"))
    assert set(reply.targets) == {"A", "B"}
    house.language.will("interpret", ChatAction(message_response="Fine."))
    await house.say("and now?")
    assert [said.message for said in house.observer.said[1:]] == ["Fine."]
    assert await house.store.history("dock") == []


async def test_several_pictures_get_names_of_their_own(house: House) -> None:
    await house.say("this is the dock", photo(), photo(colour="blue"))
    assert await house.names() == ["dock", "dock 2"]


async def test_picture_of_the_same_name_replaces_the_older_one_which_stays_in_the_history(
    house: House,
) -> None:
    await house.say("this is the dock", photo())
    await house.say("this is the dock", photo(colour="blue"))
    assert await house.names() == ["dock"]
    assert len(await house.store.history("dock")) == 1


@pytest.mark.parametrize(
    ("pictures", "words"),
    [
        (["aGk="], "not a JPEG or PNG"),
        ([photo(), "aGk="], "kept nothing"),
        ([photo()] * 5, "I take 4"),
    ],
)
async def test_what_cannot_be_kept_is_said_and_nothing_is_kept(
    house: House, pictures: list[str], words: str
) -> None:
    reply = await house.say("this is the dock", *pictures)
    assert reply.type == "error"
    assert words in reply.message
    assert await house.names() == []


async def test_picture_that_cannot_be_stored_is_not_acknowledged(house: House) -> None:
    await house.store.close()
    reply = await house.say("this is the dock", photo())
    assert reply.type == "error"
    assert "could not" in reply.message


# Pictures that are shown back


async def test_picture_is_put_on_the_screen_by_its_name(house: House) -> None:
    await house.say("this is my desk", photo(colour="blue"), author="Kim")
    await house.say("this is the dock", photo(), author="Kim")
    seen: list[CompressedImage] = []
    await house.transport.subscribe(topics.display_topic("B", FEED), seen.append)
    reply = await house.say("Show me the picture of the desk", targets=("B",), author="Lee")
    assert re.fullmatch(rf"Here is “desk”: Kim showed me at {CLOCK}\.", reply.message)
    assert reply.sources == ("desk",)
    (shown,) = house.shown
    assert (shown.target, shown.name, shown.info) == ("B", FEED, {"name": "desk"})
    await until(lambda: seen)
    red, _, blue = opened(str(shown.image)).getpixel((3, 3))  # type: ignore[misc]
    assert blue > red


async def test_what_was_shown_is_listed_and_the_newest_put_on_the_screen(house: House) -> None:
    await house.say("this is my desk", photo())
    await house.say("this is the dock", photo())
    reply = await house.say("What did I show you?")
    assert reply.message == "I remember 2 pictures: “dock”, “desk”. On the screen is “dock”."
    assert [feed.info["name"] for feed in house.shown] == ["dock"]


async def test_short_wish_to_see_something_means_the_picture_only_if_there_is_one(house: House) -> None:
    house.language.will("interpret", ChatAction(message_response="I will go there."))
    assert (await house.say("show me the desk")).message == "I will go there."
    await house.say("this is the desk", photo())
    assert "Here is “desk”" in (await house.say("show me the desk")).message


async def test_pictures_nobody_showed_are_said_to_be_unknown(house: House) -> None:
    assert (await house.say("What did I show you?")).message == "I do not remember any picture."
    reply = await house.say("show me the picture of the moon")
    assert reply.message == "I do not remember any picture of the moon."


async def test_robot_shows_its_own_pictures_and_everybodys(house: House) -> None:
    for scope in "AB":
        await house.store.add(
            MemoryEntry(name=f"view of {scope}", type="image", data=photo(), scope=scope, source=scope)
        )
    reply = await house.say("What did I show you?")
    assert re.fullmatch(rf"Here is “view of A”: I saw it at {CLOCK}\.", reply.message)


# Reasons


async def test_reply_says_why_and_how_it_is_known_is_answered_with_the_words(house: House) -> None:
    house.remembers("Noted.", name="box", data="The box is by the door.")
    await house.say("the box is by the door", author="Kim")
    house.language.will("interpret", ChatAction(message_response="By the door.", sources=("box",)))
    reply = await house.say("where is the box?", author="Kim")
    assert re.fullmatch(rf"By the door\. I know that because you told me at {CLOCK}\.", reply.message)
    assert reply.sources == ("box",)
    reply = await house.say("How do you know?", author="Lee")
    assert re.fullmatch(rf"Because Kim told me at {CLOCK}: “The box is by the door\.”", reply.message)
    async with asyncio.timeout(5):
        while (entry := await house.store.get("box")) is None or not entry.used_count:  # noqa: ASYNC110
            await asyncio.sleep(0.01)
    assert (entry.used_count, entry.source) == (1, "Kim")


async def test_reply_that_rests_on_nothing_has_no_reason(house: House) -> None:
    house.language.will("interpret", ChatAction(message_response="Fine."))
    assert (await house.say("hello")).message == "Fine."
    assert "does not rest on anything" in (await house.say("how do you know?")).message


async def test_reason_is_no_part_of_the_conversation_that_the_language_engine_sees(house: House) -> None:
    await house.store.add(MemoryEntry(name="box", data="x"))
    answer = ChatAction(message_response="There.", sources=("box",))
    house.language.will("interpret", answer, ChatAction(message_response="Fine."))
    await house.say("where is the box?")
    await house.say("thanks")
    interpreted = [asked for question, asked in house.language.asked if question == "interpret"]
    assert [turn.content for turn in interpreted[-1].history] == ["where is the box?", "There."]


# For whom


async def test_fact_is_for_all_unless_one_robot_is_to_remember_for_itself(house: House) -> None:
    house.remembers("Noted.", name="dock", data="The dock is blue.")
    await house.say("remember that the dock is blue")
    house.remembers("Noted.", name="bay", data="The bay is red.")
    await house.say("Remember for yourself that the bay is red")
    assert [(e.name, e.scope, e.source) for e in await house.store.all()] == [
        ("dock", "", "operator"), ("bay", "A", "operator"),
    ]  # fmt: skip
    assert house.language.asked[-1][1].message == "Remember that the bay is red"


async def test_correcting_and_forgetting_concern_the_memory_that_the_robot_has(house: House) -> None:
    for scope in "AB":
        await house.store.add(MemoryEntry(name="dock", data="blue", scope=scope))
    house.remembers("Noted.", name="dock", data="red")
    await house.say("the dock is red")
    assert [(e.scope, e.data) for e in await house.store.all()] == [("B", "blue"), ("A", "red")]
    forget = SystemCommand(command="remove_memory", arguments={"name": "dock"})
    house.language.will("interpret", ChatAction(message_response="Forgotten.", system_cmd=(forget,)))
    assert (await house.say("forget the dock")).message == "Forgotten."
    assert [e.scope for e in await house.store.all()] == ["B"]


def situations(house: House) -> list[Situation]:
    return [asked for question, asked in house.language.asked if question == "interpret"]


async def test_remembered_pictures_reach_the_language_engine_as_pictures(house: House) -> None:
    await house.say("this is the dock", photo())
    house.language.will("interpret", ChatAction(message_response="Fine."))
    await house.say("hello")
    (situation,) = situations(house)
    assert [(entry.name, entry.data) for entry in situation.memory] == [("dock", "")]
    (kept,) = await house.store.all(kind="image")
    assert situation.pictures == (Picture("dock", base64.b64decode(kept.data)),)


async def test_picture_sent_with_a_question_reaches_the_language_engine_once(house: House) -> None:
    house.language.will("interpret", ChatAction(message_response="A desk."))
    await house.say("what do you make of it?", photo(), file="IMG_1234.jpg")
    await house.observer.until(lambda: bool(situations(house)), timeout_s=5)
    (situation,) = situations(house)
    assert [(each.name, each.sent) for each in situation.pictures] == [("IMG_1234.jpg", True)]


async def test_picture_that_goes_with_an_answer_is_kept(house: House) -> None:
    ask = ChatFeedback(message="Where is it?", targets=("A",), type="request", id="q1")
    house.observer.publish(topics.CHAT_FEEDBACK, ask)
    await house.observer.until(lambda: bool(house.observer.said), timeout_s=5)
    await house.say("this is the dock", photo(), answers="q1")
    assert await house.names() == ["dock"]
    assert situations(house) == []


async def test_engine_that_sees_no_pictures_gets_no_remembered_ones_and_says_so_of_sent_ones() -> None:
    engine = BuiltinLanguage()
    async with opened_house(engine) as house:
        await house.say("this is the dock", photo())
        said = await house.say("what can you do?")
        assert "picture" not in said.message
        await house.say("what can you do?", photo(colour="blue"))
        await house.observer.until(
            lambda: "I cannot see what is in a picture" in house.observer.said[-1].message, timeout_s=5
        )


async def test_asking_for_everything_shows_the_language_engine_all_the_robot_knows(house: House) -> None:
    for name, scope in (("a", ""), ("b", "A"), ("c", "B")):
        await house.store.add(MemoryEntry(name=name, data=name, scope=scope))
    house.language.will("interpret", ChatAction(message_response="A lot."))
    await house.say("What do you remember?")
    ((question, situation),) = house.language.asked
    assert question == "interpret"
    assert [entry.name for entry in situation.memory] == ["a", "b"]


async def test_picture_that_is_all_of_an_answer_is_kept_without_another_question(house: House) -> None:
    ask = ChatFeedback(message="Where is it?", targets=("A",), type="request", id="q1")
    house.observer.publish(topics.CHAT_FEEDBACK, ask)
    await house.observer.until(lambda: bool(house.observer.said), timeout_s=5)
    reply = await house.say("", photo(), file="IMG_1234.jpg", answers="q1")
    assert reply.type == "response"
    (kept,) = await house.store.all(kind="image")
    assert kept.info == "Shown when I asked: Where is it?"
