"""Bare numbers and letters that stand for things of the map: "check 2 and 3", of zones 1 to 3."""

from __future__ import annotations

from collections.abc import Sequence

from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.text import Phrase, Word, keys, singular, tokens
from parley.world.object_map import MapObject

__all__ = ["with_kinds"]

_JOINTS = frozenset(
    {
        "and",
        ",",
        "or",
        "but",
        "then",
        "only",
        "just",
        "not",
        "both",
        "also",
        "first",
        "except",
        "to",
        "at",
        "in",
        "with",
        "from",
        "for",
    }
)
_BEHIND = frozenset(
    {
        ",",
        ".",
        "!",
        "?",
        ";",
        "and",
        "or",
        "but",
        "then",
        "first",
        "last",
        "too",
        "please",
        "is",
        "was",
        "has",
        "for",
        "as",
        "now",
        "instead",
        "next",
        "only",
        "later",
        "before",
        "after",
        "are",
        "were",
        "have",
        "can",
        "should",
        "must",
        "needs",
        "in",
        "so",
    }
)
_UNITS = frozenset(
    {
        "minutes",
        "minute",
        "seconds",
        "hours",
        "times",
        "metres",
        "meters",
        "percent",
        "o'clock",
        "pm",
        "am",
        "degrees",
    }
)


def with_kinds(words: Phrase, objects: Sequence[MapObject], spoken_of: Sequence[str]) -> Phrase:
    """A message in which each bare label has the noun of what it labels in front of it.

    Args:
        words: The message.
        objects: The map.
        spoken_of: What was said before, newest last, for labels that several kinds of things have.
    """
    labels = _labels(objects)
    if not labels:
        return words
    flat = keys(words)
    said = " ".join([*spoken_of, *flat]).lower()
    result: list[Word] = []
    for index, word in enumerate(words):
        kind = _kind(words, flat, index, labels, said)
        if kind:
            result += tokens(kind)
        result.append(word)
    return tuple(result)


def _labels(objects: Sequence[MapObject]) -> dict[str, set[str]]:
    """Each label and the nouns that it follows in descriptions."""
    result: dict[str, set[str]] = {}
    for item in objects:
        head, _, label = item.description.lower().rpartition(" ")
        if head and (label.isdigit() or (len(label) == 1 and label.isalpha())):
            result.setdefault(label, set()).add(head)
    return result


def _kind(words: Phrase, flat: tuple[str, ...], index: int, labels: dict[str, set[str]], said: str) -> str:
    """The noun that a bare label leaves out; empty if it is none or that cannot be told."""
    word = words[index]
    if word.key not in labels or not (word.key.isdigit() or word.raw.isupper()) or word.raw == "I":
        return ""
    behind = flat[index + 1] if index + 1 < len(flat) else "."
    if behind not in _BEHIND or behind in _UNITS:
        return ""
    before = flat[index - 1] if index else "."
    if any(_stands_before(flat, index, kind) for kinds in labels.values() for kind in kinds):
        return ""
    orders = lexicon().verbs.match(flat, index - 1) if index else None
    if not (
        before in _JOINTS or not words[max(index - 1, 0)].is_word or index == 0 or (orders and orders[0] == 1)
    ):
        return ""
    if (
        before in {"and", ",", "or", "to"}
        and index > 1
        and (flat[index - 2].isdigit() or len(flat[index - 2]) == 1)
    ):
        # "Zones 1 and 2": named together with the one before, unless that stood alone too.
        kinds = labels.get(flat[index - 2], set())
        named = any(_stands_before(flat, index - 2, kind) for kind in kinds | {f"{k}s" for k in kinds})
        if named or flat[index - 2] not in labels:
            return ""
    kinds = labels[word.key]
    if len(kinds) > 1:
        kinds = (
            {max(kinds, key=lambda kind: said.rfind(kind))} if any(kind in said for kind in kinds) else set()
        )
    return next(iter(kinds), "")


def _stands_before(flat: tuple[str, ...], at: int, kind: str) -> bool:
    words = tuple(singular(word) for word in kind.split())
    return tuple(singular(word) for word in flat[max(0, at - len(words)) : at]) == words
