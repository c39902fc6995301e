"""Ways of asking that put a frame around an order: hedges, wishes, worries, the passive, foreign grammar.

The frame consists of small words alone; what follows it is an order, an order in the passive ("that X is
checked"), an order to whoever ("if somebody looked at X"), or a noun for one ("a look at X"). A worry about
how a known thing is ("I am afraid X is open") is an order to look.
"""

from __future__ import annotations

from collections.abc import Callable

from parley.language.offline.sentences.attitudes import (
    begins_unknown,
    speaks_for_itself,
    wants,
    wants_to_know,
)
from parley.language.offline.sentences.clauses import opens_command
from parley.language.offline.sentences.deeds import COMMON
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.text import Phrase, Word, keys, lemma
from parley.language.word_lists import load_data

__all__ = ["unframed"]

IsStop = Callable[[Phrase], bool]

_DATA = load_data("frames")
_FRAME = frozenset(_DATA["frame"])
_DESIRE = frozenset(_DATA["desire"])
_ANYBODY = frozenset(_DATA["anybody"])
_SOUNDS = frozenset(_DATA["sounds"])
_WORRY = frozenset(_DATA["worry"])
_WORRIED = frozenset(_DATA["worried"])
_ASIDES = tuple(tuple(text.split()) for text in _DATA["asides"])
_TAGS = tuple(tuple(text.split()) for text in _DATA["tags"])
_PAST = frozenset({"if", "wish", "rather", "better", "glad", "happier"})
_NOT_MEANT = (
    ("not", "suppose"),
    ("not", "too"),
    ("not", "mind"),
    ("not", "be", "better"),
    ("not", "imagine"),
    ("no", "harm"),
    ("not", "hurt"),
    ("not", "harm"),
    ("not", "object"),
    ("should", "not", "you"),
    ("should", "not", "somebody"),
    ("should", "not", "someone"),
    ("ought", "not", "you"),
    ("not", "it", "time"),
    ("not", "it", "about", "time"),
    ("not", "it", "high", "time"),
    ("are", "not", "you"),
)
_LOOKS = frozenset({"look", "glance", "peek", "check", "inspection", "eye", "peep", "check-up"})
_TRIPS = frozenset({"visit", "trip", "drive", "run", "walk"})
_MARKS = frozenset({".", "!", "?", ";", "\n"})
_FINITE = lexicon().be | {"works", "runs", "seems", "looks", "has", "smells", "leaks", "needs"}
_LONGEST_STOP = 6
_LONGEST_LEAD = 14
_TIMES = frozenset(_DATA["times"])
_OPINIONS = tuple(tuple(text.split()) for text in _DATA["opinions"])


def unframed(words: Phrase, is_stop: IsStop) -> Phrase:
    """The same message with orders in place of what only frames them.

    Args:
        words: All words and punctuation.
        is_stop: Whether words name something that is known.
    """
    result: list[Word] = []
    start = 0
    for index in range(len(words) + 1):
        if index < len(words) and words[index].key not in _MARKS:
            continue
        said = _without_sounds(words[start:index])
        if start and _is_remark(said, is_stop):
            start = index + 1
            continue
        order = _order(said, is_stop)
        mark = words[index : index + 1]
        if order is not None and mark and mark[0].key == "?" and order[0].key not in lexicon().be:
            mark = (Word(".", "."),)
        result += (*(order if order is not None else said), *mark)
        start = index + 1
    return _towards(tuple(result), is_stop)


def _without_sounds(words: Phrase) -> Phrase:
    """Without "um" and "you know", and without ", yes?" and ", I think" at the end."""
    kept: list[Word] = []
    index = 0
    flat = keys(words)
    while index < len(words):
        aside = next((a for a in _ASIDES if flat[index : index + len(a)] == a), ())
        end = index + len(aside)
        between = aside and (index == 0 or flat[index - 1] == ",") and flat[end : end + 1] == (",",)
        if flat[index] in _SOUNDS or between:
            index += max(len(aside), 1)
            if flat[index : index + 1] == (",",):
                index += 1
                while kept and kept[-1].key == ",":
                    kept.pop()
            continue
        kept.append(words[index])
        index += 1
    flat = keys(kept)
    tag = next((t for t in _TAGS if flat[-len(t) :] == t and len(flat) > len(t) + 1), ())
    if tag and flat[-len(tag) - 1] == ",":
        kept = kept[: -len(tag) - 1]
    return tuple(kept)


