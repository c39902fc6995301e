"""What a map on a screen needs: the map itself (a service), and what moves on it (a topic). Ours."""

from __future__ import annotations

from pydantic import Field

from parley.messages.base import Payload
from parley.messages.status import PoseInfo

__all__ = ["GetMap", "MapInfo", "MapRoom", "MapThing", "MapView"]

Point = tuple[float, float]
"""x, y in the map frame, metres."""


class MapThing(Payload):
    """One object of the object map; its box is parallel to the axes of the map frame."""

    id: str
    kind: str = ""
    """Its class in the object map."""
    description: str = ""
    x: float
    y: float
    width: float = 0.0
    """Along x, metres."""
    height: float = 0.0
    """Along y, metres."""


class MapRoom(Payload):
    """A room, or another part of the map that has a name."""

    name: str
    corners: tuple[Point, ...]


class GetMap(Payload):
    """Request of `/parley/get_map`."""

    robot: str


class MapInfo(Payload):
    """Response of `/parley/get_map`: the occupancy map a robot drives by, and what stands where."""

    robot: str
    name: str = ""
    resolution: float = Field(gt=0)
    """Metres per pixel (map_server)."""
    width: int = Field(ge=1)
    """Pixels."""
    height: int = Field(ge=1)
    origin: PoseInfo
    """Pose of the picture's lower left corner in the map frame (map_server)."""
    image: str
    """Base64 of a grey PNG, first row on top: white free, black occupied, grey unknown."""
    objects: tuple[MapThing, ...] = ()
    rooms: tuple[MapRoom, ...] = ()


class MapView(Payload):
    """`/parley/map_view`: where a robot is and where it is going; a few times a second while it moves."""

    actor: str
    map_name: str = ""
    pose: PoseInfo
    room: str = ""
    """The part of the map with a name that it is in; empty: none."""
    holds: str = ""
    """What it has in its hand, in words; empty: nothing."""
    path: tuple[Point, ...] = ()
    """The planned way that still lies ahead."""
    goal: PoseInfo | None = None
    scan: tuple[Point, ...] = ()
    """Where the newest lidar sweep hit something; empty without a lidar."""
    unix_ms: int = 0
