"""What a look is for: something needed, something that should not be there, or how a place is. Pure."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, Literal

from parley.language.builtin.lexicon import lexicon, stem
from parley.language.lexicon import word_set

__all__ = ["OPEN", "Asked", "asked"]

_ASKING: Final = frozenset({"if", "whether", "that", "what", "which", "who", "how"})
OPEN: Final = frozenset({"what", "which", "who", "how"})
"""What asks how something is, and not whether something is so."""
_THERE: Final = word_set("there here visible present still in on at near by under behind")
_WITHIN: Final = frozenset({"in", "inside", "within", "on", "at"})
_AUXILIARY: Final = word_set("is are was were has have had been")
_BE: Final = frozenset({"is", "are"})
_SOMEBODY: Final = frozenset({"anybody", "anyone", "somebody", "someone", "nobody"})
_LEFT: Final = word_set("left forgot forgotten dropped dumped abandoned hidden planted")
_LYING: Final = word_set("lying standing behind around about unattended somewhere")
_CLEAR: Final = frozenset({"clear", "free", "empty", "unobstructed", "vacant"})
_TAKEN: Final = frozenset({"blocked", "obstructed", "occupied", "cluttered", "full"})


@dataclass(frozen=True, slots=True)
class Asked:
    """What is to be judged."""

    kind: Literal["thing", "room", "state"]
    """Whether something is there; whether a place is free; how something is, which nobody sees here."""
    thing: tuple[str, ...] = ()
    place: tuple[str, ...] = ()
    """Where, if that is said."""
    holds: bool = True
    """Whether it is said to be there, or to be free."""
    unwanted: bool = False
    """Whether it is well if it is not there."""


def asked(request: str) -> Asked:
    """What a request asks for.

    Examples:
        >>> asked("Area 1 for any suspicious boxes")
        Asked(kind='thing', thing=('suspicious', 'boxes'), place=('area', '1'), holds=True, unwanted=True)
        >>> asked("the shelf for my key").unwanted
        False
        >>> asked("how many people are in the yard").kind
        'state'
        >>> asked("whether the yard is clear")
        Asked(kind='room', thing=(), place=('the', 'yard'), holds=True, unwanted=False)
    """
    words = tuple(_HOW.sub("", re.sub("['’]s ", " is ", request.lower())).rstrip(" .?!").split())
    if words[:1] and words[0] in _ASKING:
        return Asked("state") if words[0] in OPEN else _stated(words[1:])
    if (words[:1] == ("there",) and {*words[1:2]} & _BE) or {*words[:1]} & _SOMEBODY:
        return _stated(words)
    at = next((n for n in range(len(words) - 1) if words[n] == "for"), None)
    if at is not None:
        thing, place = words[at + 1 :], words[:at]
        return Asked("thing", _bare(thing), place, unwanted=_is_unwanted(thing, sought=True))
    thing, place = _placed(words)
    return Asked("thing", _bare(thing), place, unwanted=_is_unwanted(thing))


_HOW: Final = re.compile(
    r"(?: (?:lying|standing|sitting|parked|stored)|(?<!is|as)(?<!are|ere|een|ody|one) left)"
    r"(?: (?:around|about)\b|(?= (?:in|on|at|inside|within) ))"
)
"""How something is somewhere says nothing of whether it is there."""


def _stated(words: tuple[str, ...]) -> Asked:
    """What a statement says to be there, or to be free."""
    if (left := _left_behind(words)) is not None:
        return left
    at = next((n for n, word in enumerate(words) if word in _BE), None)
    if at is None:
        return Asked("state")
    if words[0] == "there":
        thing, place = _placed(words[at + 1 :])
        if {"enough", "room", "space"} & {*thing}:  # how much that is, nobody sees here
            return Asked("state")
        holds = not {*thing} & {"no", "nobody", "nothing"}
        return Asked("thing", _bare(thing), place, holds, holds and _is_unwanted(thing))
    state = [word for word in words[at + 1 :] if word not in ("completely", "still", "really", "all")]
    if state[:1] and state[0] in _CLEAR | _TAKEN:
        return Asked("room", (), words[:at], state[0] in _CLEAR)
    if words[at + 1 : at + 2] and words[at + 1] not in _THERE:
        return Asked("state")
    thing = words[:at]
    place = words[at + 2 :] if {*words[at + 1 : at + 2]} & _WITHIN else ()
    return Asked("thing", _bare(thing), place, thing[:1] != ("nobody",), _is_unwanted(thing))


def _left_behind(words: tuple[str, ...]) -> Asked | None:
    """What somebody may have left, or may have been left: it should not be there, whatever it is."""
    at = next((n for n, word in enumerate(words) if word in _LEFT), None)
    if at is None or not at:
        return None
    by_somebody, passive = words[0] in _SOMEBODY, words[at - 1] in _AUXILIARY
    if passive and {*words[at + 1 : at + 2]} - _LYING - _THERE:
        return None  # "a door was left open"
    thing, rest = _placed(words[at + 1 :])
    if passive:
        thing = words[: next(n for n, word in enumerate(words) if word in _AUXILIARY)]
        rest = _placed(("", *words[at + 1 :]))[1]
    thing = tuple(word for word in thing if word not in _LYING)
    if not thing or not (by_somebody or passive) or {*thing} & {"the", "it", "they", "them"}:
        return None
    holds = words[0] != "nobody" and thing[0] not in ("no", "nothing")
    return Asked("thing", _bare(thing), rest, holds, holds)


def _placed(words: tuple[str, ...]) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """A thing and where it is said to be."""
    small = lexicon().classes["prepositions"] - {"a", "the", "of"}
    at = next((n for n in range(1, len(words)) if words[n] in small), len(words))
    inside = words[at : at + 1] and words[at] in _WITHIN
    return words[:at], words[at + 1 :] if inside else ()


def _bare(words: Sequence[str]) -> tuple[str, ...]:
    small = lexicon().classes["determiners"] | {"any", "no", "some"}
    last = len(words) - 1  # "component A"
    return tuple(word for at, word in enumerate(words) if word not in small or (at and at == last))


def _is_unwanted(words: Sequence[str], *, sought: bool = False) -> bool:
    """Whether it is well if nothing of the kind is there.

    "Any boxes", "suspicious boxes", "leaks" and, where a place is looked through for them, "boxes"; but "the
    boxes", "my key" and "a chair" are needed.
    """
    classes = lexicon().classes
    if not words or words[0] in _SOMEBODY:
        return False
    if words[0] in ("any", "anything"):
        return True
    if words[0] in classes["determiners"] - {"a", "an", "some"}:
        return False
    if {*words} & classes["amiss"] or stem(words[-1]) in classes["mishaps"]:
        return True
    return sought and stem(words[-1]) != words[-1]