def _is_remark(words: Phrase, is_stop: IsStop) -> bool:
    """Whether a sentence is nothing but "that makes me nervous"."""
    flat = keys(words)
    remarks = flat[:1] in {("that",), ("which",), ("this",), ("it",)} and _troubles(flat[1:5])
    return remarks and not any(_stop_end(words, i, is_stop) > i for i in range(len(words)))


def _troubles(flat: tuple[str, ...]) -> bool:
    """Whether it "makes me", "really worries us"."""
    whom = {"me", "us", "everybody", "everyone", "people"}
    return bool(_TROUBLING & set(flat[:2])) and bool(whom & set(flat[1:]))


_TROUBLING = frozenset({
    "makes", "made", "worries", "scares", "bothers", "frightens", "annoys", "drives", "gets", "gives",
    "upsets", "bugs", "unsettles", "disturbs", "concerns", "troubles", "alarms", "puzzles", "irritates",
})  # fmt: skip


def _order(words: Phrase, is_stop: IsStop) -> Phrase | None:
    """The order that a sentence means; None if it needs no rewording."""
    body = tuple(words)
    while body and (not body[0].is_word or body[0].key in {"and", "so", "then", "oh", "well", "anyway"}):
        body = body[1:]
    if len(body) < 3 or len(body) > 40:
        return None
    meant = _meant(body, is_stop)
    return _without_time(meant) if meant is not None else None


def _without_time(words: Phrase) -> Phrase:
    """Without "before lunch" at the end."""
    flat = keys(words)
    at = next((i for i in range(max(1, len(flat) - 5), len(flat)) if flat[i] in {"before", "after", "by"}), 0)
    timed = at and set(flat[at + 1 :]) <= _TIMES | lexicon().determiners and len(flat) > at + 1
    return words[:at] if timed else words


def _meant(body: Phrase, is_stop: IsStop) -> Phrase | None:
    return (
        _worry(body, is_stop)
        or _asked_for_opinion(body, is_stop)
        or _unknown(body, is_stop)
        or (_you_at(("you", "be"), body[1:], is_stop) if body[0].key == "be" else None)
        or _inside_frame(body, is_stop)
    )


def _stop_end(words: Phrase, start: int, is_stop: IsStop) -> int:
    """Where the longest name that begins at `start` ends; `start` if none does."""
    return next(
        (
            start + size
            for size in range(min(_LONGEST_STOP, len(words) - start), 0, -1)
            if is_stop(words[start : start + size])
        ),
        start,
    )


def _worry(words: Phrase, is_stop: IsStop) -> Phrase | None:
    """For "I am afraid (that) X is open", "not sure X is locked", "hopefully X works"."""
    flat = keys(words)
    at = 0
    while at < len(flat) and flat[at] in _WORRY:
        at += 1
    for cut in range(at, 0, -1):
        if not _WORRIED & set(flat[:cut]):
            return None
        end = _stop_end(words, cut, is_stop)
        if end == cut or flat[cut - 1] in lexicon().determiners:
            continue
        if end == len(flat) and flat[cut - 1] == "about":
            return (*_words("inspect"), *words[cut:])
        if flat[end : end + 1] and flat[end] in _FINITE and end + 1 < len(flat):
            return (*_words("check whether"), *words[cut:])
        return None
    return None


