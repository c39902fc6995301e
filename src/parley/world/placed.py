"""What people put on a map, changed and took off, over what its object map says. Pure.

It is kept in the form of an object map, with one field more: `gone`, what was taken off, by id (of a room:
``room NAME``), with where it stood.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, Final, Self

from pydantic import BaseModel, ConfigDict

from parley.files import validated
from parley.world.geometry import Metres
from parley.world.object_map import PLACE, MapObject, ObjectMap
from parley.world.whereabouts import Place, middle_of

__all__ = ["Placed", "at_same_spot", "key_of", "names_of", "new_id", "same_name"]

_SAME_M: Final = 0.005
_ARTICLE: Final = re.compile(r"^(?:the|a|an) ")

Point = tuple[float, float]


class _Gone(BaseModel):
    model_config = ConfigDict(extra="ignore")
    gone: dict[str, tuple[Metres, Metres]] = {}


@dataclass(frozen=True, slots=True)
class Placed:
    """The changes of one map."""

    put: ObjectMap = field(default_factory=ObjectMap)
    """Rooms and things as they are to be, new ones and others."""
    gone: Mapping[str, Point] = field(default_factory=dict)
    """What is not on the map any more, and where it stood."""

    @classmethod
    def of_json(cls, told: Mapping[str, Any], file: str = "places") -> Self:
        """What `to_json` made.

        Raises:
            FileFormatError: Names the field.
        """
        return cls(ObjectMap.of_json(told, file), validated(_Gone, told, file).gone)

    def to_json(self) -> dict[str, Any]:
        """An object map with what was taken off."""
        return self.put.to_json() | {"gone": {key: list(point) for key, point in self.gone.items()}}

    def applied(self, known: ObjectMap) -> ObjectMap:
        """An object map with these changes; applied once more they change nothing.

        What a robot found counts as it was seen, until a person says something about just that.
        """
        if self == Placed():
            return known
        put = {item.id: item for item in self.put.objects}
        kept = [
            item if item.found and not at_same_spot(item, put.get(item.id, item)) else put.pop(item.id, item)
            for item in known.objects
            if not self._is_gone(item)
        ]
        new = [item for item in put.values() if all(item.id != other.id for other in kept)]
        rooms = {area.name: area for area in known.areas if key_of(area) not in self.gone}
        rooms |= {area.name: area for area in self.put.areas}
        return replace(known, objects=(*kept, *new), areas=tuple(rooms.values()))

    def _is_gone(self, item: MapObject) -> bool:
        """Of what was found only that very sighting is gone: it may be seen again elsewhere."""
        at = self.gone.get(item.id)
        return at is not None and (not item.found or _near(at, (item.x_m, item.y_m)))

    def changed(self, was: Place | None, put: Place | None) -> Placed:
        """With one thing or room more, in another form, or taken off.

        Args:
            was: As it was; None: it is new.
            put: As it is to be; None: it is taken off.
        """
        keys = {key_of(place) for place in (was, put) if place is not None}
        things = [item for item in self.put.objects if item.id not in keys]
        rooms = [area for area in self.put.areas if key_of(area) not in keys]
        if isinstance(put, MapObject):
            things.append(replace(put, found=False))
        elif put is not None:
            rooms.append(put)
        gone = dict(self.gone)
        if was is not None and (put is None or key_of(put) != key_of(was)):
            gone[key_of(was)] = middle_of(was)
        if put is not None:
            gone.pop(key_of(put), None)
        return Placed(ObjectMap(tuple(things), tuple(rooms)), gone)

    def loaded(self, whole: ObjectMap, known: ObjectMap) -> Placed:
        """With just what is in an object map, in the place of all that is known."""
        after: tuple[Place, ...] = (*whole.objects, *whole.areas)
        before: tuple[Place, ...] = (*known.objects, *known.areas)
        keys = {*map(key_of, after)}
        left = {key_of(place): middle_of(place) for place in before if key_of(place) not in keys}
        return Placed(whole, {key: at for key, at in (dict(self.gone) | left).items() if key not in keys})


def key_of(place: Place) -> str:
    """By what a thing or room is known."""
    return place.id if isinstance(place, MapObject) else place.goal.id


def names_of(place: Place) -> tuple[str, ...]:
    """How people call it."""
    return (place.description, *place.aliases) if isinstance(place, MapObject) else (place.name,)


def same_name(known: ObjectMap, name: str, besides: Place | None = None) -> tuple[Place, ...]:
    """All that are called so, but for one."""
    wanted, own = _plain(name), key_of(besides) if besides is not None else ""
    places: tuple[Place, ...] = (*known.objects, *known.areas)
    return tuple(
        place for place in places if key_of(place) != own and wanted in {*map(_plain, names_of(place))}
    )


def new_id(name: str, known: Iterable[MapObject]) -> str:
    """An id that nothing else has, made of a name."""
    taken, stem = {item.id for item in known}, "_".join(re.findall(r"\w+", name.lower()))[:60] or PLACE
    number = 1
    while f"{stem}_{number}" in taken:
        number += 1
    return f"{stem}_{number}"


def at_same_spot(one: MapObject, other: MapObject) -> bool:
    """Whether two stand at the same spot."""
    return _near((one.x_m, one.y_m), (other.x_m, other.y_m))


def _near(one: Point, other: Point) -> bool:
    return max(abs(one[0] - other[0]), abs(one[1] - other[1])) <= _SAME_M


def _plain(name: str) -> str:
    return _ARTICLE.sub("", " ".join(re.findall(r"\w+", name.casefold())))
