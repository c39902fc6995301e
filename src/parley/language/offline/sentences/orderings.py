"""What comes before what, said pair by pair: "A after B, B after C" is C, B, A."""

from __future__ import annotations

from collections.abc import Callable
from graphlib import CycleError, TopologicalSorter

from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.nouns import bare
from parley.language.offline.words.text import Phrase, Word, keys

__all__ = ["in_sequence"]

IsStop = Callable[[Phrase], bool]

_CUTS = frozenset({",", ";", ".", "!", "\n", "and", "but", "&"})
_SMALL = frozenset({
    "comes", "come", "goes", "go", "should", "must", "has", "to", "be", "is", "please", "then", "right",
    "straight", "directly", "only", "you", "have", "been", "at", "in", "do", "visited", "seen", "done",
    "it", "immediately", "just", "not", "visit",
})  # fmt: skip


def in_sequence(words: Phrase, is_stop: IsStop) -> Phrase | None:
    """The stops of a message whose every part says which comes before which; None if it says more.

    Args:
        words: All words and punctuation.
        is_stop: Whether words name one thing on the map.
    """
    pairs: list[tuple[Phrase, Phrase]] = []
    verb = ""
    for piece in _pieces(words):
        found, looks = _pair(piece, is_stop)
        if found is None:
            return None
        verb = verb or looks
        pairs.append(found)
    if len(pairs) < 2:
        return None
    named = {keys(bare(stop)): stop for pair in pairs for stop in pair}
    sorter: TopologicalSorter[tuple[str, ...]] = TopologicalSorter(dict.fromkeys(named, ()))
    for early, late in pairs:
        sorter.add(keys(bare(late)), keys(bare(early)))
    try:
        order = list(sorter.static_order())
    except CycleError:
        return None
    lead = ("inspect",) if verb else ("go", "to")
    result: list[Word] = []
    for name in order:
        joint = (",", "then") if result else ()
        result += (*(Word(text, text) for text in (*joint, *lead)), *named[name])
    return tuple(result)


def _pieces(words: Phrase) -> list[Phrase]:
    pieces: list[list[Word]] = [[]]
    for word in words:
        if word.key in _CUTS:
            pieces.append([])
        else:
            pieces[-1].append(word)
    return [tuple(piece) for piece in pieces if piece]


def _pair(piece: Phrase, is_stop: IsStop) -> tuple[tuple[Phrase, Phrase] | None, str]:
    """What comes first and what second in "A (comes) before B", and whether it is about looking."""
    flat = keys(piece)
    at = next((i for i in range(1, len(flat) - 1) if flat[i] in {"before", "after"}), 0)
    if not at:
        return None, ""
    left, looks = _named(piece[:at], is_stop)
    right, _ = _named(piece[at + 1 :], is_stop)
    if not left or not right:
        return None, ""
    return ((left, right) if flat[at] == "before" else (right, left)), looks


def _named(words: Phrase, is_stop: IsStop) -> tuple[Phrase, str]:
    """The one thing that words name, and the verb of looking in front of it, if there is one."""
    found = lexicon().verbs.match(keys(words))
    kind = found[1].partition(":")[0] if found is not None else ""
    looks = "inspect" if kind == "look" else ""
    if found is not None and kind in {"look", "motion"}:
        words = words[found[0] :]
    while words and words[0].key in _SMALL:
        words = words[1:]
    while words and words[-1].key in _SMALL:
        words = words[:-1]
    return (words, looks) if is_stop(words) else ((), "")
