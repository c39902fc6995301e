"""Reports of what is missing, mislaid, or was left somewhere by nobody knows whom."""

from __future__ import annotations

from parley.language.offline.facts.remembering import find_fact
from parley.language.offline.scene.report_words import (
    TELLERS,
    after_lead,
    follows_preposition,
    phrase_of,
    phrases_for,
    place_named,
    words_for,
)
from parley.language.offline.scene.scene import Scene
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.nouns import bare
from parley.language.offline.words.text import Phrase, keys

__all__ = ["left_by_somebody", "missing_at", "missing_from"]


def missing_at(flat: tuple[str, ...]) -> tuple[int, int]:
    """Where words for what is missing stand, and how many; (0, 0) if nowhere."""
    for index in range(1, len(flat)):
        found = phrases_for("missing").match(flat, index)
        if found is not None:
            return index, found[0]
    return 0, 0


def missing_from(words: Phrase, scene: Scene) -> Phrase | None:
    """For "the box never arrived at A", "the box is nowhere to be found", "nobody can find the box"."""
    flat = keys(words)
    own = _mislaid(words, scene)
    if own is not None:
        return own
    at, size = missing_at(flat)
    if not at:
        return _nobody_finds(words)
    while at > 1 and flat[at - 1] in lexicon().be | {"has", "have", "had", "seems", "seem"}:
        at, size = at - 1, size + 1
    subject = bare(words[:at])
    if not subject or any(not word.is_word for word in subject) or flat[0] in TELLERS | {"it", "you", "that"}:
        return None
    rest = words[at + size :]
    if scene.is_person(subject) and "missing" not in flat[at : at + size] and not place_named(rest, scene):
        return None
    named = place_named(subject, scene) if scene.ground(subject).outcome != "match" else None
    if named is not None and not rest and follows_preposition(keys(subject), named[0]):
        # "A patient in ward 3 is missing".
        cut = next((i for i in range(1, named[0]) if lexicon().places.match(keys(subject), i)), 0)
        if cut:
            place = bare(subject[named[0] : named[1]])
            return phrase_of("inspect the", place, "for the", bare(subject[:cut]))
    where = place_named(rest, scene) if rest else None
    if where is not None:
        return phrase_of("inspect the", bare(rest[where[0] : where[1]]), "for the", subject)
    known = find_fact(subject, scene.facts)[0] is not None or scene.ground(subject).outcome != "none"
    if not known and not _LOST & set(flat[at : at + size]):
        return None
    return phrase_of("look for the", subject)


_LOST = frozenset({"disappeared", "vanished", "stolen", "astray", "missing", "gone", "lost", "nowhere"})
_LEAVING = frozenset(
    {
        "put",
        "left",
        "dropped",
        "dumped",
        "placed",
        "parked",
        "abandoned",
        "threw",
        "spilled",
        "hung",
        "forgot",
        "deposited",
        "poured",
        "tipped",
        "leaned",
    }
)


def left_by_somebody(words: Phrase, scene: Scene) -> Phrase | None:
    """The order that "somebody put a bag in A" means; None if a clause says no such thing.

    Args:
        words: One clause, without punctuation.
        scene: What is known.
    """
    flat = keys(words)
    at = next((i for i in range(1, min(5, len(flat))) if flat[i] in _LEAVING), 0)
    if (
        not at
        or flat[0] not in {"somebody", "someone", "people", "they", "kids", "children", "a", "an"}
        or len(flat) < at + 4
    ):
        return None
    if flat[at + 1] not in {"a", "an", "some", "their", "his", "her", "two", "three", "several", "what"}:
        return None
    where = place_named(words[at + 1 :], scene)
    if where is None or not follows_preposition(keys(words[at + 1 :]), where[0]):
        return None
    rest = words[at + 1 :]
    end = next((i for i in range(1, where[0]) if lexicon().places.match(keys(rest), i)), where[0])
    return phrase_of("inspect the", bare(rest[where[0] : where[1]]), "for", rest[:end])


def _mislaid(words: Phrase, scene: Scene) -> Phrase | None:
    """For "we are missing a box from A", "I think I left my coat at A", "I can not find the key"."""
    flat = keys(words)
    if flat[:1] not in {("i",), ("we",)}:
        return None
    guessed = bool(_GUESSED & set(flat[:5]))
    rest = after_lead(words, "sought", *(("let_go",) if guessed else ()))
    while keys(rest[-1:]) in _NO_PLACE or (rest and not rest[-1].is_word):
        rest = rest[:-1]
    if len(rest) < 1 or set(keys(rest[:1])) & {
        "that",
        "to",
        "it",
        "you",
        "them",
        "him",
        "her",
        "what",
        "why",
    }:
        return None
    where = place_named(rest, scene)
    if where is not None and _belongs(keys(rest), where[0]):
        # "The key to A": what it is called.
        where = None
    if where is None:
        short = len(rest) < 8 and not guessed and not lexicon().be & set(keys(rest))
        return phrase_of("look for", rest) if short else None
    at = next(
        (
            i
            for i in range(1, where[0])
            if lexicon().places.match(keys(rest), i) or rest[i].key in {"from", "somewhere"}
        ),
        where[0],
    )
    what = rest[:at]
    while len(what) > 2 and what[-1].key in words_for("left"):
        # "I think I left the tap running in A": the tap.
        what = what[:-1]
    named = set(keys(what)) - lexicon().determiners
    return phrase_of("inspect the", bare(rest[where[0] : where[1]]), "for", what) if named else None


_NO_PLACE = frozenset({("anywhere",), ("somewhere",), ("any", "more"), ("anymore",), ("again",)})


def _belongs(flat: tuple[str, ...], at: int) -> bool:
    """Whether "to the" or "of the" stands before a word."""
    while at and flat[at - 1] in lexicon().determiners:
        at -= 1
    return at > 1 and flat[at - 1] in {"to", "of", "for"}


_GUESSED = frozenset(
    {"think", "must", "may", "might", "believe", "seem", "probably", "guess", "suspect", "fear"}
)


def _nobody_finds(words: Phrase) -> Phrase | None:
    flat = keys(words)
    if flat[:1] != ("nobody",) or flat[1:3] not in {
        ("can", "find"),
        ("could", "find"),
        ("has", "seen"),
        ("knows", "where"),
    }:
        return None
    rest = bare(tuple(word for word in words[3:] if word.key not in lexicon().be))
    return phrase_of("look for the", rest) if rest else None
