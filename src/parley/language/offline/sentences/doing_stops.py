"""Verbs that say nothing but that it is a stop's turn: "do the desk", "cover aisles 2 and 4"."""

from __future__ import annotations

from collections.abc import Callable

from parley.language.offline.facts.facts import strip_openers
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


def as_stops(words: Phrase, is_stop: IsStop) -> Phrase:
    """A clause with "visit" for such a verb, where what follows is known places and nothing else."""
    rest = strip_openers(words, requests=True)
    flat = keys(rest)
    if len(flat) < 2 or flat[0] not in _DOING:
        return words
    named = rest[1:]
    while named and (named[-1].key in _TAILS or not named[-1].is_word):
        named = named[:-1]
    listed = [bare(part) for part in coordinated(named)]
    if not listed or not all(is_stop(part) for part in listed):
        return words
    return (Word("visit", "visit"), *rest[1:])
