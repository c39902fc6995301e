"""Numbers with their units in what is said, and what parameters of actions take of them."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace

from parley.language.offline.words.lexicon import PhraseTable, lexicon
from parley.language.offline.words.naming import name_words
from parley.language.offline.words.text import Phrase, keys
from parley.language.word_lists import load_data

__all__ = [
    "Quantity",
    "Taken",
    "is_unit",
    "levels",
    "number_words",
    "plain_coordinates",
    "plain_units",
    "quantities",
    "taken_by",
]

_DATA = load_data("quantities")
_UNITS: dict[str, dict[str, float]] = {}
for _dimension, _listed in _DATA["units"].items():
    for _unit, _factor in _listed.items():
        _UNITS.setdefault(_unit, {})[_dimension] = float(_factor)
_TENS: dict[str, int] = {word: int(number) for word, number in _DATA["tens"].items()}
_NUMBER = re.compile(r"-?\d+(?:[.,]\d+)?")
_WITH_UNIT = re.compile(r"(-?\d+(?:[.,]\d+)?)([a-z]+)")
_SMALL = {"a": 1.0, "an": 1.0, "half": 0.5, "quarter": 0.25, "couple": 2.0, "few": 3.0, "dozen": 12.0}
_LEVELS = PhraseTable.of(_DATA["levels"])
_TIMES = {"twice": 2.0, "thrice": 3.0}
_SHORT_UNIT = 2
_SI = frozenset({"time", "length"})
"""Given in seconds and metres where a parameter's name has no unit."""


@dataclass(frozen=True, slots=True)
class Quantity:
    """One number that is said."""

    value: float
    """As said."""
    units: tuple[tuple[str, float], ...]
    """What its unit may measure, and what one of it is in the first unit of that; empty without unit."""
    start: int
    end: int
    """Its words, unit included."""
    before: str = ""
    """The word before it."""

    @property
    def dimensions(self) -> frozenset[str]:
        """What its unit may measure."""
        return frozenset(dimension for dimension, _ in self.units)


@dataclass(frozen=True, slots=True)
class Taken:
    """What a numeric parameter takes, by its name."""

    dimensions: frozenset[str]
    """Empty if its name does not tell."""
    factor: float | None
    """What one of its unit is in the first unit of the dimension; None if its name has no unit."""
    words: frozenset[str]

    @property
    def names(self) -> frozenset[str]:
        """What parameters are called that take the same."""
        return frozenset(name for dimension in self.dimensions for name in _DATA["takes"][dimension])

    def value_of(self, said: Quantity) -> float:
        """The number for the parameter, in its own unit."""
        shared = [(d, f) for d, f in said.units if d in self.dimensions or not self.dimensions]
        if not shared:
            return said.value
        dimension, factor = shared[0]
        if self.factor is None:
            return round(said.value * (factor if dimension in _SI else 1.0), 6)
        return round(said.value * factor / self.factor, 6)

    def fit(self, said: Quantity) -> int:
        """How well a number fits: 0 if it does not, 1 without unit, 2 if unit or name agree, 3 if both."""
        named = said.before in self.words
        if not said.units:
            return 2 if named else 1
        if not self.dimensions:
            return 1
        return (2 + named) if said.dimensions & self.dimensions else 0


def taken_by(parameter: str, description: str = "") -> Taken:
    """What a numeric parameter takes.

    Args:
        parameter: Its name.
        description: Of its action; tells the unit if the name does not ("... in minutes").
    """
    spaced = re.sub(r"([a-z])([A-Z])", r"\1 \2", parameter).replace("_", " ").lower()
    raw = re.findall(r"[a-z]+", plain_units(spaced))
    words = frozenset((*raw, *name_words(parameter)))
    by_unit = [
        (d, f) for word in raw for d, f in _UNITS.get(word, {}).items() if len(word) > 1 or word != raw[0]
    ]
    by_name = frozenset(d for d, names in _DATA["takes"].items() if words & set(names))
    if by_unit:
        both = [(d, f) for d, f in by_unit if d in by_name] or by_unit
        return Taken(frozenset(d for d, _ in both), both[0][1], words)
    told = re.findall(r"\bin ([a-z]+)", description.lower())
    for unit in told:
        for dimension, factor in _UNITS.get(unit, {}).items():
            if dimension in by_name and len(unit) > 1:
                return Taken(by_name, factor, words)
    return Taken(by_name, None, words)


def quantities(words: Phrase) -> list[Quantity]:
    """The numbers of a phrase, in order."""
    flat = keys(words)
    found: list[Quantity] = []
    index = 0
    while index < len(flat):
        read = _quantity(flat, index)
        if read is None:
            index += 1
            continue
        found.append(read)
        index = read.end
    for at in range(len(found) - 2, -1, -1):
        # "40 by 60 cm" measures both in the same unit.
        one, other = found[at], found[at + 1]
        between = flat[one.end : other.start] in {("by",), ("x",)}
        if (
            between
            and other.units
            and not one.units
            and one.before in {"to", "a", "of", "into", "size", "is", "at"}
        ):
            found[at] = replace(one, units=other.units)
    return found


def levels(words: Phrase) -> list[Quantity]:
    """Words for so many percent ("halfway"), in order."""
    flat = keys(words)
    found = ((i, _LEVELS.match(flat, i)) for i in range(len(flat)))
    return [
        Quantity(float(_DATA["levels"][one[1]]), _units("percent"), i, i + one[0])
        for i, one in found
        if one is not None
    ]


def is_unit(word: str) -> bool:
    """Whether a word names what a number before it measures ("percent", "degrees")."""
    return word in _UNITS and len(word) > _SHORT_UNIT


