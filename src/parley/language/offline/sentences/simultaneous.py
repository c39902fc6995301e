"""Two things at the same time: "V while W", "V and at the same time W", "while you are at A, V"."""

from __future__ import annotations

from collections.abc import Callable

from parley.language.offline.facts.facts import strip_openers
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.text import Phrase, Word, keys, lemma

__all__ = ["side_by_side"]

Opens = Callable[[Phrase], bool]

_MARKERS = tuple(
    tuple(text.split())
    for text in (
        "and at the same time", "at the same time", "and simultaneously", "simultaneously",
        "and meanwhile", "and in the meantime", "and while doing so", "while doing so",
        "and while doing that", "and while at it",
    )
)  # fmt: skip
_YOU = (("you", "are"), ("you",), ("still",))


def side_by_side(sentence: Phrase, opens: Opens) -> tuple[Phrase, Phrase, bool] | None:
    """What is done, what is done beside it, and whether really both at once or one after the other.

    None if nothing is to be done at the same time.
    """
    words = strip_openers(sentence)
    flat = keys(words)
    if flat[-4:] == ("at", "the", "same", "time"):
        cut = next((i for i in range(1, len(flat) - 5) if flat[i] == "and" and opens(words[i + 1 :])), 0)
        return (words[:cut], words[cut + 1 : -4], True) if cut else None
    for at in range(1, len(flat) - 1):
        size = next((len(m) for m in _MARKERS if flat[at : at + len(m)] == m), 0)
        if size and opens(words[:at]) and opens(words[at + size :]):
            return _movement_first(words[:at], words[at + size :])
    if flat[:1] in {("while",), ("whilst",)}:
        return _leading(words, opens)
    at = next((i for i in range(2, len(flat) - 1) if flat[i] in {"while", "whilst"}), 0)
    if not at or not opens(words[:at]):
        return None
    return _beside(words[:at], words[at + 1 :], opens)


def _leading(words: Phrase, opens: Opens) -> tuple[Phrase, Phrase, bool] | None:
    """For "while you are at A, V", "while driving to A, V"."""
    flat = keys(words)
    cut = next((i for i in range(2, len(flat) - 1) if flat[i] == ","), 0)
    cut = cut or next((i - 1 for i in range(4, len(flat)) if opens(words[i:]) and not _doing(flat[i])), 0)
    rest = words[cut + 1 :]
    return _beside(rest, words[1 : cut + (flat[cut] != ",")], opens) if cut and opens(rest) else None


def _beside(main: Phrase, other: Phrase, opens: Opens) -> tuple[Phrase, Phrase, bool] | None:
    said = next((len(lead) for lead in _YOU if keys(other[: len(lead)]) == lead), 0)
    rest = other[said:]
    flat = keys(rest)
    if not flat:
        return None
    if flat[0] in {"waiting", "there", "here"} and len(flat) < 3:
        return main, (), False
    place = lexicon().places.match(flat)
    if said and place is not None and place[0] < len(flat):
        return (Word("visit", "visit"), *rest[place[0] :]), main, False
    if not said and not _doing(flat[0]):
        return None
    base = Word(lemma(flat[0]), lemma(flat[0]))
    doing = (base, *rest[1:])
    return _movement_first(main, doing) if opens(doing) else None


def _doing(word: str) -> bool:
    return word.endswith("ing") and lemma(word) != word


def _movement_first(first: Phrase, second: Phrase) -> tuple[Phrase, Phrase, bool]:
    """Driving comes first, what is done beside it second."""
    moving = [_kind(part) == "motion" for part in (first, second)]
    return (second, first, True) if moving == [False, True] else (first, second, moving != [True, True])


def _kind(words: Phrase) -> str:
    words = strip_openers(words, requests=True)
    flat = keys(words)
    found = lexicon().verbs.match((lemma(flat[0]), *flat[1:])) if flat else None
    return found[1].partition(":")[0] if found is not None else ""
