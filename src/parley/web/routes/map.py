"""The map a robot drives by, and the rooms and things that people put there."""

from __future__ import annotations

import json
from typing import Annotated, Any, Literal

from fastapi import APIRouter, Path, Response

from parley.errors import UnavailableError
from parley.gate.table import Effect
from parley.messages import topics
from parley.messages.map import GetMap, MapInfo, PlaceChange, PlaceChanged
from parley.web.bodies import PlacePost
from parley.web.problems import WebProblem
from parley.web.routes.access import Web, Who, may, module

__all__ = ["router"]

router = APIRouter(prefix="/map", tags=["map"], dependencies=[module("map")])

Robot = Annotated[str, Path(max_length=100)]


@router.get("/{robot}", dependencies=[may(Effect.SEE)])
async def get_map(robot: Robot, web: Web) -> MapInfo:
    """The map of a robot as a picture, and what stands where; what moves comes live as `view`."""
    return await web.link.ask(topics.GET_MAP, GetMap(robot=web.robot(robot).name), MapInfo)


async def _change(web: Web, request: PlaceChange) -> PlaceChanged:
    """Ask whoever keeps what people put on the maps.

    Raises:
        WebProblem: They refuse, or are not there.
    """
    try:
        answer = await web.link.ask(topics.PLACES, request, PlaceChanged)
    except UnavailableError as error:
        raise WebProblem(503, "Nobody keeps the map here.", "Start a system that does.") from error
    if answer.problem:
        raise WebProblem(409, answer.problem)
    return answer


@router.post("/{robot}/places", dependencies=[may(Effect.MAP)])
async def change_place(robot: Robot, post: PlacePost, web: Web, who: Who) -> PlaceChanged:
    """Put a room or thing on a robot's map, change it, or take it off; or only tell what would come of it."""
    what: Literal["try", "change"] = "try" if post.only_try else "change"
    told = post.model_dump(exclude={"only_try"})
    return await _change(
        web, PlaceChange.model_validate(told | {"what": what, "robot": web.robot(robot).name, "by": who.by})
    )


@router.get("/{robot}/file", dependencies=[may(Effect.SEE)])
async def get_object_map(robot: Robot, web: Web) -> Response:
    """The object map of a robot's map as a file, with what people put there."""
    whole = (await _change(web, PlaceChange(what="whole", robot=web.robot(robot).name))).whole
    return Response(
        json.dumps(whole, ensure_ascii=False, indent=1) + "\n",
        media_type="application/json",
        headers={"Content-Disposition": 'attachment; filename="object_map.json"'},
    )


@router.put("/{robot}/file", dependencies=[may(Effect.MAP)])
async def put_object_map(robot: Robot, whole: dict[str, Any], web: Web, who: Who) -> PlaceChanged:
    """Take over an object map in the place of the rooms and things that are on a robot's map."""
    name = web.robot(robot).name
    return await _change(web, PlaceChange(what="load", robot=name, whole=whole, by=who.by))
