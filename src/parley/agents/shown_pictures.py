"""The pictures that a language engine may look at: those sent with a message, and remembered ones."""

from __future__ import annotations

import asyncio
import base64
from collections.abc import Sequence

import structlog

from parley.errors import InvalidMessageError, TransportError
from parley.language.base import Picture
from parley.memory.client import ask_memory
from parley.memory.pictures import MAX_PICTURES, PictureError, modest_jpeg
from parley.messages.chat import ChatImage
from parley.messages.memory import GetMemory, MemoryEntry
from parley.transport.base import Transport

__all__ = ["remembered_pictures", "sent_pictures"]

log = structlog.get_logger(__name__)


async def sent_pictures(images: Sequence[ChatImage]) -> tuple[Picture, ...]:
    """Those of a message, brought to a modest size; what is no picture is left out."""
    pictures: list[Picture] = []
    for image in images[:MAX_PICTURES]:
        try:
            data = await asyncio.to_thread(modest_jpeg, image.data)
        except PictureError as error:
            log.info("picture left out", name=image.name, problem=str(error))
            continue
        pictures.append(Picture(image.name, base64.b64decode(data), sent=True))
    return tuple(pictures)


async def remembered_pictures(
    transport: Transport, memory: Sequence[MemoryEntry], scope: str
) -> tuple[Picture, ...]:
    """The newest pictures among memories that came without their data; none if the memory does not answer."""
    wanted = [entry for entry in memory if entry.type == "image"][-MAX_PICTURES:]
    pictures: list[Picture] = []
    for entry in wanted:
        request = GetMemory(request=entry.name, scope=scope, kind="named", type="image")
        try:
            found = [item for item in await ask_memory(transport, request) if item.scope == entry.scope]
            pictures += [Picture(item.name, base64.b64decode(item.data)) for item in found[-1:] if item.data]
        except (TransportError, InvalidMessageError, ValueError) as error:
            log.warning("picture not fetched", name=entry.name, problem=str(error))
    return tuple(pictures)
