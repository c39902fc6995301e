"""Words of a message with their places in it; the message itself is never changed."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

__all__ = ["Token", "tokenize"]

_WORD = re.compile(
    r"\d+(?:[.,:]\d+)+[^\W_]*"  # 2.5m, 14:30
    r"|[^\W_]\w*(?:-\w+)*(?:n['’]t\b)?"  # words, ids, t-shirt, don't
    r"|['’](?:s|m|re|ll|ve|d)\b"  # what stands for is, am, are, will, have, would
    r"|[^\w\s]",
    re.IGNORECASE,
)
_NOT = re.compile(r"\w+n['’]t\b", re.IGNORECASE)


@dataclass(frozen=True, slots=True)
class Token:
    """One word or mark."""

    text: str
    start: int
    end: int

    @property
    def low(self) -> str:
        """In small letters, with a straight apostrophe."""
        return self.text.lower().replace("’", "'")

    @property
    def is_word(self) -> bool:
        """Whether it is more than a mark."""
        return self.text[0].isalnum() or self.text[0] in "'’"


def tokenize(text: str) -> tuple[Token, ...]:
    """The words and marks of a text, in order."""
    found: list[Token] = []
    at = 0
    while at < len(text):
        match = _NOT.match(text, at) or _WORD.match(text, at)
        if match is None:
            at += 1
            continue
        found.append(Token(match[0], match.start(), match.end()))
        at = match.end()
    return tuple(found)


def words_of(tokens: Sequence[Token]) -> str:
    """The words of tokens, with spaces between."""
    return " ".join(token.text for token in tokens)
