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
    flat = keys(words)
    at = next((i for i in range(2, len(flat)) if flat[i] in _IT and flat[i - 1] == "for"), 0)
    thing = _lost(words, flat, at) if at and _searches(flat, at) else ()
    return (*words[:at], Word("the", "the"), *thing, *words[at + 1 :]) if thing else words


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
