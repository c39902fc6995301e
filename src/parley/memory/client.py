"""Asking the memory node, for nodes."""

from __future__ import annotations

from typing import Final

import structlog

from parley.errors import InvalidMessageError, TransportError
from parley.memory.limits import MOST_MEMORIES
from parley.messages import topics
from parley.messages.memory import GetMemory, MemoryEntry, MemoryList, MemoryReply
from parley.messages.ros import ChatRequest
from parley.messages.wire import decode, encode
from parley.transport.base import Transport

__all__ = ["ask_memory", "recall", "recall_newest"]

TIMEOUT_S: Final = 5.0

log = structlog.get_logger(__name__)


async def recall(
    transport: Transport, request: str, *, scope: str = "", pictures: bool = False
) -> tuple[MemoryEntry, ...]:
    """Memories that matter for `request`, oldest first; none when the memory does not answer in time.

    Pictures come without their data unless `pictures` is set: they are long.
    Going on without memories is better than not answering a person; it is logged.
    """
    query = ChatRequest(encode(GetMemory(request=request, scope=scope, pictures=pictures)))
    try:
        answer = await transport.call(topics.GET_MEMORY, query, timeout_s=TIMEOUT_S)
        return tuple(decode(MemoryReply, answer.response).entries())
    except (TransportError, InvalidMessageError) as error:
        log.warning("memory did not answer", error=str(error))
        return ()


async def recall_newest(
    transport: Transport, *, scope: str = "", limit: int = MOST_MEMORIES
) -> tuple[MemoryEntry, ...]:
    """The newest memories, oldest first, pictures without their data; none without an answer in time."""
    request = GetMemory(request="", scope=scope, kind="list", pictures=False, limit=limit)
    try:
        return await ask_memory(transport, request)
    except (TransportError, InvalidMessageError) as error:
        log.warning("memory did not answer", error=str(error))
        return ()


async def ask_memory(transport: Transport, request: GetMemory) -> tuple[MemoryEntry, ...]:
    """What a request of one of our own kinds finds; see `GetMemory.kind`.

    Raises:
        TransportError: The memory does not answer.
        InvalidMessageError: Its answer cannot be read.
    """
    answer = await transport.call(topics.GET_MEMORY, ChatRequest(encode(request)), timeout_s=TIMEOUT_S)
    return decode(MemoryList, answer.response).memories
