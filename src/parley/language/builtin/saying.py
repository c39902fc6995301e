"""Small things about putting words into replies."""

from __future__ import annotations

__all__ = ["with_article"]


def with_article(text: str) -> str:
    """A noun phrase with "the", unless it is a name or has a word like that already."""
    first = text.split(" ", 1)[0]
    name = text[:1].isupper() and not (first.isupper() and len(first) > 1)
    bare = name or first in _OWN or not text or text[-1].isdigit()
    return text if bare else f"the {text}"


_OWN = frozenset(
    {"the", "a", "an", "my", "your", "his", "her", "our", "their", "this", "that", "these", "those",
    "you", "it", "all", "what", "whether", "if"}
)  # fmt: skip
