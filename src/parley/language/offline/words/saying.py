"""Small helpers for writing plain sentences."""

from __future__ import annotations

from collections.abc import Sequence

from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.text import singular

__all__ = ["a", "capital", "in_turn", "listing", "the", "where_is", "whole_sentence"]


_SOMEBODY = frozenset({"somebody", "someone", "anybody", "anyone", "everybody", "everyone", "whoever"})


def the(text: str) -> str:
    """With the article where English wants it: "the box", but "area A", "Anna", "my desk"."""
    words = text.split()
    if not words:
        return text
    if (
        text.lower() in {"home", "everything"}
        or words[0].lower() in _SOMEBODY
        or words[0].lower() in lexicon().determiners | lexicon().quantifiers | lexicon().operator_pronouns
    ):
        return text
    placed = bool(set(words[1:-1]) & lexicon().goals_and_places)
    label = len(words) > 1 and (words[-1].isdigit() or len(words[-1]) == 1) and not placed
    name = words[0][:1].isupper() and words[0][1:].islower() and words[0].isalpha()
    identifier = "_" in words[0]
    return text if label or name or identifier else f"the {text}"


def where_is(text: str) -> str:
    """For "where is the box" and "where are the boxes"."""
    last = text.split()[-1].lower() if text else ""
    several = singular(last) != last and "'" not in last and not text[:1].isupper()
    return f"Where {'are' if several or last in {'people', 'glasses'} else 'is'} {the(text)}"


def a(text: str) -> str:
    """With the indefinite article."""
    if not text or text.split()[0].lower() in lexicon().determiners or text[0].isdigit():
        return text
    return f"{'an' if text[0].lower() in 'aeiou' else 'a'} {text}"


def capital(text: str) -> str:
    """With a capital letter at the start."""
    return text[:1].upper() + text[1:]


def listing(parts: Sequence[str], last: str = "and") -> str:
    """For "A, B and C"."""
    if len(parts) < 2:
        return "".join(parts)
    return f"{', '.join(parts[:-1])} {last} {parts[-1]}"


def in_turn(deeds: Sequence[str]) -> str:
    """What is done one after the other, in words that follow "I will"."""
    starts = [i for i, deed in enumerate(deeds) if deed.startswith(("if so,", "if not,"))]
    if starts and starts[0]:
        ends = [*starts[1:], len(deeds)]
        parts = [
            listing(deeds[a:b], "and then") for a, b in zip([0, *starts], [starts[0], *ends], strict=True)
        ]
        return "; ".join(parts)
    if len(deeds) == 2 and deeds[-1].endswith("at the same time"):
        return listing(deeds)
    return listing(deeds, "and then")


def whole_sentence(text: str) -> str:
    """With a capital letter and a full stop, unless it ends in another mark."""
    text = capital(text.strip())
    return text if not text or text[-1] in ".?!" else f"{text}."
