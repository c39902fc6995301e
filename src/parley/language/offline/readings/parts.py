"""The parts of one message: cut once for each wording that it gets while it is being read."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from parley.language.offline.scene.scene import Scene
from parley.language.offline.sentences.clauses import opens_command
from parley.language.offline.sentences.spoken import Names
from parley.language.offline.sentences.units import Unit, units
from parley.language.offline.tasks.tasks import Tasks
from parley.language.offline.words.text import Phrase

__all__ = ["Parts"]

_SHORT_ORDER = 12


@dataclass
class Parts:
    """Cuts a message; it belongs to one message and its scene, and goes with them."""

    scene: Scene
    names: Names = field(init=False)
    """Which words name one thing on the map."""
    _cut: dict[Phrase, list[Unit]] = field(init=False, default_factory=dict)
    """The parts by the wording; what names something and what opens an order stays the same meanwhile."""

    def __post_init__(self) -> None:
        self.names = Names(self.scene)

    def of(self, words: Phrase) -> list[Unit]:
        """The parts of the message in this wording, in their order."""
        if words not in self._cut:
            self._cut[words] = units(words, self.names.is_stop, self.opens)
        # What is remembered may be more by now, and an action may need it.
        return [self._as_own_order(unit) for unit in self._cut[words]]

    def opens(self, words: Phrase) -> bool:
        """Whether an order begins with these words."""
        return opens_command(words, self.scene.catalogue.verbs)

    def _as_own_order(self, unit: Unit) -> Unit:
        """For "blinds down": what an action explains is an order, though no verb begins it."""
        short = 1 < len(unit.words) <= _SHORT_ORDER
        match = Tasks(self.scene).own_match(unit.words) if short and unit.kind in {"who", "idle"} else None
        if match is None or not match.complete:
            return unit
        return replace(unit, kind="order", why=f"{match.info.name} is what it asks for")
