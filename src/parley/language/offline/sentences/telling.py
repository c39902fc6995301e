"""What a clause that only tells says of a deed: that it was left undone, is expected, done, or usual.

"Nobody has cleaned A yet" and "A should be clean by now" ask for something; "B cleaned A" and "A is cleaned
on Fridays" are news. The subject, the words between it and the deed, and the form of the deed are read apart
(`data/telling.yaml`); whatever wants to know asks here. What is due in so many words is put as an order
before (`passive`).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from typing import Literal

from parley.language.offline.facts.facts import strip_openers
from parley.language.offline.sentences.deeds import Deeds
from parley.language.offline.words.lexicon import PhraseTable, lexicon
from parley.language.offline.words.text import Phrase, Word, keys
from parley.language.word_lists import load_data

__all__ = ["Telling", "is_usual", "plainly_so", "telling"]

_DATA = load_data("telling")
_MOST_WORDS = 22
_LONGEST_SUBJECT = 8
_ADVERBS = frozenset(_DATA["between"])
_INDEFINITE = frozenset(_DATA["anybody"])
_NO_SUBJECT = frozenset(_DATA["no_subject"])
_PARTICLES = frozenset({"off", "up", "down", "out", "away", "back"})
_STRANDED = _PARTICLES | {"at", "after", "to", "into", "over", "in", "on", "for", "round"}
_NOBODY = (("nobody",), ("no", "one"), ("none", "of", "us"), ("no-one",), ("not", "a", "soul"))

Kind = Literal["undone", "expected", "done", "usual"]


@dataclass(frozen=True, slots=True)
class Telling:
    """What is told of a deed."""

    kind: Kind
    deed: str
    """Its verb, in the base form."""
    order: Phrase = ()
    """The deed as an order; for what is expected, an order to see whether it is so."""


@cache
def _table(kind: str) -> PhraseTable:
    return PhraseTable.of(_DATA[kind])


def telling(words: Phrase, deeds: Deeds) -> Telling | None:
    """What a clause tells of a deed; None if it tells of none.

    Args:
        words: One clause.
        deeds: The verbs of what the robot can do.
    """
    said = tuple(word for word in strip_openers(words) if word.is_word)
    flat = keys(said)
    asks = lexicon().question_starts | lexicon().be | lexicon().auxiliaries
    if not 3 <= len(said) <= _MOST_WORDS or flat[0] in asks | {"if", "unless", "when", "you"}:
        return None
    if is_usual(flat):
        return Telling("usual", "")
    body = _without_tail(said)
    return (
        _forgotten(body, deeds)
        or _by_nobody(body, deeds)
        or _long_since(said, deeds)
        or _time_for(body, deeds)
        or _of_subject(body, said, deeds)
        or _by_somebody(body, deeds)
    )


def plainly_so(words: Phrase) -> Phrase:
    """A message with "is" for "has been found to be", and plain words for what is only wished or feared.

    Args:
        words: All words and punctuation.
    """
    flat = keys(words)
    result: list[Word] = []
    index = 0
    while index < len(words):
        found = _table("found_so").match(flat, index)
        begins = index == 0 or not words[index - 1].is_word
        put = next((p for p in _PUT if begins and flat[index : index + len(p[0])] == p[0]), None)
        if found is not None:
            link = "are" if flat[index] in {"have", "are", "were"} else "is"
            result.append(Word(link, link))
        elif put is not None:
            result += (Word(part, part) for part in put[1])
            index += len(put[0])
            continue
        else:
            result.append(words[index])
        index += found[0] if found is not None else 1
    return tuple(result)


_PUT = tuple((tuple(said.split()), tuple(plain.split())) for said, plain in _DATA["put_plainly"].items())


def is_usual(flat: tuple[str, ...]) -> bool:
    """Whether words tell what goes on again and again, or a rule ("every day", "must stay").

    Args:
        flat: The words of one clause.
    """
    return any(_table("usual").match(flat, i) for i in range(1, len(flat))) and not any(
        _table("not_usual").match(flat, i) for i in range(len(flat))
    )


def _without_tail(words: Phrase) -> Phrase:
    """Without "yet", "since noon", "for weeks" at the end."""
    flat = keys(words)
    since = next((i for i in range(3, len(flat)) if flat[i] == "since"), len(flat))
    words, flat = words[:since], flat[:since]
    while len(flat) > 2:
        size = _table("tails").match_end(flat)
        at = next((i for i in range(max(2, len(flat) - 5), len(flat)) if flat[i] in _SPAN), 0)
        if not size and at and set(flat[at + 1 :]) <= _TIMES | lexicon().determiners and at + 1 < len(flat):
            size = len(flat) - at
        if not size:
            break
        words, flat = words[:-size], flat[:-size]
    return words


_SPAN = frozenset({"for", "in", "by", "before", "until", "till", "at"})
_TIMES = frozenset(_DATA["times"]) | frozenset(str(n) for n in range(1, 61))


_ORDINARY = frozenset({"look", "whether", "transfer"})
"""Common kinds of deeds that are missed when they are not done."""
_VISITING = frozenset({"visit", "patrol", "attend"})


def _is_deed(verb: str, deeds: Deeds) -> bool:
    """Whether a verb is missed if it is not done: one of the robot's own, a look or a delivery."""
    found = lexicon().verbs.match((verb,)) if verb else None
    kind = found[1].partition(":")[0] if found is not None else ""
    usual = not kind or kind == "other" or kind in _ORDINARY or verb in _VISITING or verb in deeds.own
    return usual and deeds.can(verb)


