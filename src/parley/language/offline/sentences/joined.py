"""A deed in the passive put in front of what it is done to, and what else is joined to it.

"(A is to be V-ed) and W-ed", "and B W-ed", "B too", "B is not", "(A need not be V-ed,) only W-ed".
"""

from __future__ import annotations

from dataclasses import dataclass

from parley.language.offline.sentences.deeds import Deeds
from parley.language.offline.sentences.subjects import ADVERBS, CUTS, LONGEST_SUBJECT, Subjects
from parley.language.offline.words.lexicon import PhraseTable, lexicon
from parley.language.offline.words.text import Phrase, Word, keys
from parley.language.word_lists import load_data

__all__ = ["Found", "Joined", "ordered"]

_DATA = load_data("forms")
_DENIED = PhraseTable.of(_DATA["denied"])
_SAME = PhraseTable.of(_DATA["same"])
_PARTICLES = frozenset({"off", "up", "down", "out", "away", "on", "over", "in"})
_STRANDED = _PARTICLES | {"at", "after", "to", "into", "for", "round", "through", "with", "of"}
_BEHIND_STRANDED = CUTS | ADVERBS | {"before", "after", "by", "when", "once"}
_BEHIND_PARTICLE = frozenset({"to", "for", "from", "with"})
_MORE = CUTS | {"also", "afterwards", "finally", "after", "that", "be", "only"}
_HELPING = ADVERBS | {"be", "to", "is", "are", "gets"}
_OBJECTS = {"they": "them", "he": "him", "she": "her"}


@dataclass(frozen=True, slots=True)
class Found:
    """Where a message says what is to be done with what."""

    start: int
    subject: Phrase
    verb: str
    end: int
    """Behind the deed."""
    negated: bool = False
    doing: bool = False
    """Whether it is said in its form in -ing, or as a noun."""


def ordered(verb: str, thing: Phrase, rest: Phrase) -> tuple[Phrase, Phrase]:
    """A deed and what it is done to, and what is left of what is said behind.

    Args:
        verb: The deed in its base form.
        thing: What it is done to, as it stands in front.
        rest: What is said behind the deed; a word that belongs to it ("looked at", "pumped up") goes along.
    """
    flat = keys(rest)
    size = 2 if flat[:2] == ("care", "of") else int(_belongs(flat))
    first = tuple(Word(key, key) for key in keys(thing[:1]))
    first = tuple(Word(key, key) for word in first for key in (_OBJECTS.get(word.key, word.key),))
    plainly = first if first and first[0].key in lexicon().determiners | {*_OBJECTS.values()} else thing[:1]
    return (*(Word(part, part) for part in verb.split()), *rest[:size], *plainly, *thing[1:]), rest[size:]


def _belongs(flat: tuple[str, ...]) -> bool:
    """Whether the first word behind a deed belongs to it, and not to a place behind."""
    if not flat or flat[0] not in _STRANDED:
        return False
    behind = flat[1] if len(flat) > 1 else ""
    if behind in lexicon().quantifiers and flat[2:3] and flat[2].isalpha() and flat[2] not in CUTS:
        # "In each of the rooms", "in both rooms".
        return False
    if not behind[:1].isalnum() or behind in _BEHIND_STRANDED:
        return True
    return flat[0] in _PARTICLES - {"on", "in", "out"} and behind in _BEHIND_PARTICLE


