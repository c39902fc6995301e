"""Several things named at once: lists of labels, ranges, all of a kind but some."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
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

_EXCEPT = tuple(
    tuple(text.split())
    for text in ("except for", "except", "but not", "but", "bar", "save for", "save", "apart from",
                 "other than", "minus", "excluding", "leaving out", "all but", "all except", "without",
                 "with the exception of", "barring", "not counting", "aside from", "excepting")
)  # fmt: skip


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

    def _without(self, at: int, stop: int, thing: Thing) -> tuple[int, Thing]:
        """For "all zones except the second"."""
        start = stop + 1 if keys(self.words[stop : stop + 1]) == (",",) else stop
        marker = next((m for m in _EXCEPT if keys(self.words[start : start + len(m)]) == m), ())
        if not marker:
            return stop, thing
        behind = start + len(marker)
        for end in range(min(len(self.words), behind + 7), behind, -1):
            if not self.words[end - 1].is_word or self.words[end - 1].key == "and":
                continue
            left_out = self.words[behind:end]
            kept = self._all_but(thing, left_out)
            if kept is not None:
                return end, Thing(kept, self.words[at:end], group=True)
        return stop, thing

    def _all_but(self, thing: Thing, left_out: Phrase) -> tuple[Phrase, ...] | None:
        """What is left of a group; None if these words leave out none of it."""
        flat = tuple(key for key in keys(left_out) if key not in {"the", "one", "number"})
        if len(flat) == 1 and (flat[0] == "last" or flat[0] in lexicon().ordinals):
            index = -1 if flat[0] == "last" else lexicon().ordinals[flat[0]] - 1
            if index < len(thing.members):
                gone = thing.members[index]
                return tuple(m for m in thing.members if m is not gone)
        gone_ids: set[str] = set()
        named = self._excluded(left_out, thing)
        if named is None:
            return None
        for phrase in named:
            found = ground_phrase(phrase, self.scene.objects, strict=True)
            gone_ids |= {item.id for item in found.candidates}
        kept = tuple(m for m in thing.members if not gone_ids & set(self._ids(m)))
        return kept if 0 < len(kept) < len(thing.members) else None

    def _excluded(self, words: Phrase, thing: Thing) -> list[Phrase] | None:
        """The phrases that name what is left out; None if a word is no name."""
        parts: list[list[Word]] = [[]]
        for word in words:
            if word.key in {"and", ","}:
                parts.append([])
            elif word.key not in {"the", "a", "one", "ones", "number"}:
                parts[-1].append(word)
        head = self._labelled(thing.members[0])[:-1] if len(thing.members[0]) > 1 else ()
        tail = thing.members[0][-1:]
        result: list[Phrase] = []
        for part in (tuple(part) for part in parts if part):
            options = [part, (*head, *part), (*part, *tail)]
            fits = next((o for o in options if self._is_one(o)), None)
            if fits is None or not all(self._names(i, -1) for i in self._places(part)):
                return None
            result.append(fits)
        return result or None

    def _places(self, part: Phrase) -> list[int]:
        return [i for i, word in enumerate(self.words) if any(word is other for other in part)][:3]

    def _ids(self, phrase: Phrase) -> Sequence[str]:
        return [item.id for item in ground_phrase(phrase, self.scene.objects, strict=True).candidates]
