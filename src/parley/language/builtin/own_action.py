"""An action of the robot's own that an order means, where no frame is."""

from __future__ import annotations

from dataclasses import dataclass

from parley.language.builtin.filling import Fill, Slots
from parley.messages.status import ActionInfo
from parley.umrf.kinds import words_of_name

__all__ = ["OwnAction"]


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
