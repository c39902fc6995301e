"""Choosing among objects by where they are (map frame, metres)."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

from parley.world.geometry import Pose2D
from parley.world.object_map import MapObject

__all__ = [
    "all_at",
    "between",
    "by_anchor",
    "by_size",
    "is_across",
    "nearest_to",
    "nearest_to_any",
    "smallest",
]

_CLEARLY = 1.25
"""Something is clearly nearer if everything else is this much farther away."""
_SLACK_M = 0.3
_BESIDE_LINE = 0.35
"""How far from the line between two things something between them may be, for each metre of the line."""
_LEVEL = 0.25
_ROOM_M2 = 2.0
"""What is larger can have things inside on the map: a room, an area."""


_COMPASS = {"north": (0.0, 1.0), "south": (0.0, -1.0), "east": (1.0, 0.0), "west": (-1.0, 0.0)}


def nearest_to(items: Sequence[MapObject], x_m: float, y_m: float) -> list[MapObject]:
    """The items that are clearly nearest to a point: one, or several that are about equally near."""
    return smallest(items, lambda item: _gap(item, x_m, y_m))


def nearest_to_any(items: Sequence[MapObject], others: Sequence[MapObject]) -> list[MapObject]:
    """The items that are clearly nearest to any of some other things."""

    def gap(item: MapObject) -> float:
        return min((_gap(item, one.x_m, one.y_m) for one in others if one is not item), default=math.inf)

    return smallest(items, gap)


def by_size(items: Sequence[MapObject], sign: float) -> list[MapObject]:
    """The clearly largest (`sign` > 0) or smallest item; all of them if sizes do not tell."""
    sized = sorted(items, key=lambda item: -sign * item.width_m * item.height_m)
    areas = [item.width_m * item.height_m for item in sized[:2]]
    ratio = max(areas) / min(areas) if min(areas) > 0 else 1.0
    return [sized[0]] if ratio > 1.2 else list(items)


def by_anchor(
    items: Sequence[MapObject], relation: str, anchors: Sequence[MapObject], pose: Pose2D | None
) -> list[MapObject]:
    """The items that stand in `relation` to the anchors."""
    if not anchors:
        return list(items)
    first = anchors[0]
    if len(anchors) > 1:
        second = anchors[1]
        return smallest(
            between(items, first, second) or items,
            lambda item: max(_gap(item, first.x_m, first.y_m), _gap(item, second.x_m, second.y_m)),
        )
    if is_across(relation):
        return _facing(items, first) or nearest_to(items, first.x_m, first.y_m)
    if first.width_m * first.height_m >= _ROOM_M2 and relation in {
        "in",
        "inside",
        "at",
        "within",
        "inside of",
        "on",
    }:
        inside = [item for item in items if _inside(item, first)]
        if inside:
            return inside
    toward = next((vector for name, vector in _COMPASS.items() if name in relation.split()), None)
    if toward is not None:
        beyond = [
            i for i in items if (i.x_m - first.x_m) * toward[0] + (i.y_m - first.y_m) * toward[1] > _SLACK_M
        ]
        items = beyond or list(items)
    elif "left" in relation or "right" in relation:
        on_side = [item for item in items if _on_side(item, first, "left" in relation, pose)]
        items = on_side or list(items)
    elif relation in {"behind", "beyond", "in front of"} and pose is not None:
        there = pose.distance_to(Pose2D(first.x_m, first.y_m))
        sign = -1.0 if relation == "in front of" else 1.0
        items = [i for i in items if sign * (pose.distance_to(Pose2D(i.x_m, i.y_m)) - there) > 0] or list(
            items
        )
    if relation.startswith(("far", "fur", "away")):
        return smallest(items, lambda item: -_gap(item, first.x_m, first.y_m), absolute=True)
    near = nearest_to(items, first.x_m, first.y_m)
    # "The closest to" is a comparison: the nearest is meant even if others are not much farther.
    return near[:1] if "closest" in relation or "nearest" in relation else near


def between(items: Sequence[MapObject], first: MapObject, second: MapObject) -> list[MapObject]:
    """The items that stand in the gap between two things, and not only somewhere near both."""
    dx, dy = second.x_m - first.x_m, second.y_m - first.y_m
    length = math.hypot(dx, dy)
    if not length:
        return []
    found: list[MapObject] = []
    for item in items:
        x, y = item.x_m - first.x_m, item.y_m - first.y_m
        along, aside = (x * dx + y * dy) / length, abs(x * dy - y * dx) / length
        if 0.0 < along < length and aside <= _BESIDE_LINE * length:
            found.append(item)
    return found


def is_across(relation: str) -> bool:
    """Whether a relation says that something faces a thing."""
    return relation.startswith(("opposite", "across", "facing", "on the opposite", "on the other"))


def _facing(items: Sequence[MapObject], anchor: MapObject) -> list[MapObject]:
    """The items across from the anchor: not next in its row, but over against it; none if nothing is."""
    level = [item for item in items if _slant(item, anchor, along_x=True) <= _LEVEL]
    upright = [item for item in items if _slant(item, anchor, along_x=False) <= _LEVEL]
    if level and upright:
        by_count = len(level) - len(upright) or _nearest_m(upright, anchor) - _nearest_m(level, anchor)
        row = level if by_count > 0 else upright
    else:
        row = level + upright
        # Two in one line with it, and nothing over against it there: these are its own row.
        row = row if len(row) > 1 else []
    along_x = row == level and bool(level)
    facing = upright if along_x else level
    facing = [item for item in facing if item not in row]
    if row and not facing:
        facing = [i for i in items if i not in row and _slant(i, anchor, along_x=not along_x) <= 2 * _LEVEL]
    return nearest_to(facing or level or upright, anchor.x_m, anchor.y_m)


def _slant(item: MapObject, anchor: MapObject, *, along_x: bool) -> float:
    """How far an item is from a level (or upright) line through the anchor, for each metre away."""
    dx, dy = abs(item.x_m - anchor.x_m), abs(item.y_m - anchor.y_m)
    away, aside = (dx, dy) if along_x else (dy, dx)
    return aside / away if away else math.inf


def _nearest_m(items: Sequence[MapObject], anchor: MapObject) -> float:
    return min(_gap(item, anchor.x_m, anchor.y_m) for item in items)


def all_at(
    items: Sequence[MapObject], relation: str, anchor: MapObject, pose: Pose2D | None
) -> list[MapObject]:
    """All items of a group that stand in `relation` to one thing; none if that cannot be told."""
    if "left" in relation or "right" in relation:
        return [item for item in items if _on_side(item, anchor, "left" in relation, pose)]
    if relation in {"behind", "beyond", "in front of"}:
        far_m = math.hypot(anchor.x_m - pose.x_m, anchor.y_m - pose.y_m) if pose is not None else 0.0
        sign = -1.0 if relation == "in front of" else 1.0
        gaps = [(item, _gap(item, pose.x_m, pose.y_m) - far_m) for item in items] if pose is not None else []
        return [item for item, more_m in gaps if sign * more_m > 0]
    inside = [item for item in items if _inside(item, anchor)]
    if inside or relation in {"in", "inside", "within", "inside of"}:
        return inside
    if relation.startswith(("far", "fur", "away", "between")) or not items:
        return []
    nearest_m = min(_gap(item, anchor.x_m, anchor.y_m) for item in items)
    return [i for i in items if _gap(i, anchor.x_m, anchor.y_m) <= max(1.6 * nearest_m, nearest_m + 1.0)]


def _on_side(item: MapObject, anchor: MapObject, left: bool, pose: Pose2D | None) -> bool:
    """Whether the item is left (or right) of the anchor, seen by the robot or on the map (x right)."""
    view = pose.bearing_to(anchor.x_m, anchor.y_m) if pose is not None else math.pi / 2
    dx, dy = item.x_m - anchor.x_m, item.y_m - anchor.y_m
    lateral = math.cos(view) * dy - math.sin(view) * dx
    return lateral > 0.1 if left else lateral < -0.1


def _inside(item: MapObject, area: MapObject) -> bool:
    return abs(item.x_m - area.x_m) <= area.width_m / 2 and abs(item.y_m - area.y_m) <= area.height_m / 2


def _gap(item: MapObject, x_m: float, y_m: float) -> float:
    return math.hypot(item.x_m - x_m, item.y_m - y_m)


def smallest(
    items: Sequence[MapObject], measure: Callable[[MapObject], float], *, absolute: bool = False
) -> list[MapObject]:
    """The items with the smallest measure: several if they are about equal."""
    measured = sorted(((measure(item), index, item) for index, item in enumerate(items)), key=lambda m: m[:2])
    if not measured:
        return []
    best = measured[0][0]
    limit = best + _SLACK_M if absolute else best * _CLEARLY + _SLACK_M
    return [item for value, _, item in measured if value <= limit]
