"""Things by whose they are: "A's car", where it is remembered that A drives the green one."""

from __future__ import annotations

from collections.abc import Sequence

from parley.language.offline.facts.owning import belongings
from parley.language.offline.facts.remembering import Remembered, newest
from parley.language.offline.scene.grounding import ground_phrase, matching
from parley.language.offline.words.nouns import bare, noun_phrase
from parley.language.offline.words.text import Phrase, Word, keys
from parley.world.object_map import MapObject

__all__ = ["owned_thing"]


def owned_thing(
    words: Phrase, objects: Sequence[MapObject], facts: Sequence[Remembered]
) -> tuple[MapObject, tuple[Remembered, ...]] | None:
    """The one object that somebody is remembered to own and that is of the kind that is named.

    Args:
        words: The description.
        objects: The map.
        facts: What is remembered, newest first.
    """
    words = _possessive(words)
    ends = ("'s", "s'")
    at = next(
        (i for i, word in enumerate(words[:-1]) if word.key.endswith(ends) or word.raw.endswith(ends)), -1
    )
    if at < 0 or not facts:
        return None
    last = words[at]
    stem = Word(last.key.removesuffix("'s"), last.raw.removesuffix("'s"))
    owner = set(noun_phrase((*bare(words[:at]), stem)).core)
    kind = bare(words[at + 1 :])
    if not owner or not kind:
        return None
    found: dict[str, tuple[MapObject, Remembered]] = {}
    for belonging in belongings(facts):
        if not owner <= set(noun_phrase(belonging.owner).core):
            continue
        if keys(kind)[-1] in _RESERVED_KINDS and not set(keys(belonging.source.fact.state[:1])) & _RESERVED:
            continue
        thing = ground_phrase(belonging.thing, objects, strict=True)
        if thing.outcome == "match" and _is_kind(thing.candidates[0], kind, belonging.kind):
            found.setdefault(thing.candidates[0].id, (thing.candidates[0], belonging.source))
    if len(found) != 1:
        return None if found else _occupied(owner, kind, objects, facts)
    item, source = next(iter(found.values()))
    return item, (source,)


def _occupied(
    owner: set[str], kind: Phrase, objects: Sequence[MapObject], facts: Sequence[Remembered]
) -> tuple[MapObject, tuple[Remembered, ...]] | None:
    """For "A's room": the room that A is remembered to be in."""
    for known in newest(facts):
        if keys(known.fact.subject) and set(noun_phrase(known.fact.subject).core) == owner:
            there = ground_phrase(known.fact.place, objects, strict=True)
            mine = there.outcome == "match" and there.candidates[0] in matching(kind, objects)
            return (there.candidates[0], (known,)) if mine else None
    return None


def _possessive(words: Phrase) -> Phrase:
    """For "the car of A" "A's car"."""
    flat = keys(words)
    at = flat.index("of") if "of" in flat[1:-1] else 0
    owner, kind = bare(words[at + 1 :]), bare(words[:at])
    if not at or not owner or not kind or len(owner) > 3 or any("'s" in key for key in flat):
        return words
    last = owner[-1]
    return (*owner[:-1], Word(f"{last.key}'s", f"{last.raw}'s"), *kind)


def _is_kind(item: MapObject, kind: Phrase, called: str) -> bool:
    if keys(kind)[-1] in _RESERVED_KINDS:
        return True
    return keys(kind) == (called,) or keys(kind) in {("one",), ("thing",)} or item in matching(kind, [item])


_RESERVED_KINDS = frozenset({"spot", "place", "space"})
_RESERVED = frozenset({"reserved", "kept", "assigned", "booked", "meant", "rented", "allocated"})
