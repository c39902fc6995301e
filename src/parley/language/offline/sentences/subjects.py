"""What something is done to: whether words can name it, and where its name begins before helping words."""

from __future__ import annotations

from dataclasses import dataclass

from parley.language.offline.sentences.clauses import opens_command
from parley.language.offline.sentences.spoken import Names
from parley.language.offline.words.lexicon import PhraseTable, lexicon
from parley.language.offline.words.text import Phrase, Word, keys
from parley.language.word_lists import load_data

__all__ = ["ADVERBS", "CUTS", "LONGEST_SUBJECT", "OPENERS", "Subjects", "after_openers", "is_free"]

_DATA = load_data("forms")
ADVERBS = frozenset(_DATA["adverbs"])
"""What may stand between a subject and its deed."""
OPENERS = PhraseTable.of(_DATA["openers"])
_JOINTS = frozenset({"and", "but", "then", "so"})
CUTS = _JOINTS | {",", ":", "-"}
"""Where a clause may end."""
LONGEST_SUBJECT = 14
_NO_THINGS = frozenset(_DATA["no_things"]) - {"a", "an", "the", "of", "for", "with", "that"}
_RELATIVE = frozenset({"that", "which", "who", "where", "whose"})
_SUBORDINATE = frozenset(_DATA["subordinate"])
_TOLD = frozenset(_DATA["told"])
_WHOLE = frozenset({"this", "these", "those", "that", "both", "all", "each"})
_RANKS = frozenset({"both", "all", "each", "last", "first", "next", "then"})
_POINTING = frozenset({"it", "they", "them", "he", "she", "both", "all"})
_PRONOUNS = {("it",), ("they",), ("he",), ("she",)}
_NEAR = frozenset({"next", "close", "closest", "nearest", "near", "opposite"})
_COMPLETE = frozenset({"has", "have", "had", "needs", "sees", "see", "find", "looks"})
_PARTICLES = frozenset({"on", "off"})
_SHORTEST_CLAUSE = 3
_LONGEST_NAME = 5


def after_openers(flat: tuple[str, ...], start: int = 0) -> int:
    """Where a clause begins behind words that only open it ("and then please")."""
    while (size := OPENERS.match(flat, start)) is not None and start + size[0] < len(flat):
        start += size[0]
    return start


def is_free(flat: tuple[str, ...]) -> bool:
    """For "what I told you about A", "whatever you are doing": a clause that stands for a thing."""
    named = flat[:1] in {("what",), ("whatever",)} and flat[1:2] in {("i",), ("you",), ("we",)}
    return named and len(flat) > _SHORTEST_CLAUSE and "," not in flat


