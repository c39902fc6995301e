"""The memory node: remembers, forgets, and hands out what matters for a request (thesis 4.3.8)."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Awaitable, Sequence
from typing import ClassVar

from parley.errors import InvalidMessageError, LanguageError, StoreError
from parley.language.base import Language
from parley.memory.store import MemoryStore
from parley.messages import topics
from parley.messages.memory import (
    RETURN_ALL,
    AddToMemory,
    GetMemory,
    MemoryEntry,
    MemoryEvent,
    MemoryReply,
    RemoveMemory,
)
from parley.messages.ros import ChatRequest, ChatResponse
from parley.messages.wire import decode, encode
from parley.nodes.base import Node
from parley.transport.base import Transport

__all__ = ["MemoryNode", "read_request"]


class MemoryNode(Node):
    """Serves one memory store to everybody on the transport.

    Changes happen in the order they arrive and are announced on `/parley/memory_event` once they are durable.
    Requests are answered side by side: a slow language engine delays neither changes nor other requests.

    Args:
        transport: Where everybody is.
        store: An open store; the caller closes it.
        language: Picks from the short list what matters.
        short_list: How many memories the language engine is shown.
        select_timeout_s: How long it may take (wall time) before the lexical finds are used instead.
    """

    name: ClassVar[str] = "memory"

    def __init__(
        self,
        transport: Transport,
        store: MemoryStore,
        language: Language,
        *,
        short_list: int = 20,
        select_timeout_s: float = 5.0,
    ) -> None:
        super().__init__(transport)
        self._store, self._language = store, language
        self._short_list, self._select_timeout_s = short_list, select_timeout_s

    async def open(self) -> None:
        """See `Node.open`."""
        await self.subscribe(topics.ADD_TO_MEMORY, AddToMemory, self._on_add)
        await self.subscribe(topics.REMOVE_MEMORY, RemoveMemory, self._on_remove)
        server = await self.transport.serve(topics.GET_MEMORY, self._on_get)
        self.opened.push_async_callback(server.close)

    async def _on_add(self, message: AddToMemory) -> None:
        for entry in message.entries():
            await self._change(entry.name, "remember", self._add(entry))

    async def _add(self, entry: MemoryEntry) -> MemoryEvent:
        await self._store.add(entry)
        return MemoryEvent(kind="added", name=entry.name)

    async def _on_remove(self, message: RemoveMemory) -> None:
        for name in message.root:
            await self._change(name, "forget", self._remove(name))

    async def _remove(self, name: str) -> MemoryEvent:
        if await self._store.remove(name, scope=None):
            return MemoryEvent(kind="removed", name=name)
        return MemoryEvent(kind="failed", name=name, message=f"I remember nothing under the name {name}.")

    async def _change(self, name: str, verb: str, change: Awaitable[MemoryEvent]) -> None:
        try:
            event = await change
        except StoreError as error:
            self.log.error("memory not changed", name=name, verb=verb, problem=str(error))
            said = f"I could not {verb} that: my memory file cannot be written."
            event = MemoryEvent(kind="failed", name=name, message=said)
        self.publish(topics.MEMORY_EVENT, event)

    async def _on_get(self, asked: ChatRequest) -> ChatResponse:
        try:
            request = read_request(asked.message)
        except InvalidMessageError as error:
            self.refuse(topics.GET_MEMORY.name, error)
            raise
        found = await self._find(request)
        return ChatResponse(encode(MemoryReply({entry.name: entry for entry in _time_order(found)})))

    async def _find(self, request: GetMemory) -> list[MemoryEntry]:
        scope = request.scope or None
        if request.request.strip().rstrip(".!").casefold() == RETURN_ALL:
            return await self._store.all(scope)
        lexical = await self._store.search(request.request, self._short_list, scope)
        short_list = await self._fill_up(lexical, scope)
        if not short_list:
            return []
        try:
            async with asyncio.timeout(self._select_timeout_s):
                chosen = set(await self._language.select_memories(request.request, short_list))
        except (LanguageError, TimeoutError) as error:
            self.log.warning("memories chosen by words alone", problem=str(error) or "no answer in time")
            return lexical
        return [entry for entry in short_list if entry.name in chosen]

    async def _fill_up(self, lexical: Sequence[MemoryEntry], scope: str | None) -> list[MemoryEntry]:
        """Add the newest memories up to the length of a short list.

        What matters need not share a word with the request; a small memory is thus shown whole.
        """
        newest = await self._store.newest(self._short_list, scope)
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


def _time_order(entries: Sequence[MemoryEntry]) -> list[MemoryEntry]:
    """Oldest first; of one name in several scopes the one of the narrower scope wins."""
    one_each = {entry.name: entry for entry in sorted(entries, key=lambda entry: entry.scope != "")}
    return sorted(one_each.values(), key=lambda entry: entry.updated_unix_ms)
