"""One frame with its roles, as it is read from a message."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

if TYPE_CHECKING:
    from parley.language.builtin.own import OwnAction

__all__ = ["Filler", "Wish", "Witness"]

Witness = Literal["agrees", "unknown", "differs"]


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


@dataclass(frozen=True, slots=True)
class Wish:
    """One frame with its roles."""

    frame: str
    start: int
    verb: str
    fillers: tuple[Filler, ...]
    share: float
    """How much the tagger believes in the least certain part of it."""
    witness: Witness
    """What the lexicon says to it."""
    act: str = "order"
    negated: bool = False
    otherwise: bool = False
    own: OwnAction | None = None
    """The action of the robot's own that is meant, where no frame is."""

    def all(self, role: str) -> tuple[Filler, ...]:
        """What fills a role."""
        return tuple(filler for filler in self.fillers if filler.role == role)

    def one(self, role: str) -> Filler | None:
        """What fills a role first."""
        return next(iter(self.all(role)), None)

    def has(self, roles: str) -> bool:
        """Whether one of these roles is filled."""
        return any(filler.role in roles for filler in self.fillers)
