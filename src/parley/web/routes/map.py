"""The map a robot drives by."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Path

from parley.gate.table import Effect
from parley.messages import topics
from parley.messages.map import GetMap, MapInfo
from parley.web.routes.access import Web, may, module

__all__ = ["router"]

router = APIRouter(prefix="/map", tags=["map"], dependencies=[module("map"), may(Effect.SEE)])


@router.get("/{robot}")
async def get_map(robot: Annotated[str, Path(max_length=100)], web: Web) -> MapInfo:
    """The map of a robot as a picture, and what stands where; what moves comes live as `view`."""
    return await web.link.ask(topics.GET_MAP, GetMap(robot=web.robot(robot).name), MapInfo)
