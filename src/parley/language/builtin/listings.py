"""What is told in a list ("there are two places of interest: ..."), and who is meant by its name later."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Final

from parley.language.builtin.decision import Told
from parley.language.builtin.lexicon import Lexicon, stem, stems
from parley.messages.memory import MemoryEntry
from parley.world.object_map import MapObject

__all__ = ["listing", "told_set"]

_LISTING: Final = re.compile(
    r"(?:(?:please|and|ok|okay|so|remember(?: that)?|note(?: that)?)[, ]+)*"
    r"(?P<fact>(?:there(?: are|'re|’re)|these are|(?:we|i)(?: have|'ve|’ve)(?: got)?) "
    r"(?P<head>[^:?]{3,80}): ?(?P<items>[^?:]+))",
    re.IGNORECASE,
)
_WORD: Final = re.compile(r"[\w-]+")


def listing(message: str, objects: Sequence[MapObject], lexicon: Lexicon) -> Told | None:
    """The fact that some things of the map are something: behind the colon stand their names, nothing else.

    Args:
        message: As it was said.
        objects: The map.
        lexicon: Closed classes.
    """
    found = _LISTING.fullmatch(" ".join(message.split()).rstrip(".! "))
    if found is None or len(_items(found["items"], objects)) < 2:
        return None
    counting = lexicon.classes["determiners"] | _COUNTS
    words = [word for word in _WORD.findall(found["head"].lower()) if word not in counting]
    fact = found["fact"]
    text = fact[:1].lower() + fact[1:] if not fact.lower().startswith("i") else fact
    return Told("_".join(words)[:150], text, f"The {' '.join(words)}") if words else None


def told_set(
    words: Sequence[str], memories: Sequence[MemoryEntry], objects: Sequence[MapObject], lexicon: Lexicon
) -> tuple[MapObject, ...]:
    """The things of a list that was told and is called so: "each place of interest"; the newest list."""
    small = lexicon.classes["determiners"] | lexicon.classes["prepositions"] | {"of", "those", "them"}
    wanted = {stem(word) for word in words if word not in small}
    for memory in reversed(memories):
        found = _LISTING.fullmatch(memory.data.rstrip(".! ")) if memory.type == "text" else None
        if found is not None and wanted and wanted <= {stem(w) for w in _WORD.findall(found["head"].lower())}:
            return _items(found["items"], objects)
    return ()


_COUNTS: Final = frozenset({
    "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten", "several", "some", "few",
    "2", "3", "4", "5", "6", "7", "8", "9", "10",
})  # fmt: skip


def _items(text: str, objects: Sequence[MapObject]) -> tuple[MapObject, ...]:
    """The things that a list names; none if anything else stands in it."""
    parts = [part for part in re.split(r",\s*(?:and\s+)?|;\s*|\s+and\s+", text.strip(" .!")) if part]
    said = [re.sub(r"^(?:the|an?|my|our) ", "", part.lower()).split() for part in parts]
    kind = said[0][:-1] if said else []
    called = [_called(words, objects) or _called([*kind, *words], objects) for words in said]
    return tuple(one[0] for one in called) if all(len(one) == 1 for one in called) else ()


def _called(words: Sequence[str], objects: Sequence[MapObject]) -> list[MapObject]:
    """What is called so; "2" behind "bay 1" is bay 2."""
    name = stems(words)
    return [item for item in objects if name in {stems(n.split()) for n in (item.description, *item.aliases)}]
