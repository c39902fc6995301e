"""What people say they will do themselves ("I'll go to A and see whether ..."): told, not asked for."""

from __future__ import annotations

from itertools import pairwise
from typing import Final

from parley.language.offline.words.text import Phrase, Word, keys, tokens

__all__ = ["straight_on", "without_own_plans"]

_ENDS: Final = frozenset({".", "!", "?", ";"})
_OPENERS: Final = frozenset(
    {"ok", "okay", "well", "right", "now", "no", "yes", "then", "thanks", "and", "but", ","}
)
_PLANS: Final = (("i", "will"), ("i", "shall"), ("we", "will"), ("we", "shall"), ("i", "am", "going", "to"))
_DEEDS: Final = frozenset(
    {
        "go", "drive", "walk", "come", "pop", "run", "check", "look", "see", "inspect", "visit", "do",
        "head", "fetch", "bring", "ask",
    }
)  # fmt: skip
_ORDERED: Final = frozenset({"you", "please", "can", "could", "would", "so", "while", "but", "robot"})
"""With one of these the rest of the sentence may be meant for the robot."""
_WHO: Final = (
    ("who", "told", "you"),
    ("who", "asked", "you"),
    ("who", "ordered", "you"),
    ("who", "allowed", "you"),
)


def without_own_plans(words: Phrase) -> Phrase:
    """The same message without what the speaker does besides, or what "who told you to ...?" names."""
    cuts = [-1, *(i for i, word in enumerate(words) if word.key in _ENDS), len(words)]
    result: list[Word] = []
    for before, end in pairwise(cuts):
        result += _one(words[before + 1 : end])
        result += words[end : end + 1]
    return tuple(result)


def _one(sentence: Phrase) -> Phrase:
    flat = keys(sentence)
    start = next((i for i, key in enumerate(flat) if key not in _OPENERS), len(flat))
    if flat[start : start + 3] in _WHO and "to" in flat[start + 3 : start + 4]:
        return (*sentence[: start + 3], *tokens("that"))
    plan = next((plan for plan in _PLANS if flat[start : start + len(plan)] == plan), None)
    if plan is None or flat[start + len(plan) : start + len(plan) + 1] not in {(deed,) for deed in _DEEDS}:
        return sentence
    more = next((i for i in range(start + len(plan), len(flat)) if flat[i] == "and"), len(flat))
    return sentence if _ORDERED & set(flat[more:]) else sentence[:more]


_STOPPING: Final = frozenset(
    {"stop", "halt", "pause", "rest", "stopping", "halting", "pausing", "break", "stay", "linger"}
)
_UNTIL: Final = frozenset({"until", "till", "before"})
_REACHING: Final = (
    ("reach",), ("have", "reached"), ("get", "to"), ("have", "got", "to"), ("are", "at"), ("are", "in"),
    ("arrive", "at"),
    ("arrive", "in"), ("come", "to"), ("have", "arrived", "at"), ("make", "it", "to"), ("see",), ("hit",),
)  # fmt: skip


def straight_on(words: Phrase) -> Phrase:
    """For "do not stop until you reach A" the order to go to A."""
    flat = keys(words)
    for at in range(len(flat) - 5):
        if flat[at : at + 2] == ("do", "not"):
            verb = at + 2
        elif flat[at] in {"never", "without"}:
            verb = at + 1
        else:
            continue
        until = next((i for i in range(verb + 1, min(verb + 5, len(flat))) if flat[i] in _UNTIL), 0)
        whose = flat[until + 1 : until + 2]
        if flat[verb] not in _STOPPING or not until or whose not in {("you",), ("reaching",)}:
            continue
        rest = flat[until + 2 :]
        lead = next((lead for lead in _REACHING if rest[: len(lead)] == lead), ())
        if lead or flat[until + 1] == "reaching":
            behind = words[until + 2 + len(lead) :]
            before = words[:at]
            apart = bool(before) and before[-1].is_word and flat[at] != "without"
            return (*before, *(tokens(",") if apart else ()), *tokens("go to"), *behind)
    return words
