"""The memory node: remembers, forgets, and hands out what matters for a request (thesis 4.3.8)."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Awaitable, Sequence
from typing import ClassVar, Final

from parley.agents.base import Node
from parley.errors import InvalidMessageError, LanguageError, StoreError
from parley.gate.vouched import may_forget, vouched
from parley.language.base import Language
from parley.memory.answer_size import MAX_ANSWER_CHARS, fitting, without_pictures
from parley.memory.limits import MOST_MEMORIES
from parley.memory.meanings import Meanings, fused
from parley.memory.store import MemoryStore
from parley.messages import topics
from parley.messages.chat import ChatFeedback
from parley.messages.memory import (
    RETURN_ALL,
    AddToMemory,
    GetMemory,
    MemoryEntry,
    MemoryEvent,
    MemoryList,
    MemoryReply,
    RemoveMemory,
)
from parley.messages.principal import Principal
from parley.messages.ros import ChatRequest, ChatResponse
from parley.messages.wire import decode, encode
from parley.sentences import sentence
from parley.transport.base import Transport

__all__ = ["MemoryNode", "read_request"]


_ABOVE: Final[dict[str, tuple[str, ...]]] = {"concluded": ("told", "seen", ""), "": ("told",)}
"""What a memory never replaces, by how it is known: a conclusion nothing, a program's word no person's."""


class MemoryNode(Node):
    """Serves one memory store to everybody on the transport.

    Changes happen in the order they arrive and are announced on `/parley/memory_event` once they are durable.
    Requests are answered side by side: a slow language engine delays neither changes nor other requests.

    Args:
        transport: Where everybody is.
        store: An open store; the caller closes it.
        language: Picks from the short list what matters.
        short_list: How many memories the language engine is shown.
        select_timeout_s: How long it may take (wall time) before the finds are used as they are.
        meanings: Finds memories by what they mean too, where an embedding model is configured; opened and
            closed with the node.
    """

    name: ClassVar[str] = "memory"
    apart = True

    def __init__(
        self,
        transport: Transport,
        store: MemoryStore,
        language: Language,
        *,
        short_list: int = MOST_MEMORIES,
        select_timeout_s: float = 5.0,
        meanings: Meanings | None = None,
    ) -> None:
        super().__init__(transport)
        self._store, self._language, self._meanings = store, language, meanings
        self._short_list, self._select_timeout_s = short_list, select_timeout_s

    async def open(self) -> None:
        """See `Node.open`."""
        if self._meanings is not None:
            await self.opened.enter_async_context(self._meanings)
        await self.subscribe(topics.ADD_TO_MEMORY, AddToMemory, self._on_add, in_charge=True)
        await self.subscribe(topics.REMOVE_MEMORY, RemoveMemory, self._on_remove, in_charge=True)
        await self.subscribe(topics.CHAT_FEEDBACK, ChatFeedback, self._on_feedback)
        server = await self.transport.serve(topics.GET_MEMORY, self._on_get)
        self.opened.push_async_callback(server.close)

    # -- changes ---------------------------------------------------------------------------------------

    async def _on_add(self, message: AddToMemory) -> None:
        for entry in message.entries():
            entry = vouched(entry, message.root[entry.name].by)
            await self._change(entry.name, entry.scope, "remember", self._add(entry))

    async def _add(self, entry: MemoryEntry) -> MemoryEvent:
        above = _ABOVE.get(entry.way, ())
        if above and await self._store.is_known(entry.name, above):
            said = sentence("something else was told or seen under the name {name}", name=entry.name)
            return MemoryEvent(kind="failed", name=entry.name, scope=entry.scope, message=said)
        await self._store.add(entry)
        if self._meanings is not None:
            self._meanings.wake()
        return MemoryEvent(kind="added", name=entry.name, scope=entry.scope)

    async def _on_remove(self, message: RemoveMemory) -> None:
        for name in message.root:
            scope, by = message.scope_of(name), message.by_of(name)
            await self._change(name, scope or "", "forget", self._remove(name, scope, by), by)

    async def _remove(self, name: str, scope: str | None, by: Principal | None) -> MemoryEvent:
        known = [entry for entry in await self._store.named(name) if scope in (None, entry.scope)]
        if not all(may_forget(entry, by) for entry in known):
            said = sentence("only a person, or a program with a key, has me forget {name}", name=name)
            return MemoryEvent(kind="failed", name=name, scope=scope or "", message=said)
        if await self._store.remove(name, scope=scope):
            return MemoryEvent(kind="removed", name=name, scope=scope or "")
        said = sentence("I remember nothing under the name {name}.", name=name)
        return MemoryEvent(kind="failed", name=name, scope=scope or "", message=said)

    async def _change(
        self, name: str, scope: str, verb: str, change: Awaitable[MemoryEvent], by: Principal | None = None
    ) -> None:
        try:
            event = await change
        except StoreError as error:
            self.log.error("memory not changed", name=name, verb=verb, problem=str(error))
            said = f"I could not {verb} that: {_plain(error)}"
            event = MemoryEvent(kind="failed", name=name, scope=scope, message=said)
        self.publish(topics.MEMORY_EVENT, event.model_copy(update={"by": by}))

    async def _on_feedback(self, feedback: ChatFeedback) -> None:
        """Record which memories a reply was founded on; of the reply itself nothing depends on it."""
        if not feedback.sources:
            return
        try:
            await self._store.mark_used(feedback.sources, feedback.targets)
        except StoreError as error:
            self.log.warning("use of memories not recorded", problem=str(error))

    # -- requests --------------------------------------------------------------------------------------

    async def _on_get(self, asked: ChatRequest) -> ChatResponse:
        try:
            request = read_request(asked.message)
        except InvalidMessageError as error:
            self.refuse(topics.GET_MEMORY.name, error)
            raise
        if request.kind == "select":
            chosen = [*await self._find(request), *await self._store.taught(request.scope or None)]
            found = [entry for entry in chosen if request.type in ("", entry.type)]
            return ChatResponse(encode(MemoryReply.of(self._fitting(_shown(_time_order(found), request))[0])))
        listed = [entry for entry in await self._list(request) if request.type in ("", entry.type)]
        if request.kind == "search":
            listed = listed[: request.limit or self._short_list]
        elif request.limit:
            listed = listed[-request.limit :]
        memories, left_out = self._fitting(_shown(listed, request))
        return ChatResponse(encode(MemoryList(memories=tuple(memories), left_out=left_out)))

    def _fitting(self, entries: Sequence[MemoryEntry]) -> tuple[list[MemoryEntry], int]:
        shown, left_out = fitting(entries)
        if left_out:
            self.log.warning("the oldest memories do not fit into one answer", left_out=left_out)
        return shown, left_out

    async def _everything(self, request: GetMemory) -> list[MemoryEntry]:
        """All memories, oldest first; pictures with their data if they fit into one answer."""
        scope = request.scope or None
        if request.pictures and await self._store.picture_chars(scope) <= MAX_ANSWER_CHARS:
            return await self._store.all(scope, request.type)
        bare = await self._store.all(scope, request.type, pictures=False)
        return without_pictures(bare) if request.pictures else bare

    async def _list(self, request: GetMemory) -> list[MemoryEntry]:
        scope = request.scope or None
        match request.kind:
            case "search":
                wanted = request.limit or self._short_list
                # Pictures are few among texts, so more is looked through when only they are asked for.
                return await self._search(request.request, scope, 10 * wanted if request.type else wanted)
            case "named":
                return await self._store.named(request.request, scope)
            case "history":
                older = await self._store.history(request.request)
                return [entry for entry in older if scope is None or entry.scope in ("", scope)]
        if request.limit:
            newest = self._store.newest(request.limit, scope, request.type, pictures=request.pictures)
            return (await newest)[::-1]
        return await self._everything(request)

    async def _find(self, request: GetMemory) -> list[MemoryEntry]:
        scope = request.scope or None
        if request.request.strip().rstrip(".!").casefold() == RETURN_ALL:
            return await self._everything(request)
        found = await self._search(request.request, scope, self._short_list)
        short_list = _own_first(await self._fill_up(found, scope, pictures=request.pictures))
        if not short_list:
            return []
        try:
            async with asyncio.timeout(self._select_timeout_s):
                chosen = set(await self._language.select_memories(request.request, short_list))
        except (LanguageError, TimeoutError) as error:
            self.log.warning("memories chosen by words alone", problem=str(error) or "no answer in time")
            return found
        return [entry for entry in short_list if entry.name in chosen]

    async def _search(self, words: str, scope: str | None, limit: int) -> list[MemoryEntry]:
        """By words, and by meaning where that is configured."""
        if self._meanings is None:
            return await self._store.search(words, limit, scope)
        lexical, alike = await asyncio.gather(
            self._store.search(words, limit, scope), self._meanings.alike(words, limit, scope)
        )
        return fused(lexical, alike, first=words)[:limit] if alike else lexical

    async def _fill_up(
        self, lexical: Sequence[MemoryEntry], scope: str | None, *, pictures: bool
    ) -> list[MemoryEntry]:
        """Add the newest memories up to the length of a short list.

        What matters need not share a word with the request; a small memory is thus shown whole.
        """
        newest = await self._store.newest(self._short_list, scope, pictures=pictures)
        unique = {(entry.name, entry.scope): entry for entry in [*lexical, *newest]}
        return list(unique.values())[: self._short_list]


def read_request(message: str) -> GetMemory:
    """Read a `get_memory` request: JSON as the contract says, or any text.

    Raises:
        InvalidMessageError: It is a JSON object, but not one of a request.
    """
    try:
        is_object = isinstance(json.loads(message), dict)
    except (ValueError, RecursionError):
        is_object = False
    return decode(GetMemory, message) if is_object else GetMemory(request=message)


def _own_first(entries: Sequence[MemoryEntry]) -> list[MemoryEntry]:
    """Of one name in several scopes only the one of the narrower scope, in the order in which they came."""
    own = {entry.name for entry in entries if entry.scope}
    return [entry for entry in entries if entry.scope or entry.name not in own]


def _time_order(entries: Sequence[MemoryEntry]) -> list[MemoryEntry]:
    """Oldest first; of one name in several scopes the one of the narrower scope wins."""
    one_each = {entry.name: entry for entry in sorted(entries, key=lambda entry: entry.scope != "")}
    return sorted(one_each.values(), key=lambda entry: entry.updated_unix_ms)


def _shown(entries: Sequence[MemoryEntry], request: GetMemory) -> list[MemoryEntry]:
    """With or without the data of pictures, as was asked for."""
    if request.pictures:
        return list(entries)
    return [e.model_copy(update={"data": ""}) if e.type == "image" else e for e in entries]


def _plain(error: StoreError) -> str:
    """What is wrong with the file, for operators."""
    if "disk is full" in str(error):
        return "there is no room left where I keep what I remember."
    return "my memory file cannot be written."
