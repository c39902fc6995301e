"""Asking the memory node, for nodes."""

from __future__ import annotations

from typing import Final

import structlog

from parley.errors import InvalidMessageError, TransportError
from parley.messages import topics
from parley.messages.memory import GetMemory, MemoryEntry, MemoryReply
from parley.messages.ros import ChatRequest
from parley.messages.wire import decode, encode
from parley.transport.base import Transport

__all__ = ["recall"]

TIMEOUT_S: Final = 5.0

log = structlog.get_logger(__name__)


async def recall(transport: Transport, request: str, *, scope: str = "") -> tuple[MemoryEntry, ...]:
    """Memories that matter for `request`, oldest first; none when the memory does not answer in time.

    Going on without memories is better than not answering a person; it is logged.
    """
    query = ChatRequest(encode(GetMemory(request=request, scope=scope)))
    try:
        answer = await transport.call(topics.GET_MEMORY, query, timeout_s=TIMEOUT_S)
        return tuple(decode(MemoryReply, answer.response).entries())
    except (TransportError, InvalidMessageError) as error:
        log.warning("memory did not answer", error=str(error))
        return ()
