"""One frame with its roles, as it is read from a message."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from parley.language.builtin.own_action import OwnAction
from parley.language.builtin.spans import Filler

__all__ = ["Wish", "Witness"]

Witness = Literal["agrees", "unknown", "differs"]


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