def _past_of(word: str, deeds: Deeds) -> str:
    """The deed of which a word is the past form; "" if of none."""
    verb = deeds.done(word)
    return verb if _is_deed(verb, deeds) else ""


def _as_order(verb: str, thing: Phrase, rest: Phrase) -> Phrase:
    """The deed, what it is done to, and the rest of what is said."""
    first = keys(rest[:1])
    whole = len(rest) == 1 and first[0] in _STRANDED
    apart = bool(first) and first[0] in _PARTICLES and keys(rest[1:2]) not in {("to",), ("of",)}
    part = int(whole or apart)
    if keys(rest[part : part + 1]) == ("by",) and set(keys(rest[part + 1 :])) <= _INDEFINITE | {"you"}:
        rest = rest[:part]
    return (Word(verb, verb), *rest[:part], *thing, *rest[part:])


def _is_thing(words: Phrase) -> bool:
    flat = keys(words)
    finite = (lexicon().be | lexicon().auxiliaries) & set(flat)
    return 0 < len(flat) <= _LONGEST_SUBJECT and not finite and not _NO_SUBJECT & set(flat)


def _forgotten(words: Phrase, deeds: Deeds) -> Telling | None:
    """For "somebody forgot to V A"."""
    flat = keys(words)
    for at in range(1, min(_LONGEST_SUBJECT, len(flat) - 1)):
        lead = _table("left_undone").match(flat, at)
        verb = flat[at + lead[0]] if lead is not None and at + lead[0] < len(flat) - 1 else ""
        if lead is not None and _is_deed(verb, deeds):
            return Telling("undone", verb, words[at + lead[0] :])
    return None


def _by_nobody(words: Phrase, deeds: Deeds) -> Telling | None:
    """For "nobody has V-ed A", "we have not V-ed A"."""
    flat = keys(words)
    at = next((len(lead) for lead in _NOBODY if flat[: len(lead)] == lead), 0)
    if not at and flat[0] in {"i", "we", "they", "somebody", "someone"}:
        denied = next((i for i in range(1, min(4, len(flat))) if flat[i] in _DENYING), 0)
        at = denied + 1 if denied else 0
    return _undone_from(words, at, deeds) if at else None


_DENYING = frozenset({"not", "never", "hardly", "barely"})


def _long_since(words: Phrase, deeds: Deeds) -> Telling | None:
    """For "it is a week since anybody V-ed A"."""
    flat = keys(words)
    at = flat.index("since", 2) if flat[0] in {"it", "that"} and "since" in flat[2:-2] else 0
    return _undone_from(words, at + 2, deeds) if at else None


def _undone_from(words: Phrase, at: int, deeds: Deeds) -> Telling | None:
    """What somebody has not done, from its verb on."""
    flat = keys(words)
    at = _past(flat, at, _ADVERBS | {"has", "have", "had", "did"})
    if at >= len(flat) - 1:
        return None
    if flat[at] in {"been", "gone", "was"} and flat[at + 1] in _AT_PLACES:
        return Telling("undone", "inspect", (Word("inspect", "inspect"), *words[at + 2 :]))
    verb = _past_of(flat[at], deeds)
    if {"did", "can", "could"} & set(flat[:at]) and _is_deed(flat[at], deeds):
        verb = flat[at]
    if not verb:
        return None
    return Telling("undone", verb, (Word(verb, verb), *words[at + 1 :]))


