"""What was moved or is to be: where something was put ("I put it in C"), what is to get out of the way."""

from __future__ import annotations

from typing import Final

from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.text import Phrase, Word, keys

__all__ = ["out_of_the_way", "what_was_left", "where_it_was_put"]

_WHO: Final = frozenset({"i", "we", "he", "she", "they", "somebody", "someone"})
_PUT: Final = frozenset({"put", "left", "moved", "placed", "brought", "took", "stored", "carried"})
_IT: Final = {"it": "is", "them": "are"}
_WHERE: Final = {
    "in": "in", "into": "in", "to": "in", "inside": "in", "on": "on", "onto": "on", "at": "at",
    "under": "under", "behind": "behind", "beside": "beside", "near": "near",
}  # fmt: skip
_BE: Final = frozenset({"is", "are", "was", "were"})


_THEIRS: Final = {"his": "'s", "her": "'s", "their": "'s"}
_LEFT: Final = frozenset({"left", "forgotten", "forgot", "put"})
_AGAIN: Final = frozenset({"on", "in", "at", "under", "behind", "inside", "by", "near"})


def what_was_left(words: Phrase) -> Phrase:
    """The same message with "A has left her B on C" said as "A's B is on C"."""
    flat = keys(words)
    for at in range(1, len(flat) - 3):
        put = at + (flat[at] in {"has", "had"})
        if flat[put] not in _LEFT or flat[put + 1 : put + 2] not in {(word,) for word in _THEIRS}:
            continue
        start = next((i + 1 for i in range(at - 1, -1, -1) if not words[i].is_word or flat[i] in _JOINTS), 0)
        who = words[start:at]
        thing = put + 2
        where = next((i for i in range(thing + 1, min(thing + 4, len(flat))) if flat[i] in _AGAIN), 0)
        named = (
            0 < len(who) < 4
            and not _NOBODY_KNOWN & set(keys(who))
            and (who[-1].is_capital or flat[start] in {"the", "a", "my", "our"})
        )
        if not where or not named or where + 1 >= len(flat):
            continue
        owner = (*who[:-1], Word(f"{who[-1].key}'s", f"{who[-1].raw}'s"))
        be = "are" if flat[where - 1].endswith("s") and not flat[where - 1].endswith("ss") else "is"
        return (*words[:start], *owner, *words[thing:where], Word(be, be), *words[where:])
    return words


_NOBODY_KNOWN: Final = frozenset({"someone", "somebody", "people", "they", "everybody", "kids"})
_JOINTS: Final = frozenset({"and", "but", "so", "because", "since", "that"})


def where_it_was_put(words: Phrase) -> Phrase:
    """The same message with "I put it in C" said as "A is in C", where A is what its sentence is about."""
    flat = keys(words)
    for at in range(1, len(flat) - 3):
        who, put, what, where = flat[at : at + 4]
        named = words[at].is_capital and (not words[at - 1].is_word or words[at - 1].key in _JOINTS)
        if not (who in _WHO or named) or put not in _PUT or what not in _IT or where not in _WHERE:
            continue
        before = at - 1 if flat[at - 1] in {"and", "but", "because", "since"} else at
        mark = before - 1 if before and flat[before - 1] in {",", ";", "."} else before
        start = next((i + 1 for i in range(mark - 1, -1, -1) if flat[i] in {".", "!", "?", ";"}), 0)
        be = next((i for i in range(start + 1, mark) if flat[i] in _BE), None)
        if be is None or flat[start] in _WHO | {"it", "they", "this", "that", "there"}:
            continue
        told = (
            Word(".", "."),
            *words[start:be],
            Word(_IT[what], _IT[what]),
            Word(_WHERE[where], _WHERE[where]),
        )
        return (*words[:mark], *told, *words[at + 4 :])
    return words


_SHIFTING: Final = frozenset({"move", "drive", "get", "take"})
_STEPPING: Final = frozenset({"go", "move", "drive", "get", "step", "back", "come", "roll"})
_AWAY: Final = tuple(
    tuple(text.split())
    for text in ("out of the way", "aside", "away", "to the side", "to one side", "over a bit", "back a bit")
)
_MARKS: Final = frozenset({".", "!", "?", ";", ",", "\n", "and", "then"})


def out_of_the_way(words: Phrase, deeds: frozenset[str]) -> Phrase:
    """A message in which nobody is sent to what is to be moved, or to what is to be left.

    "Move the van out of the way" shifts it, "move away from the van" and "get out of the way" only go: where
    to is asked.

    Args:
        words: All words and punctuation.
        deeds: First words of what robots do besides going about.
    """
    flat = keys(words)
    for at in range(len(flat)):
        if at and flat[at - 1] not in _MARKS | {"please", "you"}:
            continue
        end = next((i for i in range(at, len(flat)) if flat[i] in _MARKS), len(flat))
        said = flat[at + 1 + (flat[at + 1 : at + 2] == ("yourself",)) : end]
        leaves = said[:2] == ("away", "from") or (said[:2] == ("out", "of") and said[-1] == "way")
        if flat[at] in _STEPPING and leaves:
            return (*words[:at], Word("go", "go"), *words[end:])
        named = said[:1] and said[0] in lexicon().determiners | {"it", "them"}
        away = named and any(said[-len(one) :] == one for one in _AWAY)
        if away and flat[at] in _SHIFTING - deeds:
            return (*words[:at], Word("shift", "shift"), *words[at + 1 :])
    return words
