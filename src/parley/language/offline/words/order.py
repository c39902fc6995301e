"""When something is due, as people say it: the one list for everything that reads an order of doing."""

from __future__ import annotations

from functools import cache

from parley.language.offline.words.lexicon import PhraseTable
from parley.language.word_lists import load_data, written_out

__all__ = ["due", "phrases_due"]


@cache
def phrases_due(*kinds: str) -> tuple[str, ...]:
    """All phrases of some kinds of `data/order.yaml`, written out."""
    data = load_data("order")
    return tuple(dict.fromkeys(p for kind in kinds for text in data[kind] for p in written_out(text)))


@cache
def due(*kinds: str) -> PhraseTable:
    """What says that something is due at such a time, as a table."""
    return PhraseTable.of(phrases_due(*kinds))
