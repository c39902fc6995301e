"""What "it" is and where, by the sentence before: what cannot be seen from here, was left on or forgotten.

"I cannot see A from here, does it V?" is "does A V?", "I was in A and I think I left B on" is "I think I
left B on in A", "do not V B in A, only look for it" looks for B in A, and "N forgot her B in A. Go there and
get it" gets B.
"""

from __future__ import annotations

from typing import Final

from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.text import Phrase, Word, keys

__all__ = ["named_before"]

_STOPS: Final = frozenset({".", "!", "?", ";", "\n"})
_I: Final = frozenset({"i", "we"})
_IT: Final = frozenset({"it", "them"})
_WAS: Final = frozenset({"was", "were", "went", "worked"})
_WHERE: Final = frozenset({"in", "at", "on", "to", "near", "by"})
_LEAVING: Final = frozenset({"left", "forgot", "forgotten"})
_UNSURE: Final = _I | {
    "think", "believe", "guess", "fear", "suspect", "may", "might", "could", "must", "have", "had", "am",
    "afraid", "worried", "that", "perhaps", "maybe", "probably", "possibly", "just", "not", "sure", "if",
    "whether",
}  # fmt: skip
_WHEN: Final = frozenset({
    "earlier", "before", "today", "yesterday", "just", "now", "this", "morning", "afternoon", "evening",
    "recently", "ago", "last", "night",
})  # fmt: skip
_OWN: Final = frozenset({"his", "her", "their", "my", "our", "its", "a", "an", "the"})
_FETCHING: Final = frozenset({"get", "fetch", "grab", "collect", "take", "retrieve", "find"})
_PLACED: Final = frozenset({"there", "from", "go", "drive", "out"})
_LONGEST: Final = 5


def named_before(words: Phrase) -> Phrase:
    """The same message with "it" and "there" named where the sentence before tells what they are.

    Args:
        words: All words and punctuation.
    """
    flat = keys(words)
    if not (_IT | _LEAVING | {"there"}) & set(flat):
        return words
    for put in (_unseen, _left_behind, _only_looked_for, _forgotten):
        words = put(words, keys(words))
    return words


def _unseen(words: Phrase, flat: tuple[str, ...]) -> Phrase:
    """For "I cannot see A (from here), does it V?" "does A V?"."""
    at = next((i for i in range(min(4, len(flat))) if flat[i] in _I), -1)
    start = next((i + 1 for i in range(at + 1, min(at + 4, len(flat))) if flat[i] == "see"), 0)
    if at < 0 or not start or not {"not", "cannot"} & set(flat[at + 1 : start]):
        return words
    end = next((i for i in range(start, len(flat)) if not words[i].is_word), len(flat))
    thing = words[start:end]
    if keys(thing[-2:]) == ("from", "here"):
        thing = thing[:-2]
    rest = end + 1
    while flat[rest : rest + 1] in {("so",), ("and",), ("but",)}:
        rest += 1
    asks = flat[rest : rest + 1] != () and flat[rest] in _asking()
    it = next((i for i in range(rest + 1, len(flat)) if flat[i] in _IT | {"there"}), 0)
    if _WHOM & set(keys(thing)) or not asks:
        return words
    if flat[rest + 1 : rest + 2] == ("there",) and not _IT & set(flat[rest:]):
        # "I cannot see A, is there a B?"
        last = len(words) - (not words[-1].is_word)
        return (*words[rest:last], Word("at", "at"), *thing, *words[last:])
    if it <= rest + 1 - (flat[it] in _IT) or not 0 < len(thing) <= _LONGEST:
        return words
    there = (Word("at", "at"),) if flat[it] == "there" else ()
    return (*words[rest:it], *there, *thing, *words[it + 1 :])


_WHOM: Final = frozenset({"you", "it", "him", "her", "them", "anything", "nothing", "what", "that", "why"})


def _asking() -> frozenset[str]:
    return lexicon().be | lexicon().question_starts | {"does", "do", "has", "have", "check", "see", "look"}


