"""The object map in the thesis's JSON: what stands where, in words.

::

    {"classes": ["chair"],
     "items": {"chair": [{"id": "chair_1", "description": "chair by the window",
                          "coordinates": {"x": 1.0, "y": 2.0}, "dimensions": {"height": 0.5, "width": 0.4}}]}}

`dimensions` are the bounding box in the map plane: `width` along x, `height` along y, in metres.
Ours, optional: `aliases` (other names people use for it) and `front` (the direction its open or usable side
faces, radians in the map frame: stand there to use it) or `stand` (`x`, `y`, `yaw`: where exactly a robot
stands for it, and which way it looks); beside `items`, `areas`: rooms and the like, each with a `name` and
its `corners`, for people to see on the map and to send robots to; with a `capacity` no more robots than that
are in it at once.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, field
from typing import Any, Final, Self

from pydantic import BaseModel, ConfigDict, Field

from parley.errors import FileFormatError
from parley.files import TextFile, parse_json, validated
from parley.world.geometry import Extent, Metres, Pose2D

__all__ = ["PLACE", "MapArea", "MapObject", "ObjectMap"]

PLACE: Final = "place"
"""Class of what is nothing but a place with a name."""

_PERSON: Final = "person"
_CHARGERS: Final = frozenset({"dock", "charger"})
_CHARGING: Final = frozenset({"charger", "charging", "recharging"})


@dataclass(frozen=True, slots=True)
class MapObject:
    """One thing that people may name."""

    id: str
    description: str
    x_m: float
    y_m: float
    class_name: str = ""
    width_m: float = 0.0
    """Extent along the map's x."""
    height_m: float = 0.0
    """Extent along the map's y."""
    aliases: tuple[str, ...] = ()
    front_rad: float | None = None
    """Map-frame direction its usable side faces; None: it can be used from anywhere."""
    stand: Pose2D | None = None
    """Where a robot stands for it, and which way it looks; None: that is worked out."""
    area: MapArea | None = None
    """A room as a goal: one stands in it, not before it."""
    found: bool = False
    """Whether a robot saw it there, and no map said so."""

    @property
    def charges(self) -> bool:
        """Whether, by what it is called, robots charge there."""
        words = {*re.findall(r"\w+", " ".join((self.description, *self.aliases)).lower())}
        return self.class_name.lower() in _CHARGERS or bool(words & _CHARGING)

    def gap_m(self, x_m: float, y_m: float) -> float:
        """From a point to its outline; 0 inside."""
        beside = max(abs(self.x_m - x_m) - self.width_m / 2, 0.0)
        along = max(abs(self.y_m - y_m) - self.height_m / 2, 0.0)
        return math.hypot(beside, along)


@dataclass(frozen=True, slots=True)
class MapArea:
    """A room, or another part of the map that has a name."""

    name: str
    corners: tuple[tuple[float, float], ...]
    """x, y in the map frame, metres, one after the other around it."""
    capacity: int | None = None
    """So many robots may be in it at once: a narrow doorway, a lift, a dock; None: any number."""

    @property
    def goal(self) -> MapObject:
        """As something to drive to."""
        xs, ys = zip(*self.corners, strict=True)
        wide, high = max(xs) - min(xs), max(ys) - min(ys)
        middle = (min(xs) + wide / 2, min(ys) + high / 2)
        return MapObject(f"room {self.name}", self.name, *middle, "room", wide, high, area=self)

    def holds(self, x_m: float, y_m: float) -> bool:
        """Whether a place is in it: a line from there to the right leaves it an odd number of times."""
        sides = zip(self.corners, self.corners[1:] + self.corners[:1], strict=True)
        crossed = [
            x_m < x + (y_m - y) * (other_x - x) / (other_y - y)
            for (x, y), (other_x, other_y) in sides
            if (y > y_m) != (other_y > y_m)
        ]
        return sum(crossed) % 2 == 1

    def gap_m(self, x_m: float, y_m: float) -> float:
        """From a place to its border; 0 inside."""
        if self.holds(x_m, y_m):
            return 0.0
        sides = zip(self.corners, self.corners[1:] + self.corners[:1], strict=True)
        return min(_gap_m((x_m, y_m), one, other) for one, other in sides)


def _gap_m(place: tuple[float, float], one: tuple[float, float], other: tuple[float, float]) -> float:
    """From a place to a straight line between two others."""
    along_x, along_y = other[0] - one[0], other[1] - one[1]
    length = along_x**2 + along_y**2
    share = ((place[0] - one[0]) * along_x + (place[1] - one[1]) * along_y) / length if length else 0.0
    share = min(1.0, max(0.0, share))
    return math.hypot(one[0] + share * along_x - place[0], one[1] + share * along_y - place[1])


