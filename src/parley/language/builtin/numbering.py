"""Numbers of things that are called by them, as people say them: "gate two", "the 2nd gate", "gate #1"."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Final

from parley.language.builtin.amounts import NUMBERS, ORDINALS
from parley.language.builtin.lexicon import stem
from parley.world.object_map import MapObject

__all__ = ["with_numbers"]

_ORDINALS: Final = [word for word, at in ORDINALS.items() if at >= 0 and word.isalpha()]
_MARK: Final = r"(?:(?:number|no\.?|nr\.?|#) ?)?"
_ONE: Final = rf"(?:\d+|{'|'.join(NUMBERS)})"
_ROW: Final = rf"{_MARK}{_ONE}(?:(?:, and |, | and | to | through | or | ?[-–] ?){_MARK}{_ONE})*"
_COUNTED: Final = r"(?:more|last|final|times?|by|of|(?:minute|second|hour|metre|meter|picture|photo|time)s?)"
_BEHIND: Final = re.compile(
    rf"\b(?P<kind>[a-z]+) (?P<numbers>{_ROW})(?![\w#])(?! {_COUNTED}\b)", re.IGNORECASE
)
_BEFORE: Final = re.compile(
    rf"\b(?:the )?(?P<which>{'|'.join(_ORDINALS)}|\d+(?:st|nd|rd|th)) (?P<kind>[a-z]+)\b"
    r"(?! ?(?:\d|#|no\b|number\b))",
    re.IGNORECASE,
)
_NUMBER: Final = re.compile(rf"{_MARK}(?P<said>{_ONE})\b", re.IGNORECASE)
_CALLED: Final = re.compile(r".*?(?P<kind>[a-z]+) (?P<number>\d+)", re.IGNORECASE)


def with_numbers(text: str, places: Sequence[MapObject]) -> str:
    """A text in which things that are called by numbers are called as the map calls them.

    An ordinal is such a number only where the things of that kind are numbered from 1 on without a gap.
    """
    known: dict[str, set[int]] = {}
    for place in places:
        for name in (place.description, *place.aliases):
            if (found := _CALLED.fullmatch(name)) is not None:
                known.setdefault(stem(found["kind"].lower()), set()).add(int(found["number"]))

    def behind(found: re.Match[str]) -> str:
        numbers = known.get(stem(found["kind"].lower()), set())
        said = [_number(one["said"]) for one in _NUMBER.finditer(found["numbers"])]
        if not numbers or not numbers.issuperset(said):
            return found[0]
        return f"{found['kind']} {_NUMBER.sub(lambda one: str(_number(one['said'])), found['numbers'])}"

    def before(found: re.Match[str]) -> str:
        numbers, which = known.get(stem(found["kind"].lower()), set()), found["which"].lower()
        number = ORDINALS[which] + 1 if which in ORDINALS else int(which.rstrip("stndrh"))
        whole = numbers == set(range(1, len(numbers) + 1))
        return f"{found['kind']} {number}" if whole and number in numbers else found[0]

    return _BEFORE.sub(before, _BEHIND.sub(behind, text)) if known else text


def _number(said: str) -> int:
    return NUMBERS.get(said.lower()) or int(said)
