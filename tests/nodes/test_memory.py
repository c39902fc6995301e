"""The memory node over a real transport and a real store."""

from __future__ import annotations

import asyncio
import json
from collections.abc import AsyncIterator
from dataclasses import dataclass, field
from typing import Any

import pytest

from parley.errors import LanguageError, TransportError
from parley.language.scripted import ScriptedLanguage
from parley.memory.store import MemoryStore
from parley.messages import topics
from parley.messages.memory import MemoryEntry, MemoryEvent, MemoryReply
from parley.messages.ros import ChatRequest, String
from parley.messages.status import Rejection
from parley.messages.wire import decode
from parley.nodes.memory import MemoryNode
from parley.transport.local import LocalTransport
from tests.transport.backends import until


@dataclass
class House:
    """A memory node and everybody who talks to it."""

    transport: LocalTransport
    store: MemoryStore
    language: ScriptedLanguage
    events: list[MemoryEvent] = field(default_factory=list)
    refused: list[Rejection] = field(default_factory=list)

    async def tell(self, topic: topics.Topic[String], content: Any) -> None:
        """Publish JSON (or a text as it is) and wait until it was worked on."""
        told = len(self.events) + len(self.refused)
        text = content if isinstance(content, str) else json.dumps(content)
        self.transport.publisher(topic).publish(String(text))
        await until(lambda: len(self.events) + len(self.refused) > told)

    async def ask(self, request: str | dict[str, Any]) -> dict[str, str]:
        """Memory names and texts, in the order of the reply."""
        message = request if isinstance(request, str) else json.dumps(request)
        answer = await self.transport.call(topics.GET_MEMORY, ChatRequest(message), timeout_s=10.0)
        return {entry.name: entry.data for entry in decode(MemoryReply, answer.response).entries()}


@pytest.fixture
async def house() -> AsyncIterator[House]:
    language = ScriptedLanguage()
    async with LocalTransport() as transport, await MemoryStore.open(":memory:") as store:
        async with MemoryNode(transport, store, language):
            house = House(transport, store, language)

            def on_event(message: String) -> None:
                house.events.append(decode(MemoryEvent, message.data))

            def on_rejection(message: String) -> None:
                house.refused.append(decode(Rejection, message.data))

            await transport.subscribe(topics.MEMORY_EVENT, on_event)
            await transport.subscribe(topics.REJECTION, on_rejection)
            yield house
        assert transport.handler_failures == 0


async def test_what_is_announced_as_remembered_is_in_the_store(house: House) -> None:
    body = {"type": "text", "data": "The box is by the door.", "info": "the box", "scope": "A", "source": "B"}
    await house.tell(topics.ADD_TO_MEMORY, {"box": body})
    assert house.events == [MemoryEvent(kind="added", name="box")]
    stored = await house.store.get("box", scope="A")
    assert stored is not None
    assert (stored.data, stored.info, stored.source) == ("The box is by the door.", "the box", "B")


async def test_several_memories_in_one_message_are_each_announced_in_order(house: House) -> None:
    await house.tell(topics.ADD_TO_MEMORY, {name: {"data": name} for name in "cab"})
    await until(lambda: len(house.events) == 3)
    assert [event.name for event in house.events] == ["c", "a", "b"]
    assert [entry.name for entry in await house.store.all()] == ["c", "a", "b"]


@pytest.mark.spec("P17")
async def test_a_memory_is_forgotten_by_its_name_wherever_it_belongs(house: House) -> None:
    await house.store.add(MemoryEntry(name="box", data="x"))
    await house.store.add(MemoryEntry(name="box", data="y", scope="A"))
    await house.tell(topics.REMOVE_MEMORY, {"box": None})
    assert house.events == [MemoryEvent(kind="removed", name="box")]
    assert await house.store.all() == []


async def test_forgetting_what_nobody_remembers_is_told_in_plain_words(house: House) -> None:
    await house.tell(topics.REMOVE_MEMORY, {"box": {}})
    (event,) = house.events
    assert (event.kind, event.name) == ("failed", "box")
    assert event.message == "I remember nothing under the name box."


@pytest.mark.parametrize("topic", [topics.ADD_TO_MEMORY, topics.REMOVE_MEMORY], ids=lambda topic: topic.name)
@pytest.mark.parametrize("text", ["", "remember the box", "[]", '{"": {"data": "x"}}', '{"x": NaN}'])
async def test_what_does_not_fit_is_refused_and_changes_nothing(
    house: House, topic: topics.Topic[String], text: str
) -> None:
    if topic is topics.REMOVE_MEMORY and text.startswith('{""'):
        return  # nothing bears an empty name, so forgetting it is merely told to be impossible
    await house.tell(topic, text)
    (refused,) = house.refused
    assert (refused.source, refused.what) == ("memory", topic.name)
    assert house.events == []
    assert await house.store.all() == []
    await house.tell(topics.ADD_TO_MEMORY, {"box": {"data": "still served"}})
    assert house.events == [MemoryEvent(kind="added", name="box")]


async def test_a_store_that_cannot_write_is_told_without_technical_words(house: House) -> None:
    await house.store.close()
    await house.tell(topics.ADD_TO_MEMORY, {"box": {"data": "x"}})
    await house.tell(topics.REMOVE_MEMORY, {"box": {}})
    assert [event.kind for event in house.events] == ["failed", "failed"]
    assert house.events[0].message == "I could not remember that: my memory file cannot be written."


