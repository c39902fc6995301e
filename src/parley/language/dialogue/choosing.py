"""Which of several things is meant, once that was asked: one of them, or some of them together."""

from __future__ import annotations

import itertools
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from typing import Final

from parley.gate.assent import assent_of
from parley.language.base import Situation
from parley.language.builtin.decision import Ask, Decision, Deed, Do, Edit
from parley.language.builtin.lexicon import lexicon
from parley.language.builtin.sets import kinds
from parley.language.builtin.spatial import NEAREST, picked
from parley.language.builtin.things import head_of, link
from parley.language.builtin.tokens import Token
from parley.language.dialogue.map_words import distance_m
from parley.language.dialogue.replies import chosen, names_deed
from parley.language.dialogue.speaker import Again
from parley.language.lexicon import word_set

__all__ = ["choice_of", "in_order", "tells", "together"]

_ANSWER: Final = 10
_ORDER: Final = frozenset({"first", "before", "then", "afterwards", "later", "also", "next"})
_COUNTS: Final = {"both": 2, "two": 2, "three": 3, "four": 4, "five": 5}
_ALL: Final = frozenset({*_COUNTS, "all", "each", "every", "everything"})
_SMALL: Final = word_set("of them the these those please yes one ones in at i")
_SMALL_VERBS: Final = frozenset({"mean", "meant"})


def choice_of(situation: Situation, tokens: Sequence[Token], again: Again) -> Decision | None:
    """The order that was asked about, with what is meant of several things."""
    asked = situation.dialogue.asked
    words = [token.low for token in tokens if token.is_word]
    lead = 1 if words[:1] == ["no"] else 2 if words[:2] == ["all", "right"] else 0
    if asked is not None and (other := _another(words, asked.words, asked.choices, situation)):
        return again(other)
    words = words[lead:] if len(words) > lead + 1 else words  # "no, the red one" says which
    if asked is None or len(words) > _ANSWER or situation.message.rstrip().endswith("?"):
        return None
    if names_deed(words) or tells(words):
        return None
    also = {item.description: item.aliases for item in situation.objects}
    several = together(words, asked.choices, also) if {*asked.choices} <= {*also} else ()
    if several:
        made = [again(asked.words, [name for name in asked.choices if name != one]) for one in several]
        joined = _one_after_the_other(made)
        return replace(joined, about=asked.words) if isinstance(joined, Do) else joined
    choice = _by_place(words, asked.choices, situation) or chosen(words, asked.choices, also)
    choice = choice or _left_to_it(words, asked.choices, situation)
    if len(asked.choices) == 1 and assent_of(situation.message):
        choice = asked.choices[0]
    if choice is None or _orders(words, choice, asked.choices):
        return None
    one = again(asked.words, [name for name in asked.choices if name != choice])
    if isinstance(one, Do):
        return replace(one, about=asked.words)
    if isinstance(one, Ask) and one.choices and {*one.choices}.isdisjoint(asked.choices):
        told = _with_choice(asked.words, choice, asked.choices, situation)
        return replace(one, about=told) if told else None
    return one if isinstance(one, Edit) or (isinstance(one, Ask) and one.offer) else None


def _another(words: Sequence[str], order: str, choices: Sequence[str], situation: Situation) -> str:
    """The order with something else that the map knows in place of all choices: "no, I mean the desk"."""
    taken_back = "no" in words[:1] or bool(_SMALL_VERBS & {*words})
    bare = [word for word in words if word not in _BESIDE | _SMALL_VERBS]
    named = [item for item in situation.places if item.description.lower().split() == bare]
    if not taken_back or len(named) != 1 or named[0].description in choices:
        return ""
    return _with_choice(order, named[0].description, choices, situation)


def _left_to_it(words: Sequence[str], choices: Sequence[str], situation: Situation) -> str | None:
    """The nearest one, where the choice is left to the robot: "any", "you choose", "whichever is closer"."""
    pose, items = situation.robot_pose, [item for item in situation.places if item.description in choices]
    if pose is None or len(items) != len(choices) or not _LEFT_TO_IT.fullmatch(" ".join(words)):
        return None
    return min(items, key=lambda item: distance_m(item, pose)).description


_BESIDE: Final = word_set("no sorry oh i the my our a please actually rather")
_LEFT_TO_IT: Final = re.compile(
    r"(?:(?:oh|just|please|well|ok|okay) )*(?:(?:any|either)(?: one)?(?: of them)?(?: will do| is fine)?|"
    r"whichever(?: (?:one )?(?:is|'s) (?:clos|near|easi)(?:er|est))?|whichever you (?:like|want)|"
    r"(?:it )?(?:does not|doesn't|don't) matter(?: which(?: one)?)?|you (?:choose|decide|pick)(?: one)?|"
    r"i (?:do not|don't) (?:mind|care)|up to you|all the same(?: to me)?|(?:pick|choose) one)(?: please)?"
)


