"""Which of several things is meant, once that was asked: one of them, or some of them together."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from typing import Final

from parley.language.base import Situation
from parley.language.builtin.decision import Ask, Decision, Deed, Do, Edit
from parley.language.builtin.tokens import Token
from parley.language.dialogue.replies import chosen, names_deed
from parley.language.dialogue.speaker import Again

__all__ = ["choice_of", "together"]

_ANSWER: Final = 10
_ORDER: Final = frozenset({"first", "before", "then", "afterwards", "later", "also", "next"})
_COUNTS: Final = {"both": 2, "two": 2, "three": 3, "four": 4, "five": 5}
_ALL: Final = frozenset({*_COUNTS, "all", "each", "every", "everything"})
_SMALL: Final = frozenset(
    {"of", "them", "the", "these", "those", "please", "yes", "one", "ones", "in", "at", "i"}
)
_SMALL_VERBS: Final = frozenset({"mean", "meant"})


def choice_of(situation: Situation, tokens: Sequence[Token], again: Again) -> Decision | None:
    """The order that was asked about, with what is meant of several things.

    Args:
        situation: In which it is said.
        tokens: Of the message.
        again: Reads the order once more, without some things.
    """
    asked = situation.dialogue.asked
    words = [token.low for token in tokens if token.is_word]
    if asked is None or len(words) > _ANSWER or situation.message.rstrip().endswith("?"):
        return None
    if names_deed(words):
        return None
    also = {item.description: item.aliases for item in situation.objects}
    several = together(words, asked.choices, also) if {*asked.choices} <= {*also} else ()
    if several:
        made = [again(asked.words, [name for name in asked.choices if name != one]) for one in several]
        joined = _one_after_the_other(made)
        return replace(joined, about=asked.words) if isinstance(joined, Do) else joined
    choice = chosen(words, asked.choices, also)
    if choice is None or _orders(words, choice, asked.choices):
        return None
    one = again(asked.words, [name for name in asked.choices if name != choice])
    if isinstance(one, Do):
        return replace(one, about=asked.words)
    return one if isinstance(one, Edit) or (isinstance(one, Ask) and one.offer) else None


def _orders(words: Sequence[str], choice: str, choices: Sequence[str]) -> bool:
    """Whether a name is said with what comes first or later: "first the workshop" answers no "which one?"."""
    order = _ORDER - set(choice.lower().split())
    words = words[:-1] if words[-1] == "then" else words  # "the workshop then"
    rest = [word for word in words if word not in order]
    return len(rest) < len(words) and chosen(rest, choices) is not None


def together(
    words: Sequence[str], names: Sequence[str], also: Mapping[str, Sequence[str]]
) -> tuple[str, ...]:
    """The names that words take together: "both", "all three of them", "the red one and the blue one".

    Args:
        words: What was said.
        names: What is offered.
        also: What else each is called.
    """
    bare = [word for word in words if word not in _SMALL | _SMALL_VERBS]
    if bare and {*bare} <= _ALL:
        counts = {_COUNTS[word] for word in bare if word in _COUNTS} or {len(names)}
        return tuple(names) if counts == {len(names)} and len(names) > 1 else ()
    said = words[1:] if words[:1] == ["both"] else words
    pieces = [
        [*piece] for linking, piece in itertools.groupby(said, lambda word: word == "and") if not linking
    ]
    if len(pieces) < 2 or {"not", "but", "or", "except", "no"} & {*words}:
        return ()
    found = [chosen(piece, names, also) for piece in pieces]
    named = tuple(name for name in found if name is not None)
    return named if len(named) == len(pieces) == len({*named}) else ()


def _one_after_the_other(made: Sequence[Decision]) -> Do | None:
    """What is to be done with each of several things; what is the same for all of them is done once.

    Only what has a way of its own is the same: a look or a wait is for where the robot is then.
    """
    orders = [one for one in made if isinstance(one, Do)]
    if len(orders) < len(made) or any(deed.check or deed.open_ended for one in orders for deed in one.deeds):
        return None
    rows = [_parts(one.deeds) for one in orders]
    before = _shared(rows)
    behind = _shared([row[before:][::-1] for row in rows])
    while behind and not _leads(rows[0][len(rows[0]) - behind][0]):
        behind -= 1
    middle = [part for row in rows for part in row[before : len(row) - behind]]
    parts = [*rows[0][:before], *middle, *rows[0][len(rows[0]) - behind :]]
    return replace(orders[0], deeds=tuple(deed for part in parts for deed in part))


def _leads(deed: Deed) -> bool:
    return deed.hidden or deed.frame == "GO"


def _parts(deeds: Iterable[Deed]) -> list[tuple[Deed, ...]]:
    """Each deed with those that only prepare it."""
    parts: list[tuple[Deed, ...]] = [()]
    for deed in deeds:
        parts[-1] += (deed,)
        if not deed.hidden:
            parts.append(())
    return [part for part in parts if part]


def _shared(rows: Sequence[Sequence[tuple[Deed, ...]]]) -> int:
    """How many parts all rows begin with."""
    same = itertools.takewhile(lambda each: all(part == each[0] for part in each), zip(*rows, strict=False))
    return sum(1 for _ in same)
