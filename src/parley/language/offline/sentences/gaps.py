"""A clause with what stands in front of it put in its place ("(A) that should be V-ed", "(A) I want V-ed").

The gap is before helping words ("that has to be V-ed"), behind what is wanted ("I want ... V-ed"), behind a
verb ("you should V ..."), or behind a place ("I want you at ...").
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from parley.language.offline.sentences.deeds import Deeds
from parley.language.offline.words.lexicon import PhraseTable, lexicon
from parley.language.offline.words.text import Phrase, Word, keys
from parley.language.word_lists import load_data

__all__ = ["ASKING_YOU", "CUTS", "LATER", "LONGEST_NAME", "PREPOSITIONS", "THERE", "WANTING", "Gaps", "spelt"]

_DATA = load_data("forms")
WANTING = PhraseTable.of(_DATA["wanting"])
"""Before what is wanted."""
ASKING_YOU = PhraseTable.of(_DATA["asking_you"])
"""Before a verb that whoever is spoken to is asked for."""
THERE = PhraseTable.of(_DATA["wanting_there"])
"""Before a place where whoever is spoken to is wanted."""
CUTS = frozenset({",", "and", "but", "then", "so", ":"})
LATER = frozenset({"next", "first", "last", "now", "then", "finally", "afterwards"})
PREPOSITIONS = frozenset({"in", "at", "on", "from", "to", "near", "behind", "by", "under"})
LONGEST_NAME = 9
_MODAL = PhraseTable.of((*_DATA["modals"], *_DATA["wants_doing"], *_DATA["weak_modals"]))
_MEANT = PhraseTable.of(_DATA["meaning"])
_THERE_ENDS = frozenset(_DATA["there_ends"])
_NO_CLEFT = frozenset(_DATA["no_cleft"])
_BE = frozenset(_DATA["be"])
_RELATIVE = frozenset({"that", "which", "who", "whom"})
_FINITE = frozenset({"has", "have", "had", "needs", "belongs", "wants", "smells", "leaks", "got"})
_SMALL = frozenset({"please", "also", "just", "now", "really", "only"})
_PARTICLES = PREPOSITIONS | {"up", "off", "down", "out", "over", "into", "after", "for", "away"}
_BEHIND = LATER | CUTS | PREPOSITIONS | {"please", "before", "after", "instead", "too", "for"}
_OTHER_VERBS = frozenset({"go", "see", "find", "call", "cover"})


def spelt(text: str) -> Phrase:
    """Words as they are written here."""
    return tuple(Word(part, part) for part in text.split())


@dataclass
class Gaps:
    """Fills what a clause lacks.

    Args:
        deeds: The verbs and their forms.
        is_thing: Whether words can name what something is done to.
        robots: What the robots are called, lower case.
    """

    deeds: Deeds
    is_thing: Callable[[Phrase], bool]
    robots: frozenset[str] = frozenset()

    def is_named(self, words: Phrase) -> bool:
        """Whether words may stand in front: a thing, a place or a robot."""
        flat = keys(words)
        first = flat[1:2] if flat[:1] in {("a",), ("the",)} else ()
        if not flat or flat[0] in _NO_CLEFT or _NO_CLEFT & set(first):
            return False
        place = flat[0] in PREPOSITIONS and len(flat) > 1
        return self.is_thing(words[1:] if place else words) or (len(flat) == 1 and flat[0] in self.robots)

    def filled(self, named: Phrase, gap: Phrase, *, to: bool = True) -> Phrase | None:
        """A clause with what it lacks; None if nothing is asked for in it.

        Args:
            named: What stands in front.
            gap: The clause.
            to: Whether it may be no more than "to V".
        """
        flat = keys(gap)
        if flat[:1] == ("whose",):
            owner = next((i for i in range(2, min(6, len(flat))) if _MODAL.match(flat, i)), 0)
            return (*spelt("the"), *gap[1:owner], *spelt("of"), *named, *gap[owner:]) if owner else None
        gap = gap[1:] if flat and flat[0] in _RELATIVE else gap
        if not gap:
            return None
        return (
            self._before_modal(named, gap)
            or self._wished(named, gap)
            or self._behind_verb(named, gap)
            or self._there(named, gap)
            or (self.to_do(named, gap) if to else None)
            or self._only_meant(named, gap)
        )

    def stated(self, named: Phrase, gap: Phrase) -> Phrase | None:
        """For "it is A that has S", "it was in A that S": said of A."""
        flat = keys(gap)
        if flat[:1] not in {("that",), ("who",), ("which",)} or len(flat) < 3:
            return None
        if named[0].key in PREPOSITIONS:
            cut = next((i for i, key in enumerate(flat) if key == ","), len(flat))
            subject = flat[1] in lexicon().person_pronouns | lexicon().determiners | {"i", "we", "it", "they"}
            return (*gap[1:cut], *named, *gap[cut:]) if subject else None
        return (*named, *gap[1:]) if flat[1] in lexicon().be | _FINITE else None

    @staticmethod
    def lacks_subject(gap: Phrase) -> bool:
        """Whether a clause begins with the helping words of a deed that is due."""
        return _MODAL.match(keys(gap)) is not None

    def to_do(self, named: Phrase, gap: Phrase) -> Phrase | None:
        """For "(A is the one) to V", "(A is the one) to be V-ed"."""
        flat = keys(gap)
        if flat[:1] != ("to",) or len(flat) < 2:
            return None
        return (*named, *spelt("should"), *gap[1:]) if flat[1] == "be" else self._inserted(named, gap[1:])

    def _before_modal(self, named: Phrase, gap: Phrase) -> Phrase | None:
        """For "(A) that should be V-ed", "(N) who should V"."""
        size = _MODAL.match(keys(gap))
        if size is None or size[0] >= len(gap):
            return None
        if len(named) == 1 and named[0].key in self.robots:
            rest = gap[size[0] :]
            return (*named, Word(",", ","), *rest) if rest[0].key not in _BE else None
        return (*named, *gap)

    def _wished(self, named: Phrase, gap: Phrase) -> Phrase | None:
        """For "(A) I want V-ed"."""
        flat = keys(gap)
        size = WANTING.match(flat)
        if size is None or size[0] >= len(flat) or flat[0] not in {"i", "we"}:
            return None
        at = size[0] + (2 if flat[size[0] : size[0] + 2] == ("to", "be") else 0)
        done = self.deeds.done(flat[at]) if at < len(flat) else ""
        return (*gap[: size[0]], *named, *gap[size[0] :]) if done else None

    def _there(self, named: Phrase, gap: Phrase) -> Phrase | None:
        """For "(A) I want you at", "(A) you should go to next"."""
        flat = keys(gap)
        size = THERE.match(flat)
        at = size[0] if size is not None else len(flat)
        if at >= len(flat) or flat[at] not in _THERE_ENDS:
            return None
        placed = lexicon().determiners & set(flat[at + 1 : at + 2])
        if placed and flat[at + 2 : at + 3] not in {("end",), ("moment",)}:
            return None
        return (*spelt("go to"), *named, *gap[at + 1 :])

    def _behind_verb(self, named: Phrase, gap: Phrase) -> Phrase | None:
        """For "(A) you should V", "(A) I want you to V for B"."""
        flat = keys(gap)
        size = ASKING_YOU.match(flat)
        at = size[0] if size is not None else len(flat)
        while at < len(flat) and flat[at] in _SMALL:
            at += 1
        return self._inserted(named, gap[at:]) if at < len(flat) else None

    def _inserted(self, named: Phrase, order: Phrase) -> Phrase | None:
        """An order with what it is about behind its verb."""
        flat = keys(order)
        if not self.deeds.may(flat[0]) and flat[0] not in _OTHER_VERBS:
            return None
        verb = lexicon().verbs.match(flat)
        size = verb[0] if verb is not None else 1
        behind = flat[size + 1] if size + 1 < len(flat) else ""
        ends = not behind.isalnum() or behind in _BEHIND
        size += bool(_PARTICLES & set(flat[size : size + 1])) and ends
        if size == 1 and flat[0] == "go":
            return (*spelt("go to"), *named, *order[1:])
        return (*order[:size], *named, *order[size:])

    @staticmethod
    def _only_meant(named: Phrase, gap: Phrase) -> Phrase | None:
        """For "(A) I was interested in": asked about after another thing."""
        size = _MEANT.match(keys(gap))
        return (*spelt("what about"), *named, *gap[size[0] :]) if size is not None else None
