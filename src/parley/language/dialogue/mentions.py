"""Which things of the map a message names, wherever they stand in it, by the words of the message."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from rapidfuzz.distance import OSA

from parley.language.builtin.lexicon import Lexicon, stem, stems
from parley.language.builtin.things import head_of, link, main_word
from parley.language.builtin.tokens import Token
from parley.world.object_map import MapObject

__all__ = ["Named", "named", "named_alone", "same_kind", "same_word"]

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
