"""Where something that was seen stands, with regard to a place of the map. Pure."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Final, Literal

from parley.world.geometry import Pose2D, wrap_angle
from parley.world.object_map import MapArea, MapObject, ObjectMap

__all__ = [
    "NEAR_M",
    "Footprint",
    "Place",
    "Standing",
    "bearings",
    "called",
    "named_place",
    "nearest",
    "standing",
]

Place = MapObject | MapArea
Standing = Literal["in", "edge", "outside"]

NEAR_M: Final = 2.0
"""A thing on the map that is no farther away may be named to say where something is."""
_EDGE_M: Final = 0.3
_TOUCHING_M: Final = 0.1
"""What stands so close to a place belongs to its edge."""


@dataclass(frozen=True, slots=True)
class Footprint:
    """What something covers of the floor, as far as that was seen: a box in the map frame."""

    x_m: float
    y_m: float
    width_m: float = 0.0
    """Along the map's x."""
    height_m: float = 0.0
    """Along the map's y."""


def called(name: str) -> str:
    """A thing's name inside a sentence: names of their own go without an article."""
    return name if name[:1].isupper() else f"the {name}"


def standing(thing: Footprint, place: Place) -> Standing:
    """Whether something stands in a place, on its edge, or outside.

    Examples:
        >>> bay = MapObject("bay", "bay", 0.0, 0.0, width_m=2.0, height_m=2.0)
        >>> [standing(Footprint(x, 0.0, 0.4, 0.4), bay) for x in (0.0, 0.9, 1.5)]
        ['in', 'edge', 'outside']
    """
    if isinstance(place, MapArea):
        corners = [
            place.holds(thing.x_m + dx * thing.width_m / 2, thing.y_m + dy * thing.height_m / 2)
            for dx in (-1, 1) for dy in (-1, 1)
        ]  # fmt: skip
        return "in" if all(corners) else "edge" if any(corners) else "outside"
    sides = (
        (abs(thing.x_m - place.x_m), thing.width_m / 2, place.width_m / 2),
        (abs(thing.y_m - place.y_m), thing.height_m / 2, place.height_m / 2),
    )
    if any(away - own > half + _TOUCHING_M for away, own, half in sides):
        return "outside"
    inside = all(away + own <= half - min(_EDGE_M, half / 4) for away, own, half in sides)
    return "in" if inside else "edge"


def nearest(x_m: float, y_m: float, objects: Iterable[MapObject]) -> MapObject | None:
    """The thing of the map by which a point is, if one is near enough to say so; first what holds it."""
    gaps = [
        (
            math.hypot(
                max(abs(item.x_m - x_m) - item.width_m / 2, 0.0),
                max(abs(item.y_m - y_m) - item.height_m / 2, 0.0),
            ),
            math.hypot(item.x_m - x_m, item.y_m - y_m),
            item,
        )
        for item in objects
    ]
    gap_m, _, found = min(gaps, key=lambda one: one[:2], default=(math.inf, math.inf, None))
    return found if gap_m <= NEAR_M else None


def named_place(text: str, known: ObjectMap) -> Place | None:
    """The thing or room of the map whose name stands in a text; of several the longest name, then the last.

    Examples:
        >>> bay, hall = MapObject("b", "bay 1", 0.0, 0.0), MapObject("h", "hall", 0.0, 0.0)
        >>> named_place("whether Bay 1 is clear", ObjectMap((bay, hall))) is bay
        True
    """
    low = f" {re.sub(r'[^a-z0-9]+', ' ', text.lower())} "
    found: list[tuple[int, int, Place]] = []
    places: list[Place] = [*known.objects, *known.areas]
    for place in places:
        names = (place.name,) if isinstance(place, MapArea) else (place.description, *place.aliases)
        for name in names:
            at = low.rfind(f" {re.sub(r'[^a-z0-9]+', ' ', name.lower()).strip()} ")
            if at >= 0 and name.strip():
                found.append((len(name), at, place))
    return max(found, key=lambda one: one[:2])[2] if found else None


def bearings(pose: Pose2D, place: Place) -> tuple[float, float]:
    """Between which directions a place lies, from its right end to its left one; 0 is straight ahead."""
    if isinstance(place, MapArea):
        corners = list(place.corners)
    else:
        wide, high = place.width_m / 2, place.height_m / 2
        corners = [(place.x_m + dx * wide, place.y_m + dy * high) for dx in (-1, 1) for dy in (-1, 1)]
    middle = pose.bearing_to(
        sum(x for x, _ in corners) / len(corners), sum(y for _, y in corners) / len(corners)
    )
    aside = [wrap_angle(pose.bearing_to(x, y) - middle) for x, y in corners]
    ahead = wrap_angle(middle - pose.yaw_rad)
    return ahead + min(aside), ahead + max(aside)
