"""Pictures from robots."""

from __future__ import annotations

from typing import Annotated, Final

from fastapi import APIRouter, Path
from starlette.responses import Response

from parley.gate.table import Effect
from parley.web.models import FeedInfo
from parley.web.problems import WebProblem
from parley.web.routes.access import Web, may, module

__all__ = ["router"]

router = APIRouter(prefix="/feeds", tags=["feeds"], dependencies=[module("display"), may(Effect.SEE)])

PICTURE_WITHIN_S: Final = 3.0
"""Wall time to wait for a camera that nobody watched until now."""

Part = Annotated[str, Path(max_length=100)]


@router.get("")
async def get_feeds(web: Web) -> list[FeedInfo]:
    """All feeds; their pictures come live as `frame` to those who `watch`."""
    return list(web.state.feeds.infos.values())


@router.get("/{robot}/{name}.jpg", response_class=Response, responses={200: {"content": {"image/jpeg": {}}}})
async def get_picture(robot: Part, name: Part, web: Web) -> Response:
    """The newest picture of a feed."""
    picture = await web.feeds.newest((robot, name), within_s=PICTURE_WITHIN_S)
    if picture is None:
        raise WebProblem(404, "There is no picture yet.", "Look again later.")
    return Response(picture.data, media_type="image/jpeg", headers={"X-Unix-Ms": str(picture.unix_ms)})
