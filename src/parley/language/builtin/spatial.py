"""Which of several things is meant, by where it is: "the crate by the ramp", "the nearest box"."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from parley.language.builtin.lexicon import Lexicon, stem, stems
from parley.language.builtin.sets import kinds
from parley.language.builtin.things import link
from parley.language.lexicon import word_set
from parley.world.geometry import Pose2D
from parley.world.object_map import MapObject

__all__ = ["NEAREST", "Picked", "beside", "picked"]

_NEAR = (
    "next to", "near to", "nearest to", "closest to", "nearer to", "closer to", "close to", "nearest",
    "closest", "near", "by", "beside", "at", "alongside", "nearer", "closer", "right by", "right next to",
    "not far from",
)  # fmt: skip
_FAR = ("farthest from", "furthest from", "farthest away from", "furthest away from")
_SIDES = (
    "left of", "right of", "to the left of", "to the right of", "on the left of", "on the right of",
    "to your left of", "on the left side of", "on the right side of", "on the left hand side of",
    "on the right hand side of",
)  # fmt: skip
_BIGGEST = {"biggest": 1, "largest": 1, "smallest": -1}
_MOST = {
    "leftmost": "left", "rightmost": "right", "easternmost": "east", "westernmost": "west",
    "northernmost": "north", "southernmost": "south",
}  # fmt: skip
_AXES = {"east": (1.0, 0.0), "west": (-1.0, 0.0), "north": (0.0, 1.0), "south": (0.0, -1.0)}
_FILLING = word_set("that is 's which are the stands standing a one there lying")
_LEADING = frozenset({"by", "near", "next", "of", "in", "at", "on", "beside", "under", "behind"})
_BESIDE_M = 2.0
_MARGIN = 1.15
"""So many times farther the next one must be."""


@dataclass(frozen=True, slots=True)
class Picked:
    """What fits a description of where it is: one thing if that is certain, else those that come near."""

    things: tuple[MapObject, ...]


def picked(
    words: Sequence[str], objects: Sequence[MapObject], lexicon: Lexicon, pose: Pose2D | None
) -> Picked | None:
    """Which thing is meant; None if nothing is said about where it is, or nothing that is understood."""
    said = list(words)
    while said and (said[0] in lexicon.classes["prepositions"] or said[0] in lexicon.classes["determiners"]):
        del said[0]
    if {*said} & (lexicon.classes["quantifiers"] - {"any"}):
        return None
    for end in range(len(said), 0, -1):
        noun = stem(said[end - 1])
        if noun != said[end - 1]:
            continue
        family = [item for item in objects if noun in kinds(item)]
        if family and _begins_relation(said, end):
            found = _whole(said, end, family, lexicon)
            found = found or _of_family(said[:end], said[end:], family, objects, lexicon, pose)
            if found is not None:
                return found
    return None


def beside(it: MapObject, things: Sequence[MapObject]) -> MapObject | None:
    """Of several things the one that is called after another, or stands alone beside it."""
    main = {stem(word) for word in it.description.split()[:2]} - _LEADING
    told = [one for one in things if main & {stem(word) for word in one.description.split()}]
    if len(told) == 1:
        return told[0]
    far_m = sorted((math.hypot(one.x_m - it.x_m, one.y_m - it.y_m), n) for n, one in enumerate(things))
    alone = len(far_m) > 1 and far_m[0][0] < _BESIDE_M and far_m[0][0] < far_m[1][0] / 2
    return things[far_m[0][1]] if alone else None


def _begins_relation(words: Sequence[str], end: int) -> bool:
    rest = [word for word in words[end:] if word not in _FILLING]
    return bool(rest) or any(word in _MOST or word in _BIGGEST or word in NEAREST for word in words[:end])


NEAREST = frozenset({"nearest", "closest", "farthest", "furthest"})
"""What tells one of several things by how far it is."""


def _of_family(
    name: Sequence[str],
    rest: Sequence[str],
    family: list[MapObject],
    objects: Sequence[MapObject],
    lexicon: Lexicon,
    pose: Pose2D | None,
) -> Picked | None:
    exact = stems([*name, *rest])
    if any(stems(item.description.split()) == exact for item in family):
        return None
    measure: Callable[[MapObject], float] | None = None
    more = []
    for word in name[:-1]:
        if word in NEAREST and pose is not None:
            sign = 1.0 if word in ("nearest", "closest") else -1.0
            measure = _distance(pose.x_m, pose.y_m, sign)
        elif word in _BIGGEST:
            measure = _size(_BIGGEST[word])
        elif word in _MOST:
            measure = _along(_MOST[word], family, pose)
        elif word not in lexicon.classes["determiners"]:
            more.append(word)
    family = [item for item in family if set(stems(more)) <= set(stems(item.description.split()))]
    if not family:
        return None
    left = [word for word in rest if word != ","]
    while left and left[0] in _FILLING:
        del left[0]
    if left:
        measure = _relation(left, family, objects, lexicon, pose)
    if measure is None:
        return None
    ranked = sorted(((measure(item), item.id, item) for item in family), key=lambda one: one[:2])
    ranked = [one for one in ranked if one[0] < math.inf]
    if not ranked:
        return None
    best = ranked[0][0]
    close = [item for value, _, item in ranked if value <= best + abs(best) * (_MARGIN - 1) + 1e-6]
    return Picked(tuple(close))


def _whole(words: Sequence[str], end: int, family: Sequence[MapObject], lexicon: Lexicon) -> Picked | None:
    """What is called by its whole name: "bay A near the post" is not the bay nearest to the post."""
    said = stems(words)
    names = [(item, stems(item.description.split())) for item in family]
    named = [
        (item, name) for item, name in names if len(said) > len(name) > end and said[: len(name)] == name
    ]
    found = [item for item, name in named if words[len(name)] in lexicon.classes["prepositions"]]
    return Picked((found[0],)) if len(found) == 1 else None


def _distance(x_m: float, y_m: float, sign: float = 1.0) -> Callable[[MapObject], float]:
    return lambda item: sign * math.dist((x_m, y_m), (item.x_m, item.y_m))


def _size(sign: int) -> Callable[[MapObject], float]:
    return lambda item: -sign * item.width_m * item.height_m


def _along(
    side: str, family: Sequence[MapObject], pose: Pose2D | None
) -> Callable[[MapObject], float] | None:
    """How far to a side things are: of the map, or as the robot sees them."""
    axis = _AXES.get(side)
    if axis is None:
        if pose is None:
            return None
        x_m = sum(item.x_m for item in family) / len(family) - pose.x_m
        y_m = sum(item.y_m for item in family) / len(family) - pose.y_m
        axis = (-y_m, x_m) if side == "left" else (y_m, -x_m)
    east, north = axis
    length = math.hypot(east, north) or 1.0
    return lambda item: -(item.x_m * east + item.y_m * north) / length


def _relation(
    words: Sequence[str],
    family: Sequence[MapObject],
    objects: Sequence[MapObject],
    lexicon: Lexicon,
    pose: Pose2D | None,
) -> Callable[[MapObject], float] | None:
    """How well a thing fits what is said of where it is: the less the better."""
    text = " ".join(words)
    side = _side(words)
    if side is not None:
        return _along(side, family, pose)
    if words[0] == "between" and "and" in words:
        at = words.index("and")
        one, other = (_landmark(part, objects, lexicon) for part in (words[1:at], words[at + 1 :]))
        if one is None or other is None:
            return None
        return _between(one, other)
    for table, kind in ((_SIDES, "side"), (_FAR, "far"), (_NEAR, "near")):
        for phrase in sorted(table, key=len, reverse=True):
            if not text.startswith(phrase + " "):
                continue
            behind = words[len(phrase.split()) :]
            here = [word for word in behind if word not in lexicon.classes["determiners"]]
            if here in (["here"], ["you"], ["me"]) and pose is not None and kind != "side":
                return _distance(pose.x_m, pose.y_m, -1.0 if kind == "far" else 1.0)
            landmark = _landmark(behind, objects, lexicon)
            if landmark is None:
                return None
            if kind == "side":
                return _beside(landmark, "left" if "left" in phrase else "right", pose)
            apart = _distance(landmark.x_m, landmark.y_m, -1.0 if kind == "far" else 1.0)
            return lambda item: math.inf if item is landmark else apart(item)
    if words[0] in ("in", "inside", "within"):
        room = _landmark(words[1:], objects, lexicon)
        return None if room is None else lambda item: 0.0 if _inside(item, room) else math.inf
    return None


def _side(words: Sequence[str]) -> str | None:
    """For "on the far left", "in the south", "on your right"; None if a thing follows."""
    small = {"on", "in", "at", "to", "the", "far", "very", "your", "my", "side", "end", "of", "row", "hand"}
    left = [word for word in words if word not in small]
    leads = bool({"on", "in", "at", "to"} & {*words})
    return left[0] if leads and len(left) == 1 and left[0] in ("left", "right", *_AXES) else None


def _landmark(words: Sequence[str], objects: Sequence[MapObject], lexicon: Lexicon) -> MapObject | None:
    nested = not words or {"between", "one"} & {*words}
    found = link(words, len(words) - 1, objects, lexicon) if not nested else None
    return found.things[0] if found is not None and found.kind == "one" else None


def _between(one: MapObject, other: MapObject) -> Callable[[MapObject], float]:
    x_m, y_m = (one.x_m + other.x_m) / 2, (one.y_m + other.y_m) / 2
    half = math.dist((one.x_m, one.y_m), (other.x_m, other.y_m)) / 2

    def measure(item: MapObject) -> float:
        apart = math.dist((x_m, y_m), (item.x_m, item.y_m))
        return math.inf if item in (one, other) or apart > half else apart

    return measure


def _beside(landmark: MapObject, side: str, pose: Pose2D | None) -> Callable[[MapObject], float] | None:
    """How near to a landmark, on one side of it as the robot sees it."""
    if pose is None:
        return None
    view = (landmark.x_m - pose.x_m, landmark.y_m - pose.y_m)

    def measure(item: MapObject) -> float:
        x_m, y_m = item.x_m - landmark.x_m, item.y_m - landmark.y_m
        lateral = view[0] * y_m - view[1] * x_m
        forward = view[0] * x_m + view[1] * y_m
        right_side = lateral > 0 if side == "left" else lateral < 0
        return math.hypot(x_m, y_m) if right_side and abs(lateral) > abs(forward) / 2 else math.inf

    return measure


def _inside(item: MapObject, room: MapObject) -> bool:
    return (
        item is not room
        and abs(item.x_m - room.x_m) <= room.width_m / 2
        and abs(item.y_m - room.y_m) <= room.height_m / 2
    )
