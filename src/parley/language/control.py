"""Stop and its kin, recognised before any language engine is asked (design section 5).

Whole utterances only: "stop!", "please wait", "arrête" are orders; "don't stop", "stop at the chair" and "is
there a bus stop?" are not.
"""

from __future__ import annotations

import re
import unicodedata
from functools import cache
from typing import Literal

from rapidfuzz.distance import OSA

from parley.language.word_lists import load_data

__all__ = ["Control", "control_of"]

Control = Literal["stop", "start", "skip", "clear", "emergency_stop"]
"""What the chat interface does at once; the names are those of the system commands, but for the last."""

_CONTROLS: tuple[Control, ...] = ("emergency_stop", "stop", "start", "skip", "clear")
_LONGEST_CHARS = 120
_NOT_ALONE = frozenset({"no", "and", "so", "right", "ok", "okay", "now", "well", "just", "then"})


def control_of(text: str, names: tuple[str, ...] = ()) -> Control | None:
    """The control that a whole utterance means, or None.

    Args:
        text: What the operator said.
        names: Names of robots, which may be called before or after ("stop, A!").
    """
    if len(text) > _LONGEST_CHARS:
        return None
    if text.strip().endswith("?"):
        return None
    words = _words(text)
    if not words:
        return None
    called = {part for name in names for part in _words(name)}
    return _look_up(words) or _look_up(_strip(words, called)) or _repeated(_strip(words, called))


def _words(text: str) -> tuple[str, ...]:
    low = unicodedata.normalize("NFC", text).lower().replace("’", "'")
    low = re.sub(r"\bdon'?t\b", "do not", low)
    low = re.sub(r"\blet's\b", "let us", low)
    low = re.sub(r"\bthat's\b", "that is", low)
    # Combining marks belong to the words of Indic scripts, so not everything outside \w is a separator.
    cleaned = "".join(c if c.isalnum() or unicodedata.category(c).startswith("M") else " " for c in low)
    return tuple(cleaned.split())


def _look_up(words: tuple[str, ...]) -> Control | None:
    return _table().get(words) or (_mistyped(words[0]) if len(words) == 1 else None)


def _strip(words: tuple[str, ...], called: set[str]) -> tuple[str, ...]:
    """Without politeness and robots' names at either end."""
    dropped = _polite() | called
    start, end = 0, len(words)
    while start < end and words[start] in dropped:
        start += 1
    while end > start and words[end - 1] in dropped:
        end -= 1
    rest = words[start:end]
    return rest if rest and not (len(rest) == 1 and rest[0] in _NOT_ALONE) else ()


def _repeated(words: tuple[str, ...]) -> Control | None:
    """The same order several times ("stop stop stop"), or several orders of which stopping is one."""
    if not 1 < len(words) <= 8:
        return None
    found: set[Control] = set()
    rest = words
    while rest:
        for length in range(min(len(rest), 5), 0, -1):
            control = _table().get(rest[:length])
            if control is not None:
                found.add(control)
                rest = rest[length:]
                break
        else:
            if rest[0] not in _polite():
                return None
            rest = rest[1:]
    strengths: tuple[Control, ...] = ("emergency_stop", "clear", "stop")
    for strongest in strengths:
        if strongest in found and found <= {"stop", strongest}:
            return (
                "emergency_stop"
                if strongest == "emergency_stop"
                else "clear"
                if strongest == "clear"
                else "stop"
            )
    return found.pop() if len(found) == 1 else None


def _mistyped(word: str) -> Control | None:
    """A lone word that is one slip from stopping, pausing, continuing or cancelling."""
    for meant, control in _SLIPS.items():
        close = sorted(word) == sorted(meant) or (len(meant) > 4 and OSA.distance(word, meant) == 1)
        doubled = re.fullmatch("".join(f"{letter}+" for letter in meant), word) is not None
        if (close and word[0] == meant[0]) or doubled:
            return control
    return None


_SLIPS: dict[str, Control] = {
    "stop": "stop", "wait": "stop", "halt": "stop", "pause": "stop", "freeze": "stop", "continue": "start",
    "resume": "start", "cancel": "clear", "abort": "clear",
}  # fmt: skip


@cache
def _polite() -> frozenset[str]:
    return frozenset(load_data("control")["polite"])


@cache
def _table() -> dict[tuple[str, ...], Control]:
    data = load_data("control")
    table: dict[tuple[str, ...], Control] = {}
    for control in _CONTROLS:
        for language in data[control]:
            for phrase in language:
                table.setdefault(_words(phrase), control)
    return table
