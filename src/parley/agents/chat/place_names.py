"""What a message says about the place where a robot stands: what it is called, that it is not, to forget it.

Only what can be nothing but a name counts ("this is the last time" and "this is urgent" are none), and
whoever asks has it confirmed. Pure.
"""

from __future__ import annotations

import re
from functools import cache
from typing import Any, Final

from parley.files import words_in

__all__ = ["corrected_place", "forgotten_place", "named_here", "taken_off"]

_LEADS: Final = re.compile(
    r"[\s,.!–-]*(?:(?:oh|ok|okay|please|well|and|so|now|look|listen|hey|hi|hello|palun|kuule|nii|nüüd)[\s,.!:–-]+)*",
    re.IGNORECASE,
)
_TAILS: Final = re.compile(
    r"(?:[\s,]+(?:please|now|by the way|ok|okay|right|thanks|thank you|palun|aitäh))*[\s.!]*$", re.IGNORECASE
)
_ARTICLE: Final = re.compile(r"^(?:the|a|an|our|my|all the|see|meie|minu)\s+", re.IGNORECASE)
_HEAD_ENDS: Final = re.compile(
    r"\s+(?:of|for|in|on|at|by|with|near|behind|beside|from|under)\s+", re.IGNORECASE
)
_MOST_CHARS: Final = 120
_MOST_WORDS: Final = 6


def named_here(message: str) -> str:
    """What a message calls the place where the robot stands; empty: it says nothing of the kind.

    Examples:
        >>> named_here("This is the pharmacy."), named_here("this is the last time")
        ('pharmacy', '')
    """
    bare = _bare(message)
    for kind in ("explicit", "naming", "estonian"):
        if name := _found(kind, _led(bare)):
            return name
    return ""


def corrected_place(message: str) -> str:
    """What the place is called instead, where that follows on what it was called; empty: it says no such."""
    bare = _bare(message)
    return _found("correcting", bare) or _found("correcting", _led(bare)) or named_here(message)


def forgotten_place(message: str) -> str:
    """What is to be forgotten, be it a place or something else; empty: nothing is."""
    return _found("forgetting", _led(_bare(message)))


def taken_off(message: str) -> str:
    """What is to be taken off the map; empty: nothing is."""
    return _found("taking_off", _led(_bare(message)))


def _bare(message: str) -> str:
    if len(message) > _MOST_CHARS or "?" in message or "\n" in message:
        return ""
    return _TAILS.sub("", " ".join(message.split()))


def _led(text: str) -> str:
    return text[_LEADS.match(text).end() :]  # type: ignore[union-attr]


def _found(kind: str, text: str) -> str:
    """The name that is said in one of these shapes, if it can be one."""
    for shape in _shapes(kind):
        found = shape.fullmatch(text)
        name = "" if found is None else next((value for value in found.groups() if value), "")
        if name and (clean := _name(name)):
            return clean
    return ""


def _name(said: str) -> str:
    name = _ARTICLE.sub("", said.strip(" \"“”„«»'‘’"))
    words = re.findall(r"[\w'’-]+", name.lower())
    data = words_in("parley.agents.chat", "place_names")
    head = re.findall(r"[\w'’-]+", _HEAD_ENDS.split(name.lower())[0])
    fine = 0 < len(words) <= _MOST_WORDS and head and not {*words} & {*data["clause"]}
    return name if fine and not {head[-1], words[0]} & {*data["nothing"]} else ""


@cache
def _shapes(kind: str) -> tuple[re.Pattern[str], ...]:
    read: dict[str, Any] = words_in("parley.agents.chat", "place_names")
    return tuple(re.compile(_filled(line, read["parts"]), re.IGNORECASE) for line in read[kind].splitlines())


def _filled(shape: str, parts: dict[str, str]) -> str:
    return re.sub(r"(?<!P)<(any|named|spot|stand|mind)>", lambda found: parts[found[1]], shape)
