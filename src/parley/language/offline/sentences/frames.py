"""Ways of asking that put a frame around an order: hedges, wishes, worries, the passive, foreign grammar.

The frame consists of small words alone; what follows it is an order, an order in the passive ("that X is
checked"), an order to whoever ("if somebody looked at X"), or a noun for one ("a look at X"). A worry about
how a known thing is ("I am afraid X is open") is an order to look.
"""

from __future__ import annotations

from collections.abc import Callable

from parley.language.offline.sentences.clauses import opens_command
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
_GETTING = frozenset({"have", "get", "see", "want", "like", "having", "need", "wants", "needs"})
_NOT_MEANT = (
    ("not", "suppose"),
    ("not", "too"),
    ("not", "mind"),
    ("not", "be", "better"),
    ("not", "imagine"),
)
_KINDS = frozenset({
    "motion", "look", "whether", "search", "transfer", "grasp", "speak", "follow", "meet", "count",
    "guide", "place", "back",
})  # fmt: skip
_LOOKS = frozenset({"look", "glance", "peek", "check", "inspection", "eye", "peep", "check-up"})
_TRIPS = frozenset({"visit", "trip", "drive", "run", "walk"})
_MARKS = frozenset({".", "!", "?", ";", "\n"})
_FINITE = lexicon().be | {"works", "runs", "seems", "looks", "has", "smells", "leaks", "needs"}
_LONGEST_STOP = 6


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
        order = _order(said, is_stop) or _in_parts(said, is_stop)
        mark = words[index : index + 1]
        if order is not None and mark and mark[0].key == "?":
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


def _in_parts(words: Phrase, is_stop: IsStop) -> Phrase | None:
    """A sentence of which a part between commas is such an order."""
    if "," not in keys(words):
        return None
    pieces: list[Word] = []
    start, changed = 0, False
    for index in range(len(words) + 1):
        if index < len(words) and words[index].key != ",":
            continue
        whole = start and not {"if", "unless"} & set(keys(words[:index]))
        order = _order(words[start:index], is_stop) if whole else None
        if order is not None:
            pieces[-1:] = [Word(".", ".")]
            changed = True
        pieces += (*(order or words[start:index]), *words[index : index + 1])
        start = index + 1
    return tuple(pieces) if changed else None


