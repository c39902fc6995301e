"""Bare numbers, letters and describing words for things of the map: "check 2 and 3", of zones 1 to 3.

"The north gate, not the south one", "chemistry and physics" of labs: the noun is that of what was spoken of.
"""

from __future__ import annotations

from collections.abc import Sequence

from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.text import Phrase, Word, keys, singular, tokens
from parley.world.object_map import MapObject

__all__ = ["with_heads", "with_kinds"]

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
            result = result[:-1] if flat[index - 1 : index] == ("number",) else result
            result += tokens(kind)
        result.append(word)
    return tuple(result)


def with_heads(words: Phrase, objects: Sequence[MapObject], spoken_of: Sequence[str]) -> Phrase:
    """A message in which "the south one" and "physics" have the noun that was said before.

    Args:
        words: The message.
        objects: The map.
        spoken_of: What was said before, newest last.
    """
    described = _described(objects)
    flat = keys(words)
    if not described.keys() & set(flat):
        return words
    heard = {singular(key) for text in spoken_of for key in keys(tokens(text.lower()))}
    result: list[Word] = []
    skip = -1
    for index, word in enumerate(words):
        if index <= skip:
            continue
        said = heard | {singular(key) for key in flat[:index]}
        head = _head(flat, index, described, said)
        result.append(word)
        if head:
            skip = index + (flat[index + 1 : index + 2] == ("one",))
            result.append(Word(head, head))
    return tuple(result)


def _described(objects: Sequence[MapObject]) -> dict[str, dict[str, int]]:
    """Each word that describes things, with the nouns behind it and how many things are called so."""
    result: dict[str, dict[str, int]] = {}
    for item in objects:
        name = item.description.lower().split()
        if len(name) == 2 and name[0].isalpha() and name[1].isalpha() and len(name[1]) > 1:
            nouns = result.setdefault(name[0], {})
            nouns[name[1]] = nouns.get(name[1], 0) + 1
    return result


def _head(flat: tuple[str, ...], at: int, described: dict[str, dict[str, int]], said: set[str]) -> str:
    """The noun that a describing word leaves out; empty if it leaves none out or that cannot be told."""
    nouns = [
        noun for noun, count in described.get(flat[at], {}).items() if singular(noun) in said and count == 1
    ]
    if len(nouns) != 1:
        return ""
    before, behind = flat[at - 1] if at else ".", flat[at + 1] if at + 1 < len(flat) else "."
    if behind == "one":
        verb = lexicon().verbs.match((nouns[0],))
        return nouns[0] if verb is None and before in {"the", "that", "a", "this"} else ""
    so = before == "not" and flat[at - 2 : at - 1] in {("is",), ("are",), ("was",)}
    if so or (before == "the" and flat[at - 2 : at - 1] in {("in",), ("on",), ("at",), ("to",), ("from",)}):
        # "The door that is not red", "the door in the south".
        return ""
    closes = behind in _BEHIND - {"for", "as", "in", "is", "was", "has"} or not behind[:1].isalnum()
    named = before in _JOINTS - {"in", "from", "with", "for"} or not before[:1].isalnum()
    listed = behind not in {"and", "or", ","} or any(key in described for key in flat[at + 2 : at + 4])
    follows = any(noun in flat[at + 1 : at + 5] or f"{noun}s" in flat[at + 1 : at + 5] for noun in nouns)
    return nouns[0] if closes and listed and (named or before == "the") and not follows else ""


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
    if before == "to" and flat[index - 2 : index - 1] in {("down",), ("up",), ("back",)}:
        return ""
    if (
        before == "number"
        and index > 1
        and flat[index - 2] in _JOINTS | {"though", "although", "leave", "skip"}
    ):
        before = "and"
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
        # "Zones 1, 2 and 3": named together with the ones before, unless these stood alone too.
        first = index - 2
        while first > 1 and flat[first - 1] in {",", "and", "or"} and flat[first - 2] in labels:
            first -= 2
        kinds = labels.get(flat[first], set())
        if before == "to" and flat[index - 3 : index - 2] == ("from",):
            return ""
        named = any(_stands_before(flat, first, kind) for kind in kinds | {f"{k}s" for k in kinds})
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
