"""What is wanted: a frame with its roles, or an action of the robot's own, and that as a deed."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

from parley.language.builtin.amounts import in_unit
from parley.language.builtin.decision import Ask, Deed
from parley.language.builtin.filling import Fill, Slots
from parley.language.builtin.skills import Skill
from parley.language.builtin.spans import Filler
from parley.messages.status import ActionInfo, Kind
from parley.umrf.kinds import words_of_name

__all__ = ["Grounds", "OwnAction", "Wish", "Witness", "owned"]

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


# -- an action of the robot's own as a deed, or the question that offers it --


_HOLE = re.compile(r"(\b(?:the|an?) )?\{([^{}]*)\}")
_DETERMINED = re.compile(r"(?:the|an?|my|your|his|her|its|our|their|this|that) ", re.IGNORECASE)

Grounds = Callable[[Filler, Kind, frozenset[str]], "tuple[str, str] | Ask"]
"""From words for a place, thing or person to the argument and how the reply says it, or a question."""


def owned(own: OwnAction, grounds: Grounds) -> list[Deed] | Ask:
    """The deed of an order that means it for certain; else a question that offers it."""
    arguments: dict[str, str | float | bool] = {}
    said: dict[str, str] = {}
    for one in own.fills:
        value = _value(one, own, grounds)
        if isinstance(value, Ask):
            return value
        arguments[one.name], said[one.name] = value
    text = _in_words(own, said)
    if own.missing:
        needed = " and ".join(re.sub(r"_|::", " ", name) for name in own.missing)
        return Ask(f"I can {own.label}, but I need to know more: which {needed}?")
    deed = Deed("DO", Skill(own.action, "DO", {}), arguments, said, text=text)
    if own.certain:
        return [deed]
    return Ask(f"I am not sure what you mean. Shall I {text}?", (text[:1].upper() + text[1:],), offer=(deed,))


def _value(one: Fill, own: OwnAction, grounds: Grounds) -> tuple[str | float | bool, str] | Ask:
    if one.amount is not None:
        value = in_unit(one.amount, one.parameter.unit)
        return value, str(one.amount)
    if one.word:
        return (one.word == "yes" if own.action.inputs[one.name].startswith("bool") else one.word), one.word
    if one.parameter.kind in ("place", "thing", "person"):
        return grounds(one.filler, one.parameter.kind, own.slots.words)
    if '"' in one.filler.words or "“" in one.filler.words:
        return Ask(f"What exactly is the text in {one.filler.text}? Please say it alone.")
    return one.filler.text, f"“{one.filler.text}”"


def _in_words(own: OwnAction, said: dict[str, str]) -> str:
    """What is done: a phrase of the maker that holds all that was said, else the description with it."""
    for phrase in (own.action.label, *own.action.phrases):
        if phrase and set(re.findall(r"\{([^{}]*)\}", phrase)) == set(said):
            return _HOLE.sub(lambda hole: _put(hole, said), phrase[:1].lower() + phrase[1:])
    return f"{own.label}: {', '.join(said.values())}" if said else own.label


def _put(hole: re.Match[str], said: dict[str, str]) -> str:
    """What was said for a hole, with one article: the phrase's or its own."""
    article, words = hole[1] or "", said[hole[2]]
    return words if _DETERMINED.match(words) else article + words
