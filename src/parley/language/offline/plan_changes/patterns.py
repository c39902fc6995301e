"""Patterns of fixed words and open phrases, as `data/plan_changes.yaml` writes them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from parley.language.offline.words.text import Phrase, keys

__all__ = ["Part", "matches", "parsed"]

_LONGEST_SLOT = 12


@dataclass(frozen=True, slots=True)
class Part:
    """Fixed alternatives, or an open phrase."""

    words: tuple[tuple[str, ...], ...] = ()
    slot: str = ""
    optional: bool = False


def parsed(text: str, named: Mapping[str, str] | None = None) -> tuple[Part, ...]:
    """The parts of a pattern.

    Args:
        text: As the file has it.
        named: Lists of alternatives by the name that stands for them ("DROP").
    """
    for name, words in (named or {}).items():
        text = text.replace(name, words)
    return tuple(_part(word) for word in text.split())


def _part(text: str) -> Part:
    if text.startswith("{"):
        return Part(slot=text[1:-1])
    options = [option for option in text.split("|") if option != "?"]
    fixed = tuple(sorted((tuple(o.lstrip("?").split("_")) for o in options), key=len, reverse=True))
    return Part(fixed, "", text.startswith("?"))


def matches(parts: tuple[Part, ...], words: Phrase, at: int = 0) -> Iterator[dict[str, Phrase]]:
    """Every way in which a pattern covers the words from `at` to their end."""
    if not parts:
        if at == len(words):
            yield {}
        return
    part, rest = parts[0], parts[1:]
    if part.slot:
        for end in range(min(len(words), at + _LONGEST_SLOT), at, -1):
            for found in matches(rest, words, end):
                yield {part.slot: words[at:end], **found}
        return
    flat = keys(words[at : at + 6])
    for option in part.words:
        if flat[: len(option)] == option:
            yield from matches(rest, words, at + len(option))
    if part.optional:
        yield from matches(rest, words, at)
