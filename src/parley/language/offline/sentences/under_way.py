"""Stops on the way: "stop at A on your way to B" and "on your way to B, V" are A or V first, and B then."""

from __future__ import annotations

from parley.language.offline.sentences.clauses import opens_command
from parley.language.offline.words.text import Phrase, Word, keys, tokens

__all__ = ["under_way"]

_WAYS = (
    *(("on", whose, "way", *over, "to") for whose in ("your", "the") for over in ((), ("over",), ("back",))),
    ("en", "route", "to"),
)
_MARKS = frozenset({".", "!", "?", ";", "\n"})
_OTHERWISE = frozenset(
    {"not", "never", "without", "if", "unless", "when", "while", "until", "he", "she", "they", "i", "we"}
)


def under_way(words: Phrase) -> Phrase:
    """The message with stops on the way before what lies behind them.

    Args:
        words: All words and punctuation.
    """
    result: list[Word] = []
    start = 0
    for index in range(len(words) + 1):
        if index < len(words) and words[index].key not in _MARKS:
            continue
        result += (*_turned(words[start:index]), *words[index : index + 1])
        start = index + 1
    return tuple(result)


def _turned(sentence: Phrase) -> Phrase:
    flat = keys(sentence)
    for at in range(len(flat) - 2):
        size = next((len(way) for way in _WAYS if flat[at : at + len(way)] == way), 0)
        if not size or _OTHERWISE & set(flat):
            continue
        behind = sentence[at + size :]
        if at and opens_command(sentence[:at]):
            return (*sentence[: at - (flat[at - 1] == ",")], *tokens(", then go to"), *behind)
        comma = next((i for i in range(1, len(behind)) if behind[i].key == ","), 0)
        if not at and comma and opens_command(behind[comma + 1 :]):
            return (*behind[comma + 1 :], *tokens(", then go to"), *behind[:comma])
    return sentence
