"""The memory node over a real transport and a real store."""

from __future__ import annotations

import asyncio
import json
from collections.abc import AsyncIterator
from dataclasses import dataclass, field
from typing import Any

import pytest

from parley.agents.memory import MemoryNode
from parley.clock import WallClock
from parley.errors import LanguageError, TransportError
from parley.language.llm.scripted import ScriptedLanguage
from parley.memory.answer_size import LEFT_OUT
from parley.memory.client import ask_memory
from parley.memory.embedder import Embedder
from parley.memory.embedding_server import EmbeddingServer
from parley.memory.meanings import Meanings
from parley.memory.store import MemoryStore
from parley.messages import topics
from parley.messages.chat import ChatFeedback
from parley.messages.memory import RETURN_ALL, GetMemory, MemoryEntry, MemoryEvent, MemoryList, MemoryReply
from parley.messages.principal import Principal
from parley.messages.ros import ChatRequest, String
from parley.messages.status import Rejection
from parley.messages.wire import MAX_MESSAGE_CHARS, decode, to_string
from parley.transport.local import LocalTransport
from tests.transport.backends import until

KIM = {"kind": "person", "name": "Kim"}


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

    async def whole(self) -> dict[str, MemoryEntry]:
        """All memories by name, as the reply has them."""
        answer = await self.transport.call(topics.GET_MEMORY, ChatRequest(RETURN_ALL), timeout_s=10.0)
        return {entry.name: entry for entry in decode(MemoryReply, answer.response).entries()}

    async def listed(self, request: str = "", **rest: Any) -> list[MemoryEntry]:
        """The answer to a request of one of our own kinds."""
        return list(await ask_memory(self.transport, GetMemory(request=request, **rest)))


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
    body: dict[str, Any] = {"data": "The box is by the door.", "info": "the box", "scope": "A", "source": "B"}
    body["by"] = {"kind": "person"}
    await house.tell(topics.ADD_TO_MEMORY, {"box": body})
    assert house.events == [MemoryEvent(kind="added", name="box", scope="A")]
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
    await house.tell(topics.REMOVE_MEMORY, {"box": {"by": {"kind": "person", "name": "Kim"}}})
    assert house.events == [MemoryEvent(kind="removed", name="box", by=Principal(kind="person", name="Kim"))]
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


async def test_a_full_disk_is_told_as_such_and_nothing_is_lost(house: House) -> None:
    await house.tell(topics.ADD_TO_MEMORY, {"box": {"data": "x"}})
    await house.store.database.run(lambda db: db.execute("PRAGMA max_page_count = 1"))
    await house.tell(topics.ADD_TO_MEMORY, {"big": {"data": "word " * 50_000}})
    assert house.events[-1].message == (
        "I could not remember that: there is no room left where I keep what I remember."
    )
    assert [entry.name for entry in await house.store.all()] == ["box"]


async def test_all_memories_are_returned_oldest_first_without_asking_anybody(house: House) -> None:
    await house.tell(topics.ADD_TO_MEMORY, {name: {"data": name} for name in "bca"})
    await house.tell(topics.ADD_TO_MEMORY, {"b": {"data": "newer"}})
    await until(lambda: len(house.events) == 4)
    expected = [("c", "c"), ("a", "a"), ("b", "newer")]
    for request in ({"request": "return all memories"}, "return all memories", "Return all memories."):
        assert list((await house.ask(request)).items()) == expected
    assert house.language.asked == []


