"""How many of a group are meant, said at the end of a sentence: "check the doors for rust, all of them"."""

from __future__ import annotations

from collections.abc import Callable

from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.text import Phrase, Word, keys, singular

__all__ = ["with_how_many"]

_ENDS = frozenset({".", "!", "?", ";", "\n"})
_DEFINITE = frozenset({"the", "these", "those", "our", "my"})
_LONGEST_NOUN = 4


def with_how_many(words: Phrase, is_kind: Callable[[str], bool]) -> Phrase:
    """The message with "all of them" and "both" before what they count.

    Args:
        words: All words and punctuation.
        is_kind: Whether a word, in its base form, is what several things on the map are called.
    """
    flat = keys(words)
    for comma in range(len(flat) - 1, 1, -1):
        size = _tail(flat, comma + 1) if flat[comma] == "," else 0
        if not size:
            continue
        begin = next((i + 1 for i in range(comma - 1, -1, -1) if flat[i] in _ENDS), 0)
        at, end = _group(flat, begin, comma, is_kind)
        if end == comma or not end or flat[at - 1 : at] in {("all",), ("both",)}:
            return words
        count = "both" if flat[comma + 1] == "both" else "all"
        after = words[comma + 1 + size :]
        return with_how_many((*words[:at], Word(count, count), *words[at:comma], *after), is_kind)
    return words


def _tail(flat: tuple[str, ...], at: int) -> int:
    """How long "all of them", "all three", "both" at the end of a sentence is; 0 if none is there."""
    end = at
    if flat[at : at + 2] == ("every", "one"):
        end = at + 2
    elif flat[at : at + 1] in {("all",), ("both",), ("each",)}:
        end = at + 1 + (flat[at + 1 : at + 2] != () and flat[at + 1] in lexicon().numbers)
    if end > at and flat[end : end + 2] in {("of", "them"), ("of", "those"), ("of", "these")}:
        end += 2
    please = flat[end : end + 1] == ("please",)
    closes = end + please >= len(flat) or flat[end + please] in _ENDS
    return end - at if end > at and closes else 0


def _group(flat: tuple[str, ...], begin: int, stop: int, is_kind: Callable[[str], bool]) -> tuple[int, int]:
    """Where the first several things of a kind ("the doors") begin and end; (0, 0) if none are named."""
    for at in range(begin, stop):
        if flat[at] not in _DEFINITE:
            continue
        for end in range(at + 2, min(at + 2 + _LONGEST_NOUN, stop + 1)):
            last = flat[end - 1]
            if singular(last) != last and is_kind(singular(last)):
                return at, end
    return 0, 0
