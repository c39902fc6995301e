"""What is wanted in the passive as an order: "(if) A were checked", "(could) the B be brought to C"."""

from __future__ import annotations

from collections.abc import Callable

from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.text import Phrase, Word, keys, lemma

__all__ = ["KINDS", "base_forms", "in_active"]

IsStop = Callable[[Phrase], bool]

KINDS = frozenset({
    "motion", "look", "whether", "search", "transfer", "grasp", "speak", "follow", "meet", "count",
    "guide", "place", "back",
})  # fmt: skip
"""Kinds of orders that people wish for."""
_ANYBODY = frozenset({"somebody", "someone", "anybody", "anyone", "you", "the", "a", "one"})
_LINKING = frozenset({
    "be", "been", "was", "were", "is", "are", "get", "gets", "got", "could", "would", "should", "can",
    "to", "ought", "must", "will", "soon", "really", "perhaps", "maybe", "please", "quickly", "also",
    "now", "has", "have", "needs", "being", "not", "might", "may", "had", "kindly", "possibly",
})  # fmt: skip
_PASSIVE = frozenset({"be", "been", "was", "were", "is", "get", "gets", "got", "are", "being"})
_NO_SUBJECTS = frozenset({
    "i", "you", "we", "he", "she", "they", "it", "there", "that", "this", "who", "what", "to", "everything",
    "nothing", "nobody", "somebody", "someone", "not", "and", "or", "if", "whether", "how",
})  # fmt: skip
_NOT_DONE = frozenset({
    "do", "go", "be", "have", "worry", "interest", "tire", "finish", "suppose", "allow", "use", "bore",
    "excuse", "please", "trust", "see", "hear", "find", "understand", "surprise", "gone", "lose", "close",
    "shut", "need", "know", "say", "tell",
})  # fmt: skip
_LONGEST_STOP = 6
_LONGEST_SUBJECT = 8


def in_active(
    words: Phrase, is_stop: IsStop, *, getting: bool = False, wished: bool = False
) -> Phrase | None:
    """The order in words that say in the passive what is wanted; None if they do not.

    Args:
        words: What is wanted, from its subject on.
        is_stop: Whether words name something that is known.
        getting: Whether "have" or the like stands before: "the desk inspected".
        wished: Whether it is plain that it is wanted, so that anything may be done to anything.
    """
    flat = keys(words)
    known = _stop_end(words, is_stop)
    end = known or (_subject_end(flat) if wished else _done_at(flat) if getting else 0)
    at = end
    while at < len(flat) and flat[at] in _LINKING:
        at += 1
    if not end or at >= len(flat) or (at == end and not getting) or "not" in flat[end:at]:
        return None
    verb = base_forms(flat[at])[0] if wished or getting else lemma(flat[at])
    found = lexicon().verbs.match((verb, *flat[at + 1 :]))
    usual = found is not None and found[1].partition(":")[0] in KINDS
    free = wished or getting
    if verb == flat[at] or not (usual or (free and verb not in _NOT_DONE)):
        return None
    if at > end and not _PASSIVE & set(flat[end:at]):
        return None
    size = found[0] if found is not None else 1
    size -= size > 1 and flat[at + size - 1] in {"for", "to", "into", "from"} and at + size < len(flat)
    tail = words[at + size :]
    if keys(tail[:1]) == ("by",) and keys(tail[1:2]) and keys(tail)[1] in _ANYBODY:
        tail = tail[2:]
    return (Word(verb, verb), *words[at + 1 : at + size], *words[:end], *tail)


def base_forms(word: str) -> tuple[str, ...]:
    """The verbs of which a word may be a form ("aired", "scraping"), the likeliest first."""
    base = lemma(word)
    suffix = next((ending for ending in ("ing", "ed") if word.endswith(ending)), "")
    stem = word[: -len(suffix)] if suffix else ""
    if base != word or len(stem) < _SHORTEST_STEM or not _VOWELS & set(stem):
        return (base,)
    if stem[-1] == stem[-2]:
        return stem[:-1], stem
    short = stem[-1] not in _VOWELS and stem[-2] in _VOWELS and stem[-3:-2] not in _VOWELS
    return (f"{stem}e", stem) if short else (stem, f"{stem}e")


_SHORTEST_STEM = 3
_VOWELS = frozenset("aeiouy")


def _done_at(flat: tuple[str, ...]) -> int:
    """Where "delivered" stands in "(I would like) towels delivered to A"; 0 if nowhere."""
    for index in range(1, min(_LONGEST_STOP, len(flat))):
        base = lemma(flat[index])
        past = base != flat[index] and not flat[index].endswith(("s", "ing"))
        if past and base not in _NOT_DONE and lexicon().verbs.match((base, *flat[index + 1 :])) is not None:
            return 0 if (_NO_SUBJECTS | _PASSIVE) & set(flat[:index]) else index
    return 0


def _stop_end(words: Phrase, is_stop: IsStop) -> int:
    sizes = range(min(_LONGEST_STOP, len(words)), 0, -1)
    return next((size for size in sizes if is_stop(words[:size])), 0)


def _subject_end(flat: tuple[str, ...]) -> int:
    """Where the name of something that is not on the map ends, right before a form of "be"."""
    end = next((i for i in range(1, min(_LONGEST_SUBJECT, len(flat))) if flat[i] in _PASSIVE), 0)
    while end > 1 and flat[end - 1] in _LINKING:
        end -= 1
    plain = all(key.isalnum() or "'" in key or "-" in key for key in flat[:end])
    return end if end and plain and not _NO_SUBJECTS & set(flat[:end]) else 0
