"""Numbers, distances, angles and directions in words."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass

from parley.language.builtin.lexicon import Lexicon
from parley.language.lexicon import word_map, word_set

__all__ = ["NUMBERS", "ORDINALS", "UNITS", "Amount", "amount_of", "direction_of", "in_unit", "is_compass"]

_SMALL = """one two three four five six seven eight nine ten eleven twelve thirteen fourteen fifteen
sixteen seventeen eighteen nineteen"""
NUMBERS = {word: number for number, word in enumerate(_SMALL.split(), 1)}
"""What things are called by."""
_ONES = NUMBERS | {"zero": 0, "twice": 2, "thrice": 3}
_ROUND = "twenty thirty forty fifty sixty seventy eighty ninety"
_TENS = {word: 10 * tens for tens, word in enumerate(_ROUND.split(), 2)} | {"fourty": 40}
UNITS = word_map("""m:m metre:m meter:m metres:m meters:m cm:cm centimetre:cm centimeter:cm centimetres:cm
centimeters:cm inch:inches inches:inches foot:feet feet:feet ft:feet yard:yards yards:yards degree:degrees
degrees:degrees deg:degrees °:degrees mm:mm millimetres:mm millimeters:mm second:s seconds:s s:s sec:s
minute:min minutes:min min:min hour:h hours:h radians:radians""")
_LENGTHS = frozenset({"m", "cm", "inches", "feet", "yards", "mm"})
_ANGLES = frozenset({"degrees", "radians"})
_IN_ROW = "first second third fourth fifth sixth seventh eighth ninth tenth eleventh twelfth"
ORDINALS = {word: at for at, word in enumerate(_IN_ROW.split())} | {"last": -1, "final": -1}
ORDINALS |= {f"{at}{'th' if at > 3 else ('st', 'nd', 'rd')[at - 1]}": at - 1 for at in range(1, 13)}
"""Place in a row, from 0 on or from its end."""
_SAID_SO = word_set("""about at least another by around exactly roughly approximately more some for only
just maybe turn of a an the and like half quarter full hundred couple uh um to your circle say perhaps""")


@dataclass(frozen=True, slots=True)
class Amount:
    """A number with its unit."""

    value: float
    unit: str

    @property
    def kind(self) -> str:
        """`distance`, `angle`, `duration`, or `number` if there is no unit."""
        if self.unit in _LENGTHS:
            return "distance"
        return "angle" if self.unit in _ANGLES else "duration" if self.unit else "number"

    def __str__(self) -> str:
        return f"{self.value:g} {self.unit}".strip()


_SCALE = {
    "m": 1.0, "cm": 0.01, "mm": 0.001, "feet": 0.3048, "inches": 0.0254, "yards": 0.9144, "metres": 1.0,
    "centimetres": 0.01, "millimetres": 0.001, "s": 1.0, "min": 60.0, "h": 3600.0, "seconds": 1.0,
    "minutes": 60.0, "hours": 3600.0, "degrees": 1.0, "radians": 57.29578,
}  # fmt: skip


def in_unit(amount: Amount, unit: str) -> float:
    """The number of an amount in a unit; of one without a unit, or in one that is not known, its number.

    Args:
        amount: What was said.
        unit: Metres, seconds or degrees if empty.
    """
    to = _SCALE.get(unit, 1.0)
    return round(amount.value * _SCALE.get(amount.unit, to) / to, 4)


def amount_of(words: Sequence[str]) -> Amount | None:
    """The one amount that words mean; None if there is none, several, or words that are no part of it."""
    words = [part for word in words for part in _parted(word.lower())]
    unit = next((UNITS[word] for word in words if word in UNITS), "")
    number = [word for word in words if word not in UNITS and word not in _ABOUT]
    if any(not _is_part(word) for word in number) or sum(word in UNITS for word in words) > 1:
        return None
    if "turn" in words or "circle" in words:
        share = 90 if "quarter" in words else 180 if "half" in words else 360 if "full" in words else 0
        return Amount(share, "degrees") if share else None
    value = _number(number)
    return None if value is None else Amount(value, unit)


_ABOUT = frozenset({"about", "almost", "roughly", "approximately", "exactly", "nearly"})


def _parted(word: str) -> list[str]:
    """Number and unit of what was written as one word; the parts of words with a hyphen."""
    digits = next(
        (at for at, letter in enumerate(word) if not (letter.isdigit() or letter in ".,")), len(word)
    )
    if digits and word[digits:] in UNITS:
        return [word[:digits].replace(",", "."), word[digits:]]
    return word.split("-") if "-" in word else [word]


def _is_part(word: str) -> bool:
    return word in _ONES or word in _TENS or word in _SAID_SO or _digits(word) is not None


def _digits(word: str) -> float | None:
    return float(word) if word.replace(".", "", 1).isdigit() and word.isascii() else None


def _number(words: Sequence[str]) -> float | None:
    """What number words add up to; None if there are none, or two numbers."""
    total, current, seen, ended = 0.0, 0.0, False, False
    for at, word in enumerate(words):
        value = _digits(word)
        small = value if value is not None else _ONES.get(word, _TENS.get(word))
        if small is not None:
            if seen and (ended or not (current == 0 or current >= 100 or (current >= 20 and small < 10))):
                if current in _ONES.values() and word in _TENS:  # one eighty
                    current = current * 100 + small
                    continue
                return None
            current, seen, ended = current + small, True, value is not None
        elif word == "hundred":
            current, seen, ended = (current or 1) * 100, True, False
        elif word == "half":
            total, seen = total + 0.5, True
        elif word == "quarter":
            total, seen = total + 0.25, True
        elif word == "couple":
            current, seen = 2.0, True
        elif (
            word in ("a", "an", "another")
            and not seen
            and not {*words[at + 1 : at + 2]} & {"half", "quarter"}
            and not {*words[max(at - 2, 0) : at]} & {"half", "quarter"}
            and "hundred" not in words[at + 1 :]
        ):
            current, seen = 1.0, "couple" not in words
    return total + current if seen and total + current > 0 else None


def direction_of(words: Sequence[str], lexicon: Lexicon) -> str | None:
    """The one direction that words name, or None."""
    low = [word.lower() for word in words]
    joined = ["".join(pair) for pair in itertools.pairwise(low)]
    found = {name for name in _COMPASS if any(word in lexicon.classes[name] for word in [*low, *joined])}
    diagonal = {name for name in found if len(name) > 5}
    if diagonal:
        found = diagonal if len(diagonal) == 1 else found
    elif not found:
        found = {name for name in _SIDES if any(word in lexicon.classes[name] for word in low)}
        aside = found & {"left", "right", "back"}
        found = found - {"forward"} if aside and "and" not in low else found
    return found.pop() if len(found) == 1 else None


_SIDES = ("left", "right", "forward", "back", "around")
_COMPASS = ("north", "south", "east", "west", "northeast", "northwest", "southeast", "southwest")


def is_compass(direction: str) -> bool:
    """Whether a direction is one of the compass."""
    return direction in _COMPASS
