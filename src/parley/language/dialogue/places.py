"""Where things and the robot are, in words of the map; rooms as far as the map's words tell of them."""

from __future__ import annotations

import re
from collections.abc import Sequence

from parley.language.builtin.saying import counted
from parley.world.geometry import Pose2D
from parley.world.object_map import MapObject
from parley.world.whereabouts import called

__all__ = ["distance_m", "in_room", "lies", "room_of", "rooms", "whereabouts"]

_IN: re.Pattern[str] = re.compile(r"\b(?:in|of) the ([\w -]+?)$", re.IGNORECASE)
_AT_M = 1.3
_IN_ROOM_M = 2.5


def distance_m(item: MapObject, pose: Pose2D) -> float:
    """From a robot to the outline of a thing."""
    return item.gap_m(pose.x_m, pose.y_m)


def room_of(item: MapObject, known: Sequence[str] = ()) -> str:
    """The room that the names of a thing put it in; empty if they tell of none."""
    for name in (item.description, *item.aliases):
        if (found := _IN.search(name)) is not None and (not known or found[1].lower() in known):
            return found[1].lower()
    first = item.description.lower().split(" ", 1)[0]
    return first if first in known else ""


def rooms(objects: Sequence[MapObject]) -> tuple[str, ...]:
    """The rooms that the map's words tell of."""
    things = {name.lower() for item in objects for name in (item.description, item.class_name, *item.aliases)}
    return tuple(dict.fromkeys(room for item in objects if (room := room_of(item)) and room not in things))


def in_room(room: str, objects: Sequence[MapObject], pose: Pose2D | None) -> tuple[MapObject, ...]:
    """What is in a room, the nearest to the robot first."""
    known = rooms(objects)
    found = [item for item in objects if room_of(item, known) == room.lower()]
    return tuple(sorted(found, key=lambda item: distance_m(item, pose) if pose else 0.0))


def lies(item: MapObject, objects: Sequence[MapObject], pose: Pose2D | None) -> str:
    """Where a thing of the map is, as the end of "it is …": how far away, and what it stands by."""
    others = [other for other in objects if other.id != item.id]
    at = Pose2D(item.x_m, item.y_m, 0.0)
    near = min(others, key=lambda other: distance_m(other, at), default=None)
    room = room_of(item, rooms(objects))
    far_m = round(max(distance_m(item, pose), 1.0)) if pose is not None else 0
    parts = [f"about {counted(far_m, 'metre')} from me"] if far_m else []
    parts += [f"in the {room}"] if room and room not in item.description.lower() else []
    parts += [f"near {called(near.description)}"] if near is not None else []
    return ", ".join(parts) or "on my map"


def whereabouts(objects: Sequence[MapObject], pose: Pose2D | None) -> str:
    """Where a robot is, as the end of "I am …"."""
    if pose is None:
        return "somewhere that I cannot tell: I do not know my position"
    if not objects:
        return f"at {pose.x_m:.1f}, {pose.y_m:.1f} on the map"
    nearest = sorted(objects, key=lambda item: distance_m(item, pose))
    far_m = distance_m(nearest[0], pose)
    name = nearest[0].description
    known = rooms(objects)
    room = next(
        (r for item in nearest if distance_m(item, pose) < _IN_ROOM_M and (r := room_of(item, known))), ""
    )
    far = f"about {counted(round(max(far_m, 1.0)), 'metre')} from"
    near = f"{'by' if far_m <= _AT_M else far} {called(name)}"
    return near if not room or room in name.lower() else f"{near}, in the {room}"
