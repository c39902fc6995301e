"""Which things a description names word for word; what is plain needs no model. Pure."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Final

from parley.language.base import Grounding
from parley.world.object_map import MapObject

__all__ = ["chosen", "named"]

_ARTICLES: Final = frozenset({"the", "a", "an"})


def named(description: str, objects: Sequence[MapObject]) -> Grounding | None:
    """The things whose id, description or other name this is, or else all of the kind that it names.

    None where it takes understanding: other words, or a kind that is also part of another thing's name.
    """
    words = _words(description)
    by_id = [thing for thing in objects if thing.id.casefold() == description.strip().casefold()]
    called = [t for t in objects if words in [_words(name) for name in (t.description, *t.aliases) if name]]
    if not words or not (found := by_id or called):
        found = _of_kind(words, objects)
    if not found:
        return None
    return Grounding("match" if len(found) == 1 else "ambiguous", tuple(found))


def chosen(reply: str, choices: Sequence[str]) -> str | None:
    """The offered choice that a reply gives word for word."""
    words = _words(reply)
    found = [choice for choice in choices if words and _words(choice) == words]
    return found[0] if len(found) == 1 else None


def _of_kind(words: tuple[str, ...], objects: Sequence[MapObject]) -> list[MapObject]:
    found = [thing for thing in objects if words and _words(thing.class_name) == words]
    others = [
        thing for thing in objects if thing not in found and set(words) <= set(_words(_all_words(thing)))
    ]
    return [] if others else found


def _all_words(thing: MapObject) -> str:
    return " ".join((thing.id, thing.class_name, thing.description, *thing.aliases))


def _words(text: str) -> tuple[str, ...]:
    found = re.findall(r"[^\W_]+", text.casefold())
    return tuple(found[1:] if len(found) > 1 and found[0] in _ARTICLES else found)