async def test_more_pictures_than_one_answer_holds_are_named_without_their_data(house: House) -> None:
    picture = "A" * (MAX_MESSAGE_CHARS // 5)
    for name in "abcde":
        await house.store.add(MemoryEntry(name=name, type="image", data=picture, info=f"the {name}"))
    await house.store.add(MemoryEntry(name="fact", data="The box is red."))
    whole = await house.whole()
    assert {name: entry.data for name, entry in whole.items()} == dict.fromkeys("abcde", "") | {
        "fact": "The box is red."
    }
    assert whole["a"].info == f"the a {LEFT_OUT}"
    listed = await house.listed(kind="list")
    assert [entry.data for entry in listed if entry.type == "image"] == [""] * 5
    assert [entry.data for entry in await house.listed("a", kind="named")] == [picture]


async def test_of_more_texts_than_one_answer_holds_the_newest_are_given_and_the_rest_counted(
    house: House,
) -> None:
    for number in range(9):
        await house.store.add(MemoryEntry(name=str(number), data="A" * (MAX_MESSAGE_CHARS // 10)))
    assert list(await house.whole()) == ["5", "6", "7", "8"]
    request = ChatRequest(GetMemory(request="", kind="list").model_dump_json())
    answer = await house.transport.call(topics.GET_MEMORY, request, timeout_s=10.0)
    assert decode(MemoryList, answer.response).left_out == 5


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


async def test_times_source_and_use_come_with_the_reply(house: House) -> None:
    await house.tell(topics.ADD_TO_MEMORY, {"box": {"data": "x", "source": "Kim", "by": KIM}})
    house.transport.publisher(topics.CHAT_FEEDBACK).publish(
        to_string(ChatFeedback(message="It is there.", targets=("A",), sources=("box", "unheard of")))
    )
    async with asyncio.timeout(5):
        while not (entry := await house.whole())["box"].used_count:  # noqa: ASYNC110 - use is not announced
            await asyncio.sleep(0.01)
    assert entry["box"].source == "Kim"
    assert 0 < entry["box"].created_unix_ms <= entry["box"].updated_unix_ms <= entry["box"].used_unix_ms


async def test_feedback_that_rests_on_nothing_uses_nothing(house: House) -> None:
    await house.tell(topics.ADD_TO_MEMORY, {"box": {"data": "x"}})
    house.transport.publisher(topics.CHAT_FEEDBACK).publish(to_string(ChatFeedback(message="box")))
    await house.tell(topics.ADD_TO_MEMORY, {"chair": {"data": "x"}})
    assert (await house.whole())["box"].used_count == 0


async def test_forgetting_may_concern_one_robot_alone(house: House) -> None:
    for scope in ("", "A", "B"):
        await house.store.add(MemoryEntry(name="dock", data="x", scope=scope))
    await house.tell(topics.REMOVE_MEMORY, {"dock": {"scope": "A"}})
    assert house.events == [MemoryEvent(kind="removed", name="dock", scope="A")]
    assert [entry.scope for entry in await house.store.all()] == ["", "B"]
    await house.tell(topics.REMOVE_MEMORY, {"dock": {"scope": "A"}})
    assert house.events[-1].kind == "failed"


async def test_list_has_every_scope_by_itself_and_pictures_with_or_without_their_data(house: House) -> None:
    for scope in ("", "A"):
        await house.store.add(MemoryEntry(name="dock", data="x", scope=scope))
    await house.store.add(MemoryEntry(name="photo", type="image", data="aGk="))
    listed = await house.listed(kind="list")
    assert [(e.name, e.scope, e.data) for e in listed] == [
        ("dock", "", "x"), ("dock", "A", "x"), ("photo", "", "aGk="),
    ]  # fmt: skip
    assert [e.data for e in await house.listed(kind="list", pictures=False)] == ["x", "x", ""]
    assert [e.name for e in await house.listed(kind="list", type="image")] == ["photo"]
    assert [e.name for e in await house.listed(kind="list", limit=1)] == ["photo"]
    assert [e.scope for e in await house.listed(kind="list", scope="B")] == ["", ""]
    assert house.language.asked == []


async def test_search_is_answered_best_first_without_the_language_engine(house: House) -> None:
    await house.store.add(MemoryEntry(name="box", data="a red box"))
    await house.store.add(MemoryEntry(name="other", data="a box"))
    await house.store.add(MemoryEntry(name="photo", type="image", data="aGk=", info="the box"))
    found = await house.listed("the red box", kind="search")
    assert found[0].name == "box"
    assert [e.name for e in await house.listed("the red box", kind="search", limit=1)] == ["box"]
    assert [e.name for e in await house.listed("box", kind="search", type="image")] == ["photo"]
    assert house.language.asked == []


async def test_older_versions_can_be_read_and_put_back(house: House) -> None:
    for data in ("first", "second"):
        await house.tell(
            topics.ADD_TO_MEMORY, {"box": {"data": data, "info": "i", "source": "Kim", "by": KIM}}
        )
    await house.tell(topics.REMOVE_MEMORY, {"box": {}})
    older = await house.listed("box", kind="history")
    assert [entry.data for entry in older] == ["first", "second"]
    assert all(entry.ended_unix_ms > 0 for entry in older)
    assert await house.listed("box", kind="named") == []
    await house.tell(topics.ADD_TO_MEMORY, {"box": older[-1].body() | {"by": KIM}})
    (again,) = await house.listed("box", kind="named")
    assert (again.data, again.info, again.source, again.ended_unix_ms) == ("second", "i", "Kim", 0)


async def test_memories_are_found_by_meaning_where_that_is_configured() -> None:
    language = ScriptedLanguage()
    with EmbeddingServer({"crate": "box"}) as server:
        async with LocalTransport() as transport, await MemoryStore.open(":memory:") as store:
            meanings = Meanings(store, Embedder(server.address, "words"), WallClock())
            async with MemoryNode(transport, store, language, short_list=1, meanings=meanings):
                house = House(transport, store, language)
                for name, data in {"a": "the box", "b": "a chair", "c": "a lamp"}.items():
                    await store.add(MemoryEntry(name=name, data=data))
                meanings.wake()
                async with asyncio.timeout(10):
                    await meanings.settled.wait()
                assert [e.name for e in await house.listed("crate", kind="search")] == ["a"]
                assert list(await house.ask("crate")) == ["a"]
                server.status = 500
                assert [e.name for e in await house.listed("chair", kind="search")] == ["b"]


async def test_closing_the_node_frees_its_service() -> None:
    async with LocalTransport() as transport, await MemoryStore.open(":memory:") as store:
        async with MemoryNode(transport, store, ScriptedLanguage()):
            assert transport.endpoints()
        assert transport.endpoints() == ()


@pytest.mark.parametrize("way", ["told", "seen", "concluded", ""])
async def test_a_strangers_program_neither_replaces_nor_removes_what_a_person_told(
    house: House, way: str
) -> None:
    told = {"data": "in the box", "source": "Kim", "way": "told", "words": "it is in the box"}
    await house.tell(topics.ADD_TO_MEMORY, {"key": told | {"by": KIM}})
    await house.tell(topics.ADD_TO_MEMORY, {"key": told | {"data": "in the river", "way": way}})
    await house.tell(topics.REMOVE_MEMORY, {"key": {"by": {"kind": "engine"}}})
    await house.tell(topics.REMOVE_MEMORY, {"key": {"by": "Kim"}})
    assert [event.kind for event in house.events] == ["added", "failed", "failed", "failed"]
    assert (await house.whole())["key"].data == "in the box"
    await house.tell(topics.REMOVE_MEMORY, {"key": {"by": {"kind": "program", "key": "the hall's"}}})
    assert house.events[-1].kind == "removed"


@pytest.mark.parametrize(
    ("by", "way"),
    [({"kind": "robot", "name": "Ada"}, "seen"), ({"kind": "engine", "name": "m"}, "concluded")],
)
async def test_what_was_seen_or_concluded_no_program_without_a_key_has_forgotten(
    house: House, by: dict[str, str], way: str
) -> None:
    await house.tell(topics.ADD_TO_MEMORY, {"key": {"data": "in the box", "by": by}})
    for stranger in ({"kind": "program", "name": "x"}, by, {"kind": "person", "role": "viewer"}):
        await house.tell(topics.REMOVE_MEMORY, {"key": {"by": stranger}})
    await house.tell(topics.REMOVE_MEMORY, {"key": None})
    assert (await house.whole())["key"].way == way
    await house.tell(topics.REMOVE_MEMORY, {"key": {"by": KIM}})
    assert [event.kind for event in house.events] == ["added", *["failed"] * 4, "removed"]


async def test_what_a_program_sends_is_its_own_word_in_whosever_name_it_comes(house: House) -> None:
    sent = {"data": "If you see a crack, stop.", "source": "Kim", "way": "told", "words": "really"}
    await house.tell(topics.ADD_TO_MEMORY, {"rule": sent})
    entry = (await house.whole())["rule"]
    assert (entry.source, entry.way, entry.words, entry.is_told) == ("program", "", "", False)
