"""Where things are taken from, in words that name two places."""

from __future__ import annotations

from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.text import Phrase, Word, keys

__all__ = ["from_off", "from_one_to_another"]


def from_off(words: Phrase) -> Phrase:
    """For "the milk out of the locker", "the keys off the shelf": from there."""
    flat = keys(words)
    for index in range(1, len(flat) - 1):
        size = next((len(way) for way in _OUT_OF if flat[index : index + len(way)] == way), 0)
        if size and index + size < len(flat) and (size > 1 or flat[index + 1] in lexicon().determiners):
            return (*words[:index], Word("from", "from"), *words[index + size :])
    return words


_OUT_OF = (("out", "of"), ("off", "of"), ("out", "from"), ("from", "out", "of"), ("from", "off"), ("off",))


def from_one_to_another(words: Phrase) -> tuple[Phrase, Phrase, Phrase] | None:
    """For "(put) the book that is on the desk on the shelf", "the cup from the table on the shelf"."""
    flat = keys(words)
    lex = lexicon()
    start = next((i for i in range(1, len(flat)) if flat[i] == "from"), 0)
    at = start + 1
    if not start:
        start = next((i for i in range(1, len(flat) - 1) if flat[i] in {"that", "which"}), 0)
        at = start + 1
        while start and at < len(flat) and flat[at] in lex.be | lex.location_verbs:
            at += 1
        found = lex.places.match(flat, at) if start and at > start + 1 else None
        if found is None:
            return None
        at += found[0]
    for index in range(at + 1, len(flat) - 1):
        to = lex.places.match(flat, index) or lex.goals.match(flat, index)
        if to is not None and flat[index] != "of" and index + to[0] < len(flat):
            return words[:start], words[at:index], words[index + to[0] :]
    return None