@dataclass
class Subjects:
    """What something may be done to.

    Args:
        names: What is on the map.
    """

    names: Names

    def is_thing(self, words: Phrase) -> bool:
        """Whether words can name one thing."""
        flat = keys(words)
        if not 0 < len(flat) <= LONGEST_SUBJECT or not all(word.is_word for word in words):
            return False
        if self.names.is_stop(words) or is_free(flat):
            return True
        words = _without_relation(words)
        flat = keys(words)
        link = next((i for i in range(2, len(flat)) if flat[i] in _RELATIVE), len(flat))
        head = flat[:link]
        letter = words[link - 1].raw.isupper() and len(head) > 1
        if not letter and head[-1] in lexicon().determiners - _WHOLE:
            return False
        if head[-1] in _PARTICLES and len(head) > 1:
            return False
        finite = lexicon().be | lexicon().auxiliaries | _NO_THINGS
        first = (lexicon().goals_and_places | ADVERBS) - _RANKS - {"that"}
        return not finite & set(head) and head[0] not in first and (len(head) > 1 or head[0] not in CUTS)

    def are_things(self, words: Phrase) -> bool:
        """Whether words name one thing or several ("A, B and C")."""
        flat = keys(words)
        if self.names.is_stop(words):
            return True
        if len(words) > 1 and opens_command(words, ()) and flat[0] not in lexicon().determiners:
            return any(self.names.is_stop(words[:size]) for size in range(2, len(words)))
        ends = [i for i, key in enumerate(flat) if key in {",", "and", "or", "&", "but"}]
        begins = [0, *(end + 1 for end in ends)]
        parts = [words[begin:end] for begin, end in zip(begins, [*ends, len(words)], strict=True)]
        if not parts[0] or not parts[-1]:
            return False
        return all(not part or self.is_thing(_without_exception(part)) for part in parts)

    def is_definite(self, words: Phrase) -> bool:
        """Whether words name something that is known, or point at it."""
        flat = keys(words)
        pointing = lexicon().thing_pronouns | lexicon().determiners | _POINTING
        if flat[0] in pointing or is_free(flat):
            return True
        spans = (
            (i, j) for i in range(len(flat)) for j in range(i + 1, min(len(flat), i + _LONGEST_NAME) + 1)
        )
        return any(self.names.is_stop(words[i:j]) for i, j in spans)

    def modifies(self, words: Phrase, begin: int, deed: int) -> bool:
        """Whether a form only describes what stands behind it: "two sliced loaves"."""
        head = words[begin:deed]
        last = head[-1].key if head else "the"
        number = last.isdigit() or last in lexicon().numbers
        behind = words[deed + 1 : deed + 2]
        bare = last in lexicon().determiners or (number and not self.names.is_stop(head))
        return bool(behind and behind[0].is_word and bare)

    def begins(self, words: Phrase, at: int) -> bool:
        """Whether a clause begins at a place, but for words that only open it."""
        flat = keys(words)
        start = next((i + 1 for i in range(at - 1, -1, -1) if not words[i].is_word), 0)
        while start < at and (size := OPENERS.match(flat, start)) is not None:
            start += size[0]
        return start == at or flat[at - 1] in _JOINTS

    def start(self, words: Phrase, at: int) -> int | None:
        """Where what something is done to begins, right before the helping words; None if nothing is."""
        flat = keys(words)
        while at and flat[at - 1] in ADVERBS - {"both", "all", "each"}:
            at -= 1
        if flat[at - 1 : at] == (",",) and {"one", "ones"} & set(flat[max(0, at - _LONGEST_NAME) : at]):
            # "The vase, the one by the window, ...".
            at -= 1
        free = next((i for i in range(at) if flat[i] in {"what", "whatever"} and is_free(flat[i:at])), None)
        if free is not None and (not free or flat[free - 1] in CUTS):
            return free
        hard = next((i + 1 for i in range(at - 1, -1, -1) if _parts(words, i)), 0)
        hangs = bool(hard) and flat[hard - 1] in _SUBORDINATE
        for begin in (hard, *(i + 1 for i in range(hard, at) if flat[i] in CUTS)):
            start = after_openers(flat[:at], begin)
            if start and flat[start - 1] in _SUBORDINATE and not _only_opens(flat, start):
                continue
            if start < at and self.are_things(words[start:at]):
                alone = start == hard or not hangs or _is_complete(words[hard:start])
                return start if alone else None
        return None

    def topic(self, subject: Phrase, said: tuple[Phrase, ...]) -> Phrase:
        """What "it" and "they" in front mean: what the clause or sentence before is about."""
        if keys(subject) not in _PRONOUNS:
            return subject
        for told in said:
            end = next((i for i, word in enumerate(told) if word.key in _TOLD), 0)
            begin = 0
            while begin < end and (not told[begin].is_word or told[begin].key in _JOINTS):
                begin += 1
            thing = told[begin:end]
            pronouns = lexicon().thing_pronouns | {"they"}
            if thing and self.is_thing(thing) and thing[0].key not in pronouns:
                return thing
        return subject


def _parts(words: Phrase, i: int) -> bool:
    """Whether no subject reaches over a word."""
    key = words[i].key
    if key == "that":
        return i > 0 and words[i - 1].key in {"think", "say", "so", "is"}
    if key == "but" and {"all", "every", "each", "any", "everything", "both"} & set(keys(words[:i])):
        # "All rooms but the green one": an exception, unless a clause ends there.
        return words[i - 1].key == ","
    return key in {":", ";", "(", ")", "so", "but", "then"} or key in _SUBORDINATE - _RELATIVE


def _only_opens(flat: tuple[str, ...], start: int) -> bool:
    """For "I think that": words that only open a clause end right before it."""
    near = range(max(0, start - _LONGEST_NAME), start)
    return any((size := OPENERS.match(flat, i)) is not None and i + size[0] == start for i in near)


def _is_complete(told: Phrase) -> bool:
    """Whether a clause with a verb of its own ends in a comma."""
    comma = next((i for i in range(len(told) - 1, -1, -1) if told[i].key == ","), 0)
    finite = lexicon().be | lexicon().auxiliaries | _COMPLETE
    return bool(comma) and (bool(finite & set(keys(told[:comma]))) or comma > 2)


def _without_relation(words: Phrase) -> Phrase:
    """Without "next to", "closest to": they part no thing from what tells which one it is."""
    flat = keys(words)
    near = next((i for i in range(1, len(flat) - 2) if flat[i + 1] == "to" and flat[i] in _NEAR), 0)
    return (*words[:near], Word("by", "by"), *words[near + 2 :]) if near else words


def _without_exception(words: Phrase) -> Phrase:
    """Without "not" in front of a part of a list, and without "except B" behind it."""
    words = words[1:] if keys(words[:1]) in {("not",), ("except",), ("and",)} else words
    flat = keys(words)
    at = next((i for i in range(1, len(flat)) if flat[i] in {"except", "but", "apart", "besides"}), len(flat))
    return words[:at]
