"""Where somebody has put what was just spoken of ("A is not in B any more, I put it in C"): told plainly."""

from __future__ import annotations

from typing import Final

from parley.language.offline.words.text import Phrase, Word, keys

__all__ = ["where_it_was_put"]

_WHO: Final = frozenset({"i", "we", "he", "she", "they", "somebody", "someone"})
_PUT: Final = frozenset({"put", "left", "moved", "placed", "brought", "took", "stored", "carried"})
_IT: Final = {"it": "is", "them": "are"}
_WHERE: Final = {
    "in": "in", "into": "in", "to": "in", "inside": "in", "on": "on", "onto": "on", "at": "at",
    "under": "under", "behind": "behind", "beside": "beside", "near": "near",
}  # fmt: skip
_BE: Final = frozenset({"is", "are", "was", "were"})


def where_it_was_put(words: Phrase) -> Phrase:
    """The same message with "I put it in C" said as "A is in C", where A is what its sentence is about."""
    flat = keys(words)
    for at in range(1, len(flat) - 3):
        who, put, what, where = flat[at : at + 4]
        if who not in _WHO or put not in _PUT or what not in _IT or where not in _WHERE:
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
