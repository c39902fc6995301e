"""What a message asks for, without what is told around it."""

from __future__ import annotations

from collections.abc import Sequence

from parley.language.offline.facts.facts import read_statement
from parley.language.offline.sentences.units import Unit
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.text import Phrase, Word, keys

__all__ = ["context", "distilled", "with_the_same"]

_BEGINNING = frozenset(
    {"start", "begin", "first", "firstly", "from", "end", "finish", "starting", "beginning"}
)
_STOP = Word(".", ".")
_KEPT = frozenset({"order", "name", "asked"})
_TAIL = frozenset({"before", "because", "until", "since", "as", "so", "while", "when"})
_TELLERS = frozenset(
    {"i", "we", "he", "she", "they", "it", "somebody", "someone", "anybody", "anyone", "people"}
)


def distilled(units: Sequence[Unit]) -> Phrase | None:
    """The orders of a message, with what is told to be remembered; None if there are none.

    Args:
        units: The parts of the message, in their order.
    """
    if not any(unit.kind in {"order", "wish"} for unit in units):
        return None
    result: list[Word] = []
    for index, unit in enumerate(units):
        words = _kept(unit, units)
        if _reports(unit) and any(other.kind == "order" and other.names for other in units[:index]):
            words = _LOOK
        if unit.same:
            words = _same_there(unit, units[:index])
        elif _same_deed(unit):
            words = _deed_before(units[:index]) or words
        if not words:
            continue
        words = _going(unit, words, units[index + 1 : index + 2], first=not result)
        if result and keys(result[-1:]) not in {("otherwise",), ("else",)}:
            # "..., else" is cut off from what it begins.
            result.append(_STOP)
        result += words
    return tuple(result)


_LOOK = tuple(Word(part, part) for part in ("have", "a", "look"))
_REPORTING = frozenset(
    {
        ("tell", "me"),
        ("tell", "us"),
        ("let", "me"),
        ("report", "to"),
        ("see",),
        ("report",),
        ("say",),
        ("find", "out"),
    }
)
_AT_LARGE = frozenset({
    "what", "is", "are", "there", "going", "on", "you", "see", "find", "lying", "happening", "can", "be",
    "seen", "it", "looks", "like", "know", "how", "everything", "anything", "unusual", "things", "out",
    "notice", "up", "around", "in", "me", "us", "to", "and", "then", "report", "back", "tell", "let",
    "whatever", "all", "that",
})  # fmt: skip


def _reports(unit: Unit) -> bool:
    """For "tell me what you see there": a look at large."""
    flat = keys(unit.words)
    while flat[:1] in {("and",), ("then",)}:
        flat = flat[1:]
    begins = any(flat[: len(lead)] == lead for lead in _REPORTING)
    return (
        unit.kind == "order"
        and not unit.names
        and begins
        and {"what", "how"} & set(flat) != set()
        and (set(flat) <= _AT_LARGE)
    )


_SAME = frozenset(
    (*do, *the, *same)
    for do in (("do",), ())
    for the in (("the",), ())
    for same in (
        ("same",),
        ("same", "thing"),
        ("same", "there"),
        ("same", "thing", "there"),
        ("same", "again"),
    )
)


def _same_deed(unit: Unit) -> bool:
    flat = keys(unit.words)
    while flat[:1] in {("and",), ("then",), ("please",)}:
        flat = flat[1:]
    return unit.kind == "order" and flat in _SAME


def with_the_same(words: Phrase, units: Sequence[Unit]) -> Phrase:
    """For "(check A for B), then C, same thing" both orders in full.

    Args:
        words: All words and punctuation, of which these are the parts.
        units: The parts of the message, in their order.
    """
    result: list[Word] = []
    at = 0
    for index, unit in enumerate(units):
        if not unit.same or not unit.names or not any(_looks(other) for other in units[:index]):
            continue
        result += _without_joint(words[at : unit.start])
        result += (_STOP, *_same_there(unit, units[:index]), _STOP)
        at = unit.end
        while at < len(words) and not words[at].is_word:
            at += 1
    return (*result, *words[at:]) if result else words


