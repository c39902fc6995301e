"""What is remembered."""

from __future__ import annotations

import re
from typing import Annotated, Final
from urllib.parse import urlencode

from fastapi import APIRouter, Query
from starlette.responses import Response

from parley.gate.table import Effect
from parley.messages import topics
from parley.messages.memory import (
    AddToMemory,
    GetMemory,
    MemoryBody,
    MemoryEntry,
    MemoryList,
    RemoveMemory,
)
from parley.sentences import SpokenLanguage, in_language
from parley.web.backend import Backend
from parley.web.bodies import Done, MemoryPut
from parley.web.models import MemoryItem
from parley.web.pictures import checked_image, read_image
from parley.web.problems import WebProblem
from parley.web.routes.access import Web, Who, may, module
from parley.web.showing import Reader

__all__ = ["router"]

router = APIRouter(prefix="/memory", tags=["memory"], dependencies=[module("memory")])

MAX_ITEMS: Final = 1000
MAX_FOUND: Final = 50

Name = Annotated[str, Query(min_length=1, max_length=200)]
"""Not in the path: "boxes/left", ".." and "?" are names as well."""
Scope = Annotated[str, Query(max_length=100)]


@router.get("", dependencies=[may(Effect.SEE)])
async def get_memories(
    web: Web, reader: Reader, q: Annotated[str, Query(max_length=500)] = "", scope: Scope = ""
) -> list[MemoryItem]:
    """All memories, the newest last, or those that `q` finds, the best first.

    With `scope` only those of a robot and everybody's.
    """
    if q.strip():
        found = await _ask(
            web, GetMemory(request=q, kind="search", scope=scope, pictures=False, limit=MAX_FOUND)
        )
    else:
        found = await _ask(web, GetMemory(request="", kind="list", scope=scope, pictures=False))
    return [_item(entry, reader) for entry in found[-MAX_ITEMS:]]


@router.get("/one", dependencies=[may(Effect.SEE)])
async def get_memory(name: Name, web: Web, reader: Reader, scope: Scope = "") -> MemoryItem:
    """One memory by its name."""
    return _item(await _get(web, name, scope, pictures=False), reader)


@router.get("/history", dependencies=[may(Effect.SEE)])
async def get_memory_history(name: Name, web: Web, reader: Reader, scope: Scope = "") -> list[MemoryItem]:
    """The versions of a memory that were replaced or forgotten, oldest first; pictures are left out."""
    request = GetMemory(request=name, kind="history", scope=scope, pictures=False)
    return [_item(entry, reader) for entry in await _ask(web, request)]


@router.get(
    "/image",
    response_class=Response,
    responses={200: {"content": {"image/jpeg": {}, "image/png": {}}}},
    dependencies=[may(Effect.SEE)],
)
async def get_memory_image(name: Name, web: Web, scope: Scope = "") -> Response:
    """The picture of a memory."""
    entry = await _get(web, name, scope, pictures=True)
    if entry.type != "image":
        raise WebProblem(404, "There is no picture with this memory.")
    data, media_type = read_image(entry.data)
    return Response(data, media_type=media_type)


@router.put("", dependencies=[may(Effect.REMEMBER)])
async def put_memory(name: Name, put: MemoryPut, web: Web, who: Who) -> Done:
    """Remember something under a name; what stood there before goes to the history."""
    if put.type == "image":
        checked_image(put.data)
    former = (await _former(web, name, put) if put.again else None) or MemoryBody(
        data="", source=who.by.name or "operator", way="told"
    )
    body = MemoryBody(
        type=put.type,
        data=put.data,
        info=put.info or (put.data[:200] if put.type == "text" else name),
        scope=put.scope,
        source=former.source,
        way=former.way,
        words=former.words,
        by=who.by,
    )
    await _change(web, AddToMemory({name: body}))
    return Done()


@router.delete("", dependencies=[may(Effect.FORGET)])
async def delete_memory(
    name: Name, web: Web, who: Who, scope: Annotated[str | None, Query(max_length=100)] = None
) -> Done:
    """Forget a memory, everywhere or with `scope` only there; the history keeps it."""
    await _change(web, RemoveMemory.of(name, who.by, scope))
    return Done()


async def _ask(web: Backend, request: GetMemory) -> tuple[MemoryEntry, ...]:
    return (await web.link.ask(topics.GET_MEMORY, request, MemoryList)).memories


async def _get(web: Backend, name: str, scope: str, *, pictures: bool) -> MemoryEntry:
    """The memory of that name: the robot's own, else everybody's, else any."""
    found = await _ask(web, GetMemory(request=name, kind="named", scope=scope, pictures=pictures))
    named = sorted(found, key=lambda entry: (entry.scope != scope, entry.scope != ""))
    if not named:
        raise WebProblem(404, f"Nothing is remembered under the name {name}.")
    return named[0]


async def _former(web: Backend, name: str, put: MemoryPut) -> MemoryEntry | None:
    """What is put back, by the history and not by who asks; None if it is not the same."""
    request = GetMemory(request=name, kind="history", scope=put.scope, pictures=put.type == "image")
    former = [entry for entry in await _ask(web, request) if entry.scope == put.scope]
    if former and (former[-1].type, former[-1].data) == (put.type, put.data):
        return former[-1]
    return None


async def _change(web: Backend, message: AddToMemory | RemoveMemory) -> None:
    try:
        event = await web.link.change_memory(message)
    except TimeoutError as error:
        raise WebProblem(504, "The memory does not answer.", "Try again.") from error
    if event.kind == "failed":
        is_unknown = isinstance(message, RemoveMemory)
        raise WebProblem(404 if is_unknown else 507, event.message or "That could not be stored.")


def _item(entry: MemoryEntry, language: SpokenLanguage) -> MemoryItem:
    is_image = entry.type == "image"
    query = urlencode({"name": entry.name} | ({"scope": entry.scope} if entry.scope else {}))
    return MemoryItem(
        name=entry.name,
        scope=entry.scope,
        type=entry.type,
        data=f"/api/memory/image?{query}" if is_image else entry.data,
        info=entry.info,
        told=_told(entry, language),
        source=entry.source,
        way=entry.way,
        words=entry.words,
        created_unix_ms=entry.created_unix_ms,
        updated_unix_ms=entry.updated_unix_ms,
        used_unix_ms=entry.used_unix_ms,
        used_count=entry.used_count,
    )


_POINT: Final = re.compile(r" at the point \(-?[\d.]+, -?[\d.]+\)")
"""Where on the map something was, which robots alone can use."""


def _told(entry: MemoryEntry, language: SpokenLanguage) -> str:
    """What robots note is put into the reader's words; what people said stays."""
    text = entry.info if entry.type == "image" else entry.data
    return text if entry.is_told else in_language(_POINT.sub("", text), language)