def _order(words: Phrase, is_stop: IsStop) -> Phrase | None:
    """The order that a sentence means; None if it needs no rewording."""
    body = tuple(words)
    while body and (not body[0].is_word or body[0].key in {"and", "so", "then", "oh", "well", "anyway"}):
        body = body[1:]
    if len(body) < 3 or len(body) > 40:
        return None
    return (
        _worry(body, is_stop)
        or _fronted(body, is_stop)
        or _topic(body, is_stop)
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


def _fronted(words: Phrase, is_stop: IsStop) -> Phrase | None:
    """For "to the desk you must go"."""
    flat = keys(words)
    if flat[0] not in {"to", "at", "into", "in"}:
        return None
    end = _stop_end(words, 1, is_stop)
    rest = flat[end:]
    if end == 1 or rest[:1] != ("you",) or len(rest) > 7:
        return None
    verb = lexicon().verbs.match(rest, len(rest) - 1)
    kind = verb[1].partition(":")[0] if verb is not None else ""
    if kind not in {"motion", "look", "back"} or "not" in rest:
        return None
    return (*_words("inspect" if kind == "look" else "go to"), *words[1:end])


def _topic(words: Phrase, is_stop: IsStop) -> Phrase | None:
    """For "the desk, is it free": asked with the thing in its place."""
    flat = keys(words)
    end = _stop_end(words, 0, is_stop)
    asks = flat[end : end + 1] == (",",) and flat[end + 1 : end + 2] and flat[end + 1] in lexicon().be
    if not end or not asks or flat[end + 2 : end + 3] not in {("it",), ("that",)} or len(flat) < end + 4:
        return None
    return (*_words("check whether"), *words[:end], words[end + 1], *words[end + 3 :])


def _inside_frame(words: Phrase, is_stop: IsStop) -> Phrase | None:
    flat = keys(words)
    at = 0
    while at < len(flat) and flat[at] in _FRAME:
        at += 1
    opens = opens_command(words)
    for cut in range(at, 0, -1):
        lead = flat[:cut]
        if not _DESIRE & set(lead) or _denied(lead) or lead[-1] in lexicon().determiners:
            continue
        rest = words[cut:]
        order = _passive(lead, rest, is_stop)
        if order is None and not opens:
            order = (
                _active(lead, rest, is_stop) or _noun_of_order(rest, is_stop) or _you_at(lead, rest, is_stop)
            )
        if order is not None:
            return order
    # "X should be checked by somebody".
    return (
        _passive(("would",), words, is_stop)
        if "be" in flat[1:] and _DESIRE & set(flat) and not opens
        else None
    )


def _denied(lead: tuple[str, ...]) -> bool:
    if not {"not", "never", "no"} & set(lead):
        return False
    return not any(lead[i : i + len(m)] == m for m in _NOT_MEANT for i in range(len(lead)))


def _passive(lead: tuple[str, ...], rest: Phrase, is_stop: IsStop) -> Phrase | None:
    """For "the desk be inspected", and "the desk inspected" behind "have"."""
    end = _stop_end(rest, 0, is_stop)
    flat = keys(rest)
    at = end
    while at < len(flat) and flat[at] in _LINKING:
        at += 1
    if not end or at >= len(flat) or (at == end and lead[-1] not in _GETTING) or "not" in flat[end:at]:
        return None
    verb = lemma(flat[at])
    found = lexicon().verbs.match((verb, *flat[at + 1 :]))
    if found is None or verb == flat[at] or found[1].partition(":")[0] not in _KINDS:
        return None
    if at > end and not {"be", "been", "was", "were", "is", "get", "gets", "got", "are", "being"} & set(
        flat[end:at]
    ):
        return None
    tail = rest[at + found[0] :]
    if keys(tail[:1]) == ("by",) and keys(tail[1:2]) and keys(tail)[1] in _ANYBODY | {"you"}:
        tail = tail[2:]
    return (Word(verb, verb), *rest[at + 1 : at + found[0]], *rest[:end], *tail)


_LINKING = frozenset({
    "be", "been", "was", "were", "is", "are", "get", "gets", "got", "could", "would", "should", "can",
    "to", "ought", "must", "will", "soon", "really", "perhaps", "maybe", "please", "quickly", "also",
    "now", "has", "have", "needs", "being", "not", "might", "may", "had",
})  # fmt: skip


def _active(lead: tuple[str, ...], rest: Phrase, is_stop: IsStop) -> Phrase | None:
    """For "(somebody would) look at the desk", "(if you) went to the desk"."""
    if not rest:
        return None
    base = lemma(rest[0].key)
    found = lexicon().verbs.match((base, *keys(rest[1:])))
    if found is None or found[1].partition(":")[0] not in _KINDS:
        return None
    if base != rest[0].key and not _PAST & set(lead):
        return None
    whom = (_ANYBODY | {"you", "robot"}) & set(lead)
    if not whom and lead[-1] not in {"to", "and", "please", "just", "kindly"}:
        return None
    named = any(
        is_stop(rest[i:j]) for i in range(1, len(rest)) for j in range(i + 1, min(len(rest), i + 5) + 1)
    )
    return (Word(base, base), *rest[1:]) if named else None


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
    """For "(I would need you) at the desk"."""
    if lead[-1] != "you" or keys(rest[:1]) not in {("at",), ("in",), ("by",), ("near",)}:
        return None
    end = _stop_end(rest, 1, is_stop)
    return (*_words("go to"), *rest[1:]) if end > 1 else None


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
