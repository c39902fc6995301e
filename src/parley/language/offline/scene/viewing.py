"""Choosing among like things by where they are: as the robot sees them, or on the map (x east, y north)."""

from __future__ import annotations

import math
from collections.abc import Sequence

from parley.language.offline.scene.spatial import nearest_to, smallest
from parley.world.geometry import Pose2D
from parley.world.object_map import MapObject

__all__ = ["COMPASS", "VIEWS", "by_view", "is_view", "rank_word"]

COMPASS = {
    "north": (0.0, 1.0), "south": (0.0, -1.0), "east": (1.0, 0.0), "west": (-1.0, 0.0),
    "north-east": (1.0, 1.0), "north-west": (-1.0, 1.0), "south-east": (1.0, -1.0),
    "south-west": (-1.0, -1.0), "northeast": (1.0, 1.0), "northwest": (-1.0, 1.0), "southeast": (1.0, -1.0),
    "southwest": (-1.0, -1.0),
}  # fmt: skip
"""Directions on the map."""
VIEWS = frozenset({
    "nearest", "closest", "nearby", "farthest", "furthest", "nearer", "closer", "farther", "further",
    "left", "right", "newer", "newest", "older", "oldest", "leftmost", "rightmost", "middle", "central",
    "center", "centre", "corner", "ahead", "behind",
    *COMPASS, *(f"{name}ern" for name in COMPASS), *(f"{name}ernmost" for name in COMPASS),
})  # fmt: skip
_RANK = "#"


def rank_word(number: int, side: str) -> str:
    """The stand-in for "second from the left" among the words of a noun phrase."""
    return f"{_RANK}{number}{side}"


def is_view(word: str) -> bool:
    """Whether a word says where something is rather than what it is called."""
    return word in VIEWS or word.startswith(_RANK)


def by_view(
    items: Sequence[MapObject], word: str, pose: Pose2D | None, objects: Sequence[MapObject]
) -> list[MapObject]:
    """The items that a word such as "nearest", "leftmost" or "northern" means; all if it tells nothing.

    Left and right are as seen from `pose`, else on the map with north up; the corner is one of the map's.
    """
    direction = COMPASS.get(word.removesuffix("ernmost").removesuffix("ern"))
    if direction is not None:
        return smallest(items, lambda i: -(i.x_m * direction[0] + i.y_m * direction[1]), absolute=True)
    if word in {"middle", "central", "center", "centre"}:
        return _middle(items)
    if word == "corner":
        return _cornered(items, objects)
    if word in {"newer", "newest", "older", "oldest"}:
        # Only what is called old or new tells.
        wanted = ("new", "newer", "modern") if word.startswith("new") else ("old", "older")
        said = [i for i in items if set(wanted) & set(i.description.lower().split())]
        opposed = ("old", "older") if word.startswith("new") else ("new", "newer", "modern")
        return (
            said or [i for i in items if not set(opposed) & set(i.description.lower().split())] or list(items)
        )
    if word.startswith(_RANK):
        return _ranked(items, int(word[1]), word[2:], pose)
    if word.startswith(("left", "right")):
        row = _from_left(items, pose)
        row = row if word.startswith("left") else row[::-1]
        level = _lateral(row[0], pose), _bearing(row[0], pose)
        return [i for i in row if (_lateral(i, pose), _bearing(i, pose)) == level]
    return list(items) if pose is None else _by_distance(items, word, pose)


def _by_distance(items: Sequence[MapObject], word: str, pose: Pose2D) -> list[MapObject]:
    if word in {"nearest", "closest", "nearer", "closer"}:
        return nearest_to(items, pose.x_m, pose.y_m)[:1]
    if word == "nearby":
        return nearest_to(items, pose.x_m, pose.y_m)
    if word in {"ahead", "behind"}:
        sign = 1.0 if word == "ahead" else -1.0
        seen = [i for i in items if sign * math.cos(_bearing(i, pose)) > math.cos(math.pi / 3)]
        return seen or [i for i in items if sign * math.cos(_bearing(i, pose)) > 0.0] or list(items)
    return smallest(items, lambda i: -math.hypot(i.x_m - pose.x_m, i.y_m - pose.y_m), absolute=True)


def _bearing(item: MapObject, pose: Pose2D | None) -> float:
    """How far to the left it is seen (radians); on the map without a pose."""
    if pose is None:
        return 0.0
    angle = pose.bearing_to(item.x_m, item.y_m) - pose.yaw_rad
    return round(math.atan2(math.sin(angle), math.cos(angle)), 6)


def _lateral(item: MapObject, pose: Pose2D | None) -> float:
    """How far to the left it is (metres)."""
    if pose is None:
        return -item.x_m
    distance = math.hypot(item.x_m - pose.x_m, item.y_m - pose.y_m)
    return round(distance * math.sin(_bearing(item, pose)), 1)


def _from_left(items: Sequence[MapObject], pose: Pose2D | None) -> list[MapObject]:
    return sorted(items, key=lambda i: (-_lateral(i, pose), -_bearing(i, pose)))


def _ranked(items: Sequence[MapObject], number: int, side: str, pose: Pose2D | None) -> list[MapObject]:
    if side in COMPASS:
        towards = COMPASS[side]
        row = sorted(items, key=lambda i: -(i.x_m * towards[0] + i.y_m * towards[1]))
    else:
        row = _from_left(items, pose)
        row = row[::-1] if side.startswith("right") else row
    return [row[number - 1]] if number <= len(row) else list(items)


def _middle(items: Sequence[MapObject]) -> list[MapObject]:
    if len(items) % 2 == 0:
        return list(items)
    x_m = sum(i.x_m for i in items) / len(items)
    y_m = sum(i.y_m for i in items) / len(items)
    return smallest(items, lambda i: math.hypot(i.x_m - x_m, i.y_m - y_m), absolute=True)


def _cornered(items: Sequence[MapObject], objects: Sequence[MapObject]) -> list[MapObject]:
    xs, ys = [o.x_m for o in objects], [o.y_m for o in objects]

    def gap(item: MapObject) -> float:
        return min(
            math.hypot(item.x_m - x, item.y_m - y) for x in (min(xs), max(xs)) for y in (min(ys), max(ys))
        )

    return smallest(items, gap)
