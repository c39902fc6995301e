"""An action of the robot's own as a deed, or the question that offers it."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Final

from parley.language.builtin.decision import Ask, Deed
from parley.language.builtin.filling import Fill
from parley.language.builtin.own import OwnAction
from parley.language.builtin.skills import Skill
from parley.language.builtin.wishes import Filler
from parley.messages.status import Kind

__all__ = ["Grounds", "owned"]

Grounds = Callable[[Filler, Kind, frozenset[str]], "tuple[str, str] | Ask"]
"""From words for a place, thing or person to the argument and how the reply says it, or a question."""

_SCALE: Final = {
    "m": 1.0, "cm": 0.01, "mm": 0.001, "feet": 0.3048, "inches": 0.0254, "yards": 0.9144, "s": 1.0,
    "min": 60.0, "h": 3600.0, "metres": 1.0, "centimetres": 0.01, "millimetres": 0.001, "seconds": 1.0,
    "minutes": 60.0, "hours": 3600.0, "radians": 57.29578,
}  # fmt: skip


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
        to = _SCALE.get(one.parameter.unit, 1.0)
        value = round(one.amount.value * _SCALE.get(one.amount.unit, to) / to, 4)
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
            return re.sub(r"\{([^{}]*)\}", lambda hole: said[hole[1]], phrase[:1].lower() + phrase[1:])
    return f"{own.label}: {', '.join(said.values())}" if said else own.label
