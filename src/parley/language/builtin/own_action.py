"""An action of the robot's own that an order means, where no frame is."""

from __future__ import annotations

from dataclasses import dataclass, replace

from parley.language.builtin.amounts import Amount
from parley.language.builtin.filling import Fill, Slots
from parley.language.builtin.spans import Filler
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

    def done(self, times: int) -> OwnAction | None:
        """The same so many times, if it has an input for that."""
        name = self.slots.counting
        if not name or name in {fill.name for fill in self.fills}:
            return None
        said = Filler("O", -1, -1, 0, (str(times), "times"))
        often = Fill(name, self.slots.parameters[name], said, Amount(times, ""))
        missing = tuple(other for other in self.missing if other != name)
        return replace(self, fills=(*self.fills, often), missing=missing)
