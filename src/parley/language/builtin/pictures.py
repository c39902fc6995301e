"""What a picture shows, in the words of the robot's detector: what is there and where, never how it is."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final

from parley.errors import LanguageError
from parley.language.base import InspectionReport
from parley.language.builtin.judging import OPEN, Asked, asked
from parley.language.builtin.lexicon import lexicon, stem
from parley.language.builtin.saying import as_said, with_article
from parley.language.builtin.things import head_of, link
from parley.robots.base import CameraImage, Detection
from parley.umrf.kinds import is_word_for
from parley.world.object_map import MapArea, MapObject, ObjectMap
from parley.world.whereabouts import Footprint, Standing, nearest, standing

__all__ = ["inspect"]

_LEAST_PIXELS: Final = 40
_LEAST_CONFIDENCE: Final = 0.5
"""Smaller or less certain finds are not trusted."""
_SURE: Final = 0.8
"""What is less certain is said to be."""
_SOMEBODY: Final = frozenset({"somebody", "someone", "anybody", "anyone", "nobody", "person", "people"})
_PERSONS: Final = frozenset({"person", "human", "man", "woman", "child", "people"})
_ANY: Final = frozenset({"anybody", "anyone", "anything", "nobody", "nothing"})
_ANYTHING: Final = frozenset({"anything", "something", "nothing"})

Place = MapObject | MapArea


@dataclass(frozen=True, slots=True)
class _Scene:
    """What is seen, with regard to the place that is asked about."""

    seen: Sequence[Detection]
    known: ObjectMap
    place: Place | None

    @property
    def there(self) -> str:
        """The place in words, behind what is said of it."""
        return f" in {with_article(_name(self.place))}" if self.place is not None else ""

    @property
    def shown(self) -> str:
        """All that is seen, but for the place itself."""
        return ", ".join(dict.fromkeys(one.label for one in self.seen if one.label != _name(self.place)))

    @property
    def also(self) -> str:
        """The same as a sentence; empty where nothing is seen in a place."""
        shown = self.shown or ("" if self.place is not None else "nothing that I know")
        return f" I can see: {shown}." if shown else ""

    def of(self, found: Detection) -> Standing | None:
        """Where something stands with regard to the place; None if nobody can tell, or no place is meant."""
        if self.place is None or found.x_m is None or found.y_m is None:
            return None
        return standing(Footprint(found.x_m, found.y_m, *found.span_m), self.place)

    def told(self, found: Detection, *, article: str = "") -> str:
        """What was found, where it stands and how far away: "a red box at the edge of bay 1"."""
        where = {"in": self.there, "edge": self.there.replace(" in ", " at the edge of ", 1)}
        text = where.get(self.of(found) or "", "") or ("" if article else self._by(found))
        text = "" if _name(self.place).lower() in found.label.lower() else text  # it says so itself
        far = "" if found.distance_m is None else f", about {found.distance_m:.1f} m away"
        unsure = found.confidence is not None and found.confidence < _SURE
        named = with_article(found.label) if article else f"{_article(found.label)} {found.label}"
        return f"{'what may be ' if unsure else ''}{named}{text}{far}"

    def _by(self, found: Detection) -> str:
        others = (item for item in self.known.objects if item.description != found.label)
        by = (
            nearest(found.x_m, found.y_m, others) if found.x_m is not None and found.y_m is not None else None
        )
        return f" by {with_article(by.description)}" if by is not None else ""


def inspect(image: CameraImage, request: str, known: ObjectMap | None = None) -> InspectionReport:
    """Say whether what is asked for is in a picture, or whether a place is free.

    Args:
        image: The picture.
        request: What to look for or at.
        known: The map, for telling what stands in which place.

    Raises:
        LanguageError: The robot has no detector, so nothing can be said about its pictures.
    """
    if image.detections is None:
        raise LanguageError(
            "this robot has no detector, and without a language model I cannot judge pictures"
        )
    seen = [found for found in image.detections if _is_trusted(found)]
    wish, known = asked(request), known or ObjectMap()
    scene = _Scene(seen, known, _place(wish.place, known))
    bounded = isinstance(scene.place, MapObject) and _is_bounded(scene.place)  # of a room only a part is seen
    if wish.kind == "room" and bounded and all(found.x_m is not None for found in seen):
        return _room(scene, wish)
    if wish.kind == "thing" and (wish.thing or wish.place):
        return _thing(scene, wish, as_said(" ".join(wish.thing), request))
    stated = request.lower().split(" ")[0] not in OPEN
    statement = request.partition(" ")[2] if stated else ""
    judge = f" Please look at the picture and judge whether {statement}." if statement else ""
    return InspectionReport(f"I looked.{scene.also}{judge}")


def _is_trusted(found: Detection) -> bool:
    sure = found.confidence is None or found.confidence >= _LEAST_CONFIDENCE
    return sure and found.pixels >= _LEAST_PIXELS


def _room(scene: _Scene, wish: Asked) -> InspectionReport:
    """Whether a place is free of things."""
    assert scene.place is not None
    own = {_name(scene.place).lower()}
    standing_there = [f for f in scene.seen if scene.of(f) in ("in", "edge") and f.label.lower() not in own]
    name = with_article(_name(scene.place))
    if not standing_there:
        return InspectionReport(
            f"I see nothing standing{scene.there}, so far as I can see it from here.",
            wish.holds, unwanted=not wish.holds,
        )  # fmt: skip
    what = " and ".join(scene.told(found) for found in standing_there)
    return InspectionReport(
        f"{name[:1].upper()}{name[1:]} is not clear: I see {what}.", not wish.holds, standing_there[0].label,
        attention=True, things=tuple(standing_there),
    )  # fmt: skip


def _thing(scene: _Scene, wish: Asked, name: str) -> InspectionReport:
    """Whether something is there."""
    found = _called(scene, wish)
    here = [one for one in found if scene.of(one) != "outside" or not _is_bounded(scene.place)]
    if here and not (wish.unwanted or not wish.holds):
        text, on_it = _on_it(scene, here[0])
        text = f"I can see {scene.told(here[0], article='the')}.{text}"
        return InspectionReport(text, True, here[0].label, things=(here[0], *on_it))
    if here:
        text = f"I can see {' and '.join(scene.told(one) for one in here)}."
        # That it is not there would be well, and is not so.
        return InspectionReport(
            text, wish.holds, here[0].label, attention=not wish.holds, unwanted=wish.unwanted,
            things=tuple(here),
        )  # fmt: skip
    other = f", but {' and '.join(scene.told(one) for one in found)}" if found else ""
    if wish.unwanted or not wish.holds:
        text = f"I see no {name or 'such thing'}{scene.there}{other}."
        text = text.replace("no anything", "nothing").replace("no something", "nothing")
        more = "" if found else scene.also
        unwanted = wish.unwanted
        return InspectionReport(
            text + more, (not wish.holds) or bool(found), name, attention=bool(found), unwanted=unwanted,
            things=tuple(found),
        )  # fmt: skip
    more = f" I can see {' and '.join(scene.told(one) for one in found)}." if found else ""
    if {*wish.thing} & _ANY:  # whether anybody is there is only asked: no is an answer, too
        none = "nobody" if {*wish.thing} & _SOMEBODY else "nothing else"
        return InspectionReport(f"I see {none}{scene.there}.{more or scene.also}", False, name, unwanted=True)
    return InspectionReport(
        f"I looked, but I cannot see {with_article(name) or 'it'}{scene.there}.{more or scene.also}",
        False, name, things=tuple(found),
    )  # fmt: skip


def _on_it(scene: _Scene, found: Detection) -> tuple[str, tuple[Detection, ...]]:
    """What stands on a part of the floor that is looked at: whoever wants to see it wants to know."""
    place = next((item for item in scene.known.objects if item.description == found.label), None)
    if not _is_bounded(place):
        return "", ()
    there = replace(scene, place=place)
    things = tuple(one for one in scene.seen if one is not found and there.of(one) in ("in", "edge"))
    return (f" There is {' and '.join(map(there.told, things))}." if things else ""), things


def _called(scene: _Scene, wish: Asked) -> list[Detection]:
    """What is seen and called so: by all words of its label, or by a part of them.

    Of what should not be there the kind is enough: nobody knows which box it will be.
    """
    if {*wish.thing} & _ANYTHING:
        known = (item for item in scene.known.objects if not item.found)
        expected = {name.lower() for item in known for name in (item.description, item.id)}
        return [one for one in scene.seen if one.label.lower() not in expected]
    names = {stem(word) for word in wish.thing}
    if names & _SOMEBODY:
        return [one for one in scene.seen if _PERSONS & {*one.label.lower().split()}]
    labels = [(one, {stem(word) for word in one.label.lower().split()}) for one in scene.seen]
    if wish.unwanted:
        kind = stem(wish.thing[-1])
        return [one for one, label in labels if kind in label or label <= names]
    whole = [one for one, label in labels if label <= names]
    return whole or [one for one, label in labels if names and names <= label]


def _place(words: Sequence[str], known: ObjectMap) -> Place | None:
    """What of the map is meant by the words for a place."""
    small = lexicon().classes["determiners"] | lexicon().classes["prepositions"]
    bare = [word for at, word in enumerate(words) if word not in small or (at and at == len(words) - 1)]
    if not bare:
        return None
    named = next((area for area in known.areas if area.name.lower() == " ".join(bare)), None)
    found = link(bare, head_of(bare, lexicon()), known.objects, lexicon())
    return found.things[0] if found.kind == "one" else named


def _is_bounded(place: Place | None) -> bool:
    """Whether a place is a part of the floor: what is looked for in it is nowhere else."""
    if not isinstance(place, MapObject):
        return place is not None
    words = {*place.class_name.lower().split(), *place.description.lower().split()}
    return place.width_m > 0 and any(is_word_for(word, "place") for word in words)


def _name(place: Place | None) -> str:
    return "" if place is None else place.description if isinstance(place, MapObject) else place.name


def _article(label: str) -> str:
    return "an" if label[:1].lower() in "aeiou" else "a"