def _with_choice(order: str, choice: str, choices: Sequence[str], situation: Situation) -> str:
    """An order in which what was not clear is called by its name; empty where that stands in no one place."""
    named = [
        re.compile(rf"\b{re.escape(kind)}\b", re.IGNORECASE) for kind in _shared_kinds(choices, situation)
    ]
    found = [pattern for pattern in named if len(pattern.findall(order)) == 1]
    return found[0].sub(lambda _: choice, order) if len(found) == 1 else ""


def _shared_kinds(names: Sequence[str], situation: Situation) -> set[str]:
    """What all of several things are."""
    items = [item for item in situation.objects if item.description in names]
    return set.intersection(*({*kinds(item)} for item in items)) if items else set()


def tells(words: Sequence[str]) -> bool:
    """Whether it is said how something is: "the red one is full" answers no "which one?"."""
    at = next((n for n, word in enumerate(words) if word in ("is", "are", "was", "were", "has", "'s")), 0)
    return at > 0 and words[at - 1] not in _LEADING_TO


_LEADING_TO: Final = word_set("it that this which who where mean meant there whichever")


def _by_place(words: Sequence[str], choices: Sequence[str], situation: Situation) -> str | None:
    """The one that is told by where it is: "the one closest to the gate", "the nearest"."""
    shared = _shared_kinds(choices, situation)
    at = next((n for n, word in enumerate(words) if word in ("one", *NEAREST)), None)
    if not shared or at is None or NEAREST.isdisjoint(words):
        return None
    said = [*words[: at + (words[at] != "one")], min(shared), *words[at + 1 :]]
    said = [word for word in said if word != "one"]
    found = picked(said, situation.objects, lexicon(), situation.robot_pose)
    names = [item.description for item in found.things] if found is not None else []
    return names[0] if len(names) == 1 and names[0] in choices else None


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
    but = next((n for n, word in enumerate(words) if word in ("except", "but")), 0)
    if but and {*bare[: bare.index(words[but])]} <= _ALL:  # "all of them but the red one"
        out = chosen([word for word in words[but + 1 :] if word != "for"], names, also)
        return tuple(name for name in names if name != out) if out is not None else ()
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


def in_order(situation: Situation, again: Again) -> Do | None:
    """An order in which it is said what comes first or last: "check A and B, start with B"."""
    said = _EDGE.fullmatch(situation.message.strip())
    made = again(said["order"]) if said is not None else None
    if said is None or not isinstance(made, Do) or not {deed.frame for deed in made.deeds} <= _VISITING:
        return None
    visits: list[tuple[Deed, ...]] = []
    for part in _parts(made.deeds):
        if part[-1].frame == "GO" or not visits:
            visits.append(part)
        else:
            visits[-1] += part
    told = [" ".join(str(value) for deed in visit for value in deed.arguments.values()) for visit in visits]
    names = [item.description for item in situation.places if any(item.description in one for one in told)]
    edge = (said["edge"] or said["one"]).lower().split()
    name = chosen(edge, names) or _one_like(edge, names, situation)
    meant = [visit for visit, text in zip(visits, told, strict=True) if name is not None and name in text]
    if len(meant) != 1 or any(deed.check or deed.open_ended for deed in made.deeds):
        return None
    rest = [visit for visit in visits if visit is not meant[0]]
    last = "last" in (said["where"] or "") or (said["verb"] or "")[:1].lower() in ("f", "e")
    return replace(made, deeds=tuple(itertools.chain(*(rest + meant if last else meant + rest))))


def _one_like(words: Sequence[str], names: Sequence[str], situation: Situation) -> str | None:
    """The one among things of a kind that is described: "the one by the gate"."""
    shared = _shared_kinds(names, situation)
    said = [min(shared) if word == "one" and shared else word for word in words]
    items = [item for item in situation.objects if item.description in names]
    found = link(said, head_of(said, lexicon()), items, lexicon()) if "one" in words and shared else None
    return found.things[0].description if found is not None and found.kind == "one" else None


_EDGE: Final = re.compile(
    r"(?P<order>.+?)(?:\s*[,;.!–-]+\s*|\s+)(?:(?:and|but|please|just|do|take|with)\s+)*"
    r"(?:(?P<verb>start|starting|begin|beginning|finish|finishing|end|ending)(?: off| up)? "
    r"(?:with|at|in|from|by) (?:the )?(?P<edge>[\w' -]+?)|(?:the )?(?P<one>[\w' -]+?) (?P<where>first|last))"
    r"(?:,? please)?[.!]*",
    re.IGNORECASE,
)
_VISITING: Final = frozenset({"GO", "LOOK", "PHOTO", "COUNT"})


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
