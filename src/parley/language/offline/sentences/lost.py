"""What was lost, where the order only says "look for it": the thing that the telling before it names."""

from __future__ import annotations

from typing import Final

from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.text import Phrase, Word, keys
from parley.language.word_lists import load_data

__all__ = ["with_what_was_lost"]

_LOSING: Final = tuple(
    tuple(line.split()) for line in sorted(load_data("units")["losing"], key=lambda line: -len(line.split()))
)
_MARKS: Final = frozenset({".", "!", "?", ";", "\n"})
_IT: Final = frozenset({"it", "them"})
_WHOSE: Final = frozenset({"my", "his", "her", "their", "our", "the", "a", "an"})
_ENDS: Final = frozenset({
    "and", "but", "so", "again", "somewhere", "anywhere", "near", "this", "that", "last", "yesterday",
    "today",
    "it", "there", "when", "while", "because", "i", "he", "she", "they", "we", "behind", "around", "is",
    "are",
    "was", "were", "from", "with", "earlier", "could", "please", "can", "would", "who", "which", "off", "out",
})  # fmt: skip
_LONGEST: Final = 4


def with_what_was_lost(words: Phrase) -> Phrase:
    """For "I dropped my A near B. Look for it" "... Look for the A"."""
    words = _sought_for(_fetched_for(_how_bad(words)))
    flat = keys(words)
    at = next((i for i in range(2, len(flat)) if flat[i] in _IT and flat[i - 1] == "for"), 0)
    thing = _lost(words, flat, at) if at and _searches(flat, at) else ()
    return (*words[:at], Word("the", "the"), *thing, *words[at + 1 :]) if thing else words


def _sought_for(words: Phrase) -> Phrase:
    """For "find him for her" "find him"."""
    flat = keys(words)
    for at in range(len(flat) - 3):
        whom = flat[at + 1] in _IT | {"him", "her"} and flat[at + 2] == "for"
        if flat[at] == "find" and whom and flat[at + 3] in {"her", "him", "me", "us", "them"}:
            return (*words[: at + 2], *words[at + 4 :])
    return words


def _fetched_for(words: Phrase) -> Phrase:
    """For "fetch the A, B needs it" "bring the A to B"."""
    flat = keys(words)
    at = next((i for i in range(len(flat)) if flat[i] in {"fetch", "get", "bring", "grab", "collect"}), -1)
    comma = next((i for i in range(at + 2, len(flat)) if not words[i].is_word), 0) if at >= 0 else 0
    need = next((i for i in range(comma + 2, min(comma + 6, len(flat) - 1)) if flat[i] in _NEEDING), 0)
    if not comma or not need or flat[need + 1] not in _IT or any(w.is_word for w in words[need + 2 :]):
        return words
    who, thing = words[comma + 1 : need], words[at + 1 : comma]
    named = who[-1].is_capital or who[0].key == "the"
    if not named or {"to", "for", "me", "him", "her", "it"} & set(keys(thing)):
        return words
    return (*words[:at], Word("bring", "bring"), *thing, Word("to", "to"), *who)


_NEEDING: Final = frozenset({"needs", "wants", "need", "want"})


def _how_bad(words: Phrase) -> Phrase:
    """For "have a look how bad it is" "have a look at it"."""
    flat = keys(words)
    for at in range(1, len(flat) - 3):
        if flat[at] != "how" or flat[at + 1] not in _BAD or flat[at + 2] not in _IT | {"that", "this"}:
            continue
        if flat[at + 3] not in lexicon().be | {"looks", "look"} or flat[at + 4 : at + 5] not in _NO_MORE:
            continue
        it = Word("it", "it")
        if flat[at - 1] in {"look", "glance", "peek"}:
            return (*words[:at], Word("at", "at"), it, *words[at + 4 :])
        size = 2 if flat[at - 2 : at] in {("find", "out"), ("tell", "me"), ("tell", "us")} else 1
        see = size == 2 or flat[at - 1] in {"see", "check"}
        order = (Word("inspect", "inspect"),) if see else words[at - 1 : at]
        return (*words[: at - size], *order, it, *words[at + 4 :])
    return words


_BAD: Final = frozenset({
    "bad", "badly", "serious", "severe", "deep", "big", "dirty", "wet", "dangerous", "urgent", "far", "full",
    "high",
})  # fmt: skip
_NO_MORE: Final = frozenset({(), (".",), (",",), ("?",), ("!",), (";",), ("and",), ("please",), ("then",)})


def _searches(flat: tuple[str, ...], at: int) -> bool:
    """Whether "for it" belongs to looking or searching."""
    return bool({"look", "search", "looking", "searching", "hunt", "eye", "lookout"} & set(flat[at - 5 : at]))


def _lost(words: Phrase, flat: tuple[str, ...], before: int) -> Phrase:
    """What was told to be lost, last before a word; nothing if nothing was."""
    for index in range(before - 1, -1, -1):
        verb = next((v for v in _LOSING if flat[index : index + len(v)] == v), ())
        start = index + len(verb)
        if not verb or flat[start : start + 1] == () or flat[start] not in _WHOSE:
            continue
        end = start + 1
        while end < before and words[end].is_word and not _ends(flat, end):
            end += 1
        between = {key for key in flat[end:before] if key in _MARKS | {",", "so", "could", "would", "please"}}
        if start + 1 < end <= start + 1 + _LONGEST and between:
            return words[start + 1 : end]
    return ()


def _ends(flat: tuple[str, ...], index: int) -> bool:
    return flat[index] in _ENDS or lexicon().places.match(flat, index) is not None
