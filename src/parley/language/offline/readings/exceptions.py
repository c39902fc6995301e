"""Exceptions that nothing tells: "all rooms but the one with the piano", where nobody knows which that is.

What is to be left out must not be done: who does not know what that is asks.
"""

from __future__ import annotations

from typing import Final

from parley.language.offline.scene.scene import Scene
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.text import Phrase, keys, tokens

__all__ = ["unknown_exception", "with_answer"]

_BUT: Final = tuple(
    tuple(text.split())
    for text in (
        "except for", "apart from", "aside from", "other than", "with the exception of", "save for",
        "but not", "but for", "except", "excluding", "but", "save", "besides", "bar", "minus",
    )
)  # fmt: skip
_ALL: Final = frozenset({"all", "every", "each", "any", "both", "everything", "everywhere"})
_ONES: Final = frozenset({"one", "ones"})


def unknown_exception(words: Phrase) -> tuple[int, int] | None:
    """Where an exception stands that is still a description, once all that is known has been named.

    Args:
        words: All words and punctuation, groups put together.
    """
    flat = keys(words)
    for at in range(1, len(flat) - 3):
        lead = next((lead for lead in _BUT if flat[at : at + len(lead)] == lead), ())
        start = at + len(lead)
        if not lead or not _ALL & set(flat[:at]):
            continue
        if flat[start : start + 1] == ("the",) and flat[start + 1 : start + 2] and flat[start + 1] in _ONES:
            end = next((i for i in range(start + 2, len(flat)) if not words[i].is_word), len(flat))
            if end > start + 3 or (end > start + 2 and flat[start + 2] not in lexicon().be):
                return start, end
    return None


def with_answer(words: Phrase, hints: list[str], scene: Scene) -> Phrase:
    """The words with the answer to the question in the place of an exception that nothing tells."""
    place = unknown_exception(words)
    answer = next((tokens(hint) for hint in hints if scene.ground(tokens(hint)).outcome == "match"), ())
    return (*words[: place[0]], *answer, *words[place[1] :]) if place is not None and answer else words
