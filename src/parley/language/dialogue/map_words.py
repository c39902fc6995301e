"""Things of the map in words: which ones a message names, and where they and the robot are."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

from rapidfuzz.distance import OSA

from parley.language.builtin.lexicon import Lexicon, stem, stems
from parley.language.builtin.saying import counted
from parley.language.builtin.things import head_of, link, main_word
from parley.language.builtin.tokens import Token
from parley.world.geometry import Pose2D
from parley.world.object_map import MapObject
from parley.world.whereabouts import called

__all__ = [
    "Named", "distance_m", "in_room", "lies", "named", "named_alone", "room_of", "rooms", "same_kind",
    "same_word", "whereabouts",
]  # fmt: skip

_LONGEST = 8
_IN_TIME = {"before", "after"}
"""They part two names: "the yard before the gate" is no thing."""
_LETTER = "A"
"""Stands for "a" that is the last word of a name, and no article."""
_BEHIND = " . , ; : ! ? - and or first last please too out now then again is off instead "
"""Before these no article stands."""


@dataclass(frozen=True, slots=True)
class Named:
    """Words that name something on the map."""

    start: int
    end: int
    things: tuple[MapObject, ...]
    """One, or several that are called so."""
    words: tuple[str, ...]

    @property
    def text(self) -> str:
        """The words."""
        return " ".join(self.words)


def same_word(one: str, other: str) -> bool:
    """Whether two words are the same but for plural or one slip in a long word."""
    one, other = stem(one), stem(other)
    return one == other or (min(len(one), len(other)) > 4 and OSA.distance(one, other) == 1)


def same_kind(one: MapObject, other: MapObject) -> bool:
    """Whether two things are called by the same noun: "red gate", "gate by the desk", "gate 2"."""
    names = ([*stems(item.description.lower().split())] for item in (one, other))
    nouns = {main_word((name[0], *(word for word in name[1:] if len(word) > 1))) for name in names}
    return len(nouns) == 1


def named(tokens: Sequence[Token], objects: Sequence[MapObject], lexicon: Lexicon) -> list[Named]:
    """What is named, from left to right; of words that overlap the longest run counts."""
    low = [token.low for token in tokens]
    names = {
        tuple(name.lower().replace("_", " ").replace("-", " ").split())
        for item in objects
        for name in (item.description, item.class_name, *item.aliases)
    }
    names |= {other for name in names for other in lexicon.synonyms.get(name, ())}
    words = {_LETTER, *(word for name in names for word in name)}
    before = {name[0] for name in names if name[1:] and name[-1] == "a"}
    for at, token in enumerate(tokens if before else ()):  # "skip A", "leave out area a", "A first"
        alone = f" {[*low, '.'][at + 1]} " in _BEHIND
        if token.low == "a" and (alone or (at and (token.text == "A" or low[at - 1] in before))):
            low[at] = _LETTER
    found: list[Named] = []
    start = 0
    while start < len(low):
        best = _longest(low, start, objects, words, lexicon) if tokens[start].is_word else None
        if best is not None:
            found.append(best)
        start = best.end if best is not None else start + 1
    return found


def named_alone(tokens: Sequence[Token], objects: Sequence[MapObject], lexicon: Lexicon) -> list[MapObject]:
    """The things that are named so that no other one can be meant, in the order of the words."""
    return [name.things[0] for name in named(tokens, objects, lexicon) if len(name.things) == 1]


def _longest(
    low: Sequence[str], start: int, objects: Sequence[MapObject], words: set[str], lexicon: Lexicon
) -> Named | None:
    small = (lexicon.classes["prepositions"] | lexicon.classes["determiners"]) - _IN_TIME
    if low[start] in small or not any(same_word(low[start], word) for word in words):
        return None
    for end in range(min(len(low), start + _LONGEST), start, -1):
        window = low[start:end]
        if window[-1] in small or not all(
            word in small or any(same_word(word, known) for known in words) for word in window
        ):
            continue
        if window == [_LETTER]:
            called = tuple(item for item in objects if item.description.lower().endswith(" a"))
            return Named(start, end, called, ("a",))
        window = [word.lower() for word in window]
        mention = link(window, head_of(window, lexicon), objects, lexicon)
        if mention.kind in ("one", "several"):
            return Named(start, end, mention.things, tuple(window))
    return None


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
