"""What has to be done first, in the passive: "once A has been checked, V" is "check A, then V"."""

from __future__ import annotations

from collections.abc import Callable

from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.text import Phrase, Word, keys, lemma

__all__ = ["done_first"]

IsStop = Callable[[Phrase], bool]
Opens = Callable[[Phrase], bool]

_WHEN = (
    ("only", "once"), ("only", "after"), ("only", "when"), ("as", "soon", "as"), ("not", "before"),
    ("not", "until"), ("once",), ("after",), ("when",),
)  # fmt: skip
_LINKS = frozenset(
    {"has", "have", "had", "is", "are", "was", "were", "been", "being", "all", "both", "fully", "properly"}
)
_KINDS = frozenset(
    {"look", "motion", "whether", "search", "transfer", "grasp", "count", "other", "catalogue"}
)
_MARKS = frozenset({".", "!", "?", ";", "\n"})
_LONGEST = 16
_THEN = (Word(",", ","), Word("then", "then"))


def done_first(words: Phrase, is_stop: IsStop, opens: Opens) -> Phrase:
    """The same message with such a condition as an order that comes first.

    Args:
        words: All words and punctuation.
        is_stop: Whether words name one thing on the map.
        opens: Whether a command begins with these words.
    """
    flat = keys(words)
    for index in range(len(flat)):
        marker = next((m for m in _WHEN if flat[index : index + len(m)] == m), ())
        at = index + len(marker)
        if not marker or flat[at : at + 1] in {("you",), ("that",), ("it",), ("this",), ("i",)}:
            continue
        found = _passive(words, at, is_stop)
        if found is None:
            continue
        order, end = found
        start = next((i + 1 for i in range(index - 1, -1, -1) if flat[i] in _MARKS), 0)
        before, after = words[start:index], words[end:]
        while after and after[0].key in {",", "then"}:
            after = after[1:]
        if opens(after):
            return (*words[:index], *order, *_THEN, *done_first(after, is_stop, opens))
        if opens(before) and (not after or after[0].key in _MARKS):
            return (*words[:start], *order, *_THEN, *_ended(before), *after)
    return words


def _ended(words: Phrase) -> Phrase:
    while words and (not words[-1].is_word or words[-1].key in {"but", "and"}):
        words = words[:-1]
    return words


def _passive(words: Phrase, start: int, is_stop: IsStop) -> tuple[Phrase, int] | None:
    """The order in "A and B have been checked", and where it ends."""
    flat = keys(words)
    stop = min(len(flat), start + _LONGEST)
    link = next((i for i in range(start + 1, stop) if flat[i] in _LINKS - {"all", "both"}), 0)
    if not link or any(flat[i] in _MARKS for i in range(start, link)):
        return None
    subject = words[start:link]
    named = any(
        is_stop(subject[a:b]) for a in range(len(subject)) for b in range(a + 1, min(len(subject), a + 6) + 1)
    )
    at = link
    while at < stop and flat[at] in _LINKS:
        at += 1
    if not named or at >= len(flat):
        return None
    verb = lemma(flat[at])
    found = lexicon().verbs.match((verb, *flat[at + 1 :]))
    if found is None or verb == flat[at] or found[1].partition(":")[0] not in _KINDS or verb in {"do", "be"}:
        return None
    end = at + found[0]
    return (Word(verb, verb), *words[at + 1 : end], *subject), end
