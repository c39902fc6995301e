"""Answers `/parley/get_map`: the map a robot drives by, as a picture, and the things on it."""

from __future__ import annotations

import asyncio
import base64
import io
from collections.abc import Mapping
from typing import ClassVar, Protocol

from PIL import Image

from parley.agents.base import Node
from parley.errors import InvalidMessageError
from parley.messages import topics
from parley.messages.map import GetMap, MapInfo, MapRoom, MapThing
from parley.messages.ros import ChatRequest, ChatResponse
from parley.messages.status import PoseInfo
from parley.messages.wire import decode, encode
from parley.transport.base import Transport
from parley.world.object_map import MapArea, MapObject, ObjectMap
from parley.world.occupancy import OccupancyMap

__all__ = ["MapService", "map_info", "room_of", "thing_of"]


class KnownMap(Protocol):
    """What one robot knows of its surroundings, as it is now."""

    @property
    def occupancy(self) -> OccupancyMap:
        """The floor it drives by."""
        ...

    @property
    def objects(self) -> ObjectMap:
        """What stands on it."""
        ...


class MapService(Node):
    """Knows the maps of all robots of a system.

    Args:
        transport: Where it answers.
        maps: By robot.
    """

    name: ClassVar[str] = "map_service"

    def __init__(self, transport: Transport, maps: Mapping[str, KnownMap]) -> None:
        super().__init__(transport)
        self._maps = maps

    async def open(self) -> None:
        """See `Node.open`."""
        server = await self.transport.serve(topics.GET_MAP, self._on_get)
        self.opened.push_async_callback(server.close)

    async def _on_get(self, request: ChatRequest) -> ChatResponse:
        """A `MapInfo`, or an empty object: there is no such map, or the request cannot be read."""
        try:
            robot = decode(GetMap, request.message).robot
        except InvalidMessageError as error:
            self.refuse(topics.GET_MAP.name, error)
            return ChatResponse("{}")
        if robot not in self._maps:
            return ChatResponse("{}")
        known = self._maps[robot]
        info = await asyncio.to_thread(map_info, robot, known.occupancy, known.objects)
        return ChatResponse(encode(info))


def map_info(robot: str, occupancy: OccupancyMap, objects: ObjectMap) -> MapInfo:
    """The message about one map."""
    buffer = io.BytesIO()
    Image.fromarray(occupancy.to_pixels()).save(buffer, "PNG")
    rows, columns = occupancy.cells.shape
    return MapInfo(
        robot=robot,
        name=occupancy.name,
        resolution=occupancy.resolution_m,
        width=columns,
        height=rows,
        origin=PoseInfo(x=occupancy.origin_x_m, y=occupancy.origin_y_m),
        image=base64.b64encode(buffer.getvalue()).decode("ascii"),
        objects=tuple(map(thing_of, objects.objects)),
        rooms=tuple(map(room_of, objects.areas)),
    )


def thing_of(item: MapObject) -> MapThing:
    """The message about one thing."""
    stand = item.stand
    return MapThing(
        id=item.id,
        kind=item.class_name,
        description=item.description,
        x=item.x_m,
        y=item.y_m,
        width=item.width_m,
        height=item.height_m,
        aliases=item.aliases,
        front=item.front_rad,
        stand=PoseInfo(x=stand.x_m, y=stand.y_m, yaw=stand.yaw_rad) if stand is not None else None,
        found=item.found,
    )


def room_of(area: MapArea) -> MapRoom:
    """The message about one room."""
    return MapRoom(name=area.name, corners=area.corners)
