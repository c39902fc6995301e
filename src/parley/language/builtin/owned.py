"""An action of the robot's own as a deed, or the question that offers it."""

from __future__ import annotations

import re
from collections.abc import Callable

from parley.language.builtin.amounts import in_unit
from parley.language.builtin.decision import Ask, Deed
from parley.language.builtin.filling import Fill
from parley.language.builtin.skills import Skill
from parley.language.builtin.spans import Filler
from parley.language.builtin.wishes import OwnAction
from parley.messages.status import Kind

__all__ = ["Grounds", "owned"]

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
