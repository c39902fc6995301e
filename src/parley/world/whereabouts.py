"""Where something that was seen stands, with regard to a place of the map. Pure."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Final, Literal

from parley.world.geometry import Pose2D, wrap_angle
from parley.world.object_map import PLACE, MapArea, MapObject, ObjectMap

__all__ = [
    "NEAR_M",
    "Footprint",
    "Place",
    "Standing",
    "bearings",
    "called",
    "middle_of",
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
    """Whether something stands in a place, on its edge, or outside; a mere spot reaches two metres around.

    Examples:
        >>> bay = MapObject("bay", "bay", 0.0, 0.0, width_m=2.0, height_m=2.0)
        >>> [standing(Footprint(x, 0.0, 0.4, 0.4), bay) for x in (0.0, 0.9, 1.5)]
        ['in', 'edge', 'outside']
    """
    if isinstance(place, MapObject) and place.class_name == PLACE and not place.width_m + place.height_m:
        return "in" if math.hypot(thing.x_m - place.x_m, thing.y_m - place.y_m) <= NEAR_M else "outside"
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
    gaps = [(item.gap_m(x_m, y_m), math.hypot(item.x_m - x_m, item.y_m - y_m), item) for item in objects]
    gap_m, _, found = min(gaps, key=lambda one: one[:2], default=(math.inf, math.inf, None))
    return found if gap_m <= NEAR_M else None


def named_place(text: str, known: ObjectMap, pose: Pose2D) -> tuple[Place | None, ObjectMap]:
    """The thing or room of the map that a text names, and the map without others of the same name.

    Of several names the longest counts, then the last; of several places with one name the nearest: a robot
    that looks there was sent there.

    Args:
        text: In words.
        known: The map.
        pose: Where the robot is.
    """
    low = f" {_plain(text)} "
    found: dict[tuple[int, int], list[Place]] = {}
    places: list[Place] = [*known.objects, *known.areas]
    for place in places:
        names = (place.name,) if isinstance(place, MapArea) else (place.description, *place.aliases)
        at, name = max(((low.rfind(f" {_plain(name)} "), _plain(name)) for name in names), default=(-1, ""))
        if at >= 0 and name:
            found.setdefault((len(name), at), []).append(place)
    if not found:
        return None, known
    same = sorted(found[max(found)], key=lambda place: _away_m(pose, place))
    others = {place.id for place in same[1:] if isinstance(place, MapObject)}
    return same[0], replace(known, objects=tuple(item for item in known.objects if item.id not in others))


def _plain(text: str) -> str:
    return re.sub(r"[^a-z0-9]+", " ", text.lower()).strip()


def _away_m(pose: Pose2D, place: Place) -> float:
    x_m, y_m = middle_of(place)
    return math.hypot(x_m - pose.x_m, y_m - pose.y_m)


def middle_of(place: Place) -> tuple[float, float]:
    """The middle of a thing, or of a room's corners."""
    if isinstance(place, MapObject):
        return place.x_m, place.y_m
    x, y = zip(*place.corners, strict=True)
    return sum(x) / len(x), sum(y) / len(y)


def bearings(pose: Pose2D, place: Place) -> tuple[float, float]:
    """Between which directions a place lies, from its right end to its left one; 0 is straight ahead."""
    if isinstance(place, MapArea):
        corners = list(place.corners)
    else:
        wide, high = place.width_m / 2, place.height_m / 2
        corners = [(place.x_m + dx * wide, place.y_m + dy * high) for dx in (-1, 1) for dy in (-1, 1)]
    middle = pose.bearing_to(*middle_of(place))
    aside = [wrap_angle(pose.bearing_to(x, y) - middle) for x, y in corners]
    ahead = wrap_angle(middle - pose.yaw_rad)
    return ahead + min(aside), ahead + max(aside)
