"""Hours as people say them: "between two and three", "at night", "öösel". Pure."""

from __future__ import annotations

import re
from typing import Final

from parley.messages.rules import Day, Hours

__all__ = ["hours_in"]

_NUMBERS: Final = {
    word: number
    for words in (
        "one two three four five six seven eight nine ten eleven twelve",
        "ühest kahest kolmest neljast viiest kuuest seitsmest kaheksast üheksast kümnest üheteistkümnest"
        " kaheteistkümnest",
        "üheni kaheni kolmeni neljani viieni kuueni seitsmeni kaheksani üheksani kümneni üheteistkümneni"
        " kaheteistkümneni",
        "üks kaks kolm neli viis kuus seitse kaheksa üheksa kümme üksteist kaksteist",
    )
    for number, word in enumerate(words.split(), 1)
} | {"noon": 12, "midnight": 24, "keskööni": 24, "keskööst": 24}

_TIME: Final = (
    rf"(?P<{{0}}>\d{{{{1,2}}}}(?:[:.]\d{{{{2}}}})?|{'|'.join(sorted(_NUMBERS, key=len, reverse=True))})"
    r"(?:\s*o'?clock)?(?:\s*(?P<{0}half>am|pm|a\.m\.|p\.m\.))?"
)
_SPANS: Final = tuple(
    re.compile(form.format(a=_TIME.format("a"), b=_TIME.format("b")))
    for form in (
        r"\bbetween {a} and {b}(?!\w)",
        r"\bfrom {a} (?:to|until|till) {b}(?!\w)",
        r"\bkella {a} (?:kuni )?(?:kella )?{b}(?!\w)",
        r"\b{a} kuni {b}(?!\w)",
    )
)
_OPEN: Final = tuple(
    (re.compile(rf"\b{word} {_TIME.format('a')}(?!\w)(?!\s+(?!on\b|at\b|in\b|nobody\b)\w)"), is_start)
    for word, is_start in (
        (r"(?:after|past)", True), (r"before", False), (r"pärast kella", True), (r"enne kella", False),
    )
)  # fmt: skip
"""With one end; "after two knocks" is no hour."""
_MORNING, _EVENING, _DAY = 6 * 60, 18 * 60, 24 * 60
_PARTS: Final[tuple[tuple[str, str, str], ...]] = (
    (r"at night|during the night|by night|overnight|öösel|öösiti", "22:00", "06:00"),
    (r"in the mornings?|hommikul|hommikuti", "06:00", "12:00"),
    (r"in the afternoons?|pärastlõunal|pärastlõunati", "12:00", "18:00"),
    (r"in the evenings?|õhtul|õhtuti", "18:00", "22:00"),
    (r"during the day|by day|päeval", "06:00", "22:00"),
)
_DAYS: Final[tuple[tuple[str, tuple[Day, ...]], ...]] = (
    (r"(?:on|at) (?:the )?weekends?|nädalavahetus(?:el|eti)", ("sat", "sun")),
    (r"on (?:weekdays|working days|workdays)|tööpäeviti|tööpäevadel", ("mon", "tue", "wed", "thu", "fri")),
    (r"on mondays?|esmaspäev(?:al|iti)", ("mon",)),
    (r"on tuesdays?|teisipäev(?:al|iti)", ("tue",)),
    (r"on wednesdays?|kolmapäev(?:al|iti)", ("wed",)),
    (r"on thursdays?|neljapäev(?:al|iti)", ("thu",)),
    (r"on fridays?|reedel|reedeti", ("fri",)),
    (r"on saturdays?|laupäev(?:al|iti)", ("sat",)),
    (r"on sundays?|pühapäev(?:al|iti)", ("sun",)),
)


def hours_in(text: str) -> tuple[tuple[Hours | None, ...], str]:
    """The hours that a text speaks of, and the text without them.

    Returns:
        Every way in which they can be meant, the likelier first ("between two and three" is in the afternoon
        or in the night); a single None if it speaks of none.
    """
    days, text = _days_in(text)
    for pattern in _SPANS:
        if found := pattern.search(text):
            rest = text[: found.start()] + text[found.end() :]
            return tuple(_hours(start, end, days) for start, end in _meant(found)), _tidy(rest)
    for pattern, is_start in _OPEN:
        if found := pattern.search(text):
            rest = text[: found.start()] + text[found.end() :]
            meant = _one_ended(found, is_start=is_start)
            return tuple(_hours(start, end, days) for start, end in meant), _tidy(rest)
    for words, start, end in _PARTS:
        if found := re.search(rf"(?:\b(?:{words})\b)", text):
            rest = text[: found.start()] + text[found.end() :]
            return (_hours(start, end, days),), _tidy(rest)
    return (Hours(days=days) if days else None,), text


def _hours(start: str, end: str, days: tuple[Day, ...]) -> Hours:
    return Hours(days=days, start=start, end=end)


def _days_in(text: str) -> tuple[tuple[Day, ...], str]:
    days: list[Day] = []
    for words, named in _DAYS:
        if re.search(rf"\b(?:{words})\b", text):
            text = _tidy(re.sub(rf"(?:,|\band|\bja)?\s*\b(?:{words})\b", "", text))
            days += named
    return tuple(dict.fromkeys(days)), text


def _meant(found: re.Match[str]) -> list[tuple[str, str]]:
    """Start and end; twice if nobody can tell the morning from the afternoon."""
    end_half = (found["bhalf"] or "").replace(".", "")
    start_half = (found["ahalf"] or "").replace(".", "") or end_half
    start, plain_start = _minute(found["a"], start_half)
    end, plain_end = _minute(found["b"], end_half or start_half)
    clear = bool(start_half) or not (plain_start and plain_end)
    if clear or start > 12 * 60 or end > 12 * 60:
        return [(_text(start), _text(end))]
    early, late = (start, end), ((start + 720) % 1440, end + 720 if end < 720 else end)
    pair = [late, early] if start < 7 * 60 else [early, late]
    return [(_text(a), _text(b)) for a, b in pair]


def _one_ended(found: re.Match[str], *, is_start: bool) -> list[tuple[str, str]]:
    """From an hour to the end of the night or of the day, or from midnight to it; the likelier first."""
    half = (found["ahalf"] or "").replace(".", "")
    minute, plain = _minute(found["a"], half)
    minutes = [minute % _DAY] if half or not plain else [(minute + 720) % _DAY, minute % _DAY]
    if not is_start:
        return [("00:00", _text(minute)) for minute in reversed(minutes)]
    return [(_text(minute), _text(_DAY if _MORNING <= minute < _EVENING else _MORNING)) for minute in minutes]


def _minute(text: str, half: str) -> tuple[int, bool]:
    """The minute of the day, and whether it may as well be meant twelve hours later."""
    if text in _NUMBERS:
        hour, minute, plain = _NUMBERS[text], 0, _NUMBERS[text] < 24
    else:
        hours, _, minutes = text.replace(".", ":").partition(":")
        hour, minute, plain = int(hours), int(minutes or 0), not minutes
    if half == "pm" and hour < 12:
        hour += 12
    elif half == "am" and hour == 12:
        hour = 0
    return min(hour * 60 + minute, 1440), plain and 1 <= hour <= 12


def _text(minute: int) -> str:
    return f"{minute // 60:02d}:{minute % 60:02d}"


def _tidy(text: str) -> str:
    return re.sub(r"\s+", " ", text).strip(" ,;")