def number_words() -> frozenset[str]:
    """All single words for numbers."""
    return frozenset({*lexicon().numbers, *_TENS})


def is_measure(words: Phrase) -> bool:
    """Whether words say nothing but how long or how much ("a minute and a half")."""
    flat = keys(words)
    bare = is_unit(flat[0]) and flat[1:] in {(), ("and", "a", "half")}
    return bare or any(q.units and not q.start and q.end == len(flat) for q in quantities(words))


def _quantity(flat: Sequence[str], start: int) -> Quantity | None:
    before = flat[start - 1] if start else ""
    if flat[start] in _TIMES or (flat[start] == "once" and start == len(flat) - 1 and start):
        return Quantity(_TIMES.get(flat[start], 1.0), _units("times"), start, start + 1, before)
    joined = _WITH_UNIT.fullmatch(flat[start])
    if joined and joined[2] in _UNITS:
        return Quantity(_float(joined[1]), _units(joined[2]), start, start + 1, before)
    number = _number(flat, start)
    if number is None:
        return None
    value, end = number
    unit = flat[end] if end < len(flat) else ""
    if unit in _UNITS and not (unit == "x" and flat[end + 1 : end + 2]):
        end += 1
        if flat[end : end + 3] == ("and", "a", "half"):
            value, end = value + 0.5, end + 3
        elif unit in _METRES and (more := _in_words(flat, end) or _digits(flat, end)):
            # "A metre twenty".
            value, end = value + more[0] / 100, more[1]
        return Quantity(value, _units(unit), start, end, before)
    return None if flat[start] in _SMALL else Quantity(value, (), start, end, before)


_METRES = frozenset({"metre", "meter", "metres", "meters"})


def _digits(flat: Sequence[str], at: int) -> tuple[float, int] | None:
    """A whole number of two digits without a unit of its own."""
    said = (
        at < len(flat) and re.fullmatch(r"[1-9]\d", flat[at]) and not is_unit(" ".join(flat[at + 1 : at + 2]))
    )
    return (float(flat[at]), at + 1) if said else None


def _units(unit: str) -> tuple[tuple[str, float], ...]:
    return tuple(_UNITS[unit].items())


def _number(flat: Sequence[str], start: int) -> tuple[float, int] | None:
    """A number and where it ends: "-2", "minus two", "one hundred and twenty", "half a"."""
    if flat[start] in {"minus", "negative"} and start + 1 < len(flat):
        read = _number(flat, start + 1)
        return None if read is None else (-read[0], read[1])
    if _NUMBER.fullmatch(flat[start]):
        return _float(flat[start]), start + 1
    if flat[start] in _SMALL:
        end = start + 1
        value = _SMALL[flat[start]]
        while end < len(flat) and flat[end] in {"a", "an", "of", *_SMALL}:
            value = (
                _SMALL.get(flat[end], value)
                if flat[end] in _SMALL and flat[end] not in {"a", "an"}
                else value
            )
            end += 1
        return value, end
    return _in_words(flat, start)


def _in_words(flat: Sequence[str], start: int) -> tuple[float, int] | None:
    value, end = 0.0, start
    while end < len(flat):
        parts = flat[end].split("-")
        numbers = [_word_value(part) for part in parts]
        if flat[end] == "hundred" and end > start:
            value *= 100
        elif all(number is not None for number in numbers):
            value += sum(number or 0 for number in numbers)
        elif not (flat[end] == "and" and end > start and flat[end - 1] == "hundred"):
            break
        end += 1
    return (value, end) if end > start else None


def _word_value(word: str) -> int | None:
    return lexicon().numbers.get(word, _TENS.get(word))


def _float(text: str) -> float:
    return float(text.replace(",", "."))


_N = r"-?\d+(?:\.\d+)?"
_GAP = r"\s*(?:[,;/]|and|\s)\s*"
_NAMED_AXES = re.compile(
    rf"\bx\s*(?:=|:|is)?\s*({_N})(?:\s*m\b)?{_GAP}y\s*(?:=|:|is)?\s*({_N})(?:\s*m\b)?"
    rf"(?:{_GAP}z\s*(?:=|:|is)?\s*({_N})(?:\s*m\b)?)?",
    re.IGNORECASE,
)
_IN_BRACKETS = re.compile(rf"[(\[]\s*({_N}){_GAP}({_N})(?:{_GAP}({_N}))?\s*[)\]]")
_BEFORE_PLACES = "".join(
    rf"(?<=\b{word} )|" for word in ("to", "for", "towards", "point", "position", "coordinates")
).rstrip("|")
_BEHIND_TO = re.compile(
    rf"(?:{_BEFORE_PLACES})({_N})\s*[,;/]\s*({_N})(?:\s*[,;/]\s*({_N}))?(?![\d,])", re.IGNORECASE
)


def plain_coordinates(message: str) -> str:
    """The message with each place in numbers written in one way: "(1, -2)" and "x=1, y=-2" are "x 1 y -2"."""
    for pattern in (_NAMED_AXES, _IN_BRACKETS, _BEHIND_TO):
        message = pattern.sub(_written_out, message)
    return message


_RATES = tuple((re.compile(pattern, re.IGNORECASE), unit) for pattern, unit in _DATA["rates"].items())


def plain_units(text: str) -> str:
    """The text with units of several words as one: "metres per second" is "mps", "40 %" is "40 percent"."""
    if "per" in text or "/" in text or "%" in text or "degree" in text or "turn" in text:
        for pattern, unit in _RATES:
            text = pattern.sub(unit, text)
    return text


def _written_out(found: re.Match[str]) -> str:
    axes = (f"{axis} {number}" for axis, number in zip("xyz", found.groups(), strict=True) if number)
    return " ".join(axes)
