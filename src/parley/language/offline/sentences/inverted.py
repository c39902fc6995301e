"""Questions that only their order of words shows: "is the gate open"."""

from __future__ import annotations

from parley.language.offline.facts.facts import strip_openers
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.text import Phrase, keys

__all__ = ["asks"]

_ASKED_OF_OTHERS = frozenset({"i", "we", "they", "he", "she", "it", "anybody", "anyone", "somebody", "there"})
_HELPING = frozenset({"do", "have", "can", "could", "may", "should", "shall", "must", "will", "would"})


def asks(words: Phrase) -> bool:
    """Whether a clause without a question mark has words in an order that only questions have.

    Args:
        words: One clause.
    """
    flat = keys(strip_openers(words))
    if len(flat) < 3:
        return False
    if flat[0] in {"is", "are", "was", "were", "am", "has", "does", "did"}:
        return flat[1] not in {"to", "by", "been", "being"}
    if flat[1] == "we" and flat[0] in {"can", "could", "shall", "would"}:
        return False
    return (
        lexicon().wants.match(flat) is None
        and flat[0] in _HELPING
        and (
            flat[1] in _ASKED_OF_OTHERS
            or (flat[:2] in {("do", "you"), ("have", "you")} and flat[2] != "mind")
        )
    )
