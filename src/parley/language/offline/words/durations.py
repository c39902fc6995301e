"""Spans of time in words."""

from __future__ import annotations

import re

from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.text import Phrase, keys

__all__ = ["duration_s", "is_clock", "without_duration"]

_UNITS_S = {
    "second": 1.0, "seconds": 1.0, "sec": 1.0, "secs": 1.0, "s": 1.0, "minute": 60.0, "minutes": 60.0,
    "min": 60.0, "mins": 60.0, "hour": 3600.0, "hours": 3600.0, "h": 3600.0,
}  # fmt: skip
_VAGUE = {"a": 1.0, "an": 1.0, "half": 0.5, "couple": 2.0, "few": 3.0, "quarter": 0.25}


def duration_s(phrase: Phrase) -> float | None:
    """The span that a phrase names ("half a minute" is 30), or None if it names none."""
    flat = keys(phrase)
    at = next((i for i in range(1, len(flat)) if flat[i] in _UNITS_S), 0)
    if not at:
        return None
    count, words = 1.0, [word for word in flat[max(0, at - 3) : at] if word not in {"for", "of"}]
    for word in words:
        if re.fullmatch(r"\d+(?:[.,]\d+)?", word):
            count = float(word.replace(",", "."))
        elif word in lexicon().numbers:
            count = float(lexicon().numbers[word])
        elif word in _TENS:
            count = _TENS[word]
        elif word in _VAGUE:
            count = _VAGUE[word] if word not in {"a", "an"} or count == 1.0 else count
    half = flat[at + 1 : at + 4] == ("and", "a", "half")
    return (count + 0.5 * half) * _UNITS_S[flat[at]]


def without_duration(phrase: Phrase) -> Phrase:
    """Without a span of time at the end ("the box for ten seconds" is "the box")."""
    flat = keys(phrase)
    if not flat or flat[-1] not in _UNITS_S:
        return phrase
    at = next((i for i in range(len(flat) - 2, 0, -1) if flat[i] in {"for", "in"}), 0)
    return phrase[:at] if at and len(flat) - at <= 5 else phrase


_TENS = {
    "fifteen": 15.0,
    "twenty": 20.0,
    "thirty": 30.0,
    "forty": 40.0,
    "fifty": 50.0,
    "sixty": 60.0,
    "ninety": 90.0,
}


def is_clock(flat: tuple[str, ...]) -> bool:
    """Whether words are nothing but a time of day ("nine", "half past ten", "noon").

    Args:
        flat: Lower case words.
    """
    return bool(flat) and not flat[0].isdigit() and set(flat) <= _CLOCK | set(lexicon().numbers)


_CLOCK = frozenset({
    "half", "quarter", "past", "to", "o'clock", "am", "pm", "sharp", "noon", "midnight", "in", "the",
    "morning", "evening", "afternoon", "or", "so", "at", "latest", ".", "please",
})  # fmt: skip
