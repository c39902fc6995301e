"""What people say as the rest reads it: frames off, run-on speech cut, conditions and stops in order."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from functools import lru_cache

from parley.language.offline.scene.grounding import ground_phrase
from parley.language.offline.scene.marks import marks_of
from parley.language.offline.scene.scene import Scene
from parley.language.offline.scene.viewing import is_view
from parley.language.offline.sentences.conditioning import as_conditions
from parley.language.offline.sentences.finite import parted
from parley.language.offline.sentences.frames import unframed
from parley.language.offline.sentences.itineraries import as_itinerary
from parley.language.offline.sentences.run_on import holds_order, punctuated
from parley.language.offline.sentences.told import in_order
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.nouns import bare
from parley.language.offline.words.text import Phrase, keys, plain
from parley.world.object_map import MapObject

__all__ = ["Names", "orders_among_talk", "spoken"]

_LONGEST_NAME = 7
_SMALL_TALK = 8
"""Words that a message of nothing but talk may have without being looked through."""


def spoken(words: Phrase, scene: Scene) -> Phrase:
    """A message in plainer words, with marks where its sentences end.

    Args:
        words: All words and punctuation.
        scene: What is known; what was changed is noted in its trace.
    """
    names = Names(scene)
    result = in_order(punctuated(parted(words), names.is_stop), names.is_stop)
    result = unframed(result, names.is_stop)
    result = as_conditions(result, names.is_stop, scene.is_person)
    if not scene.situation.queue:
        result = as_itinerary(result, names.is_stop) or result
    if keys(result) != keys(words):
        scene.trace.note("words", f"meant as “{plain(result)}”")
    return result


def orders_among_talk(words: Phrase, scene: Scene) -> bool:
    """Whether a message of more than a few words asks for something, whatever talk it begins with."""
    return len(words) > _SMALL_TALK and holds_order(words, Names(scene).is_stop)


_MOST_LOOKED_UP = 20_000


@lru_cache(maxsize=8)
def _looked_up(objects: tuple[MapObject, ...]) -> dict[tuple[str, ...], bool]:
    """What was looked up on a map already; it is the same for every message about that map."""
    del objects
    return {}


@dataclass
class Names:
    """Which words name one thing on the map; each phrase is looked up once."""

    scene: Scene
    known: dict[tuple[str, ...], bool] = field(init=False)
    said: frozenset[str] = field(init=False)
    heads: frozenset[str] = field(init=False)
    """The last words of names."""
    called: frozenset[str] = field(init=False)
    """What only one thing is called."""

    def __post_init__(self) -> None:
        self.known = _looked_up(self.scene.objects)
        if len(self.known) > _MOST_LOOKED_UP:
            self.known.clear()
        names = (part for item in self.scene.objects for part in item.description.lower().split())
        self.said = frozenset(names)
        self.heads = frozenset(item.description.lower().split()[-1] for item in self.scene.objects)
        called = Counter(item.description.lower() for item in self.scene.objects)
        self.called = frozenset(name for name, count in called.items() if count == 1)

    def is_stop(self, words: Phrase) -> bool:
        """Whether words name one thing on the map and say nothing else."""
        if len(words) == 1 and marks_of(words[0]):
            return True
        flat = keys(words)
        found = self.known.get(flat)
        if found is None:
            found = self.known[flat] = self._is_name(words, flat)
        return found

    def _is_name(self, words: Phrase, flat: tuple[str, ...]) -> bool:
        if " ".join(flat).removeprefix("the ") in self.called:
            return True
        if not flat or len(flat) > _LONGEST_NAME or any(not word.is_word for word in words):
            return False
        if flat[-1] in lexicon().determiners or (
            flat[0] in lexicon().vocabulary and not self._may_begin(flat)
        ):
            return False
        named = bare(words)
        if named[-1:] != words[-1:]:
            # "The desk first": more than the name.
            return False
        sides = all(is_view(word.key) or word.key in {"your", "back"} for word in named)
        if sides and not set(keys(named)) & (self.heads if len(named) == 1 else self.said):
            # "On your right": where something is, and no name.
            return False
        rest = set(flat) - self.said - lexicon().determiners
        if not named or len(rest) > 1:
            return False
        strict = ground_phrase(named, self.scene.objects, strict=True).outcome == "match"
        return strict or self._shortened(named)

    def _shortened(self, named: Phrase) -> bool:
        """Whether two or more words of one description, and of no other, stand for it."""
        said = set(keys(named))
        if len(said) < 2 or not any(word.isalpha() and len(word) > 2 for word in said):
            return False
        return sum(said <= set(item.description.lower().split()) for item in self.scene.objects) == 1

    def _may_begin(self, flat: tuple[str, ...]) -> bool:
        return flat[0] in lexicon().determiners or flat[0] in self.said
