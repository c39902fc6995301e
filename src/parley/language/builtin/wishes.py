"""One frame with its roles, as it is read from a message, or an action of the robot's own that it means."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from parley.language.builtin.filling import Fill, Slots
from parley.language.builtin.spans import Filler
from parley.messages.status import ActionInfo
from parley.umrf.kinds import words_of_name

__all__ = ["OwnAction", "Wish", "Witness"]

Witness = Literal["agrees", "unknown", "differs"]


@dataclass(frozen=True, slots=True)
class OwnAction:
    """An action that an order means, with what it says for each input."""

    action: ActionInfo
    fills: tuple[Fill, ...]
    slots: Slots
    certain: bool
    """Whether it is done without asking."""
    missing: tuple[str, ...] = ()
    """Inputs that are needed and were not said."""

    @property
    def label(self) -> str:
        """What it does, in words of its maker; those of its name where there are no others."""
        first = self.action.description.partition(". ")[0].rstrip(".").partition(";")[0].partition(":")[0]
        text = first if " " in first else " ".join(words_of_name(self.action.name))
        return text[:1].lower() + text[1:]


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
