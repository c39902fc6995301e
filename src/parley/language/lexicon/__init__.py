"""What is known of words: frames, verbs and closed word classes, as data with sentences that test them."""

from __future__ import annotations

from typing import Any

from parley.files import words_in

__all__ = ["load_data"]


def load_data(name: str) -> Any:
    """The content of one data file; see `words_in`."""
    return words_in(__name__, name)
