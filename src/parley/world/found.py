"""What robots found and no map knew, or knew to be elsewhere: kept beside the object map, over restarts."""

from __future__ import annotations

import asyncio
import json
import math
import re
from dataclasses import replace
from itertools import count
from pathlib import Path
from typing import Any, Final

import numpy as np
import structlog

from parley.errors import FileFormatError
from parley.files import parse_json, read_text, replace_text
from parley.world.geometry import Pose2D
from parley.world.object_map import MapObject, ObjectMap
from parley.world.occupancy import OccupancyMap
from parley.world.placed import new_id
from parley.world.whereabouts import Footprint, nearest, standing

__all__ = ["FoundThings", "reaching_floor"]

log = structlog.get_logger(__name__)

_MOVED_M: Final = 3.0
"""Something of the same name that is seen no farther away was moved; else it is another one."""
_SEEN_M: Final = 0.1
"""So much beside its place on the map something may be seen that was not moved."""
_SAME_PLACE_M: Final = 0.5
"""No farther from where the map has a thing of that kind it is that thing, whatever it is called there."""
_COLOURS: Final = frozenset({
    "black", "white", "grey", "gray", "red", "green", "blue", "yellow", "orange", "brown", "purple", "pink",
})  # fmt: skip
_SMALLEST_M: Final = 0.1
_WHERE: Final = re.compile(r"\b(?:at|by|from|in|near|of|on|with)\b")
"""Before these stands what it is: a box by the door is no door."""
_DEEPEST_M: Final = 1.0
"""No furniture has its middle farther from the floor before it."""


class FoundThings:
    """Things that were found, the newest place of each.

    Args:
        file: Where they are kept, in the form of an object map; None: nowhere.
    """

    def __init__(self, file: Path | None = None) -> None:
        self._file = file
        self._things: tuple[MapObject, ...] = ()
        self._knew: dict[str, Any] = {}
        """Where the map had each of them when it was found; None: nowhere. What people say later counts."""
        if file is not None and file.is_file():
            try:
                told = parse_json(read_text(file), file.name)
                self._things = tuple(replace(item, found=True) for item in ObjectMap.of_json(told).objects)
                self._knew = dict(told.get("knew", {}))
            except (FileFormatError, TypeError, ValueError) as error:  # what was found can be found again
                log.warning("what was found before cannot be read", error=str(error))

    def added_to(self, known: ObjectMap) -> ObjectMap:
        """The map with what was found; what was moved stands where it was seen last."""
        if not self._things:
            return known
        moved = {thing.id: thing for thing in self._things if self._holds(thing, known)}
        kept = tuple(moved.pop(item.id, item) for item in known.objects)
        return replace(known, objects=(*kept, *moved.values()))

    def _holds(self, thing: MapObject, known: ObjectMap) -> bool:
        """Whether the map is still as it was when this was found."""
        return thing.id not in self._knew or self._knew[thing.id] == _at_home(known.get(thing.id))

    async def forget(self, thing: MapObject) -> None:
        """Something that was found is not there any more."""
        self._things = tuple(item for item in self._things if item.id != thing.id)
        await self._keep()

    async def note(self, label: str, place: Footprint, known: ObjectMap) -> MapObject:
        """Take over that something was seen; returns it as it stands on the map from now on.

        Args:
            label: What it is, in words.
            place: What it covers.
            known: The object map without what was found.
        """
        now = self.added_to(known)
        alike = [item for item in now.objects if label.lower() in (item.description.lower(), *item.aliases)]
        alike = alike or [
            replace(item, aliases=(*item.aliases, label.lower()))
            for item in now.objects
            if _may_be(label, item) and _apart_m(item, place) <= _SAME_PLACE_M
        ]
        old = min(alike, key=lambda item: _apart_m(item, place), default=None)
        if old in now.objects and (standing(place, old) == "in" or _is_there(place, old)):
            return old
        if old is not None and _apart_m(old, place) <= _MOVED_M:
            found = _at(old, place)
        else:
            found = _at(_new(label, place, now), place)
        self._things = (*(item for item in self._things if item.id != found.id), found)
        self._knew[found.id] = _at_home(known.get(found.id))
        await self._keep()
        return found

    async def _keep(self) -> None:
        if self._file is not None:
            knew = {item.id: self._knew.get(item.id) for item in self._things if item.id in self._knew}
            told = ObjectMap(self._things).to_json() | {"knew": knew}
            await asyncio.to_thread(_write, self._file, json.dumps(told, ensure_ascii=False) + "\n")


