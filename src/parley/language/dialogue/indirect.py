"""Orders that are not given as such: "we need you at the desk", "somebody should check the gate"."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache

from parley.language.builtin.decision import Ask, Decision, Do
from parley.language.builtin.lexicon import Lexicon, lemmas
from parley.language.builtin.tokens import Token
from parley.language.dialogue.questions import plain
from parley.language.dialogue.speaker import Again
from parley.language.lexicon import load_data

__all__ = ["Shape", "meant", "meant_order", "shapes"]

_PART = re.compile(r"<(\w+)>")


@dataclass(frozen=True, slots=True)
class Shape:
    """How an order is said round about, and which it is."""

    pattern: re.Pattern[str]
    order: str
    offered: bool
    """Whether it may have been a question as well, so that it is asked about first."""


@cache
def shapes() -> tuple[Shape, ...]:
    """All of them, in the order in which they are tried."""
    read = load_data("indirect")
    found = []
    for kind in ("meant", "offered"):
        for line in str(read[kind]).splitlines():
            shape, order = line.split(" => ")
            pattern = re.compile(_PART.sub(r"(?P<\1>.+)", shape))
            found.append(Shape(pattern, order, kind == "offered"))
    return tuple(found)


def meant_order(bare: str) -> tuple[str, bool] | None:
    """The order that words mean which give none, and whether it is only offered; None for all others.

    Args:
        bare: The message, as `plain` gives it.
    """
    for shape in shapes():
        if (found := shape.pattern.fullmatch(bare)) is not None:
            return _PART.sub(lambda part: found[part[1]], shape.order), shape.offered
    return None


def meant(tokens: Sequence[Token], names: Sequence[str], lexicon: Lexicon, again: Again) -> Decision | None:
    """What comes of a message that means an order without giving it; None for all others.

    `names` are those of the robot that is spoken to; `again` decides about the order.
    """
    found = meant_order(plain(tokens, names))
    if found is None:
        return None
    order, offered = found
    first, _, rest = order.partition(" ")
    verb = next((lemma for lemma in lemmas(first) if (lemma,) in lexicon.verbs), first)  # "going to the desk"
    made = again(f"{verb} {rest}")
    if not isinstance(made, Do):
        return None
    return Ask(f"Shall I {verb} {rest}?", offer=made.deeds) if offered else made
