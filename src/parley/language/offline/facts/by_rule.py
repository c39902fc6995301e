"""Where somebody is by a rule: "A has the early shift", "whoever has the early shift sits in the office"."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Final

from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.nouns import bare
from parley.language.offline.words.text import Phrase, keys, lemma, singular, tokens

if TYPE_CHECKING:
    from parley.language.offline.facts.remembering import Remembered

__all__ = ["placed_by_rule", "without_time"]

_WHOEVER: Final = tuple(
    tuple(text.split())
    for text in (
        "whoever", "anyone who", "anybody who", "the person who", "the one who", "everyone who",
        "everybody who", "the person with", "the one with", "anyone with", "whoever is",
    )
)  # fmt: skip
_STAYING: Final = frozenset({
    "sits", "sit", "is", "works", "stands", "stays", "waits", "lives", "sleeps", "reports", "stand", "stay",
    "gets",
})  # fmt: skip
_SMALL: Final = frozenset(
    {"the", "a", "an", "has", "have", "is", "on", "of", "does", "do", "this", "week", "today", "for", "s"}
)
_TIMED: Final = frozenset(
    {"from", "since", "as", "until", "starting", "for", "during", "this", "on", "at", "in"}
)
_TIMES: Final = frozenset({
    "today", "tomorrow", "yesterday", "now", "monday", "tuesday", "wednesday", "thursday", "friday",
    "saturday", "sunday", "morning", "afternoon", "evening", "night", "noon", "midnight", "week", "weekend",
    "month", "hour", "hours", "minutes", "day", "days", "shift", "lunch", "breakfast", "dinner", "moment",
})  # fmt: skip
_AT_ONCE: Final = frozenset({"today", "now", "currently", "tonight", "lately", "recently", "meanwhile"})
_LONGEST: Final = 5


def without_time(words: Phrase) -> Phrase:
    """A sentence without when it holds, said before it ("from today on, the keys are in the office")."""
    flat = keys(words)
    at = 0
    if flat[:1] and flat[0] in _AT_ONCE:
        at = 1
    elif flat[:1] and flat[0] in _TIMED:
        named = [i for i in range(1, min(_LONGEST, len(flat))) if flat[i] in _TIMES]
        at = named[0] + 1 if named else 0
        while at and flat[at : at + 1] and flat[at] in {*_TIMES, "on", "onwards", "this"}:
            at += 1
    rest = words[at + (flat[at : at + 1] == (",",)) :]
    said = len(rest) > 3 and rest[0].is_word and rest[0].key not in lexicon().be
    begins = bool(at) and said and (rest[0].is_capital or flat[at : at + 1] == (",",) or _opens(rest))
    return rest if begins else words


def _opens(words: Phrase) -> bool:
    return words[0].key in lexicon().determiners


def placed_by_rule(facts: Sequence[Remembered], placed: set[tuple[str, ...]]) -> Iterator[Remembered]:
    """Where people are for what they do or have, if nothing better is known.

    Args:
        facts: What is remembered, newest first.
        placed: Of whom or what it is known where they are.
    """
    for rule in facts:
        found = _rule(tokens(rule.entry.data))
        if found is None:
            continue
        condition, relation, place = found
        for item in facts:
            fact = item.fact
            named = bool(fact.subject) and fact.subject[0].is_capital and item is not rule
            if not named or fact.negated or keys(fact.subject) in placed:
                continue
            if condition <= _content((*fact.state, *fact.place)):
                yield replace(rule, fact=replace(fact, place=place, relation=relation, state=()))
                break


def _rule(words: Phrase) -> tuple[frozenset[str], str, Phrase] | None:
    """What somebody must do or have, and where they are then."""
    words = tuple(word for word in words if word.is_word)
    flat = keys(words)
    lead = max((lead for lead in _WHOEVER if flat[: len(lead)] == lead), key=len, default=())
    for at in range(len(lead) + 1, len(flat) - 1) if lead else ():
        where = lexicon().places.match(flat, at + 1)
        if flat[at] in _STAYING and where is not None:
            condition = _content(words[len(lead) : at])
            place = bare(words[at + 1 + where[0] :])
            return (condition, where[1], place) if condition and place else None
    return None


def _content(words: Phrase) -> frozenset[str]:
    return frozenset(lemma(singular(word.key)) for word in words if word.is_word and word.key not in _SMALL)
