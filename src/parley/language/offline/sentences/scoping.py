"""What a denial covers: "not A but B" is B, "do not go to A, just to B" is going to B.

A part of a message that only says what is not wanted is left out where another part says what is; the verb of
the denied part goes to the wanted one if that has none. What is denied alone stays: it is an order too.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from parley.language.offline.scene.marks import marks_of
from parley.language.offline.sentences.clauses import opens_command
from parley.language.offline.words.lexicon import PhraseTable, lexicon
from parley.language.offline.words.text import Phrase, Word, keys, lemma
from parley.language.word_lists import load_data

__all__ = ["scoped"]

IsStop = Callable[[Phrase], bool]

_DATA = load_data("scoping")
_TAILS = PhraseTable.of(_DATA["tails"])
_FOR_NOW = PhraseTable.of(_DATA["for_now"])
_RATHER = PhraseTable.of(_DATA["rather"])
_PREFERRED = PhraseTable.of(_DATA["preferred_to"])
_ABOUT = PhraseTable.of(_DATA["about"])
_SURE = PhraseTable.of(_DATA["sure"])
_MARKS = frozenset({".", "!", "?", ";", "\n", ":"})
_LINKS = frozenset({"to", "at", "in", "into", "by", "inside", "towards", "on", "near"})
_SAID = frozenset({"said", "mean", "meant", "want", "wanted", "need", "needed", "say", "asked"})
_GOING = frozenset({"motion", "back", "wait"})
_LONGEST = 7


@dataclass(frozen=True)
class _Part:
    """A part of the message between marks."""

    words: Phrase
    mark: Phrase = ()
    denied: bool = False
    """Whether it says nothing but that something is not wanted."""
    verb: Phrase = ()
    """What was to be done with it."""


def scoped(words: Phrase, is_stop: IsStop, is_pending: IsStop) -> Phrase:
    """The message without what is only denied, if it says what is wanted instead.

    Args:
        words: All words and punctuation.
        is_stop: Whether words name something on the map.
        is_pending: Whether they name something that the robot is still to do; to deny that changes the plan.
    """
    words = _contrasted(words, is_stop)
    plainer = _along(_each_asked(words), is_stop)
    preferred = _preferred(plainer, is_stop)
    if len(preferred) < len(plainer) and _says(_without_end(preferred), is_stop):
        preferred = (*_words("go to"), *preferred[2:])
    words = _without_tail(_sure(preferred))
    parts = _with_denials(words, is_stop)
    denied = [part for part in parts if part.denied]
    if not denied or any(_names_stop(part.words, is_pending) for part in denied):
        return words
    if not any(not part.denied and _names_stop(part.words, is_stop) for part in parts):
        return words
    result: list[Word] = []
    verb: Phrase = ()
    for part in parts:
        if part.denied:
            verb = part.verb or verb
            if result and part.mark and part.mark[0].key in _MARKS and result[-1].key in {",", "but"}:
                result[-1:] = part.mark
            continue
        wanted = _wanted(part.words, verb, is_stop)
        verb = () if opens_command(wanted) else verb
        result += (*wanted, *part.mark)
    return tuple(result)


def _without_tail(words: Phrase) -> Phrase:
    """Without ", nothing else" behind what is asked for."""
    end = len(words)
    while end and not words[end - 1].is_word:
        end -= 1
    size = _TAILS.match_end(keys(words[:end]))
    before = words[end - size - 1 : end - size]
    if not size or not before or before[0].key not in {",", ".", ";", "and", "but"} or end - size < 3:
        return words
    return (*words[: end - size - 1], *words[end:])


def _sure(words: Phrase) -> Phrase:
    """For "see to it that no door is open" "make sure that"."""
    flat = keys(words)
    for index in range(len(flat)):
        found = _SURE.match(flat, index)
        if found is not None and found[0] > 2 and found[1] not in {"make sure that", "make certain that"}:
            return (*words[:index], *_words("make sure that"), *words[index + found[0] :])
    return words


def _contrasted(words: Phrase, is_stop: IsStop) -> Phrase:
    """For "A does not need checking but B does": B needs checking."""
    flat = keys(words)
    end = next((i for i in range(len(flat)) if flat[i] in _MARKS), len(flat))
    at = next(
        (i for i in range(1, end - 3) if flat[i] in {"does", "do", "is", "are"} and flat[i + 1] == "not"), 0
    )
    joint = next((i for i in range(at + 2, end) if flat[i] in {"but", "only", ","}), 0) if at else 0
    other = joint + 1 + (flat[joint + 1 : joint + 2] in {("but",), ("only",)})
    if (
        not joint
        or flat[end - 1] != flat[at]
        or not is_stop(words[:at])
        or not is_stop(words[other : end - 1])
    ):
        return words
    told = words[at + 2 : joint]
    if flat[at] in {"is", "are"}:
        return (*words[other:end], *told, *words[end:])
    verb = Word(f"{told[0].key}s", f"{told[0].raw}s") if flat[at] == "does" else told[0]
    return (*words[other : end - 1], verb, *told[1:], *words[end:])


def _along(words: Phrase, is_stop: IsStop) -> Phrase:
    """For "up aisle 1, down aisle 2": to each of them."""
    flat = keys(words)
    result = list(words)
    for index in range(1, len(words) - 1):
        path = flat[index] in _PATHS and (flat[index - 1] == "," or flat[index - 1] in _GOING_VERBS)
        if path and _stop_end(words, index + 1, is_stop) > index + 1:
            result[index] = Word("to", "to")
    return tuple(result)


_PATHS = frozenset({"up", "down", "along", "through", "past", "round", "across", "via", "by"})
_GOING_VERBS = frozenset({"go", "drive", "run", "move", "head", "roll", "walk", "then"})


def _each_asked(words: Phrase) -> Phrase:
    """For "I want to know of all doors whether they are shut": whether all doors are shut."""
    flat = keys(words)
    at = next((i for i in range(1, len(flat)) if flat[i] in {"whether", "if"}), 0)
    lead = next((m for m in _KNOWING if flat[: len(m)] == m), ())
    points = flat[at + 1 : at + 2] in {("it",), ("they",)} or (
        at + 1 < len(words) and bool(marks_of(words[at + 1]))
    )
    if not at or not lead or at <= len(lead) or not points:
        return words
    return (*_words("check whether"), *words[len(lead) : at], *words[at + 2 :])


_KNOWING = tuple(
    (*want, "know", of)
    for want in (
        ("i", "want", "to"),
        ("i", "need", "to"),
        ("i", "would", "like", "to"),
        ("we", "need", "to"),
        ("let", "me"),
    )
    for of in ("of", "about", "for")
)


def _preferred(words: Phrase, is_stop: IsStop) -> Phrase:
    """For "go to B rather than A", "check B, not A": without A."""
    flat = keys(words)
    for index in range(2, len(flat) - 1):
        found = _PREFERRED.match(flat, index)
        if found is None or flat[index - 1] in {"is", "are", "do", "did", "does", "am", "if", "or"}:
            continue
        start = index + found[0]
        start += flat[start : start + 1] != () and flat[start] in _LINKS
        end = _stop_end(words, start, is_stop)
        if found[1] not in {"not", "and not", "but not"} and end == start:
            marks = (i for i in range(start, len(flat)) if flat[i] in _MARKS | {",", "and", "then"})
            end = min(next(marks, len(flat)), start + 6)
        close = end == len(flat) or flat[end] in _MARKS | {",", "and", "then"}
        if end == start or not close or not _names_stop(words[:index], is_stop):
            continue
        lead = index - (flat[index - 1] == ",")
        return _preferred((*words[:lead], *words[end:]), is_stop)
    return words


def _stop_end(words: Phrase, start: int, is_stop: IsStop) -> int:
    sizes = range(min(_LONGEST, len(words) - start), 0, -1)
    return next((start + size for size in sizes if is_stop(words[start : start + size])), start)


def _names_stop(words: Phrase, is_stop: IsStop) -> bool:
    return any(_stop_end(words, i, is_stop) > i for i in range(len(words)) if words[i].is_word)


def _with_denials(words: Phrase, is_stop: IsStop) -> list[_Part]:
    """The parts of a message, cut at marks and before "but"."""
    parts: list[_Part] = []
    start = 0
    for index in range(len(words) + 1):
        ends = index == len(words) or words[index].key in _MARKS | {","}
        joint = not ends and index > start and words[index].key in {"but", "and"}
        if not ends and not (
            joint and (words[index].key == "but" or _then_orders(words, start, index, is_stop))
        ):
            continue
        body = words[start:index]
        mark = words[index : index + 1] if ends else ()
        start = index + 1 if ends else index
        if any(word.is_word for word in body):
            verb = _denial(body, is_stop)
            denied = verb is not None
            parts.append(
                _Part(body, mark if ends else (Word(",", ","),) if denied else (), denied, verb or ())
            )
    return parts


def _then_orders(words: Phrase, start: int, index: int, is_stop: IsStop) -> bool:
    """Whether an order follows "and" behind a mere denial ("skip A and go to B")."""
    return opens_command(words[index + 1 :]) and _denial(words[start:index], is_stop) is not None


def _denial(words: Phrase, is_stop: IsStop) -> Phrase | None:
    """What was to be done with what is denied (maybe nothing); None if it is no mere denial."""
    words = _without_end(words)
    flat = keys(words)
    while (
        flat[:1] in {("no",), ("but",), ("and",), ("oh",), ("actually",)}
        and len(flat) > 2
        and not _no_stop(words, is_stop)
    ):
        words, flat = words[1:], flat[1:]
    for lead in (
        ("do", "not", "bother", "with"),
        ("i", "do", "not", "want", "you"),
        ("i", "do", "not", "need", "you"),
        ("we", "do", "not", "want", "you"),
        ("you", "are", "not", "needed"),
        ("do", "not", "go", "anywhere", "near"),
        ("stay", "out", "of"),
        ("stay", "away", "from"),
        ("keep", "away", "from"),
        ("keep", "out", "of"),
        ("keep", "clear", "of"),
        ("avoid",),
        ("do", "not", "bother", "about"),
        ("do", "not", "worry", "about"),
        ("never", "mind"),
        ("forget", "about"),
        ("no", "more"),
        ("it", "is", "not"),
        ("not",),
        ("no",),
        ("neither",),
        ("anything", "but"),
        ("nothing", "in"),
        ("never",),
    ):
        if flat[: len(lead)] == lead and _only_stops(words[len(lead) :], is_stop):
            return ()
    if (
        flat[:2] in {("not", "all"), ("not", "every"), ("not", "both"), ("not", "everything")}
        and len(flat) < 6
    ):
        return ()
    end = _stop_end(words, 0, is_stop)
    if (
        end
        and flat[end : end + 2] in {("is", "not"), ("was", "not")}
        and flat[end + 2 : end + 3] in {("what",), ("the",), ("where",)}
    ):
        return ()
    if (
        flat[:3] in {("do", "not", stop) for stop in ("stop", "halt", "wait", "pause", "park", "linger")}
        and len(flat) > 4
    ):
        return _words("go to")
    passive = next((m for m in _NOT_WANTED if flat[: len(m)] == m), ())
    if (
        passive
        and flat[-1].endswith(("ed", "en", "seen", "done"))
        and _only_stops(words[len(passive) : -1], is_stop)
    ):
        return _words(lemma(flat[-1]))
    if flat[:1] and flat[0] in _IGNORING:
        size = 1 + (flat[1:2] in {("out",), ("about",)})
        tail = flat[-1:] in {("alone",), ("be",), ("out",)}
        return () if _only_stops(words[size : len(words) - tail], is_stop) else None
    found = lexicon().prohibitions.match(flat)
    if found is None or found[0] >= len(words):
        return None
    rest = words[found[0] :]
    verb = lexicon().verbs.match((lemma(rest[0].key), *keys(rest[1:])))
    if verb is None or verb[1].partition(":")[0] in {"other", "wait", "speak"}:
        return None
    size = verb[0] + (keys(rest[verb[0] : verb[0] + 1]) != () and rest[verb[0]].key in _LINKS)
    return (
        (*_words(verb[1].partition(":")[2]), *rest[verb[0] : size])
        if _only_stops(rest[size:], is_stop)
        else None
    )


_NOT_WANTED = (
    ("i", "do", "not", "want"),
    ("i", "do", "not", "need"),
    ("we", "do", "not", "want"),
    ("we", "do", "not", "need"),
    ("no", "need", "to", "have"),
)
_IGNORING = frozenset({"ignore", "skip", "leave", "forget", "omit", "disregard", "exclude"})


def _no_stop(words: Phrase, is_stop: IsStop) -> bool:
    return words[0].key == "no" and _only_stops(words[1:], is_stop)


def _without_end(words: Phrase) -> Phrase:
    while words:
        flat = keys(words)
        size = _FOR_NOW.match_end(flat)
        if words[-1].is_word and not size:
            break
        words = words[: -(size or 1)]
    return words


def _only_stops(words: Phrase, is_stop: IsStop) -> bool:
    """Whether words are things of the map, one or several, and what they are said to be wanted for."""
    at, any_named = 0, False
    while at < len(words):
        at += words[at].key in _LINKS and at + 1 < len(words)
        end = _stop_end(words, at, is_stop)
        if end == at and words[at].key.isdigit():
            # "Not 12 or 13", where rooms were spoken of.
            end = at + 1
        if end == at:
            break
        any_named, at = True, end
        if at < len(words) and words[at].key in {"and", "or", "nor", "and/or"}:
            at += 1
    rest = keys(words[at:])
    return any_named and (
        not rest or rest in {("go",), ("alone",), ("be",)} or _ABOUT.match_end(rest) == len(rest)
    )


def _wanted(words: Phrase, verb: Phrase, is_stop: IsStop) -> Phrase:
    """The wanted part as an order of its own, with the verb of the denied one if it has none."""
    rest = words
    while (found := _RATHER.match(keys(rest))) is not None and found[0] < len(rest):
        rest = rest[found[0] :]
    done = _wished_done(rest, is_stop)
    if done:
        return done
    if keys(rest[:2]) == ("it", "is") or _says(rest, is_stop):
        rest = rest[2:]
    while keys(rest[-1:]) in {("instead",), ("rather",)}:
        rest = rest[:-1]
    start = int(bool(rest) and rest[0].key in _LINKS)
    end = _stop_end(rest, start, is_stop)
    chosen_one = _the_one(rest[end:]) if end > start else None
    if chosen_one is not None:
        return (*(chosen_one or verb or _words("go to")), *rest[start:end])
    if end == start or not _nothing_more(rest[end:]):
        return rest if opens_command(rest) else words
    if not verb:
        return (
            rest if start else words if words != rest and opens_command(words) else (*_words("go to"), *rest)
        )
    goes = lexicon().verbs.match(keys(verb))
    moving = goes is not None and goes[1].partition(":")[0] in _GOING
    link = () if start or not moving or verb[-1].key in _LINKS else _words("to")
    return (*verb, *link, *rest[start if verb[-1].key in _LINKS else 0 :])


def _the_one(words: Phrase) -> Phrase | None:
    """What is to be done with "(A) is the one to inspect"; None if nothing of the kind is said."""
    flat = keys(words)
    if flat[:3] not in {
        ("is", "the", "one"),
        ("is", "the", "right"),
        ("is", "what", "i"),
        ("is", "where", "i"),
    }:
        return None
    rest = words[4:] if flat[3:4] == ("to",) else ()
    return rest if rest and opens_command(rest) else ()


def _wished_done(words: Phrase, is_stop: IsStop) -> Phrase:
    """For "I want the desks checked": check the desks; empty if it is no such wish."""
    if keys(words[:1]) not in {("i",), ("we",)} or len(words) < 4 or words[1].key not in {"want", "need"}:
        return ()
    end, verb = _stop_end(words, 2, is_stop), lemma(words[-1].key)
    if end != len(words) - 1 or end == 2 or verb == words[-1].key:
        return ()
    return (*_words(verb), *words[2:end])


def _says(words: Phrase, is_stop: IsStop) -> bool:
    """For "I meant the desk": a thing and nothing else."""
    said = keys(words[:1]) in {("i",), ("we",)} and len(words) > 2 and words[1].key in _SAID
    end = _stop_end(words, 2, is_stop) if said else 2
    return end > 2 and _nothing_more(words[end:])


def _nothing_more(words: Phrase) -> bool:
    rest = keys(_without_end(words))
    return not rest or _ABOUT.match_end(rest) == len(rest) or rest[0] in {"and", "then"}


def _words(text: str) -> Phrase:
    return tuple(Word(part, part) for part in text.split())
