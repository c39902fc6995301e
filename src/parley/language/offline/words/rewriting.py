"""Other words in the place of some, wherever a pattern is found in a message."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from parley.language.offline.words.text import Phrase, Word

__all__ = ["Found", "rewritten"]

Found = Callable[[int, Sequence[Word]], tuple[int, Phrase] | None]
"""What is found at a place, given what was written before it: how many words, and what stands for them."""


def rewritten(words: Phrase, found: Found) -> Phrase:
    """A message with other words wherever something is found, read once from left to right.

    Args:
        words: All words and punctuation.
        found: Tells what stands for the words at a place; None if nothing is found there, and the word stays.
    """
    result: list[Word] = []
    at = 0
    while at < len(words):
        size, instead = found(at, result) or (1, words[at : at + 1])
        result += instead
        at += size
    return tuple(result)
