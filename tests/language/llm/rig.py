"""A scripted model behind real HTTP, and everybody between the operator and the engine, for tests."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Sequence
from contextlib import AsyncExitStack, asynccontextmanager
from dataclasses import dataclass, field
from typing import Any

from parley.agents.chat.chat_interface import ChatInterface
from parley.agents.memory import MemoryNode
from parley.agents.planner.check import plan_problems
from parley.agents.recovery.error_handler import ErrorHandler
from parley.clock import SimClock, WallClock
from parley.config import ModelSettings
from parley.language.base import Language, Situation
from parley.language.llm import build_language
from parley.language.llm.scripted_server import Say, ScriptedServer
from parley.language.llm.usage import Usage
from parley.memory.store import MemoryStore
from parley.messages import topics
from parley.messages.chat import ChatFeedback, ChatInput, ReplyDraft
from parley.messages.memory import MemoryEntry
from parley.messages.status import ActionInfo
from parley.world.object_map import MapObject
from tests.agents.crew import Crew, crew

LOOK = ActionInfo(
    name="Look", inputs={"what": "string"}, description="Look at a thing.", phrases=("look at {what}",)
)
FIND = ActionInfo(
    name="Find", inputs={"target": "string"}, outputs={"x": "number"}, phrases=("find {target}",)
)
DRIVE = ActionInfo(name="Drive", inputs={"x": "number"}, phrases=("go to {place}",))

BOX = MapObject("box_1", "box by the door", 1.0, 2.0, "box")

LOOK_PLAN: dict[str, Any] = {
    "message_response": "I will look at the box.",
    "queue": [{"action": "Look", "parameters": {"what": "box"}, "reason": "see what is in it"}],
}
LOOKS = Say(answer=LOOK_PLAN)


class HandClock(SimClock):
    """Waits are noted and over at once; time-outs end when the test lets time pass."""

    def __init__(self) -> None:
        super().__init__()
        self.waits: list[float] = []

    async def sleep(self, seconds: float) -> None:
        self.waits.append(seconds)
        self.advance(seconds)
        await asyncio.sleep(0)

    @asynccontextmanager
    async def timeout(self, seconds: float) -> AsyncIterator[None]:
        async with asyncio.timeout(None) as scope:

            async def expire() -> None:
                await SimClock.sleep(self, seconds)
                scope.reschedule(0.0)

            watcher = asyncio.create_task(expire())
            try:
                yield
            finally:
                watcher.cancel()


def situation(message: str = "look at the box", **known: Any) -> Situation:
    known.setdefault("catalogue", (LOOK, FIND, DRIVE))
    return Situation(message, robot="A", robots=("A", "B"), **known)


@dataclass
class Model:
    """The server, and the engine that asks it."""

    server: ScriptedServer
    language: Language
    clock: HandClock
    usage: Usage = field(default_factory=Usage)

    def will(self, *answers: Say) -> None:
        self.server.will(*answers)


@asynccontextmanager
async def model(*behind: str, **settings: Any) -> AsyncIterator[Model]:
    """A scripted model; `behind` it the engines of those names."""
    clock, usage = HandClock(), Usage()
    async with ScriptedServer() as server:
        language = build_language(
            [f"local:m@{server.url}", *behind], ModelSettings(**settings),
            check=plan_problems, clock=clock, usage=usage,
        )  # fmt: skip
        async with language:  # type: ignore[attr-defined]
            yield Model(server, language, clock, usage)


@dataclass
class Room:
    """A crew with robot A, whose chat and recovery ask the scripted model."""

    crew: Crew
    model: Model
    drafts: list[ReplyDraft]
    count: int = 0

    async def say(self, text: str, **extra: Any) -> ChatFeedback:
        """Say something; what is answered to just that."""
        self.count += 1
        name = f"said-{self.count}"
        said = ChatInput(message=text, targets=("A",), id=name, **extra)
        self.crew.observer.publish(topics.CHAT_INPUT, said)
        await self.crew.until(lambda: any(told.reply_to == name for told in self.crew.observer.said))
        return next(told for told in self.crew.observer.said if told.reply_to == name)

    async def untouched(self) -> bool:
        """Whether nothing at all reached an engine or the memory."""
        await self.crew.settled()
        memory = self.crew.wire.of(topics.ADD_TO_MEMORY) + self.crew.wire.of(topics.REMOVE_MEMORY)
        return not (self.crew.wire.commands() or self.crew.body.did or memory)


@asynccontextmanager
async def room(
    *behind: str, objects: Sequence[MapObject] = (BOX,), memories: Sequence[MemoryEntry] = (), **settings: Any
) -> AsyncIterator[Room]:
    """Chat interface, recovery, memory, planner and an engine, on a scripted model."""
    async with model(*behind, **settings) as asked, crew() as party, AsyncExitStack() as stack:
        enter, transport, clock = stack.enter_async_context, party.transport, WallClock()
        store = await enter(await MemoryStore.open(":memory:", clock))
        for entry in memories:
            await store.add(entry)
        await enter(MemoryNode(transport, store, asked.language))
        await enter(ErrorHandler(transport, asked.language, clock, objects=lambda _: objects))
        await enter(ChatInterface(transport, asked.language, clock, objects=lambda _: objects))
        drafts: list[ReplyDraft] = []
        await party.observer.subscribe(topics.REPLY_DRAFT, ReplyDraft, drafts.append)
        await party.engine("A")
        yield Room(party, asked, drafts)
