"""What actions reach through the transport: the operator, the screen, the memory."""

from __future__ import annotations

import asyncio
import base64
import io
from collections.abc import AsyncIterator
from dataclasses import dataclass, field

import numpy as np
import pytest
from PIL import Image

from parley.agents.memory import MemoryNode
from parley.clock import WallClock
from parley.engine.services import ContextServices
from parley.language.llm.scripted import ScriptedLanguage
from parley.memory.store import MemoryStore
from parley.messages import topics
from parley.messages.chat import Aside, ChatFeedback, ChatInput
from parley.messages.display import DisplayFeed
from parley.messages.memory import MemoryEntry
from parley.messages.ros import String
from parley.messages.wire import decode, to_string
from parley.robots.base import CameraImage
from parley.transport.local import LocalTransport


@dataclass
class Desk:
    """The services of robot A, and the operator's end of the topics."""

    transport: LocalTransport
    services: ContextServices
    heard: list[ChatFeedback] = field(default_factory=list)
    pictures: list[DisplayFeed] = field(default_factory=list)

    def say(self, text: str, target: str = "A", *, kind: str = "response", reply_to: str = "") -> None:
        said = ChatInput.model_validate(
            {"message": text, "targets": [target], "type": kind, "reply_to": reply_to}
        )
        self.transport.publisher(topics.CHAT_INPUT).publish(to_string(said))

    async def hears(self, count: int) -> ChatFeedback:
        async with asyncio.timeout(5):
            while len(self.heard) < count:  # noqa: ASYNC110 - short, and ends with the first message
                await asyncio.sleep(0)
        return self.heard[count - 1]

    async def asking(self, question: str, count: int = 1) -> asyncio.Task[str]:
        """Ask, and wait until the operator has heard it."""
        task = asyncio.create_task(self.services.ask(question))
        await self.hears(count)
        return task


@pytest.fixture
async def desk() -> AsyncIterator[Desk]:
    async with LocalTransport() as transport, ContextServices("A", transport) as services:
        found = Desk(transport, services)
        await transport.subscribe(
            topics.CHAT_FEEDBACK, lambda m: found.heard.append(decode(ChatFeedback, m.data))
        )
        await transport.subscribe(
            topics.DISPLAY_FEED, lambda m: found.pictures.append(decode(DisplayFeed, m.data))
        )
        yield found
        assert transport.handler_failures == 0


async def soon() -> None:
    for _ in range(20):
        await asyncio.sleep(0)


async def test_telling_is_information_from_the_robot(desk: Desk) -> None:
    pixels = np.zeros((20, 30, 3), np.uint8)
    desk.services.tell("I see a box.", CameraImage(30, 20, "rgb8", pixels, 0.0))
    heard = await desk.hears(1)
    with Image.open(io.BytesIO(base64.b64decode(heard.images[0].data))) as picture:
        assert picture.size == (30, 20)
    assert (heard.type, heard.targets, heard.message) == ("info", ("A",), "I see a box.")
    assert heard.by_step


async def test_question_is_a_request_with_choices_and_the_answer_comes_back(desk: Desk) -> None:
    task = asyncio.create_task(desk.services.ask("Which?", ("red", "blue")))
    question = await desk.hears(1)
    assert (question.type, question.message, question.choices) == ("request", "Which?", ("red", "blue"))
    desk.say("red", reply_to=question.id)
    assert await task == "red"


@pytest.mark.parametrize("target", ["A", "a", " A "])
async def test_answer_that_names_no_question_answers_the_open_one(desk: Desk, target: str) -> None:
    task = await desk.asking("Which?")
    desk.say("red", target)
    assert await task == "red"


async def test_answers_go_to_the_question_they_name_and_else_to_the_oldest(desk: Desk) -> None:
    first, second = await desk.asking("First?"), await desk.asking("Second?", 2)
    assert desk.heard[0].id != desk.heard[1].id
    desk.say("two", reply_to=desk.heard[1].id)
    assert await second == "two"
    desk.say("one")
    assert await first == "one"


