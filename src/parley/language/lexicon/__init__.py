"""What is known of words: frames, verbs and closed word classes, as data with sentences that test them."""

from __future__ import annotations

from typing import Any

from parley.files import words_in

__all__ = ["load_data", "word_map", "word_set"]


def load_data(name: str) -> Any:
    """The content of one data file; see `words_in`."""
    return words_in(__name__, name)


def word_set(text: str) -> frozenset[str]:
    """A closed class of words, written with blanks between them."""
    return frozenset(text.split())


def word_map(text: str) -> dict[str, str]:
    """What each word stands for, written as ``took:take``, with blanks between them."""
    return {word: meant for word, _, meant in (pair.partition(":") for pair in text.split())}