def _asked_for_opinion(words: Phrase, is_stop: IsStop) -> Phrase | None:
    """For "would you say X is open?" "is X open?"."""
    flat = keys(words)
    lead = next((lead for lead in _OPINIONS if flat[: len(lead)] == lead), ())
    start = len(lead) + (flat[len(lead) : len(lead) + 1] == ("the",))
    end = _stop_end(words, start, is_stop) if lead else 0
    if (
        not lead
        or end == start
        or flat[end : end + 1] not in {("is",), ("are",), ("was",)}
        or len(flat) < end + 2
    ):
        return None
    return (words[end], *words[len(lead) : end], *words[end + 1 :])


def _inside_frame(words: Phrase, is_stop: IsStop) -> Phrase | None:
    """An order behind words that only say that it is wanted, be they small or an attitude to it."""
    flat = keys(words)
    at = 0
    while at < len(flat) and flat[at] in _FRAME:
        at += 1
    if opens_command(words):
        return None
    for cut in range(_lead_end(words, at, is_stop), 0, -1):
        lead = flat[:cut]
        framed = cut <= at and bool(_DESIRE & set(lead))
        if lead[-1] in lexicon().determiners or not (framed or wants(lead)) or _denied(lead):
            continue
        rest = words[cut:]
        itself = framed or speaks_for_itself(lead)
        order = (
            (_active(lead, rest, is_stop) if itself else None)
            or (_noun_of_order(rest, is_stop) if itself or lead[-1] != "to" else None)
            or _you_at(lead, rest, is_stop)
        )
        if order is not None:
            return order
    return None


def _lead_end(words: Phrase, at: int, is_stop: IsStop) -> int:
    """How far the words before what is wanted may go: over small words, and up to the first thing named."""
    limit = min(len(words) - 1, _LONGEST_LEAD)
    named = next((i for i in range(limit) if _stop_end(words, i, is_stop) > i), limit)
    return max(at if at < len(words) else len(words) - 1, named)


def _unknown(words: Phrase, is_stop: IsStop) -> Phrase | None:
    """For "I can not tell whether X is open", "nobody knows who is at X"."""
    flat = keys(words)
    for cut in range(1, min(len(flat) - 2, _LONGEST_LEAD)):
        rest = words[cut:]
        if not begins_unknown(keys(rest)) or not wants_to_know(flat[:cut]):
            continue
        named = any(_stop_end(rest, i, is_stop) > i for i in range(1, len(rest)))
        if not named or "," in keys(rest) or _goes_on(rest):
            return None
        if rest[0].key in {"whether", "if"}:
            return (*_words("check whether"), *rest[1:])
        return (*_words("find out"), *rest)
    return None


def _goes_on(words: Phrase) -> bool:
    """Whether another order is joined to words."""
    flat = keys(words)
    return any(
        flat[i] in {"and", "so", "but"} and opens_command(words[i + 1 :]) for i in range(len(flat) - 1)
    )


def _denied(lead: tuple[str, ...]) -> bool:
    if not {"not", "never", "no"} & set(lead):
        return False
    return not any(lead[i : i + len(m)] == m for m in _NOT_MEANT for i in range(len(lead)))


def _active(lead: tuple[str, ...], rest: Phrase, is_stop: IsStop) -> Phrase | None:
    """For "(somebody would) look at the desk", "(if you) went to the desk"."""
    if not rest:
        return None
    base = lemma(rest[0].key)
    found = lexicon().verbs.match((base, *keys(rest[1:])))
    if found is None or found[1].partition(":")[0] not in COMMON:
        return None
    if base != rest[0].key and lead[-1] in lexicon().be and not rest[0].key.endswith("ing"):
        return None
    if base != rest[0].key and not (_doing(lead) if rest[0].key.endswith("ing") else _PAST & set(lead)):
        return None
    whom = (_ANYBODY | {"you", "robot"}) & set(lead)
    if not whom and lead[-1] not in {"to", "and", "please", "just", "kindly"} and not _doing(lead):
        return None
    named = any(
        is_stop(rest[i:j]) for i in range(1, len(rest)) for j in range(i + 1, min(len(rest), i + 5) + 1)
    )
    past = base != rest[0].key and not rest[0].key.endswith("ing")
    return (Word(base, base), *(_in_base_form(rest[1:]) if past else rest[1:])) if named else None


