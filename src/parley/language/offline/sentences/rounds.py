"""Rounds through several places with something to watch for: "do the halls and look out for smoke"."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

from parley.language.offline.scene.marks import marks_of
from parley.language.offline.sentences.clauses import Clause
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.nouns import bare
from parley.language.offline.words.text import Phrase, Word, keys, lemma, singular

__all__ = ["as_round", "watched_for"]

_MAKING = frozenset(
    {
        "do",
        "make",
        "take",
        "have",
        "start",
        "run",
        "go",
        "walk",
        "go on",
        "drive",
        "complete",
        "finish",
        "begin",
    }
)
_ROUNDS = frozenset(
    {"round", "rounds", "tour", "lap", "patrol", "sweep", "circuit", "walk", "turn", "trip", "inspection"}
)
_THROUGH = frozenset({"of", "through", "round", "around", "across", "over", "at", "in", "along"})
_BEFORE = frozenset(
    {
        "a",
        "the",
        "your",
        "another",
        "quick",
        "short",
        "full",
        "complete",
        "security",
        "usual",
        "on",
        "regular",
        "long",
        "little",
        "evening",
        "night",
    }
)
_WATCHING = (
    ("look", "out", "for"),
    ("watch", "out", "for"),
    ("look", "for"),
    ("watch", "for"),
    ("keep", "an", "eye", "out", "for"),
    ("check", "for"),
    ("search", "for"),
    ("keep", "your", "eyes", "open", "for"),
    ("look", "around", "for"),
    ("be", "on", "the", "lookout", "for"),
    ("scan", "for"),
    ("keep", "looking", "for"),
    ("keep", "a", "lookout", "for"),
    ("see", "if", "there", "are"),
    ("see", "if", "there", "is"),
    ("check", "if", "there", "is"),
    ("check", "if", "there", "are"),
    ("inspect", "them", "for"),
    ("check", "them", "for"),
    ("search", "them", "for"),
    ("inspect", "each", "for"),
    ("check", "each", "for"),
    ("inspect", "each", "one", "for"),
    ("check", "each", "one", "for"),
    ("i", "am", "looking", "for"),
    ("we", "are", "looking", "for"),
    ("looking", "for"),
    ("looking", "out", "for"),
    ("watching", "for"),
    ("watching", "out", "for"),
    ("checking", "for"),
    ("searching", "for"),
    ("scanning", "for"),
    ("try", "to", "spot"),
    ("tell", "me", "if", "you", "see"),
    ("tell", "me", "about", "any"),
    ("report", "any"),
    ("note", "any"),
    ("look", "there", "for"),
    ("scan", "them", "for"),
    ("search", "each", "for"),
    ("we", "are", "after"),
    ("i", "am", "after"),
    ("let", "me", "know", "if", "you", "see"),
)
_REPORTING = frozenset({("report",), ("note",), ("flag",), ("find",), ("spot",), ("notice",), ("mention",)})
_ANYTHING = frozenset(
    {("anything",), ("any",), ("anyone",), ("anybody",), ("everything",), ("whatever",), ("all",)}
)
_GOING = frozenset({"motion", "look", "guide"})


def as_round(words: Phrase) -> Phrase:
    """For "do a quick round through A" "visit A", for "do an inspection of A" "inspect A"."""
    flat = keys(words)
    for index, word in enumerate(flat):
        if lemma(word) not in _MAKING:
            continue
        at = index + 1
        while at < len(flat) and flat[at] in _BEFORE:
            at += 1
        if (
            at > index + 1
            and flat[at : at + 1]
            and flat[at] in _ROUNDS
            and flat[at + 1 : at + 2]
            and flat[at + 1] in _THROUGH
        ):
            verb = "inspect" if flat[at] == "inspection" else "visit"
            return (*words[:index], Word(verb, verb), *words[at + 2 :])
    return words


def watched_for(
    parts: Sequence[Clause], is_several: Callable[[Phrase], bool], is_known: Callable[[Phrase], bool]
) -> list[Clause]:
    """Going somewhere and watching for something as one clause, where that is to be done at several places.

    Args:
        parts: The clauses.
        is_several: Whether words name more than one thing of the map.
        is_known: Whether words name something of the map, or something remembered.
    """
    result: list[Clause] = []
    for part in parts:
        before = result[-1] if result else None
        there = _without_same(part, _place(before.words) if before is not None else ())
        what = _watched(there) or _looked_at(there, is_known)
        place = _place(before.words) if before is not None and what else ()
        if before is None or not place or part.condition or before.condition or not is_several(place):
            result.append(part)
            continue
        words = (Word("inspect", "inspect"), *place, Word("for", "for"), *what)
        result[-1] = replace(before, words=words)
    return result


def _without_same(part: Clause, place: Phrase) -> Clause:
    """For "(go to the doors and) count the bolts in each": where it is done anyway."""
    same = len(place) > 0 and marks_of(place[-1]) != () and marks_of(part.words[-1]) == marks_of(place[-1])
    link = keys(part.words[-2:-1]) in {("in",), ("at",), ("on",), ("of",)}
    return replace(part, words=part.words[:-2]) if same and link else part


def _watched(part: Clause) -> Phrase:
    flat = keys(part.words)
    at = 1 if flat[:1] in {("and",), ("then",), ("please",), ("while",)} else 0
    size = next((len(lead) for lead in _WATCHING if flat[at : at + len(lead)] == lead), 0)
    if flat[at : at + 1] in _REPORTING and flat[at + 1 : at + 2] in _ANYTHING:
        size = 1
    rest = bare(part.words[at + size :]) if size else ()
    return rest if rest and lexicon().places.match(keys(rest)) is None and not _says_where(rest) else ()


def _looked_at(part: Clause, is_known: Callable[[Phrase], bool]) -> Phrase:
    """For "count the people", "check the gas taps": what every place has of its own."""
    flat = keys(part.words)
    found = lexicon().verbs.match(flat, int(flat[:1] in {("and",), ("then",)}))
    if found is None or found[1].partition(":")[0] not in _LOOKING:
        return ()
    rest = part.words[found[0] + int(flat[0] in {"and", "then"}) :]
    named = bare(rest)
    whole = 0 < len(named) <= _LONGEST_SIGHT and all(word.is_word for word in named)
    several = whole and singular(named[-1].key) != named[-1].key
    if not whole or (named == rest and not several) or _says_where(rest) or is_known(named):
        return ()
    return named


_LOOKING = frozenset({"look", "count", "search"})
_LONGEST_SIGHT = 4


def _says_where(words: Phrase) -> bool:
    flat = keys(words)
    found = next((i for i in range(1, len(flat) - 1) if flat[i] in {"in", "at", "on"}), 0)
    return bool(found) and flat[found + 1] not in {"there", "it", "them"}


def _place(words: Phrase) -> Phrase:
    """Where an order to go or to look goes; empty if it is none, or already says what for."""
    flat = keys(words)
    found = lexicon().verbs.match((lemma(flat[0]), *flat[1:])) if flat else None
    if found is None or found[1].partition(":")[0] not in _GOING or "for" in flat:
        return ()
    rest = words[found[0] :]
    goal = lexicon().goals.match(keys(rest)) or lexicon().places.match(keys(rest))
    return rest[goal[0] :] if goal is not None and goal[0] < len(rest) else rest
