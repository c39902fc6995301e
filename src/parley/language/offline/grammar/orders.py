"""What a message consists of once it is parsed: orders, what is named or told, what comes before what."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal

from parley.language.offline.grammar.things import Item
from parley.language.offline.words.text import Phrase

__all__ = ["Kind", "Mark", "Node", "Order", "Part"]

Kind = Literal["go", "look", "search", "whether", "count", "leave_out", "other", "again", "named"]
"""`again`: what was asked for last, for other things. `named`: things and nothing said of them."""

Mark = Literal[
    "stop",
    "ask",
    "told",
    "before",
    "after",
    "first",
    "if",
    "unless",
    "otherwise",
    "correct",
    "then",
    "comma",
    "wait",
]


@dataclass(slots=True)
class Order:
    """One thing that is asked for, as far as its own words tell."""

    kind: Kind
    things: list[Phrase] = field(default_factory=list)
    what: Phrase = ()
    """What is looked for, or what may be so."""
    words: Phrase = ()
    """As it was said, from the verb on."""
    refers: bool = False
    where: Literal["", "first", "before", "last"] = ""
    """Where in the plan it belongs: before everything, before the order before it, at the end."""
    ranked: bool = False
    """Whether it is only said to be the first or last stop."""
    also: bool = False
    """Whether it goes on with what the order before it did ("... too")."""
    plural: bool = False
    """Whether it refers to several ("both", "each of them")."""
    somebody: bool = False
    """Whether it refers to a person."""
    """Whether "it", "there", "each" stand for what was named before."""
    negated: bool = False
    group: bool = False
    """Whether its things were named as several at once."""
    unread: int = 0
    """How many words it leaves unexplained."""
    condition: Phrase = ()
    hangs: bool = False
    """Whether it depends on `condition` (on what was looked at last, if that is empty)."""
    otherwise: bool = False
    """To be done if that is not so."""


@dataclass(slots=True)
class Node:
    """A part of the message that is no order: a mark between orders, or what is told."""

    mark: Mark
    items: list[Item] = field(default_factory=list)
    orders: list[Order] = field(default_factory=list)
    only: bool = False
    """Whether it is said to be so and not otherwise ("only after B")."""
    unread: bool = False
    """Whether it begins like an order, that nobody could read."""
    reason: bool = False
    """Whether a condition may be no more than why ("in case they need help")."""


Part = Order | Node