def _without_joint(words: Phrase) -> Phrase:
    while words and (not words[-1].is_word or words[-1].key in {"and", "then", "so", "but"}):
        words = words[:-1]
    return words


def _going(unit: Unit, words: Phrase, following: Sequence[Unit], *, first: bool) -> Phrase:
    """A bare name as a place to go to, if it comes first or something is to be looked at there."""
    at = 0
    while at < len(words) and words[at].key in _RANKS:
        at += 1
    if unit.kind == "order" and unit.names and keys(words[at:]) == keys(unit.names[0]):
        return (*words[:at], Word("go", "go"), Word("to", "to"), *words[at:])
    if unit.kind != "name" or unit.same or len(unit.names) != 1:
        plain_first = unit.kind == "name" and not unit.same and first and keys(words)[0] not in _BEGINNING
        return (Word("go", "go"), Word("to", "to"), *words) if plain_first else words
    looks = any(_looks(other) for other in following)
    if (first or looks) and keys(words)[0] not in _BEGINNING:
        return (*words[:at], Word("go", "go"), Word("to", "to"), *words[at:])
    return words


_RANKS = frozenset({"first", "then", "next", "and", "finally", "lastly", "also"})


def _looks(unit: Unit) -> bool:
    """Whether a part is an order to look at or for something."""
    if unit.kind != "order":
        return False
    flat = keys(unit.words)
    start = next((i for i in range(len(flat)) if flat[i] not in _RANKS), 0)
    found = lexicon().verbs.match(flat, start)
    return found is not None and found[1].partition(":")[0] in {"look", "search", "whether", "count"}


def _same_there(unit: Unit, units: Sequence[Unit]) -> Phrase:
    """The order that was given last, at another place."""
    place = (Word("go", "go"), Word("to", "to"), *unit.names[0], _STOP)
    for other in reversed(units):
        flat = keys(other.words)
        start = next((i for i in range(len(flat)) if flat[i] not in {"and", "then", "first"}), 0)
        found = lexicon().verbs.match(flat, start) if other.kind == "order" else None
        if found is None or found[1].partition(":")[0] not in {"look", "search", "whether", "count"}:
            continue
        words = _untagged(other.words[start:])
        name = other.names[-1] if other.names else ()
        at = next((i for i in range(len(words)) if name and words[i : i + len(name)] == name), -1)
        if at < 0:
            return (*place, *words)
        return (*words[:at], *unit.names[0], *words[at + len(name) :])
    return place


def _deed_before(units: Sequence[Unit]) -> Phrase:
    """What "do the same" means behind going somewhere else: the look that was asked for last."""
    for unit in reversed(units):
        flat = keys(unit.words)
        start = next((i for i in range(len(flat)) if flat[i] not in {"and", "then", "first"}), 0)
        found = lexicon().verbs.match(flat, start) if unit.kind == "order" else None
        kind = found[1].partition(":")[0] if found is not None else ""
        if kind in {"look", "search", "whether", "count"}:
            return _LOOK if unit.names or _reports(unit) else unit.words[start:]
    return ()


def context(units: Sequence[Unit], known: Sequence[Phrase] = ()) -> list[Phrase]:
    """What is told of before the first order and may be meant by "there" and "it" in it.

    Args:
        units: The parts of the message.
        known: What something is remembered about.
    """
    before: list[Phrase] = []
    for unit in units:
        if unit.kind in _KEPT:
            break
        if unit.kind == "told":
            said = f" {' '.join(keys(unit.words))} "
            before += [subject for subject in known if f" {' '.join(keys(subject))} " in said]
            before += unit.names
    return before


def _kept(unit: Unit, units: Sequence[Unit]) -> Phrase:
    """What of a part goes into the plainer message; nothing for what is only told."""
    words = unit.words
    if unit.kind == "order":
        words = _there(_untagged(_without_heading(_without_tail(words, unit), unit)))
        first = next((other for other in units if other.kind == "order"), None)
        return _without_first(words) if unit is first else words
    if unit.kind == "name":
        return words
    if unit.kind == "asked":
        return (*words, Word("?", "?")) if unit.names else ()
    kept = (
        unit.kind == "wish"
        or (unit.kind == "told" and _is_fact(unit))
        or (unit.kind == "idle" and unit.names)
    )
    return words if kept else ()


