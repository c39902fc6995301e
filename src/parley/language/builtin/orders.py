"""The orders of a message, each from one verb to the next, whatever frame the tagger sees in them."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass

from parley.language.builtin.lexicon import Lexicon
from parley.language.builtin.reading import Reading
from parley.language.builtin.spans import Filler, Parse

__all__ = ["Clause", "clauses_of"]

_ORDERING = frozenset({"order", "answer", "social"})
_TELLING = frozenset({*_ORDERING, "told", "edit"})


@dataclass(frozen=True, slots=True)
class Clause:
    """One order of a message."""

    start: int
    end: int
    verb: tuple[str, ...]
    content: tuple[int, ...]
    """Places of the words that carry something, without the verb's."""
    text: str
    """From its first word that carries something."""
    fillers: tuple[Filler, ...]
    orders: bool
    """Whether it is an order for all that the tagger sees in it."""
    may_order: bool
    """Whether it is at least neither a question, a need nor an alarm."""


def clauses_of(parse: Parse, reading: Reading, lexicon: Lexicon, *, whole: bool = False) -> list[Clause]:
    """The orders of a message: each from one verb to the next, or all of it as one."""
    size = len(parse.tokens)
    starts = [verb.start for verb in parse.verbs if not whole and _opens(parse, verb.start, lexicon)]
    bounds = [0, *(start for start in starts if _content(parse, 0, start, lexicon)), size]
    fillers = [filler for wish in reading.wishes for filler in wish.fillers] + [*reading.loose]
    found = []
    for start, end in itertools.pairwise(bounds):
        called = {at for f in fillers if f.role == "A" for at in range(f.start, f.end)}
        content = [at for at in _content(parse, start, end, lexicon) if at not in called]
        acts = {parse.acts[at] for at in content}
        verb = next((verb for verb in parse.verbs if start <= verb.start < end), None)
        places = (
            [*range(verb.start, verb.end), *verb.particles]
            if verb is not None and content and verb.start <= content[0]
            else content[:1]
        )
        words = tuple(parse.tokens[at].low for at in places)
        inside = {f.start: f for f in fillers if start <= f.start < end and f.role != "A"}
        text = parse.text(content[0], end) if content else ""
        rest = tuple(at for at in content if at not in places)
        roles = _sorted(inside, parse, rest, places)
        orders, may_order = acts <= _ORDERING, acts <= _TELLING
        found.append(Clause(start, end, words, rest, text, roles, orders, may_order))
    return found


def _sorted(
    inside: dict[int, Filler], parse: Parse, rest: Sequence[int], places: Sequence[int]
) -> tuple[Filler, ...]:
    """The roles of a clause, and as roles unknown the words that are in none."""
    taken = {at for filler in inside.values() for at in range(filler.start, filler.end)} | {*places}
    for at in rest:
        if at not in taken:
            inside[at] = Filler("?", at, at + 1, 0, (parse.tokens[at].low,))
    return tuple(inside[at] for at in sorted(inside))


def _opens(parse: Parse, at: int, lexicon: Lexicon) -> bool:
    """Whether a verb begins a clause: behind a mark or a linking word."""
    while (
        at
        and parse.tokens[at - 1].is_word
        and parse.tokens[at - 1].low in lexicon.classes["small"] - {"and", "then"}
    ):
        at -= 1
    return not at or not parse.tokens[at - 1].is_word or parse.tokens[at - 1].low in ("and", "then")


def _content(parse: Parse, start: int, end: int, lexicon: Lexicon) -> list[int]:
    small = lexicon.classes["small"]
    return [at for at in range(start, end) if parse.tokens[at].is_word and parse.tokens[at].low not in small]
