"""Which parts of a message only say what is not wanted, and where they begin and end."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from dataclasses import dataclass, replace

from parley.language.offline.sentences.clauses import opens_command
from parley.language.offline.sentences.sparing import explains, leads, name_spans, names_in, spares, spares_it
from parley.language.offline.words.lexicon import PhraseTable, lexicon
from parley.language.offline.words.text import Phrase, Word, keys, lemma
from parley.language.word_lists import load_data

__all__ = [
    "ABOUT", "LINKS", "MARKS", "Part", "led_in", "names_stop", "pointed", "stop_end", "with_denials",
    "without_end", "without_reasons", "words_of",
]  # fmt: skip

IsStop = Callable[[Phrase], bool]

_DATA = load_data("scoping")
_FOR_NOW = PhraseTable.of(_DATA["for_now"])


ABOUT = PhraseTable.of(_DATA["about"])


MARKS = frozenset({".", "!", "?", ";", "\n", ":"})


LINKS = frozenset({"to", "at", "in", "into", "by", "inside", "towards", "on", "near"})


_LONGEST = 7


@dataclass(frozen=True)
class Part:
    """A part of the message between marks."""

    words: Phrase
    mark: Phrase = ()
    denied: bool = False
    """Whether it says nothing but that something is not wanted."""
    verb: Phrase = ()
    """What was to be done with it."""
    names: tuple[Phrase, ...] = ()
    """What is not wanted."""


def pointed(parts: list[Part], is_stop: IsStop) -> list[Part]:
    """With "A has been cleaned, leave it" as a denial of A."""
    result = list(parts)
    for index, part in enumerate(parts):
        if part.denied or not spares_it(part.words):
            continue
        at = index - 1
        while at > 0 and not names_stop(parts[at].words, is_stop) and explains(parts[at].words):
            at -= 1
        if at < 0 or parts[at].denied or not _tells(parts[at].words):
            continue
        names = names_in(parts[at].words, is_stop)
        if names:
            result[at : index + 1] = [replace(p, denied=True, names=names) for p in parts[at : index + 1]]
    return result


def _tells(words: Phrase) -> bool:
    """Whether a part tells something, and is no order."""
    told = any(key in _FINITE or key.endswith("ed") for key in keys(words[1:]))
    return told and not opens_command(words) and words[0].key not in {"if", "when", "unless"}


def led_in(parts: list[Part]) -> list[Part]:
    """With "whatever you do," in front of a denial as a part of it."""
    pairs = itertools.zip_longest(parts, parts[1:])
    return [replace(p, denied=True) if after and after.denied and leads(p.words) else p for p, after in pairs]


def without_reasons(parts: list[Part], is_stop: IsStop) -> list[Part]:
    """With "she is asleep" behind a denial as a part of it."""
    result: list[Part] = []
    for part in parts:
        before = result[-1] if result else None
        why = before is not None and before.denied and before.mark[:1] and before.mark[0].key == ","
        idle = not part.denied and explains(part.words) and not names_stop(part.words, is_stop)
        result.append(replace(part, denied=True) if why and idle else part)
    return result


def stop_end(words: Phrase, start: int, is_stop: IsStop) -> int:
    """Where the longest name that begins at a word ends; the start if none begins there."""
    sizes = range(min(_LONGEST, len(words) - start), 0, -1)
    return next((start + size for size in sizes if is_stop(words[start : start + size])), start)


def names_stop(words: Phrase, is_stop: IsStop) -> bool:
    """Whether words name something anywhere."""
    return any(stop_end(words, i, is_stop) > i for i in range(len(words)) if words[i].is_word)


def with_denials(words: Phrase, is_stop: IsStop) -> list[Part]:
    """The parts of a message, cut at marks, before "but", and around what is denied."""
    parts: list[Part] = []
    start = 0
    while start < len(words):
        end = _part_end(words, start, is_stop)
        mark, asked = words[end : end + 1], words[end : end + 1] and words[end].key == "?"
        for body in _pieces(words[start:end], is_stop):
            denial = None if asked else _denial(body, is_stop)
            ends = body[-1] is words[end - 1]
            own = mark if ends else (Word(",", ","),) if denial is not None else ()
            parts.append(replace(denial or Part(body), mark=own))
        start = end + 1
    return parts


def _part_end(words: Phrase, start: int, is_stop: IsStop) -> int:
    """Where a part ends: at a mark, or behind a list of what is denied."""
    ends = [i for i in range(start, len(words)) if words[i].key in MARKS | {","}]
    end = ends[0] if ends else len(words)
    for later in [*ends[1:4], len(words)] if ends else []:
        listed = all(words[i].key == "," for i in ends if i < later) and {"and", "or", "nor"} & set(
            keys(words[end:later])
        )
        if listed and words[start:later] and spares(words[start:later], is_stop):
            return later
    return end


def _pieces(body: Phrase, is_stop: IsStop) -> list[Phrase]:
    """A part cut where a denial begins or ends; always before "but"."""
    if not any(word.is_word for word in body):
        return []
    inside = {i for start, end in name_spans(body, is_stop) for i in range(start + 1, end)}
    for index in range(1, len(body)):
        before, behind = body[:index], body[index:]
        if index in inside:
            continue
        joint = behind[0].key in _JOINTS
        if not joint and behind[0].key not in _STARTERS and not _ends_name(before, is_stop):
            continue
        if behind[0].key == "but" or _cuts(before, behind, is_stop, joint=joint):
            return [*_pieces(before, is_stop), *_pieces(behind, is_stop)]
    return [body]


def _cuts(before: Phrase, behind: Phrase, is_stop: IsStop, *, joint: bool) -> bool:
    """Whether a denial ends here and an order begins, or the other way round."""
    if behind[0].key in {"and", "or"} and not opens_command(behind[1:]):
        return bool(spares_it(behind[1:]) or (spares(before, is_stop) and _tells(behind[1:])))
    if before[-1].key in {"if", "whether", "or", "why", "did", "do", "does", "is", "are"}:
        return False
    if _denial(before, is_stop) is not None:
        return joint or (len(behind) > 1 and opens_command(behind))
    if _denial(behind, is_stop) is not None:
        return bool(names_stop(before, is_stop)) and (joint or behind[0].key in _STARTERS)
    return joint and behind[0].key == "so" and spares_it(behind)


def _ends_name(words: Phrase, is_stop: IsStop) -> bool:
    sizes = range(1, min(_LONGEST, len(words)) + 1)
    return any(is_stop(words[-size:]) for size in sizes)


def _denial(words: Phrase, is_stop: IsStop) -> Part | None:
    """A part that is nothing but a denial, with what was to be done with what is denied; else None."""
    body = without_end(words)
    flat = keys(body)
    if (
        flat[:2] in {("not", "all"), ("not", "every"), ("not", "both"), ("not", "everything")}
        and len(flat) < 6
    ):
        return Part(words, denied=True)
    verb = _verb_denied(body, is_stop)
    names = spares(words, is_stop)
    if verb is None and not names:
        return None
    return Part(words, (), True, verb or (), names or names_in(words, is_stop))


def _verb_denied(words: Phrase, is_stop: IsStop) -> Phrase | None:
    """What was to be done with what is denied, with its preposition; None if no verb says so."""
    flat = keys(words)
    while flat[:1] in {("no",), ("but",), ("and",), ("oh",), ("actually",), ("so",)} and len(flat) > 2:
        if flat[0] == "no" and lexicon().prohibitions.match(flat) is not None:
            break
        words, flat = words[1:], flat[1:]
    end = stop_end(words, 0, is_stop)
    if end and flat[end:] in {("not",), ("no",)}:
        return ()
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
        return words_of("go to")
    passive = next((m for m in _NOT_WANTED if flat[: len(m)] == m), ())
    if (
        passive
        and flat[-1].endswith(("ed", "en", "seen", "done"))
        and _only_stops(words[len(passive) : -1], is_stop)
    ):
        return words_of(lemma(flat[-1]))
    found = lexicon().prohibitions.match(flat)
    if found is None or found[0] >= len(words):
        return None
    rest = words[found[0] :]
    verb = lexicon().verbs.match((lemma(rest[0].key), *keys(rest[1:])))
    if verb is None or verb[1].partition(":")[0] in {"other", "wait", "speak"}:
        return None
    goal = lexicon().goals.match(keys(rest), verb[0])
    linked = keys(rest[verb[0] : verb[0] + 1]) != () and rest[verb[0]].key in LINKS
    size = verb[0] + (goal[0] if goal is not None and goal[0] > 1 else linked)
    return (
        (*words_of(verb[1].partition(":")[2]), *rest[verb[0] : size])
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


_JOINTS = frozenset({
    "but", "so", "though", "although", "because", "since", "as", "while", "and", "then", "or", "yet", "only",
    "just",
})  # fmt: skip


_STARTERS = frozenset({
    "leave", "skip", "avoid", "ignore", "omit", "exclude", "stay", "keep", "not", "no", "never", "do",
    "without", "spare", "nobody", "it",
})  # fmt: skip


_FINITE = frozenset(
    {"is", "are", "was", "were", "has", "have", "had", "does", "needs", "wants", "gets", "must"}
)


def without_end(words: Phrase) -> Phrase:
    """Without marks and words such as "for now" at the end."""
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
        at += words[at].key in LINKS and at + 1 < len(words)
        end = stop_end(words, at, is_stop)
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
        not rest or rest in {("go",), ("alone",), ("be",)} or ABOUT.match_end(rest) == len(rest)
    )


def words_of(text: str) -> Phrase:
    """Plain words, as they are."""
    return tuple(Word(part, part) for part in text.split())