class _Coordinates(BaseModel):
    model_config = ConfigDict(extra="ignore", allow_inf_nan=False)
    x: Metres
    y: Metres


class _Dimensions(BaseModel):
    model_config = ConfigDict(extra="ignore", allow_inf_nan=False)
    height: Extent
    width: Extent


class _Stand(BaseModel):
    model_config = ConfigDict(extra="ignore", allow_inf_nan=False)
    x: Metres
    y: Metres
    yaw: float = 0.0


class _Item(BaseModel):
    model_config = ConfigDict(extra="ignore", allow_inf_nan=False)
    id: str = Field(min_length=1, coerce_numbers_to_str=True)
    description: str = Field(min_length=1)
    coordinates: _Coordinates
    dimensions: _Dimensions
    aliases: list[str] = Field(default_factory=list)
    front: float | None = Field(default=None)
    stand: _Stand | None = None


class _Area(BaseModel):
    model_config = ConfigDict(extra="forbid", allow_inf_nan=False)
    name: str = Field(min_length=1)
    corners: list[tuple[Metres, Metres]] = Field(min_length=3)
    capacity: int | None = Field(default=None, ge=1)


class _File(BaseModel):
    model_config = ConfigDict(extra="ignore", allow_inf_nan=False)
    classes: list[str]
    items: dict[str, list[_Item]]
    areas: list[_Area] = Field(default_factory=list)


@dataclass(frozen=True, slots=True)
class ObjectMap(TextFile):
    """All objects of one map, ids unique."""

    objects: tuple[MapObject, ...] = field(default=())
    areas: tuple[MapArea, ...] = field(default=())

    @property
    def rooms(self) -> tuple[MapObject, ...]:
        """The areas as goals."""
        return tuple(area.goal for area in self.areas)

    @property
    def places(self) -> tuple[MapObject, ...]:
        """All to which words may lead: objects and rooms."""
        return self.objects + self.rooms

    def get(self, object_id: str) -> MapObject | None:
        """The object of that id, or None."""
        return next((item for item in self.objects if item.id == object_id), None)

    @property
    def people(self) -> tuple[tuple[float, float], ...]:
        """Where somebody is: things of the class `person`."""
        return tuple((item.x_m, item.y_m) for item in self.objects if item.class_name == _PERSON)

    @classmethod
    def parse(cls, text: str, file: str = "object map") -> Self:
        """Read the JSON text of an object map; `file` is only for messages.

        Raises:
            FileFormatError: Names the file and the field.
        """
        return cls.of_json(parse_json(text, file), file)

    @classmethod
    def of_json(cls, told: Any, file: str = "object map") -> Self:
        """The object map of a JSON value; `file` is only for messages.

        Raises:
            FileFormatError: Names the file and the field.
        """
        parsed = validated(_File, told, file)
        areas = (MapArea(area.name, tuple(area.corners), area.capacity) for area in parsed.areas)
        return cls(tuple(_objects(parsed, file)), tuple(areas))

    def to_json(self) -> dict[str, Any]:
        """The thesis's form."""
        items: dict[str, list[dict[str, Any]]] = {}
        for item in self.objects:
            body: dict[str, Any] = {
                "id": item.id,
                "description": item.description,
                "coordinates": {"x": item.x_m, "y": item.y_m},
                "dimensions": {"height": item.height_m, "width": item.width_m},
            }
            if item.aliases:
                body["aliases"] = list(item.aliases)
            if item.front_rad is not None:
                body["front"] = item.front_rad
            if item.stand is not None:
                body["stand"] = {"x": item.stand.x_m, "y": item.stand.y_m, "yaw": item.stand.yaw_rad}
            items.setdefault(item.class_name, []).append(body)
        areas = [
            {"name": area.name, "corners": [list(corner) for corner in area.corners]}
            | ({"capacity": area.capacity} if area.capacity is not None else {})
            for area in self.areas
        ]
        return {"classes": sorted(items), "items": items} | ({"areas": areas} if areas else {})


def _objects(parsed: _File, file: str) -> list[MapObject]:
    found: list[MapObject] = []
    seen: set[str] = set()
    for class_name, items in parsed.items.items():
        for index, item in enumerate(items):
            if item.id in seen:
                raise FileFormatError(file, f"items.{class_name}[{index}].id", f"{item.id!r} is used twice")
            seen.add(item.id)
            found.append(
                MapObject(
                    id=item.id,
                    description=item.description,
                    x_m=item.coordinates.x,
                    y_m=item.coordinates.y,
                    class_name=class_name,
                    width_m=item.dimensions.width,
                    height_m=item.dimensions.height,
                    aliases=tuple(item.aliases),
                    front_rad=item.front,
                    stand=Pose2D(item.stand.x, item.stand.y, item.stand.yaw) if item.stand else None,
                )
            )
    return found
