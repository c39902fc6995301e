"""Verbs that say nothing but that it is a stop's turn: "do the desk", "cover aisles 2 and 4 for dust"."""

from __future__ import annotations

from collections.abc import Callable

from parley.language.offline.facts.facts import strip_openers
from parley.language.offline.scene.marks import marks_of
from parley.language.offline.words.nouns import bare, coordinated
from parley.language.offline.words.text import Phrase, Word, keys

__all__ = ["as_stops"]

IsStop = Callable[[Phrase], bool]

_DOING = frozenset({"do", "cover", "tackle", "handle", "serve", "attend", "hit", "try", "use", "manage"})
_TAILS = frozenset(
    {
        "too",
        "also",
        "next",
        "now",
        "first",
        "last",
        "then",
        "please",
        "instead",
        "well",
        "as",
        "again",
        "today",
    }
)


_THROUGH = frozenset(
    tuple(text.split())
    for text in (
        "work through", "go through", "run through", "go round", "go around", "see to", "deal with",
        "attend to", "work your way through", "make your way through", "go over", "do a round of",
        "make a round of",
    )
)  # fmt: skip
_IN_TURN = (
    ("one", "by", "one"),
    ("one", "at", "a", "time"),
    ("in", "turn"),
    ("one", "after", "the", "other"),
)


def as_stops(words: Phrase, is_stop: IsStop) -> Phrase:
    """A clause with "visit" for such a verb, where what follows is known places and nothing else.

    With what is to be looked for there ("do the desk for dust") it is "check".
    """
    rest = strip_openers(words, requests=True)
    flat = keys(rest)
    size = next((len(verb) for verb in _THROUGH if flat[: len(verb)] == verb), 0)
    turn = next((m for m in _IN_TURN if flat[-len(m) :] == m), ())
    takes = flat[:1] == ("take",) and bool(turn or (len(flat) == 2 and marks_of(rest[1])))
    size = size or int(bool(flat) and (flat[0] in _DOING or takes))
    if not size or len(flat) <= size:
        return words
    named = rest[size : len(rest) - len(turn)]
    while named and (named[-1].key in _TAILS or not named[-1].is_word):
        named = named[:-1]
    if _are_stops(named, is_stop):
        return (Word("visit", "visit"), *named) if turn else (Word("visit", "visit"), *rest[size:])
    sought = next((i for i in range(1, len(named) - 1) if named[i].key == "for"), 0)
    if sought and named[sought + 1].key not in _NOT_SOUGHT and _are_stops(named[:sought], is_stop):
        return (Word("check", "check"), *rest[size:])
    return words


def _are_stops(words: Phrase, is_stop: IsStop) -> bool:
    listed = [bare(part) for part in coordinated(words)]
    return bool(listed) and all(is_stop(part) for part in listed)


_NOT_SOUGHT = frozenset({"me", "us", "now", "today", "a", "an", "him", "her", "them", "once", "later"})
