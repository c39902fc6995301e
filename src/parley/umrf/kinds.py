"""What the inputs of an action take, as people speak of it: a place, a person, an angle, one of a few words.

Our own actions say so (`action(kinds=...)`, descriptors); for those of other makers it is derived from the
parameter's name, its declared type and what is said about it. Pure.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from types import MappingProxyType
from typing import Final, get_args

from parley.messages.pvf import SEPARATOR
from parley.messages.status import ActionInfo, Kind, ParameterInfo

__all__ = ["KINDS", "is_word_for", "parameters_of", "words_of_name"]

KINDS: Final[tuple[Kind, ...]] = get_args(Kind)

_NUMBERS: Final = frozenset({"number", "float", "double", "int", "integer"})
_BOOLEANS: Final = frozenset({"bool", "boolean"})


def _table(**rows: str) -> Mapping[str, str]:
    return MappingProxyType({word: name for name, words in rows.items() for word in words.split()})


_UNIT_OF: Final = _table(
    celsius="celsius", percent="percent", rpm="rpm", kilograms="kg", grams="grams", litres="litres liters",
    centimetres="cm centimetres centimeters", millimetres="mm millimetres millimeters",
    metres="m metre metres meter meters", degrees="deg degree degrees", minutes="min minute minutes",
    seconds="s sec secs second seconds", hours="hours",
)  # fmt: skip
"""Word of a name or description -> the unit it names."""
_MEASURED: Final = _table(
    celsius="c temperature temp", metres="distance depth altitude height length",
    degrees="angle rotation tilt yaw", seconds="duration",
)  # fmt: skip
"""What is measured -> the unit it is in where none is named; "degrees c" are celsius."""
_KIND_OF_UNIT: Final[Mapping[str, Kind]] = MappingProxyType(
    {
        **dict.fromkeys(("metres", "centimetres", "millimetres"), "distance"),
        "degrees": "angle",
        **dict.fromkeys(("seconds", "minutes", "hours"), "duration"),
    }
)
_KIND_OF_WORD: Final = _table(
    person="person who whom whoever patient guest visitor contact recipient receiver leader user customer "
    "client resident staff human somebody addressee performer doctor patients people pers passenger pupil",
    direction="direction heading side way orientation bearing course",
    place="place location loc room area destination dest goal waypoint where station position spot site zone "
    "dock bay aisle floor field surface lane route stop stage hall gate point landmark vessel",
    text="text txt message msg sentence words question utterance phrase speech note title reminder reason "
    "topic name announcement content query statement",
)
_LIST: Final = r"(?P<list>[\w-]+(?: [\w-]+)?(?:, [\w-]+(?: [\w-]+)?)*,? or [\w-]+(?: [\w-]+)?)"


def is_word_for(word: str, kind: Kind) -> bool:
    """Whether a word is one for a kind of thing: "visitor" for a person."""
    return _KIND_OF_WORD.get(word) == kind


def words_of_name(name: str) -> list[str]:
    """The words a name is made of, in small letters."""
    return re.findall(r"[a-z]+|\d+", re.sub(r"(?<=[a-z0-9])(?=[A-Z])", " ", name).lower())


def parameters_of(info: ActionInfo) -> dict[str, ParameterInfo]:
    """What each input takes: as it is told, else derived."""
    alike = [_is_of(kind, _NUMBERS) for kind in info.inputs.values()]
    return {
        name: info.parameters.get(name)
        or _derived(name, kind, info.description, alike.count(_is_of(kind, _NUMBERS)) == 1)
        for name, kind in info.inputs.items()
    }


def _derived(name: str, pvf_type: str, description: str, alone: bool) -> ParameterInfo:
    """What a parameter takes; what is said of the action counts for one that is alone of its type."""
    words = words_of_name(name.rpartition(SEPARATOR)[2])
    if _is_of(pvf_type, _NUMBERS):
        unit = _unit(words) or (_unit(re.findall(r"\w+", description.lower())) if alone else "")
        return ParameterInfo(kind=_KIND_OF_UNIT.get(unit, "number"), unit=unit)
    if _is_of(pvf_type, _BOOLEANS):
        return ParameterInfo(kind="choice", choices=("yes", "no"))
    choices = tuple(pvf_type.split("|")) if "|" in pvf_type else _choices(name, description, alone)
    if choices:
        return ParameterInfo(kind="choice", choices=choices)
    found = next((_KIND_OF_WORD[word] for word in words if word in _KIND_OF_WORD), "thing")
    return ParameterInfo.model_validate({"kind": found})


def _is_of(pvf_type: str, types: Iterable[str]) -> bool:
    return pvf_type.lower().rstrip("0123456789") in types


def _unit(words: Sequence[str]) -> str:
    if "per" in words:
        return ""
    if "c" in words:
        return "celsius"
    tables = (_UNIT_OF, _MEASURED)
    return next((table[word] for table in tables for word in words if word in table), "")


def _choices(name: str, description: str, alone: bool) -> tuple[str, ...]:
    """The closed list that a description gives: "mode is eco, boost or night"."""
    ways = [rf"\b{re.escape(name)}(?:(?: is| can be| may be)(?: one of)?|:) {_LIST}"]
    if alone:
        ways += [rf": {_LIST}\.?$", r"\b(?P<list>on or off|up or down|left or right)\b"]
    found = next((hit for way in ways if (hit := re.search(way, description, re.IGNORECASE))), None)
    return tuple(re.split(r",? or |, ", found["list"])) if found else ()
