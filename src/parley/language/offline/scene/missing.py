"""Reports of what is missing, mislaid, or was left somewhere by nobody knows whom."""

from __future__ import annotations

from functools import cache

from parley.language.offline.facts.remembering import find_fact
from parley.language.offline.scene.report_words import TELLERS, follows_preposition, phrase_of, place_named
from parley.language.offline.scene.scene import Scene
from parley.language.offline.words.lexicon import PhraseTable, lexicon
from parley.language.offline.words.nouns import bare
from parley.language.offline.words.text import Phrase, keys
from parley.language.word_lists import load_data

__all__ = ["left_by_somebody", "missing_at", "missing_from"]


@cache
def _missing_table() -> PhraseTable:
    return PhraseTable.of(load_data("incidents")["missing"])


def missing_at(flat: tuple[str, ...]) -> tuple[int, int]:
    """Where words for what is missing stand, and how many; (0, 0) if nowhere."""
    for index in range(1, len(flat)):
        found = _missing_table().match(flat, index)
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
    subject = bare(words[:at])
    if not subject or any(not word.is_word for word in subject) or flat[0] in TELLERS | {"it", "you", "that"}:
        return None
    if scene.is_person(subject) and "missing" not in flat[at : at + size]:
        return None
    rest = words[at + size :]
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
    if find_fact(subject, scene.facts)[0] is None and scene.ground(subject).outcome == "none":
        return None
    return phrase_of("look for the", subject)


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


_MISLAID = (
    ("we", "are", "missing"),
    ("i", "am", "missing"),
    ("we", "miss"),
    ("i", "miss"),
    ("we", "can", "not", "find"),
    ("i", "can", "not", "find"),
    ("i", "think", "i", "left"),
    ("i", "think", "i", "lost"),
    ("i", "think", "i", "forgot"),
    ("i", "must", "have", "left"),
    ("i", "may", "have", "left"),
    ("i", "might", "have", "left"),
    ("i", "must", "have", "lost"),
    ("i", "must", "have", "dropped"),
    ("i", "may", "have", "lost"),
    ("i", "might", "have", "lost"),
    ("i", "believe", "i", "left"),
    ("i", "seem", "to", "have", "left"),
    ("i", "think", "i", "dropped"),
    ("i", "may", "have", "dropped"),
    ("i", "might", "have", "dropped"),
    ("i", "may", "have", "forgotten"),
    ("i", "must", "have", "forgotten"),
    ("i", "probably", "left"),
    ("i", "probably", "lost"),
    ("we", "lost"),
    ("i", "lost"),
    ("i", "have", "lost"),
    ("we", "have", "lost"),
    ("i", "think", "i", "have", "left"),
    ("we", "think", "we", "left"),
)


def _mislaid(words: Phrase, scene: Scene) -> Phrase | None:
    """For "we are missing a box from A", "I think I left my coat at A"."""
    flat = keys(words)
    lead = next((lead for lead in _MISLAID if flat[: len(lead)] == lead), ())
    where = place_named(words[len(lead) :], scene) if lead else None
    if where is None:
        return None
    rest = words[len(lead) :]
    at = next(
        (
            i
            for i in range(1, where[0])
            if lexicon().places.match(keys(rest), i) or rest[i].key in {"from", "somewhere"}
        ),
        where[0],
    )
    what = rest[:at]
    return phrase_of("inspect the", bare(rest[where[0] : where[1]]), "for", what) if bare(what) else None


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
