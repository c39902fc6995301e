"""Words of a message that fill a role."""

from __future__ import annotations

from dataclasses import dataclass

__all__ = ["Filler"]


@dataclass(frozen=True, slots=True)
class Filler:
    """What fills a role: words of the message, by their places."""

    role: str
    start: int
    end: int
    head: int
    words: tuple[str, ...]
    """From start to end, in small letters."""
    share: float = 1.0
    said: str = ""
    """As it was said."""

    @property
    def text(self) -> str:
        """Its words, as they were said."""
        return self.said or " ".join(self.words)
