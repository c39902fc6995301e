"""Several things named at once: lists of labels, ranges, all of a kind but some."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import lru_cache

from parley.language.offline.grammar.small import small
from parley.language.offline.scene.grounding import ground_phrase
from parley.language.offline.scene.known import UnclearError
from parley.language.offline.scene.scene import Scene
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.nouns import number_of
from parley.language.offline.words.text import Phrase, Word, keys, singular, split_name, tokens
from parley.world.object_map import MapObject

__all__ = ["Groups", "Item", "Thing", "vocabulary"]


@dataclass(frozen=True, slots=True)
class Thing:
    """Something that is named, or several."""

    members: tuple[Phrase, ...]
    """Its names, one by one."""
    said: Phrase
    known: bool = False
    """Whether only memory knows it."""
    group: bool = False
    """Whether it stands for several things at once."""


@dataclass(frozen=True, slots=True)
class Item:
    """One word, or one thing that several words name."""

    key: str
    words: Phrase
    thing: Thing | None = None


@lru_cache(maxsize=256)
def vocabulary(objects: tuple[MapObject, ...]) -> frozenset[str]:
    """Every word that can name something of the map, singular."""
    found: set[str] = set()
    for item in objects:
        texts = (item.description, *item.aliases)
        found.update(word.key for text in texts for word in tokens(text) if word.is_word)
        found.update(split_name(item.class_name))
    single = {number_of(singular(word)) for word in found}
    single |= {other for word in single for other in lexicon().synonyms.get(word, ()) if " " not in other}
    return frozenset(single - lexicon().determiners - small().prepositions)


@dataclass
class Groups:
    """The words of a message, and what they can name together."""

    words: Phrase
    scene: Scene

    def __post_init__(self) -> None:
        """Collect what the map calls its things."""
        self.names = vocabulary(self.scene.objects)

    def _names(self, index: int, start: int) -> bool:
        key = self.words[index].key
        if not self.words[index].is_word:
            return False
        if key.isdigit() or len(key) == 1:
            return index > start and self._is_label(index)
        if key in small().sets["modifiers"] or key in lexicon().ordinals:
            return True
        if key == "of":
            return index > start and "of" in self.names
        return number_of(singular(key)) in self.names or key in self.names

    def _is_label(self, index: int) -> bool:
        word = self.words[index]
        letter = len(word.key) == 1 and (word.key != "a" or word.is_capital)
        return word.is_word and (word.key.isdigit() or letter)

    def _members(self, phrase: Phrase) -> tuple[Phrase, ...]:
        try:
            return tuple(self.scene.several(phrase))
        except UnclearError:
            return ()

    def _labels(self, at: int, head: Phrase, first: Word | None) -> tuple[int, list[Phrase]]:
        """For "zones 2, 3 and 5", "zones 1 to 4", "zones from 4 down to 1"."""
        named = self._labelled(head)
        found = [(*named, first)] if first is not None else []
        end, start = at, at
        while start < len(self.words):
            key = self.words[start].key
            joins = key in {",", "and", "&", "plus", "from", "number", "numbers"} | small().sets["to"] | {
                "down",
                "up",
            }
            if joins and start - end < 3:
                start += 1
                continue
            repeated = keys(self.words[start : start + len(named)]) == keys(named)
            start += len(named) if repeated else 0
            if start >= len(self.words) or not self._is_label(start) or (found and start == end):
                break
            member = (*named, self.words[start])
            if not self._is_one(member):
                break
            between = set(keys(self.words[end:start]))
            if between & small().sets["to"] and found:
                found += list(self._range(named, found[-1][-1].key, self.words[start].key))
            else:
                found.append(member)
            start = end = start + 1
        return end, found

    def _labelled(self, head: Phrase) -> Phrase:
        last = head[-1]
        return (*head[:-1], Word(singular(last.key), singular(last.raw)))

    def _range(self, head: Phrase, first: str, last: str) -> Iterable[Phrase]:
        digits = first.isdigit() and last.isdigit()
        if not digits and not (len(first) == len(last) == 1 and first.isalpha() and last.isalpha()):
            return
        start, end = (int(first), int(last)) if digits else (ord(first), ord(last))
        step = 1 if end > start else -1
        for number in range(start + step, end + step, step) if abs(start - end) <= 50 else ():
            label = str(number) if digits else chr(number)
            member = (*head, Word(label, label if digits else label.upper()))
            if self._is_one(member):
                yield member

    def between(self, first: Phrase, last: Phrase) -> list[Phrase]:
        """For "tank 4" and "tank 1": both and those between; nothing if they are of two kinds."""
        if len(first) < 2 or len(first) != len(last) or keys(first[:-1]) != keys(last[:-1]):
            return []
        behind = list(self._range(first[:-1], first[-1].key, last[-1].key))
        return [first, *behind] if behind else []

    def _is_one(self, phrase: Phrase) -> bool:
        return ground_phrase(phrase, self.scene.objects, strict=True).outcome == "match"
