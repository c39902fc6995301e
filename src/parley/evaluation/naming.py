"""Whether words name what is meant."""

from __future__ import annotations

import re
from collections.abc import Sequence

from parley.world.object_map import MapObject

__all__ = ["contains_all", "names"]

_NOTHING = frozenset({"", "the", "a", "an"})
_NUMBER = re.compile(r"-?\d+(?:\.\d+)?$")


def words_of(text: str) -> set[str]:
    """The words that tell something from something else."""
    return {word for word in re.split(r"[^\w']+|'s\b", text.casefold()) if word not in _NOTHING}


def contains_all(wanted: str, text: str) -> bool:
    """Whether all words of `wanted`, or one of the alternatives of each, are in a text.

    Quotation marks are for YAML and count for nothing; a word also stands for longer ones.
    """
    lowered = text.casefold().replace("turned ", "")
    return all(
        any(option in lowered for option in part.split("|"))
        for part in wanted.casefold().replace('"', "").split()
    )


def names(wanted: str, value: str, objects: Sequence[MapObject]) -> bool:
    """Whether an argument names what is wanted.

    Args:
        wanted: An object's id, a number, words with ``|`` between alternatives, or ``*`` for whatever it is.
        value: The argument.
        objects: What is on the map; an object is named by its id, or by words that fit it and no other.
    """
    if "*" in wanted.split("|"):
        return bool(value.strip())
    if _NUMBER.match(wanted):
        return bool(_NUMBER.match(value)) and abs(float(wanted) - float(value)) < 0.01
    for item in objects:
        if item.id == wanted:
            return value.casefold() == item.id.casefold() or _names_object(item, words_of(value), objects)
    return any(option.casefold() in value.casefold() for option in wanted.replace('"', "").split("|"))


def _names_object(item: MapObject, mine: set[str], objects: Sequence[MapObject]) -> bool:
    if not mine:
        return False
    exact = [o for o in objects if mine == words_of(o.description)]
    if exact:
        return item in exact
    return [o for o in objects if mine <= words_of(f"{o.id} {o.description} {o.class_name}")] == [item]
