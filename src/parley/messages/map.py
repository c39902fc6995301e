"""What a map on a screen needs: the map itself, what people put on it, and what moves on it. Ours."""

from __future__ import annotations

from typing import Any, Literal

from pydantic import Field

from parley.messages.base import Payload
from parley.messages.principal import Principal
from parley.messages.status import PoseInfo
from parley.sentences import SpokenLanguage

__all__ = ["GetMap", "MapInfo", "MapRoom", "MapThing", "MapView", "PlaceChange", "PlaceChanged", "PlacesKept"]

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
    aliases: tuple[str, ...] = ()
    front: float | None = None
    """Which way its usable side faces, radians in the map frame."""
    stand: PoseInfo | None = None
    """Where a robot stands for it, and which way it looks; None: that is worked out."""
    found: bool = False
    """Whether a robot saw it there, and nobody put it on the map."""


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
    places: str = ""
    """Another one than before: rooms or things changed, ask for the map again."""
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


class PlaceChange(Payload):
    """Request of `/parley/places`: one room or thing that a person puts on the map, changes or takes off."""

    what: Literal["change", "try", "whole", "load"] = "change"
    """`try`: only tell what would come of it; `whole`: give the object map; `load`: take over `whole`."""
    robot: str
    """Whose map it is."""
    was: MapRoom | MapThing | None = None
    """As it was shown to who changes it; None: it is new. Without `put` it is taken off the map."""
    put: MapRoom | MapThing | None = None
    """As it is to be; a thing with an empty id gets one."""
    anyway: bool = False
    """Whether it may have the name of another one."""
    whole: dict[str, Any] | None = None
    """For `load`: an object map."""
    words: str = ""
    """What the person said, if it was told."""
    by: Principal | None = None
    language: SpokenLanguage = "en"
    """Of what is told in words."""


class PlaceChanged(Payload):
    """Response of `/parley/places`."""

    put: MapRoom | MapThing | None = None
    """As it stands on the map now, or with `try` would."""
    same: tuple[MapRoom | MapThing, ...] = ()
    """What has that name already: nothing was done, who changes it has to say which is meant."""
    notes: tuple[str, ...] = ()
    """What people should know about it: that no robot gets there, or may go there."""
    problem: str = ""
    """Why nothing was done, in plain words; empty if it was."""
    whole: dict[str, Any] | None = None
    """For `whole`: the object map, in the thesis's form."""


class PlacesKept(Payload):
    """`/parley/places_kept`, latched: what people changed on all maps."""

    maps: dict[str, dict[str, Any]] = Field(default_factory=dict)
    """Name of a map -> an object map of what they put there, with what they took off; see
    `parley.world.placed`."""