def _in_base_form(words: Phrase) -> Phrase:
    """For "(went to A) and checked B, then took a look": the verbs behind as orders too."""
    result: list[Word] = []
    for index, word in enumerate(words):
        joined = index and words[index - 1].key in {"and", "then"}
        base = lemma(word.key)
        if joined and base != word.key and lexicon().verbs.match((base, *keys(words[index + 1 :]))):
            word = Word(base, base)
        result.append(word)
    return tuple(result)


_BEFORE_DOING = (_ANYBODY - {"us", "we"}) | {
    "in", "of", "about", "worth", "for", "be", "mind", "consider", "fancy", "like", "you",
}  # fmt: skip


def _doing(lead: tuple[str, ...]) -> bool:
    """Whether words are followed by what is to be done in its form in -ing."""
    return lead[-1] in _BEFORE_DOING


def _noun_of_order(rest: Phrase, is_stop: IsStop) -> Phrase | None:
    """For "a quick look at the desk", "a visit to the desk"."""
    flat = keys(rest)
    at = next((i for i in range(min(4, len(flat))) if flat[i] in _LOOKS | _TRIPS), -1)
    if at < 0 or (at and flat[0] not in {"a", "an", "another", "some", "quick"}):
        return None
    start = (
        at
        + 1
        + (flat[at + 1 : at + 2] in {(p,) for p in ("at", "to", "of", "into", "in", "on", "over", "around")})
    )
    end = _stop_end(rest, start, is_stop)
    verb = "inspect" if flat[at] in _LOOKS else "go to"
    return (*_words(verb), *rest[start:]) if end > start > at + 1 else None


def _you_at(lead: tuple[str, ...], rest: Phrase, is_stop: IsStop) -> Phrase | None:
    """For "(I would need you) at the desk", "(have you back) on it", "(manage to be) at the desk"."""
    last = next((key for key in reversed(lead) if key not in _BACK), "")
    whoever = bool(({"you"} | _ANYBODY) & set(lead))
    there = last in {"you", "yourself"} or (last in {"be", "being", "were"} and whoever)
    if not there or keys(rest[:1]) not in _PLACES:
        return None
    end = _stop_end(rest, 1, is_stop)
    later = keys(rest[end : end + 1]) in _LATER or keys(rest[end:]) in _SOON
    return (*_words("go to"), *(rest[1:end] if later else rest[1:])) if end > 1 else None


_PLACES = frozenset({("at",), ("in",), ("by",), ("near",), ("on",), ("beside",), ("behind",)})
_BACK = frozenset({"back", "over", "down", "up", "right", "round", "out"})
_LATER = frozenset(
    {("when",), ("before",), ("as",), ("while",), ("for",), ("until",), ("because",), ("since",)}
)
_SOON = frozenset(
    {("soon",), ("now",), ("by", "now"), ("already",), ("right", "now"), ("today",), ("again",)}
)


_GOING = frozenset({"go", "drive", "come", "move", "run", "walk", "head", "roll"})


def _towards(words: Phrase, is_stop: IsStop) -> Phrase:
    """For "go at the desk" and "look if is free", as people say it who are new to English."""
    flat = keys(words)
    result: list[Word] = []
    for index, word in enumerate(words):
        before = flat[index - 1] if index else ""
        wrong = word.key in {"at", "on", "in"} and before in _GOING
        if wrong and _stop_end(words, index + 1, is_stop) > index + 1:
            result += _words("to" if words[index + 1].key in lexicon().determiners else "to the")
            continue
        result.append(word)
        if word.key in {"if", "whether"} and flat[index + 1 : index + 2] in {("is",), ("are",)}:
            result += _words("it")
    return tuple(result)


def _words(text: str) -> Phrase:
    return tuple(Word(part, part) for part in text.split())
