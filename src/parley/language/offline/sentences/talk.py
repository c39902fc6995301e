"""Talk around orders: who is speaking, how they feel, what is only said to the listener. No order, no fact.

"It is A from B", "B here", "A speaking": who calls. "Bear with me", "well done for yesterday", "first things
first": nothing that could be done. In a long message with orders the same goes for what people say of
themselves, unless it is worth keeping.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, Protocol

from parley.language.offline.facts.facts import read_statement
from parley.language.offline.facts.worth import worth_keeping
from parley.language.offline.words.lexicon import PhraseTable, lexicon
from parley.language.offline.words.text import Phrase, Word, keys, tokens
from parley.language.word_lists import load_data

__all__ = ["TALK", "introduces", "is_talk", "without_talk"]

TALK: Final = frozenset({"who", "mood"})
"""The kinds of parts that are talk, whatever stands around them."""

_DATA = load_data("units")
_MOODS = PhraseTable.of(_DATA["moods"])
_WHOLE_MOODS = PhraseTable.of(_DATA["whole_moods"])
_TITLES = frozenset(_DATA["titles"])
_NO_CALLER = frozenset(_DATA["no_caller"])
_WHERE_FROM = frozenset({"from", "on", "at", "in", "over", "up", "down", "out", "of"})
_HERE = frozenset({"here", "speaking", "calling", "again"})
_IT_IS = frozenset({("it", "is"), ("this", "is"), ("that", "is"), ("i", "am")})
_LONGEST = 12
_SHORTEST_MESSAGE = 10
_LONG_MESSAGE = 20
_STOP = Word(".", ".")


class _Part(Protocol):
    @property
    def kind(self) -> str: ...
    @property
    def start(self) -> int: ...
    @property
    def end(self) -> int: ...
    @property
    def words(self) -> Phrase: ...
    @property
    def names(self) -> tuple[Phrase, ...]: ...


@dataclass(frozen=True, slots=True)
class _Caller:
    """Words in which somebody may say who is calling."""

    words: Phrase
    flat: tuple[str, ...]
    first_is_thing: bool

    def says_so(self) -> bool:
        if not self.flat or len(self.flat) > _LONGEST:
            return False
        if self.flat[:3] == ("my", "name", "is") or self.flat[:4] == ("you", "are", "speaking", "to"):
            return True
        lead = 2 if self.flat[:2] in _IT_IS else 0
        return self._it_is(lead) if lead else self._signs() or self._comes_from(0, capital=True)

    def _it_is(self, lead: int) -> bool:
        rest = self.flat[lead:]
        if rest[:1] in {("me",), ("only",), ("just",)} and "me" in rest[:2]:
            return True
        if rest[-1:] in {("speaking",), ("calling",)}:
            return "not" not in rest
        if self.flat[0] == "i":
            return False
        named = self._named(lead)
        tail = self.flat[named : named + 1]
        if named == lead:
            return False
        proper = all(word.is_capital or word.key in _TITLES for word in self.words[lead:named])
        return (proper and tail in {(), (",",)}) or self._comes_from(lead, capital=proper)

    def _comes_from(self, start: int, *, capital: bool) -> bool:
        """For "A from B", "A here": a name, and where it is said to call from."""
        named = self._named(start)
        tail = self.flat[named : named + 1]
        proper = all(w.is_capital or w.key in _TITLES for w in self.words[start:named])
        if named == start or not tail or (capital and not proper):
            return False
        links = _WHERE_FROM if proper else frozenset({"from"})
        finite = lexicon().be | lexicon().auxiliaries
        return tail[0] in _HERE or (tail[0] in links and not finite & set(self.flat[named:]))

    def _named(self, start: int) -> int:
        """Behind a name of up to three words."""
        at = start
        while at < min(len(self.words), start + 3) and self._may_be_name(at, start):
            at += 1
        return at

    def _may_be_name(self, at: int, start: int) -> bool:
        word = self.words[at]
        if self.flat[at] in _TITLES:
            return True
        known = word.key in lexicon().vocabulary or word.key in lexicon().nouns
        return word.is_word and word.key.isalpha() and not known and not (self.first_is_thing and at == start)

    def _signs(self) -> bool:
        """For "the night shift here", "control room speaking"."""
        if self.flat[-1] in {"speaking", "calling"}:
            return len(self.flat) <= 6 and not _NO_CALLER & set(self.flat)
        at = self.flat.index("here") if "here" in self.flat else 0
        behind = self.flat[at + 1 : at + 2]
        head = self.flat[:at]
        if head[:1] in _THEN:
            # "Then return here".
            head, at = head[1:], at - 1
        if not 0 < at <= 4 or (behind and behind[0] not in _WHERE_FROM | {"again", ","}):
            return False
        if _NO_CALLER & set(head) or any(not word.is_word for word in self.words[:at]):
            return False
        verb = lexicon().verbs.match(head)
        # "Stop here" is an order, "dock office here" is none.
        return verb is None or (len(head) > 1 and verb[0] < len(head) and head[-1] in lexicon().nouns)


_THEN = frozenset((word,) for word in ("then", "and", "finally", "afterwards"))


def introduces(words: Phrase, *, first_is_thing: bool = False) -> bool:
    """Whether words say who is speaking, and from where.

    Args:
        words: One part of a message.
        first_is_thing: Whether they begin with the name of something on the map.
    """
    return _Caller(words, keys(words), first_is_thing).says_so()


def is_talk(words: Phrase) -> bool:
    """Whether words are said to the listener without asking for anything ("bear with me")."""
    flat = keys(word for word in words if word.is_word)
    whole = _WHOLE_MOODS.match(flat)
    return _MOODS.match(flat) is not None or (whole is not None and whole[0] == len(flat))


def without_talk(words: Phrase, parts: Sequence[_Part]) -> Phrase:
    """The message without its talk; all of it if there is nothing else.

    Args:
        words: All words and punctuation, of which these are the parts.
        parts: The parts of the message, in their order.
    """
    dropped = [part for part in parts if _is_dropped(part, parts, words)]
    left = [part for part in parts if part not in dropped]
    if not dropped or len(words) < _SHORTEST_MESSAGE or all(part.kind == "idle" for part in left):
        return words
    result: list[Word] = []
    at = 0
    for part in dropped:
        result += words[at : part.start]
        while result and not result[-1].is_word:
            result.pop()
        result += (_STOP,) if result else ()
        result += _where_from(part, left)
        at = part.end
        while at < len(words) and (
            not words[at].is_word or (words[at].key in _JOINING and words[at - 1].key == ",")
        ):
            at += 1
    return (*result, *words[at:])


_JOINING = frozenset({"so", "and", "but"})


def _is_dropped(part: _Part, parts: Sequence[_Part], words: Phrase) -> bool:
    ordered = any(other.kind == "order" for other in parts)
    if keys(part.words) in {("look",), ("listen",), ("see",)}:
        behind = next((other for other in parts if other.start >= part.end), None)
        return behind is not None and behind.kind in {"told", "reason", *TALK} and len(parts) > 2
    if part.kind in TALK:
        return ordered or "name" not in keys(part.words)
    if part.kind != "told" or not ordered or len(words) < _LONG_MESSAGE or part.names:
        return False
    flat = keys(part.words)
    if flat[:2] in {("i", "mean"), ("i", "meant"), ("i", "said")}:
        return False
    first = next((key for key in flat if key not in _JOINING), "")
    if first not in {"i", "we"}:
        return False
    seen = {"a", "an"} & set(flat[1:5]) and {"near", "by", "beside", "at", "in", "on"} & set(flat[4:])
    if seen and {"it", "there", "that"} & {
        key for other in parts if other is not part for key in keys(other.words)
    }:
        # "We have a bag by the bar, ... see if it is still there".
        return False
    fact = read_statement(part.words)
    if fact is not None and fact.is_location and _goes_to_speaker(parts):
        return False
    return fact is None or fact.is_location or not worth_keeping(fact, part.words)


def _goes_to_speaker(parts: Sequence[_Part]) -> bool:
    """Whether an order needs to know where the speaker is ("bring it to me")."""
    return any({"me", "us", "here"} & set(keys(part.words)) for part in parts if part.kind == "order")


def _where_from(part: _Part, left: Sequence[_Part]) -> Phrase:
    """Where the speaker is, if an order comes back to it."""
    if part.kind != "who" or not part.names or not _goes_to_speaker(left):
        return ()
    return (*tokens("I am at the"), *part.names[-1], _STOP)
