"""What is told in a list ("there are two places of interest: ..."), and who is meant by its name later."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Final

from parley.language.builtin.decision import Told
from parley.language.builtin.lexicon import Lexicon, stem, stems
from parley.language.lexicon import word_set
from parley.messages.memory import MemoryEntry
from parley.world.object_map import MapObject

__all__ = ["listing", "told_set"]

_LEAD: Final = (
    r"(?:(?:please|and|ok|okay|so|(?:just )?so you know|you should know|fyi|for your information|"
    r"keep in mind|remember|note)(?: that)?[:, ]+)*"
)
_COUNT: Final = r"(?:two|three|four|five|six|seven|eight|nine|ten|\d+)"
_THERE_ARE: Final = r"(?:there(?: are|'re|’re)|these are|(?:we|i)(?: have|'ve|’ve)(?: got)?)"
_LISTINGS: Final = tuple(
    re.compile(rf"{_LEAD}(?P<fact>{shape} ?(?P<items>[^?:]+))", re.IGNORECASE)
    for shape in (
        rf"{_THERE_ARE} (?P<head>[^:?]{{3,80}}):",
        rf"{_THERE_ARE} (?P<head>{_COUNT} \w+(?: \w+)?(?: of \w+)?),(?: namely)?",
        r"(?:the|our|my) (?P<head>\w+(?: \w+)?(?: of \w+)?) are(?: called)?:?",
    )
)
_WORD: Final = re.compile(r"[\w-]+")


def listing(message: str, objects: Sequence[MapObject], lexicon: Lexicon) -> Told | None:
    """The fact that some things of the map are something: behind the colon stand their names alone."""
    found = _found(" ".join(message.split()))
    if found is None or len(_items(found["items"], objects, found["head"])) < 2:
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
        found = _found(memory.data) if memory.type == "text" else None
        if found is not None and wanted and wanted <= {stem(w) for w in _WORD.findall(found["head"].lower())}:
            return _items(found["items"], objects, found["head"])
    return ()


def _found(text: str) -> re.Match[str] | None:
    """The list that a text is."""
    return next((match for one in _LISTINGS if (match := one.fullmatch(text.rstrip(".! ")))), None)


_COUNTS: Final = word_set("two three four five six seven eight nine ten several some few 2 3 4 5 6 7 8 9 10")


def _items(text: str, objects: Sequence[MapObject], head: str) -> tuple[MapObject, ...]:
    """The things that a list names, with words of its `head` or without; none if anything else is in it."""
    parts = [part for part in re.split(r",\s*(?:and\s+)?|;\s*|\s+and\s+", text.strip(" .!")) if part]
    said = [re.sub(r"^(?:the|an?|my|our) ", "", part.lower()).split() for part in parts]
    kinds = [said[0][:-1] if said else [], *([word] for word in _WORD.findall(head.lower()))]
    called = [
        next((things for kind in ([], *kinds) if (things := _called([*kind, *words], objects))), [])
        for words in said
    ]
    return tuple(one[0] for one in called) if all(len(one) == 1 for one in called) else ()


def _called(words: Sequence[str], objects: Sequence[MapObject]) -> list[MapObject]:
    """What is called so; "2" behind "bay 1" is bay 2."""
    name = stems(words)
    return [item for item in objects if name in {stems(n.split()) for n in (item.description, *item.aliases)}]
