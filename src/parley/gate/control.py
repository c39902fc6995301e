"""Stop and its kin, recognised before any language engine is asked (design section 5).

Whole utterances only: "stop!", "please wait", "arrête" are orders; "don't stop", "stop at the chair" and "is
there a bus stop?" are not. What else calls to stop is read by `stop_words`.
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterator
from functools import cache
from typing import Final, Literal

from rapidfuzz.distance import OSA

from parley.files import words_in
from parley.gate.control_grammar import among_talk, composed

__all__ = ["Control", "behind_stop", "control_of", "stops_all"]

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
    words, asked = _unasked(_words(text))
    if not words or (text.strip().endswith("?") and not asked):
        return None
    if _stops_doing(words):
        return "stop"
    called = {part for name in names for part in _words(name)} | (_EVERYBODY if names else set())
    bare = tuple(word for word in words if word not in _around())
    if 0 < len(bare) < len(words) and (found := _table().get(bare)) is not None:
        return found
    plain = _strip(_without_span(words), called)
    if _clears(plain):
        return "clear"
    if len(plain) < len(words) and _look_up(plain) == "stop":
        return "stop"
    return _look_up(words) or _look_up(plain) or stops_all(text) or _in_full(text, words, called)


def stops_all(text: str) -> Literal["stop", "emergency_stop"] | None:
    """What words of stopping mean with who all is before or behind them: "emergency stop for all"."""
    words = _strip(_words(text), set()) if len(text) <= _LONGEST_CHARS else ()
    for whom in _everybody():
        size = len(whom)
        for rest in (words[size:] * (words[:size] == whom), words[:-size] * (words[-size:] == whom)):
            bare = _strip(rest, set())
            if _look_up(bare) == "stop":
                return "stop"
            if _look_up(bare[:-1] if {*bare[-1:]} & _for() else bare) == "emergency_stop":
                return "emergency_stop"
    return None


def behind_stop(text: str, names: tuple[str, ...] = ()) -> Iterator[tuple[str, str]]:
    """The words of stopping at the head of a message, and what comes behind them, shortest head first.

    Args:
        text: What the operator said: "stop, all of you back to the dock".
        names: Names of robots.
    """
    called = {part for name in names for part in _words(name)}
    for cut in _CUT.finditer(text[:_LONGEST_CHARS]):
        head, rest = text[: cut.start()], text[cut.end() :]
        bare = _strip(_without_span(_words(head)), called)
        if rest and "stop" in (_look_up(bare), _repeated(bare), composed(bare), stops_all(head)):
            yield head, rest


_CUT: Final = re.compile(r"[\s,.;:!–—-]+(?:(?:and|then|but|ja|siis)\s+)*", re.IGNORECASE)

_EVERYBODY = {"everyone", "everybody", "robots"}


def _in_full_words(text: str) -> str:
    for short, full in (("'s", " is"), ("'m", " am"), ("'re", " are"), ("'ve", " have"), ("'ll", " will")):
        text = re.sub(rf"(?<=\w){short}\b", full, text.replace("’", "'"))
    return text


def _in_full(text: str, words: tuple[str, ...], called: set[str]) -> Control | None:
    """What is put together from a verb and small words, or said among what is only told."""
    alone = _strip(words, called)
    whole = _look_up(alone) or _repeated(alone) or composed(alone)
    if whole is not None:
        return whole
    parts = [
        _unasked(_words(part))[0]
        for part in re.split(
            r"[.!?,;:\n–—]+|\s-\s|\bbecause\b|\bso\b(?!\s+(?:far|fast|that))", _in_full_words(text)
        )
    ]

    def meant(part: tuple[str, ...]) -> str | None:
        bare = _strip(_without_span(part), called)
        foreign = tuple(word for word in part if word not in _around())
        if foreign and foreign != part and foreign in _table():
            return _table()[foreign]
        return "clear" if _clears(bare) else _look_up(part) or _look_up(bare) or composed(bare)

    corrected = next((size for size in range(len(parts) - 1, 0, -1) if _takes_back(parts[size])), 0)
    if corrected and len(parts) < 5 and meant(parts[0]) is not None:
        # "Stop, no, I mean carry on": the last word counts.
        rest = tuple(word for part in parts[corrected:] for word in part)
        rest = rest[_takes_back(rest) :]
        last = meant(rest) if rest else None
        return next((control for control in _CONTROLS if control == last), None)
    among = among_talk([part for part in parts if not part or not set(part) <= called], meant)
    told = sum(len(part) for part in parts if meant(part) is None)
    if among == "skip" and told > 2 and not _OF_ANYTHING.isdisjoint(words) and "step" not in words:
        return None  # "there is a box, ignore it": that is what was just told of
    return next((control for control in _CONTROLS if control == among), None)


_OF_ANYTHING = frozenset({"leave", "ignore"})
"""Verbs that mean a step only where nothing else was spoken of."""
_TAKING_BACK = (
    ("no", "i", "mean"), ("i", "mean"), ("i", "meant"), ("no", "wait"), ("or", "rather"), ("rather",),
    ("no", "actually"),
    ("actually",), ("on", "second", "thoughts"), ("sorry", "i", "mean"), ("sorry", "i", "meant"),
    ("no", "sorry"),
)  # fmt: skip


def _takes_back(words: tuple[str, ...]) -> int:
    """How many words at the start take back what was said; 0 if none do."""
    return next((len(lead) for lead in _TAKING_BACK if words[: len(lead)] == lead), 0)


def _words(text: str) -> tuple[str, ...]:
    low = unicodedata.normalize("NFC", text).lower().replace("’", "'")
    low = re.sub(r"\bdon'?t\b", "do not", low)
    low = re.sub(r"\blet's\b", "let us", low)
    low = re.sub(r"\bthat's\b", "that is", low)
    # Combining marks belong to the words of Indic scripts, so not everything outside \w is a separator.
    cleaned = "".join(c if c.isalnum() or unicodedata.category(c).startswith("M") else " " for c in low)
    return tuple(cleaned.split())


_ASKING = (
    ("can", "you"), ("could", "you"), ("would", "you"), ("will", "you"), ("i", "want", "you", "to"),
    ("i", "need", "you", "to"), ("you", "should"), ("you", "must"), ("you", "need", "to"),
    ("you", "have", "to"),
    ("i", "would", "like", "you", "to"), ("i", "said"), ("i", "told", "you", "to"), ("please", "can", "you"),
    ("please", "could", "you"),
)  # fmt: skip


def _unasked(words: tuple[str, ...]) -> tuple[tuple[str, ...], bool]:
    """Without "could you" and the like before an order, and whether there was any."""
    size = next((len(lead) for lead in _ASKING if words[: len(lead)] == lead), 0)
    return (words[size:], bool(size)) if len(words) > size else (words, False)


_SAYING = frozenset({"talking", "asking", "saying", "joking", "kidding", "bothering", "being", "apologizing"})


def _stops_doing(words: tuple[str, ...]) -> bool:
    """For "stop following me", "stop driving around"; not for "stop talking", nor "stop going to the box"."""
    doing = words[1] if len(words) > 1 and words[0] == "stop" else ""
    short = len(words) <= 3 or set(words[2:]) <= {
        "me",
        "him",
        "her",
        "it",
        "them",
        "us",
        "around",
        "please",
        "now",
    }
    return doing.endswith("ing") and doing not in _SAYING and short


_SPANS = tuple(
    tuple(text.split())
    for text in (
        "for a second", "for a sec", "for a moment", "for a minute", "for a bit", "for a while",
        "a second", "a sec",
        "a moment", "a minute", "a bit", "for now", "right there", "where you are",
        "until further notice",
        "what you are doing", "whatever you are doing", "everything you are doing", "doing that",
        "doing this",
        "immediately", "at once", "this instant", "right now",
    )
)  # fmt: skip


def _without_span(words: tuple[str, ...]) -> tuple[str, ...]:
    """Without how long or where one should stop; that changes nothing."""
    end = next((len(s) for s in _SPANS if len(words) > len(s) and words[-len(s) :] == s), 0)
    return words[: len(words) - end]


_CLEARING = frozenset({
    "cancel", "abort", "scrap", "clear", "discard", "abandon", "drop", "delete", "erase", "remove", "kill",
    "ditch",     "scratch", "forget", "dismiss", "terminate", "end", "empty", "wipe", "undo",
})  # fmt: skip
_PLANS = frozenset({
    "plan", "mission", "queue", "task", "tasks", "job", "jobs", "list", "tour", "orders", "steps", "actions",
    "thing",     "lot", "round", "route", "schedule", "instructions", "operation", "order",
})  # fmt: skip
_WHOLE = frozenset(
    {"the", "whole", "entire", "current", "complete", "all", "of", "my", "your", "our", "this", "rest"}
)  # fmt: skip
_STRONG = frozenset({"cancel", "abort", "scrap", "discard", "abandon", "ditch", "terminate"})


def _clears(words: tuple[str, ...]) -> bool:
    """For "scrap the whole plan", "call it all off", "cancel all of it": the whole plan is given up."""
    if words[:1] == ("call",) and words[-1:] == ("off",):
        return (
            set(words[1:-1]) <= {"it", "all", "everything", "the", "whole", "thing", "of"} and len(words) > 2
        )
    if words[:1] == ("call",) and words[1:2] == ("off",):
        words = ("cancel", *words[2:])
    if len(words) < 2 or words[0] not in _CLEARING:
        return False
    rest = words[1:]
    if set(rest) <= {"it", "all", "everything", "of", "that", "this"}:
        return words[0] in _STRONG and bool({"all", "everything"} & set(rest))
    whole = bool({"all", "whole", "entire", "complete", "plan", "mission", "queue"} & set(rest))
    return rest[-1] in _PLANS and set(rest[:-1]) <= _WHOLE and whole


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
def _around() -> frozenset[str]:
    return frozenset(part for text in words_in("parley.gate", "control")["around"] for part in text.split())


@cache
def _everybody() -> tuple[tuple[str, ...], ...]:
    phrases = words_in("parley.gate", "control")["everybody"]
    return tuple(sorted(map(_words, phrases), key=len, reverse=True))


@cache
def _for() -> frozenset[str]:
    return frozenset(words_in("parley.gate", "control")["for"])


@cache
def _polite() -> frozenset[str]:
    return frozenset(words_in("parley.gate", "control")["polite"])


@cache
def _table() -> dict[tuple[str, ...], Control]:
    data = words_in("parley.gate", "control")
    table: dict[tuple[str, ...], Control] = {}
    for control in _CONTROLS:
        for language in data[control]:
            for phrase in language:
                table.setdefault(_words(phrase), control)
    return table
