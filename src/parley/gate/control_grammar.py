"""Stop and its kin in English: verbs with small words around them, and among what is told.

"Could you hold off for a tick", "continue with your round", "leave that one, next please" are put together
from few words each; "stop! there is a child" says one of them and why. What names a place or a thing, or
asks for something else as well, is none of them.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cache
from itertools import pairwise
from typing import Any, Final, Literal

from parley.files import words_in

__all__ = ["among_talk", "composed"]

Composed = Literal["stop", "start", "skip", "clear"]
Words = tuple[str, ...]

_ORDER: tuple[Composed, ...] = ("stop", "clear", "skip", "start")
_LONGEST = 12
_LONGEST_NAME = 4
_WEAK = frozenset({"wait", "hold", "hang", "one", "just", "stay", "moment"})
"""With these a sentence may also go on ("wait, the red one")."""


_THIS_FIRST = frozenset(
    {"this", "that", "it", "and", "go", "on", "move", "jump", "to", "do", "current", "what"}
)


@cache
def _data() -> dict[str, Any]:
    data: dict[str, Any] = words_in("parley.gate", "control_grammar")
    return data


@cache
def _phrases(name: str) -> tuple[Words, ...]:
    return tuple(sorted((tuple(text.split()) for text in _data()[name]), key=len, reverse=True))


@cache
def _verbs(kind: str) -> tuple[Words, ...]:
    return tuple(sorted((tuple(text.split()) for text in _data()[kind]["verbs"]), key=len, reverse=True))


def composed(words: Words) -> Composed | None:
    """What an utterance means that is one control verb with small words; None if it is more.

    Args:
        words: Lower case, without punctuation.
    """
    if not words or len(words) > _LONGEST:
        return None
    if words in _phrases("start_phrases"):  # "you can go" is more than "go"
        return "start"
    words = _unasked(words)
    half = len(words) // 2
    if half and words[:half] == words[half:]:
        # "Hang on, hang on".
        words = words[:half]
    for kind in _ORDER:
        if kind != "skip" and words in _phrases(f"{kind}_phrases"):
            return kind
    if words in _phrases("next"):
        return "skip"
    return next((kind for kind in _ORDER if _is_made_of(words, kind)), None)


def _unasked(words: Words) -> Words:
    words = ("would", "you", *words) if words[:1] == ("mind",) else words
    if (
        words[:3] in {("would", "you", "mind"), ("do", "you", "mind")}
        and words[3:4]
        and words[3].endswith("ing")
    ):
        stem = words[3][:-3]
        stem = stem[:-1] if stem[-1:] == stem[-2:-1] else stem
        known = {verb[0] for kind in _ORDER for verb in _verbs(kind)}
        words = (next((form for form in (stem, f"{stem}e") if form in known), stem), *words[4:])
    while True:
        lead = next((lead for lead in _phrases("asking") if words[: len(lead)] == lead), ())
        if not lead or len(lead) >= len(words) or words[:2] == ("do", "not"):
            return words
        words = words[len(lead) :]


_OF_A: Final = frozenset(
    {"step", "stop", "task", "action", "thing", "item", "leg", "place", "bit", "part", "piece"}
)


def _is_made_of(words: Words, kind: Composed) -> bool:
    verb = next((verb for verb in _verbs(kind) if words[: len(verb)] == verb), ())
    rest = set(words[len(verb) :])
    if not verb or not rest <= frozenset(_data()[kind]["small"]):
        return False
    if verb == ("move",):  # "move it" is said of what stands in the way, too
        return bool(rest & {"again", "on", "now", "off"}) and not rest & {"it", "this", "that"}
    if verb == ("finish",):
        return bool(rest & {"again", "on", "now", "off", "it", "this", "round", "job", "started"})
    if kind == "skip" and any(pair[0] == "a" and pair[1] not in _OF_A for pair in pairwise((*words, ""))):
        return False  # "leave out A"
    if kind == "skip" and "next" in rest and not rest & _THIS_FIRST:
        # "Skip the next one": what is done now is not meant.
        return False
    needed = _data()[kind].get("needs")
    return needed is None or bool(rest & frozenset(needed))


def among_talk(parts: Sequence[Words], control: Callable[[Words], str | None]) -> str | None:
    """The one control that an utterance asks for, where all else in it is only told or exclaimed.

    Args:
        parts: The utterance between its marks; lower case words.
        control: What a part means by itself.
    """
    parts = [part for part in parts if part]
    if not 1 < len(parts) <= 5:
        return None
    found = [(part, control(part) or composed(part)) for part in parts]
    said = {meant for _, meant in found if meant is not None}
    strongest = next(
        (kind for kind in ("emergency_stop", "clear", "stop", "skip", "start") if kind in said), None
    )
    beside = {"stop", "skip"} if strongest == "clear" else {"stop"}
    if strongest is None or (len(said) > 1 and not said <= {*beside, strongest}):
        return None
    weak = all(part[0] in _WEAK for part, meant in found if meant == strongest)
    rest = [part for part, meant in found if meant is None]
    return strongest if all(_is_talk(part, weak=weak) for part in rest) else None


def _goes_on(words: Words) -> bool:
    """For "kids crossing" and "two forklifts in the way": what is going on, as people call it out."""
    tail = next((tail for tail in _phrases("going_on") if words[-len(tail) :] == tail), ())
    before = words[: -len(tail)] if tail else ()
    return 0 < len(before) <= _LONGEST_NAME and not frozenset(_data()["no_names"]) & set(before)


def _is_talk(words: Words, *, weak: bool) -> bool:
    while words and not any(words[: len(start)] == start for start in _phrases("tells")):
        lead = next((lead for lead in _phrases("interjections") if words[: len(lead)] == lead), ())
        if not lead:
            break
        words = words[len(lead) :]
    if not words:
        return True
    tells = any(words[: len(lead)] == lead for lead in _phrases("tells"))
    if words in _phrases("tells") or (words[0] in {"only", "just"} and 1 < len(words) <= _LONGEST_NAME):
        return True  # "false alarm", "only the toaster"
    if _goes_on(words):
        return True
    called = not weak and words[0] in {"a", "an"}
    return tells and (called or bool(frozenset(_data()["finite"]) & set(words)))
