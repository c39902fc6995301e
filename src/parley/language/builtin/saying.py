"""Small things about putting words into replies."""

from __future__ import annotations

import re
from collections.abc import Sequence

from parley.language.lexicon import word_set

__all__ = ["as_said", "counted", "listed", "which_one", "with_article"]


def as_said(words: str, text: str) -> str:
    """Words of a text as they stand in it, with the capitals of names."""
    words = re.sub(r" (?=['’]s\b)", "", words)
    found = re.search(re.escape(words), text, re.IGNORECASE)
    return found[0] if found is not None else words


def counted(number: int, what: str) -> str:
    """So many of something: "1 step", "2 steps"."""
    return f"{number} {what}" if number == 1 else f"{number} {what}s"


def listed(parts: Sequence[str], last: str = "and") -> str:
    """Several parts of a sentence as one."""
    return parts[0] if len(parts) == 1 else f"{', '.join(parts[:-1])} {last} {parts[-1]}"


def which_one(names: Sequence[str]) -> str:
    """The question which of several things is meant."""
    named = listed([with_article(name) for name in names], "or")
    return f"Which one do you mean: {named}?" if len(names) > 1 else f"Do you mean {named}?"


def with_article(text: str) -> str:
    """A noun phrase with "the", unless it is a name or has a word like that already."""
    first = text.split(" ", 1)[0]
    name = text[:1].isupper() and not (first.isupper() and len(first) > 1)
    bare = name or first in _OWN or not text or text[-1].isdigit() or text[-2:-1] == " "  # "bay A"
    return text if bare else f"the {text}"


_OWN = word_set("""the a an my your his her our their this that these those you it all everyone everybody
what whether if how which who where when why""")
