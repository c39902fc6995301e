"""The conversation: what was said, and saying something."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Path, Query
from starlette.responses import Response

from parley.gate.stop_words import calls_to_stop
from parley.gate.table import Effect
from parley.web.bodies import ChatPage, ChatPost
from parley.web.models import ChatEntry
from parley.web.problems import WebProblem
from parley.web.routes.access import Web, Who, may, module
from parley.web.showing import Reader, shown_in

__all__ = ["router"]

router = APIRouter(prefix="/chat", tags=["chat"], dependencies=[module("chat")])


@router.get("", dependencies=[may(Effect.SEE)])
async def get_chat(
    web: Web,
    reader: Reader,
    before: Annotated[int | None, Query(ge=0, le=2**53)] = None,
    limit: Annotated[int, Query(ge=1, le=500)] = 50,
    q: Annotated[str, Query(max_length=200)] = "",
    robot: Annotated[str, Query(max_length=100)] = "",
) -> ChatPage:
    """A piece of the conversation: the newest entries before `before` that contain all words of `q`."""
    entries, complete = await web.store.page(before=before, limit=limit, words=q, robot=robot)
    return ChatPage.model_validate(shown_in(reader, ChatPage(entries=tuple(entries), complete=complete)))


@router.post("", dependencies=[may(Effect.SPEAK, Effect.STOP)])
async def post_chat(post: ChatPost, web: Web, who: Who) -> ChatEntry:
    """Say something to robots; it is kept durably before it is sent. Everybody may call to stop."""
    if not calls_to_stop(post.text):
        who.need(Effect.SPEAK)
    return await web.say(post, who.by)


@router.get(
    "/images/{key}",
    response_class=Response,
    responses={200: {"content": {"image/jpeg": {}, "image/png": {}}}},
    dependencies=[may(Effect.SEE)],
)
async def get_image(key: Annotated[str, Path(max_length=100)], web: Web) -> Response:
    """A picture that was attached to a message."""
    picture = await web.store.picture(key)
    if picture is None:
        raise WebProblem(404, "This picture is not kept any more.")
    return Response(picture.data, media_type=picture.media_type)