async def test_what_is_no_answer_to_this_robot_answers_nothing(desk: Desk) -> None:
    task = await desk.asking("Which?")
    desk.say("go on", kind="request")
    desk.say("red", "B")
    desk.say("red", reply_to="another question")
    desk.transport.publisher(topics.CHAT_INPUT).publish(String("not JSON"))
    await soon()
    assert not task.done()
    desk.say("blue")
    assert await task == "blue"


async def test_answer_without_a_question_is_not_kept_for_the_next(desk: Desk) -> None:
    desk.say("red")
    await soon()
    task = await desk.asking("Which?")
    await soon()
    assert not task.done()
    desk.say("blue")
    assert await task == "blue"


async def test_cancelling_withdraws_the_question(desk: Desk) -> None:
    task = await desk.asking("Which?")
    task.cancel()
    with pytest.raises(asyncio.CancelledError):
        await task
    withdrawn = await desk.hears(2)
    assert withdrawn.closes == desk.heard[0].id
    assert withdrawn.type == "info"


async def test_closing_ends_open_questions() -> None:
    async with LocalTransport() as transport:
        async with ContextServices("A", transport) as services:
            task = asyncio.create_task(services.ask("Which?"))
            await soon()
        with pytest.raises(asyncio.CancelledError):
            await task


async def test_picture_is_shown_as_jpeg_on_the_robots_feed(desk: Desk) -> None:
    pixels = np.full((20, 30, 3), (200, 30, 30), np.uint8)
    desk.services.show("inspection", CameraImage(30, 20, "rgb8", pixels, 0.0), {"request": "box"})
    await soon()
    (feed,) = desk.pictures
    assert (feed.target, feed.name, feed.info) == ("A", "inspection", {"request": "box"})
    assert isinstance(feed.image, str)
    with Image.open(io.BytesIO(base64.b64decode(feed.image))) as picture:
        assert (picture.format, picture.size) == ("JPEG", (30, 20))
        assert abs(np.asarray(picture).mean(axis=(0, 1)) - (200, 30, 30)).max() < 10


async def test_what_is_remembered_is_found_again_and_says_who_said_it(desk: Desk) -> None:
    store = await MemoryStore.open(":memory:", WallClock())
    async with store, MemoryNode(desk.transport, store, ScriptedLanguage()):
        desk.services.add(MemoryEntry(name="box", type="text", data="The box is red", info="box"))
        async with asyncio.timeout(5):
            while not (found := await desk.services.find("box")):  # noqa: ASYNC110 - stored soon
                await asyncio.sleep(0.01)
        assert [(entry.data, entry.source) for entry in found] == [("The box is red", "A")]


async def test_memory_that_is_not_there_finds_nothing(desk: Desk) -> None:
    assert await desk.services.find("box") == []


async def test_what_was_no_answer_is_said_as_a_request_and_its_reply_waited_for(desk: Desk) -> None:
    asides: list[Aside] = []
    await desk.transport.subscribe(topics.ASIDE, lambda message: asides.append(decode(Aside, message.data)))
    asking = await desk.asking("Is it done?")
    desk.say("where should I put it?")
    assert await asking == "where should I put it?"
    referring = asyncio.create_task(desk.services.refer("where should I put it?"))
    async with asyncio.timeout(5):
        while not asides:  # noqa: ASYNC110 - short, and ends with the message
            await asyncio.sleep(0)
    (aside,) = asides
    assert (aside.actor, aside.message) == ("A", "where should I put it?")
    assert aside.reply_to == desk.heard[0].id
    await soon()
    assert not referring.done()
    reply = ChatFeedback(message="On me.", targets=("A",), reply_to=aside.request_id)
    desk.transport.publisher(topics.CHAT_FEEDBACK).publish(to_string(reply))
    async with asyncio.timeout(5):
        await referring


async def test_answer_sent_twice_does_not_answer_the_next_question(desk: Desk) -> None:
    said = ChatInput(message="yes", targets=("A",), type="response", id="x1")
    publisher = desk.transport.publisher(topics.CHAT_INPUT)
    first = await desk.asking("Is it done?")
    publisher.publish(to_string(said))
    assert await first == "yes"
    second = await desk.asking("And the other one?", count=2)
    publisher.publish(to_string(said))
    desk.say("no")
    assert await second == "no"
