"""Steps that bring the robot to its charger, by an action of its own or by driving there."""

from __future__ import annotations

from dataclasses import dataclass, replace

from parley.language.offline.tasks.catalogue import call, text_inputs
from parley.language.offline.tasks.commands import Command
from parley.language.offline.tasks.going import Going, UnableError
from parley.language.offline.words.nouns import bare
from parley.language.offline.words.proper import unmarked
from parley.language.offline.words.text import Phrase, keys, plain, tokens

__all__ = ["Docking"]

_OWN_PLACES = frozenset({"dock", "charger", "base", "home", "charging station", "docking station", "station"})


@dataclass
class Docking(Going):
    """How to get to the charger."""

    def _go(self, command: Command) -> None:
        if self._means_dock(command.place):
            self._dock(command)
            return
        super()._go(command)

    def _back(self, command: Command) -> None:
        home = command.place or (tokens("home") if "home" in command.verb else ())
        if self._means_dock(home):
            self._dock(command)
            return
        super()._back(command)

    def _means_dock(self, place: Phrase) -> bool:
        """Whether a place is the robot's own and only its docking action knows the way there."""
        words = " ".join(keys(bare(place)))
        own = words in _OWN_PLACES and self.catalogue.with_role("dock") is not None
        return own and not self._grounds(place)

    def _charging(self) -> list[Phrase]:
        """The one place that is called after charging ("charging bay")."""
        named = [item.description for item in self.scene.objects]
        called = [name for name in named if "charging" in unmarked(name).lower().split()]
        return [tokens(called[0])] if len(called) == 1 else []

    def _dock(self, command: Command) -> None:
        info = self.catalogue.with_role("dock")
        if info is not None and not text_inputs(info):
            self.steps.append(call(info, {}, "go to my charger"))
            self.will.append("go to my charger")
            self.here = ""
            return
        places = (command.place, *self._charging(), tokens("charger"), tokens("dock"))
        place = next((p for p in places if p and self._grounds(p)), ())
        if not place:
            raise UnableError(plain(command.clause))
        super()._go(replace(command, kind="motion", verb="go", place=place))
