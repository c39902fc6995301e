"""What people say as the rest reads it: frames off, run-on speech cut, conditions and stops in order."""

from __future__ import annotations

from dataclasses import dataclass, field

from parley.language.offline.scene.grounding import ground_phrase
from parley.language.offline.scene.scene import Scene
from parley.language.offline.sentences.conditioning import as_conditions
from parley.language.offline.sentences.frames import unframed
from parley.language.offline.sentences.itineraries import as_itinerary
from parley.language.offline.sentences.run_on import holds_order, punctuated
from parley.language.offline.sentences.told import in_order
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.nouns import bare
from parley.language.offline.words.text import Phrase, keys, plain

__all__ = ["orders_among_talk", "spoken"]

_LONGEST_NAME = 7
_SMALL_TALK = 8
"""Words that a message of nothing but talk may have without being looked through."""


def spoken(words: Phrase, scene: Scene) -> Phrase:
    """A message in plainer words, with marks where its sentences end.

    Args:
        words: All words and punctuation.
        scene: What is known; what was changed is noted in its trace.
    """
    names = _Names(scene)
    result = in_order(punctuated(words, names.is_stop), names.is_stop)
    result = unframed(result, names.is_stop)
    result = as_conditions(result, names.is_stop, scene.is_person)
    if not scene.situation.queue:
        result = as_itinerary(result, names.is_stop) or result
    if keys(result) != keys(words):
        scene.trace.note("words", f"meant as “{plain(result)}”")
    return result


def orders_among_talk(words: Phrase, scene: Scene) -> bool:
    """Whether a message of more than a few words asks for something, whatever talk it begins with."""
    return len(words) > _SMALL_TALK and holds_order(words, _Names(scene).is_stop)


@dataclass
class _Names:
    """Which words name one thing on the map; each phrase is looked up once."""

    scene: Scene
    known: dict[tuple[str, ...], bool] = field(default_factory=dict)
    said: frozenset[str] = field(init=False)

    def __post_init__(self) -> None:
        names = (part for item in self.scene.objects for part in item.description.lower().split())
        self.said = frozenset(names)

    def is_stop(self, words: Phrase) -> bool:
        """Whether words name one thing on the map and say nothing else."""
        flat = keys(words)
        if not flat or len(flat) > _LONGEST_NAME or any(not word.is_word for word in words):
            return False
        if flat[-1] in lexicon().determiners or (
            flat[0] in lexicon().vocabulary and not self._may_begin(flat)
        ):
            return False
        if flat not in self.known:
            named = bare(words)
            rest = set(flat) - self.said - lexicon().determiners
            found = (
                bool(named)
                and len(rest) < 2
                and ground_phrase(named, self.scene.objects, strict=True).outcome == "match"
            )
            self.known[flat] = found
        return self.known[flat]

    def _may_begin(self, flat: tuple[str, ...]) -> bool:
        return flat[0] in lexicon().determiners or flat[0] in self.said
