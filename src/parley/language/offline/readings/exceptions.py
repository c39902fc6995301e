"""Exceptions that nothing tells: "all rooms but the one with the piano", where nobody knows which that is.

What is to be left out must not be done: who does not know what that is asks.
"""

from __future__ import annotations

from typing import Final

from parley.language.offline.scene.group_words import exception_at
from parley.language.offline.scene.grouping import grouped
from parley.language.offline.scene.marks import marks_of
from parley.language.offline.scene.scene import Scene
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.nouns import coordinated
from parley.language.offline.words.text import Phrase, keys, tokens

__all__ = ["unknown_exception", "with_answer"]

_ALL: Final = frozenset({"all", "every", "each", "any", "both", "everything", "everywhere"})
_ONES: Final = frozenset({"one", "ones"})


def unknown_exception(words: Phrase) -> tuple[int, int] | None:
    """Where an exception stands that is still a description, once all that is known has been named.

    Args:
        words: All words and punctuation, groups put together.
    """
    flat = keys(words)
    for at in range(1, len(flat) - 3):
        start = at + exception_at(flat, at)
        if start == at or flat[at] == "," or not _ALL & set(flat[:at]):
            continue
        if flat[start : start + 1] == ("the",) and flat[start + 1 : start + 2] and flat[start + 1] in _ONES:
            end = next((i for i in range(start + 2, len(flat)) if not words[i].is_word), len(flat))
            if end > start + 3 or (end > start + 2 and flat[start + 2] not in lexicon().be):
                return start, end
    return None


def with_answer(words: Phrase, hints: list[str], scene: Scene) -> Phrase:
    """The words with the answers to questions about them in the place of what was asked about.

    That is an exception that nothing tells, or a kind of thing of which the answer means some ("all but A").
    """
    place = unknown_exception(words)
    answer = next((tokens(hint) for hint in hints if scene.ground(tokens(hint)).outcome == "match"), ())
    if place is not None and answer:
        return (*words[: place[0]], *answer, *words[place[1] :])
    for hint in hints:
        said = tokens(hint)
        if exception_at(keys(said), 0) and (kind := _kind_of(words, set(), scene)) is not None:
            said = (*words[kind[0] : kind[1]], *said)
        several: Phrase = next(((word,) for word in grouped(said, scene) if marks_of(word)), ())
        meant = set(marks_of(several[0])) if several else set()
        if not several:
            several, meant = tokens(hint), _listed(tokens(hint), scene)
        span = _kind_of(words, meant, scene) if meant else None
        if span is not None:
            return (*words[: span[0]], *several, *words[span[1] :])
    return words


def _listed(words: Phrase, scene: Scene) -> set[str]:
    """The things that "A, B and C" are; empty if that is no such list."""
    found = [scene.ground(part) for part in coordinated(words)]
    whole = len(found) > 1 and all(one.outcome == "match" for one in found)
    return {one.candidates[0].id for one in found} if whole else set()


def _kind_of(words: Phrase, meant: set[str], scene: Scene) -> tuple[int, int] | None:
    """Where words name a kind of thing that all of these belong to."""
    for start in range(len(words)):
        for end in range(min(len(words), start + _LONGEST_KIND), start, -1):
            if not words[end - 1].is_word or (start and not words[start].is_word):
                continue
            found = scene.ground(words[start:end])
            if found.outcome == "ambiguous" and meant <= {item.id for item in found.candidates}:
                return start, end
    return None


_LONGEST_KIND = 5