@dataclass
class Joined:
    """Reads what is joined to a deed.

    Args:
        deeds: The verbs and their forms.
        subjects: What something may be done to.
    """

    deeds: Deeds
    subjects: Subjects

    def with_others(self, subject: Phrase, rest: Phrase) -> tuple[Phrase, Phrase]:
        """For "(A is to be V-ed) for C, and B too": what something is done to, with B, and the rest."""
        flat = keys(rest)
        cut = next((i for i, key in enumerate(flat) if key in CUTS), len(flat))
        begin = cut
        while begin < len(flat) and flat[begin] in {",", "and", "so", "also"}:
            begin += 1
        for end in range(begin + 1, min(len(flat), begin + LONGEST_SUBJECT)):
            close = self._close(flat, end, _SAME)
            if close and subject and self._names(rest[begin:end]):
                return (*subject, Word("and", "and"), *rest[begin:end]), (*rest[:cut], *rest[close:])
        return subject, rest

    def behind(self, rest: Phrase, found: Found) -> Phrase:
        """What is said behind a deed, with orders in place of what is joined to it."""
        flat = keys(rest)
        begin = next((i for i, key in enumerate(flat) if key in CUTS), len(flat))
        while begin < len(flat) and flat[begin] in _MORE:
            begin += 1
        if begin == len(flat):
            return rest
        return (*rest[:begin], *(self._same_thing(rest[begin:], found) or self._other(rest[begin:], found)))

    def denied(self, rest: Phrase, found: Found) -> Phrase | None:
        """What is ordered in "(A is not to be V-ed), only W-ed", "(A need not be V-ed), but B has to be"."""
        at = next((i for i, word in enumerate(rest) if word.key in CUTS), len(rest))
        while at < len(rest) and rest[at].key in CUTS | {"only", "just", "instead"}:
            at += 1
        behind = rest[at:]
        flat = keys(behind)
        verb = self.deeds.done(flat[0]) if behind else ""
        if self.deeds.can(verb):
            order, tail = ordered(verb, found.subject, behind[1:])
            return (*order, *tail)
        end = next((i for i in range(1, len(flat)) if self._close(flat, i, _SAME) == len(flat)), 0)
        named = bool(end) and self.subjects.is_thing(behind[:end])
        return ordered(found.verb, behind[:end], ())[0] if named else None

    @staticmethod
    def _close(flat: tuple[str, ...], at: int, table: PhraseTable) -> int:
        """Where words of a table that end a clause end; 0 if there are none."""
        size = table.match(flat, at)
        close = at + size[0] if size is not None else 0
        return close if close and (close == len(flat) or flat[close] in CUTS) else 0

    def _names(self, words: Phrase) -> bool:
        return self.subjects.is_thing(words) and self.subjects.are_things(words)

    def _form(self, word: str, found: Found) -> str:
        """The verb of a form like that of the deed before: "V-ed and W-ed", "V-ing and W-ing"."""
        return self.deeds.done(word) or (self.deeds.doing(word) if found.doing else "")

    def _same_thing(self, rest: Phrase, found: Found) -> Phrase | None:
        """For "and W-ed": done to the same thing."""
        flat = keys(rest)
        verb = self._form(flat[0], found)
        own = flat[0] in self.deeds.own or {"by"} & set(flat[1:2])
        if not self.deeds.can(verb) or own or lexicon().determiners & set(flat[1:2]):
            return None
        order, tail = ordered(verb, found.subject, rest[1:])
        return (*order, *self.behind(tail, found))

    def _other(self, rest: Phrase, found: Found) -> Phrase:
        """For "and B W-ed", "and B has to be", "and B is not"."""
        flat = keys(rest)
        for end in range(1, min(len(flat), LONGEST_SUBJECT)):
            if not self._names(rest[:end]):
                continue
            if close := self._close(flat, end, _DENIED):
                return (Word("not", "not"), *rest[:end], *rest[close:])
            if close := self._close(flat, end, _SAME):
                return (*ordered(found.verb, rest[:end], ())[0], *rest[close:])
            deed = end
            while deed < len(flat) and flat[deed] in _HELPING:
                deed += 1
            verb = self._form(flat[deed], found) if deed < len(flat) else ""
            whole = not lexicon().determiners & set(flat[deed + 1 : deed + 2])
            if self.deeds.can(verb) and whole and not self.subjects.modifies(rest, 0, deed):
                order, tail = ordered(verb, rest[:end], rest[deed + 1 :])
                return (*order, *self.behind(tail, Found(0, rest[:end], verb, 0, doing=found.doing)))
        return rest
