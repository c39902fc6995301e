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
_PAST_PLANS: Final = tuple(
    (who, *lead)
    for who in ("i", "we")
    for lead in (
        ("was", "going", "to"), ("were", "going", "to"), ("was", "about", "to"), ("were", "about", "to"),
        ("had", "planned", "to"), ("had", "meant", "to"), ("was", "planning", "to"), ("meant", "to"),
        ("were", "planning", "to"), ("had", "wanted", "to"), ("was", "meaning", "to"), ("wanted", "to"),
        ("had", "intended", "to"), ("intended", "to"), ("would", "have"), ("had", "hoped", "to"),
    )
)  # fmt: skip
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
    deed: Phrase = ()
    for before, end in pairwise(cuts):
        sentence, plan = _dropped(_with_deed(words[before + 1 : end], deed))
        deed = plan or deed
        result += _one(sentence)
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


def _dropped(sentence: Phrase) -> tuple[Phrase, Phrase]:
    """For "I was going to ask you to V, but S" only S; else what the speaker was going to do as well."""
    flat = keys(sentence)
    start = next((i for i, key in enumerate(flat) if key not in _OPENERS), len(flat))
    plan = next((plan for plan in _PAST_PLANS if flat[start : start + len(plan)] == plan), None)
    but = next((i for i in range(start + 3, len(flat) - 2) if flat[i] in {"but", "only"}), 0)
    if plan is None or not but:
        return sentence, ()
    deed = tuple(w for w in sentence[start + len(plan) : but] if w.is_word and w.key not in _OURSELVES)
    if keys(deed[:2]) in _ASKED:
        return (sentence if "wanted" in plan else sentence[but + 1 :]), ()
    told, asked = sentence[:but], _with_deed(sentence[but + 1 :], deed)
    return (asked, ()) if len(asked) != len(sentence) - but - 1 else ((*told, *sentence[but:]), deed)


def _with_deed(sentence: Phrase, deed: Phrase) -> Phrase:
    """For "(I was going to V.) Could you do that" "Could you V"."""
    flat = keys(sentence)
    at = next((i for i in range(len(flat) - 1) if flat[i : i + 2] in {("do", "it"), ("do", "that")}), -1)
    if not deed or at < 0 or not {"you", "please", "so"} & set(flat[:at]):
        return sentence
    return (*sentence[:at], *deed, *sentence[at + 2 :])


_ASKED: Final = frozenset((verb, "you") for verb in ("ask", "send", "tell", "have", "let", "get"))
_OURSELVES: Final = frozenset({"myself", "ourselves"})
_STOPPING: Final = frozenset(
    {"stop", "halt", "pause", "rest", "stopping", "halting", "pausing", "break", "stay", "linger"}
)
_UNTIL: Final = frozenset({"until", "till", "before"})
_REACHING: Final = (
    ("reach",), ("have", "reached"), ("get", "to"), ("have", "got", "to"), ("are", "at"), ("are", "in"),
    ("arrive", "at"),
    ("arrive", "in"), ("come", "to"), ("have", "arrived", "at"), ("make", "it", "to"), ("see",), ("hit",),
)  # fmt: skip


_ON: Final = (
    ("keep", "going"), ("keep", "driving"), ("keep", "moving"), ("keep", "on", "going"), ("keep", "on"),
    ("carry", "on"), ("drive", "on"), ("go", "on"), ("continue",), ("move", "on"), ("roll", "on"),
)  # fmt: skip
_PASSING: Final = frozenset((verb,) for verb in ("pass", "passing")) | frozenset(
    (verb, way) for verb in ("go", "come", "drive", "walk", "roll", "get") for way in ("past", "by")
)


def _passed_by(words: Phrase) -> Phrase:
    """For "if you pass A (on the way), do not stop there" "do not go to A"."""
    flat = keys(words)
    for at in range(len(flat) - 5):
        if flat[at] not in {"if", "when", "should"} or flat[at + 1] != "you":
            continue
        size = next((len(p) for p in _PASSING if flat[at + 2 : at + 2 + len(p)] == p), 0)
        start = at + 2 + size
        end = next((i for i in range(start + 1, len(flat) - 2) if flat[i : i + 2] == ("do", "not")), 0)
        if not size or not end or flat[end + 2] not in _STOPPING | {"go", "look", "turn"}:
            continue
        close = next(
            (i for i in range(end + 3, len(flat)) if not words[i].is_word or flat[i] == "and"), len(flat)
        )
        ways = (i for i in range(start + 1, end) if flat[i] in {"on", ",", "along", "again"})
        named = words[start : next(ways, end)]
        if set(flat[end + 3 : close]) <= _THERE:
            return (*words[:at], *tokens("do not go to"), *named, *words[close:])
    return words


_THERE: Final = frozenset({"there", "at", "it", "in", "inside", "for", "anything", "but", "go", "on"})


def straight_on(words: Phrase) -> Phrase:
    """For "do not stop until you reach A" the order to go to A, for "if you pass A, don't stop" not to."""
    words = _passed_by(words)
    flat = keys(words)
    for at in range(len(flat) - 4):
        onward = next((len(on) for on in _ON if flat[at : at + len(on)] == on), 0)
        if flat[at : at + 2] == ("do", "not"):
            verb = at + 2
        elif flat[at] in {"never", "without"}:
            verb = at + 1
        elif onward:
            verb = at + onward - 1
        else:
            continue
        until = next((i for i in range(verb + 1, min(verb + 5, len(flat))) if flat[i] in _UNTIL), 0)
        whose = flat[until + 1 : until + 2]
        if not (onward or flat[verb] in _STOPPING) or not until or whose not in {("you",), ("reaching",)}:
            continue
        rest = flat[until + 2 :]
        lead = next((lead for lead in _REACHING if rest[: len(lead)] == lead), ())
        if lead or flat[until + 1] == "reaching":
            behind = words[until + 2 + len(lead) :]
            before = words[:at]
            apart = bool(before) and before[-1].is_word and flat[at] != "without"
            return (*before, *(tokens(",") if apart else ()), *tokens("go to"), *behind)
    return words