def _at_home(item: MapObject | None) -> list[float] | None:
    """Where the map has something."""
    return [item.x_m, item.y_m] if item is not None else None


def _may_be(label: str, item: MapObject) -> bool:
    """Whether what was seen may be a thing that the map calls otherwise: a "black box" its "lost box"."""
    seen, known = (_WHERE.split(text.lower())[0].split() for text in (label, item.description))
    kinds = {item.class_name.lower(), *known[-1:]}
    colours = {word for word in (*seen, *known) if word in _COLOURS}
    return bool(seen) and seen[-1] in kinds and len(colours) < 2


def _apart_m(item: MapObject, place: Footprint) -> float:
    return float(((item.x_m - place.x_m) ** 2 + (item.y_m - place.y_m) ** 2) ** 0.5)


def _is_there(place: Footprint, item: MapObject) -> bool:
    """Whether all that was seen of something lies where the map has it."""
    sides = (
        (abs(place.x_m - item.x_m), place.width_m, item.width_m),
        (abs(place.y_m - item.y_m), place.height_m, item.height_m),
    )
    return all(away + own / 2 <= half / 2 + _SEEN_M for away, own, half in sides)


def _at(item: MapObject, place: Footprint) -> MapObject:
    """Where it was seen; its front is not known there."""
    width, height = max(place.width_m, _SMALLEST_M), max(place.height_m, _SMALLEST_M)
    return replace(
        item, x_m=round(place.x_m, 3), y_m=round(place.y_m, 3), width_m=round(width, 3),
        height_m=round(height, 3), front_rad=None, stand=None,
        found=True,
    )  # fmt: skip


def _new(label: str, place: Footprint, known: ObjectMap) -> MapObject:
    """A thing with a name of its own: the label, or where that is taken, with where it stands."""
    words = re.findall(r"\w+", _WHERE.split(label.lower())[0]) or ["thing"]
    by = nearest(place.x_m, place.y_m, known.objects)
    taken = {item.description.lower() for item in known.objects}
    name = f"{label} by {by.description}" if label.lower() in taken and by is not None else label
    if name.lower() in taken:
        name = next(name for n in count(2) if (name := f"{label} {n}").lower() not in taken)
    return MapObject(new_id(label, known.objects), name, place.x_m, place.y_m, class_name=words[-1])


def reaching_floor(place: Footprint, occupancy: OccupancyMap, seen_from: Pose2D) -> Footprint:
    """The same, reaching to the floor before it: only the middle of furniture may be known, deep within."""
    bearing = seen_from.bearing_to(place.x_m, place.y_m)
    for away_m in np.arange(0.0, _DEEPEST_M, occupancy.resolution_m / 2):
        x, y = math.cos(bearing) * away_m, math.sin(bearing) * away_m
        if occupancy.is_free(place.x_m - x, place.y_m - y):
            width, height = (2 * round(abs(side), 3) for side in (x, y))
            return replace(place, width_m=max(place.width_m, width), height_m=max(place.height_m, height))
    return place


def _write(file: Path, text: str) -> None:
    """Keep it; where that fails it is known until the program ends."""
    try:
        replace_text(file, text)
    except OSError as error:
        log.warning("what was found cannot be kept", error=str(error))