def _is_fact(unit: Unit) -> bool:
    """Whether it says where something is, of something that has a name of its own."""
    fact = read_statement(unit.words)
    if fact is None or not fact.is_location or keys(unit.words)[0] in _TELLERS | lexicon().question_starts:
        return False
    if {"way", "going", "gone"} & set(keys(unit.words)):
        return False
    place = set(keys(fact.place))
    return any(place <= set(keys(name)) or set(keys(name)) <= place for name in unit.names)


def _without_tail(words: Phrase, unit: Unit) -> Phrase:
    """Without "before she checks out" and other ends that tell why or when for people."""
    flat = keys(words)
    named = {key for name in unit.names for key in keys(name)}
    for index in range(2, len(flat) - 1):
        if flat[index] not in _TAIL or flat[index + 1] not in _TELLERS:
            continue
        if {"you", "if", "whether"} & set(flat[:index]) or named & set(flat[index:]):
            continue
        return words[:index]
    return words


_TAGS = frozenset({
    ("one", "last", "time"), ("a", "last", "time"), ("very", "well"), ("really", "well"), ("over",),
    ("for", "the", "last", "time"), ("a", "second", "time"), ("once", "more"), ("one", "more", "time"),
    ("would", "you"), ("will", "you"), ("could", "you"), ("can", "you"), ("please",), ("thanks",),
    ("thank", "you"), ("ok",), ("okay",), ("if", "you", "can"), ("if", "you", "could"), ("if", "possible"),
    ("would", "you", "please"), ("for", "me"), ("for", "us"), ("will", "you", "please"), ("right",),
    ("if", "you", "like"), ("alright",),
})  # fmt: skip
_THERE = frozenset(
    {
        ("in", "there"),
        ("up", "there"),
        ("out", "there"),
        ("over", "there"),
        ("down", "there"),
        ("inside", "there"),
    }
)


def _untagged(words: Phrase) -> Phrase:
    """Without "would you" and "please" at the end."""
    while True:
        flat = keys(words)
        tag = next((t for t in _TAGS if flat[-len(t) :] == t and len(flat) > len(t) + 2), ())
        if not tag and flat[-1:] != (",",):
            return words
        words = words[: -len(tag)] if tag else words[:-1]


def _there(words: Phrase) -> Phrase:
    """For "look at X in there": going there, then looking at X."""
    flat = keys(words)
    if flat[-2:] not in _THERE or len(flat) < 5:
        return words
    while flat[:1] in {("go",), ("and",), ("come",), ("then",)}:
        words, flat = words[1:], flat[1:]
    found = lexicon().verbs.match(flat)
    if found is None or not found[1].startswith(("look:", "search:", "whether:", "count:")):
        return words
    return (Word("go", "go"), Word("there", "there"), _STOP, *words[:-2])


def _without_first(words: Phrase) -> Phrase:
    """Without "first of all" behind what is said first anyway."""
    flat = keys(words)
    tail = next((t for t in _FIRST if flat[-len(t) :] == t and len(flat) > len(t) + 1), ())
    return words[: -len(tail)] if tail else words


_FIRST = (
    ("first", "of", "all"),
    ("to", "start", "with"),
    ("to", "begin", "with"),
    ("for", "a", "start"),
    ("for", "starters"),
)


def _without_heading(words: Phrase, unit: Unit) -> Phrase:
    """Without "do my round:" in front of what the round consists of."""
    flat = keys(words)
    at = flat.index(":") if ":" in flat else 0
    named = {key for name in unit.names for key in keys(name)} - lexicon().determiners
    verb = lexicon().verbs.match(flat)
    looks = verb is not None and verb[1].startswith(("look:", "search:", "whether:", "count:", "motion:"))
    return words[at + 1 :] if at and not looks and not named & set(flat[:at]) and named else words