def _left_behind(words: Phrase, flat: tuple[str, ...]) -> Phrase:
    """For "I was in A and I think I left B on" "I think I left B on in A"."""
    was = next((i for i in range(1, len(flat) - 4) if flat[i] in _WAS and flat[i - 1] in _I), 0)
    if not was:
        return words
    where = was + 1
    while flat[where] in _WHEN and where < len(flat) - 1:
        where += 1
    end = next((i for i in range(where, len(flat)) if not words[i].is_word or flat[i] in {"and", "but"}), 0)
    if flat[where] not in _WHERE or not end:
        return words
    place_end = end
    while flat[place_end - 1] in _WHEN:
        place_end -= 1
    left = next((i for i in range(end + 1, len(flat)) if flat[i] not in _UNSURE | {"and", "but"}), 0)
    if not left or flat[left] not in _LEAVING or not _I & set(flat[end:left]):
        return words
    stop = next((i for i in range(left, len(flat)) if not words[i].is_word or flat[i] == "and"), len(flat))
    thing = words[left + 1 : stop]
    if keys(thing[-1:]) == ("there",):
        thing = thing[:-1]
    first = end + 1 if flat[end] in {"and", "but", ",", "."} else end
    if not thing or not 0 < place_end - where - 1 <= _LONGEST:
        return words
    there = Word("in", "in") if flat[where] == "to" else words[where]
    said = (*words[first : left + 1], *thing, there, *words[where + 1 : place_end])
    return (*words[: was - 1], *said, *words[stop:])


def _only_looked_for(words: Phrase, flat: tuple[str, ...]) -> Phrase:
    """For "do not V A, only look for it" "do not V A, only look for A"."""
    start = next((i for i in range(len(flat) - 4) if flat[i : i + 2] == ("do", "not")), -1)
    comma = next((i for i in range(start + 3, len(flat)) if not words[i].is_word), 0) if start >= 0 else 0
    verb = lexicon().verbs.match(flat, start + 2) if comma else None
    look = next((i for i in range(comma + 1, min(comma + 5, len(flat))) if flat[i] == "look"), 0)
    if verb is None or not look or flat[look + 1 : look + 2] not in {("for",), ("at",)}:
        return words
    thing = words[start + 2 + verb[0] : comma]
    it = look + 2
    ends = it + 1 >= len(flat) or not words[it + 1].is_word
    named = thing and thing[0].key in lexicon().determiners and flat[it : it + 1] in {("it",), ("them",)}
    return (*words[:it], *thing, *words[it + 1 :]) if named and ends else words


def _forgotten(words: Phrase, flat: tuple[str, ...]) -> Phrase:
    """For "N forgot her A in B. Go there and get it" "... Go there and get the A"."""
    at = next((i for i in range(1, len(flat) - 4) if flat[i] in _LEAVING and flat[i + 1] in _OWN), 0)
    if not at or flat[at - 1] in _I:
        # What the operator has lost is found without this (`lost`).
        return words
    where = next((i for i in range(at + 3, len(flat)) if flat[i] in _WHERE), 0)
    stop = next((i for i in range(where + 1, len(flat)) if flat[i] in _STOPS), 0) if where else 0
    if not stop or where - at - 2 > _LONGEST or any(not word.is_word for word in words[at:where]):
        return words
    fetches = (i for i in range(stop + 1, len(flat)) if flat[i] in _IT and flat[i - 1] in _FETCHING)
    it = next(fetches, 0)
    if not it or any(key in _IT for key in flat[stop:it]):
        return words
    source: Phrase = ()
    if not _PLACED & {*flat[stop : it + 2]} and flat[it - 1] != "find":
        # "Take it" from where it was left; "go there and get it" says so itself.
        source = (Word("from", "from"), *words[where + 1 : stop])
    return (*words[:it], Word("the", "the"), *words[at + 2 : where], *source, *words[it + 1 :])
