"""Commands to general purpose service robots, made by a grammar (`data/gpsr.yaml`); a seed decides which.

The kinds of commands are those of RoboCup@Home's GPSR test; the grammar and what is said are our own.
"""

from __future__ import annotations

import random
import re
from collections.abc import Sequence
from pathlib import Path
from typing import Final

from pydantic import BaseModel, ConfigDict, Field

from parley.evaluation.cases import Case, CaseBody, Expected, World
from parley.files import parse_yaml, read_text, validated
from parley.messages.status import ActionInfo

__all__ = ["GPSR_SEED", "Grammar", "gpsr_cases"]

GPSR_SEED: Final = 2026
PER_KIND: Final = 5
_CHOICE = re.compile(r"\(([^()|]*(?:\|[^()|]*)+)\)(?!\w)")
_SLOT = re.compile(r"\{(\w+)\}")
_ROLE = re.compile(r"\w+")

Value = str | tuple[str, str]
"""Words, or words and what a step has to name."""


class _Strict(BaseModel):
    model_config = ConfigDict(extra="forbid")


class _Catalogue(_Strict):
    roles: dict[str, str]
    actions: list[ActionInfo]


class _Arena(_Strict):
    robot: str
    pose: tuple[float, float, float]
    objects: list[list[str | float]]
    rooms: list[Value]
    surfaces: list[Value]
    spots: list[Value]


class _Kind(_Strict):
    say: list[str] = Field(min_length=1)
    do: list[list[str]] = Field(min_length=1)
    """Right plans; those with slots that the sentence does not have do not count."""
    declines: bool = False
    """Whether it is fair as well to say that it cannot be done."""
    asks: list[str] = Field(default_factory=list)
    """Parts of a question that it is fair as well to ask."""


class Grammar(_Strict):
    """The whole of the file."""

    catalogues: dict[str, _Catalogue]
    arenas: list[_Arena]
    slots: dict[str, list[Value]]
    polite: list[str]
    kinds: dict[str, _Kind]

    def make(self, kind: str, number: int, seed: int) -> Case:
        """One command; the same for the same arguments.

        Args:
            kind: One of `kinds`.
            number: Which of them.
            seed: Of all.
        """
        chance = random.Random(f"{seed}/{kind}/{number}")
        arena = self.arenas[number % len(self.arenas)]
        name = chance.choice(sorted(self.catalogues))
        chosen = self.kinds[kind]
        sentence = self._wording(chosen.say[number % len(chosen.say)], chance)
        values = {slot: chance.choice(self._values(slot, arena)) for slot in _SLOT.findall(sentence)}
        said = {slot: value if isinstance(value, str) else value[0] for slot, value in values.items()}
        named = {slot: value if isinstance(value, str) else value[1] for slot, value in values.items()}
        plans = [
            [self._step(step, named, self.catalogues[name].roles) for step in plan]
            for plan in chosen.do
            if {slot for step in plan for slot in _SLOT.findall(step)} <= named.keys()
        ]
        right = Expected(do_any=plans, may_remember=sentence.startswith("{name}"))
        others = [Expected(declines=True)] if chosen.declines else []
        others += [Expected(asks=True, says=chosen.asks)] if chosen.asks else []
        world = World(
            robot=arena.robot,
            robots=[arena.robot],
            pose=arena.pose,
            catalogue=self.catalogues[name].actions,
            objects=[list(item) for item in arena.objects],
        )
        body = CaseBody(in_=arena.robot, say=sentence.format(**said), either=[right, *others])
        return Case(kind, body, world, part="gpsr", blind=True)

    def _wording(self, template: str, chance: random.Random) -> str:
        polite = "" if template.startswith("=") else chance.choice(self.polite)
        text = polite + _CHOICE.sub(
            lambda found: chance.choice(found[1].split("|")), template.removeprefix("=")
        )
        return text if chance.random() < 0.5 else text[:1].upper() + text[1:] + chance.choice((".", "", "!"))

    def _values(self, slot: str, arena: _Arena) -> Sequence[Value]:
        places = {"room": arena.rooms, "surface": arena.surfaces, "spot": arena.spots}
        return places[slot] if slot in places else self.slots[slot]

    @staticmethod
    def _step(step: str, named: dict[str, str], roles: dict[str, str]) -> str:
        return _ROLE.sub(lambda found: roles[found[0]], step.format(**named), count=1)


def gpsr_cases(seed: int = GPSR_SEED, per_kind: int = PER_KIND) -> list[Case]:
    """So many commands of each kind.

    Raises:
        FileFormatError: The grammar is broken.
    """
    path = Path(__file__).parent / "data" / "gpsr.yaml"
    grammar = validated(Grammar, parse_yaml(read_text(path), path.name), path.name)
    return [grammar.make(kind, number, seed) for kind in grammar.kinds for number in range(per_kind)]