async def test_all_memories_are_returned_oldest_first_without_asking_anybody(house: House) -> None:
    await house.tell(topics.ADD_TO_MEMORY, {name: {"data": name} for name in "bca"})
    await house.tell(topics.ADD_TO_MEMORY, {"b": {"data": "newer"}})
    await until(lambda: len(house.events) == 4)
    expected = [("c", "c"), ("a", "a"), ("b", "newer")]
    for request in ({"request": "return all memories"}, "return all memories", "Return all memories."):
        assert list((await house.ask(request)).items()) == expected
    assert house.language.asked == []


async def test_the_language_engine_picks_what_matters_and_time_orders_it(house: House) -> None:
    for name in "abc":
        await house.store.add(MemoryEntry(name=name, data=f"box {name}"))
    house.language.will("select_memories", ["c", "a", "unheard of"])
    assert list(await house.ask({"request": "the boxes"})) == ["a", "c"]


async def test_a_request_may_be_plain_text_or_any_json_that_is_no_object(house: House) -> None:
    await house.store.add(MemoryEntry(name="a", data="42"))
    for text in ("what about 42", "42", '"42"', "[42]", "", "{not json"):
        house.language.will("select_memories", ["a"])
        assert list(await house.ask(text)) == ["a"]


async def test_an_object_that_is_no_request_is_refused_to_the_caller_and_to_all(house: House) -> None:
    with pytest.raises(TransportError, match="request"):
        await house.ask({"query": "box"})
    await until(lambda: house.refused)
    assert (house.refused[0].what, house.refused[0].problems[0].path) == ("get_memory", "request")


async def test_an_empty_memory_answers_nothing_without_asking_anybody(house: House) -> None:
    assert await house.ask("where is the box?") == {}
    assert house.language.asked == []


async def test_a_small_memory_is_shown_whole_since_what_matters_need_not_share_a_word() -> None:
    seen: list[list[str]] = []

    class Watching(ScriptedLanguage):
        async def select_memories(self, query: str, index: Any) -> list[str]:
            seen.append([entry.name for entry in index])
            return []

    async with (
        LocalTransport() as transport,
        await MemoryStore.open(":memory:") as store,
        MemoryNode(transport, store, Watching(), short_list=3),
    ):
        house = House(transport, store, ScriptedLanguage())
        await store.add(MemoryEntry(name="box", data="a box"))
        await store.add(MemoryEntry(name="drink", data="a drink"))
        await house.ask("the box, and I am thirsty")
        for name in "xyz":
            await store.add(MemoryEntry(name=name, data=name))
        await house.ask("the box, and I am thirsty")
    assert seen == [["box", "drink"], ["box", "z", "y"]]


@pytest.mark.parametrize("failure", ["error", "silence"])
async def test_without_an_answer_of_the_language_engine_shared_words_decide(failure: str) -> None:
    language = ScriptedLanguage()
    language.will("select_memories", LanguageError("no model") if failure == "error" else asyncio.Event())
    async with (
        LocalTransport() as transport,
        await MemoryStore.open(":memory:") as store,
        MemoryNode(transport, store, language, select_timeout_s=0.02),
    ):
        house = House(transport, store, language)
        await store.add(MemoryEntry(name="a", data="the box"))
        await store.add(MemoryEntry(name="b", data="the chair"))
        await store.add(MemoryEntry(name="c", data="another box"))
        assert list(await house.ask("which boxes?")) == ["a", "c"]


async def test_a_hung_language_engine_delays_neither_changes_nor_other_requests(house: House) -> None:
    await house.store.add(MemoryEntry(name="a", data="the box"))
    gate = asyncio.Event()
    house.language.will("select_memories", gate, ["a"])
    slow = asyncio.create_task(house.ask("box"))
    await until(lambda: house.language.asked)
    await house.tell(topics.ADD_TO_MEMORY, {"b": {"data": "x"}})
    assert house.events == [MemoryEvent(kind="added", name="b")]
    assert list(await house.ask("return all memories")) == ["a", "b"]
    assert not slow.done()
    gate.set()
    assert list(await slow) == ["a"]


async def test_a_robot_is_told_its_own_memories_and_everybodys_its_own_winning(house: House) -> None:
    for scope in ("B", "A", ""):
        await house.store.add(MemoryEntry(name="dock", data=f"dock of {scope or 'all'}", scope=scope))
    await house.store.add(MemoryEntry(name="box", data="x", scope="B"))
    assert await house.ask({"request": "return all memories", "scope": "A"}) == {"dock": "dock of A"}
    house.language.will("select_memories", ["dock", "box"])
    assert await house.ask({"request": "the dock", "scope": "A"}) == {"dock": "dock of A"}


async def test_the_reply_has_the_keys_of_the_thesis(house: House) -> None:
    await house.store.add(MemoryEntry(name="a", type="image", data="aGk=", info="a picture"))
    answer = await house.transport.call(topics.GET_MEMORY, ChatRequest("return all memories"), timeout_s=10.0)
    reply = json.loads(answer.response)
    assert {key: reply["a"][key] for key in ("type", "data", "info")} == {
        "type": "image", "data": "aGk=", "info": "a picture",
    }  # fmt: skip


async def test_closing_the_node_frees_its_service() -> None:
    async with LocalTransport() as transport, await MemoryStore.open(":memory:") as store:
        async with MemoryNode(transport, store, ScriptedLanguage()):
            assert transport.endpoints()
        assert transport.endpoints() == ()