_AT_PLACES = frozenset(
    {
        "to",
        "at",
        "in",
        "by",
        "near",
        "round",
        "past",
        "over",
        "into",
        "along",
        "through",
        "down",
        "up",
        "inside",
    }
)


def _time_for(words: Phrase, deeds: Deeds) -> Telling | None:
    """For "it is time A was V-ed", "it is time for A to be V-ed", "time A got its V"."""
    flat = keys(words)
    lead = _table("time_for").match(flat)
    if lead is None:
        return None
    rest = words[lead[0] :]
    return next(_due(rest, deeds, _table("timed"), "undone"), None)


def _of_subject(words: Phrase, said: Phrase, deeds: Deeds) -> Telling | None:
    """For "A needs V-ing", "A has not been V-ed", "A has been V-ed", "A should be V-ed by now"."""
    flat = keys(words)
    for at in range(1, min(_LONGEST_SUBJECT, len(flat) - 1) + 1):
        thing = words[:at]
        if not _is_thing(thing):
            continue
        done = _table("done").match(flat, at)
        end = _past(flat, at + done[0], _ADVERBS | {"been"}) if done is not None else 0
        if done is not None and end < len(flat):
            denied = {"not", "never", "nor"} & set(flat[at:end])
            verb = _past_of(flat[end], deeds)
            if verb:
                order = _as_order(verb, thing, words[end + 1 :])
                return Telling("undone" if denied else "done", verb, order)
            verb = _past_of(flat[end][2:], deeds) if flat[end][:2] == "un" else ""
            if verb and not denied:
                return Telling("undone", verb, _as_order(verb, thing, words[end + 1 :]))
    by_now = bool({"already"} & set(flat)) or keys(said)[-2:] == ("by", "now")
    thought = by_now and flat[0] not in {"your", "my"}
    ways = (
        *_due(words, deeds, _table("expected"), "expected"),
        *(_due(words, deeds, _table("due_by_now"), "expected") if thought else ()),
        *_due(words, deeds, _table("lacking"), "undone"),
    )
    return next(iter(ways), None)


def _past(flat: tuple[str, ...], at: int, small: frozenset[str]) -> int:
    while at < len(flat) and flat[at] in small:
        at += 1
    return at


def _due(words: Phrase, deeds: Deeds, markers: PhraseTable, kind: Kind) -> Iterator[Telling]:
    """Each way to read a clause as a subject, words that call for a deed, and the deed."""
    flat = keys(words)
    for at in range(1, min(_LONGEST_SUBJECT, len(flat) - 1) + 1):
        thing = words[:at]
        marker = markers.match(flat, at)
        if marker is None or not _is_thing(thing):
            continue
        end = _past(flat, at + marker[0], _ADVERBS)
        if end >= len(flat) or "not" in flat[at:end]:
            continue
        if kind == "expected":
            link = "are" if flat[at - 1].endswith("s") else "is"
            so = (*thing, Word(link, link), *words[end:])
            yield Telling("expected", flat[end], (Word("check", "check"), Word("whether", "whether"), *so))
            continue
        noun = _past(flat, end, _BEFORE_NOUNS)
        verb = _past_of(flat[end], deeds)
        behind = end + 1
        if not verb and noun < len(flat) and _is_deed(flat[noun], deeds):
            verb, behind = flat[noun], noun + 1
        if verb:
            yield Telling(kind, verb, _as_order(verb, thing, words[behind:]))


_BEFORE_NOUNS = frozenset(_DATA["before_nouns"])


_HANGING = frozenset({"once", "after", "before", "when", "until", "as", "if", "unless"})
"""Words behind which a clause tells when or whether something is due."""


def _by_somebody(words: Phrase, deeds: Deeds) -> Telling | None:
    """For "A has V-ed B already": news, if it is said who."""
    flat = keys(words)
    for at in range(1, min(_LONGEST_SUBJECT, len(flat) - 1)):
        who = words[:at]
        if keys(who)[0] in _INDEFINITE | {"a", "an"} or (lexicon().be | _HANGING) & set(keys(who)):
            continue
        begin = _past(flat, at, _ADVERBS | {"has", "have", "had"})
        verb = _past_of(flat[begin], deeds) if begin < len(flat) else ""
        if verb and not {"not", "never"} & set(flat[:begin]):
            return Telling("done", verb)
    return None
