"""Numbered lists in running text: "1) A 2) B" is A. B."""

from __future__ import annotations

from parley.language.offline.words.text import Phrase, Word, keys

__all__ = ["unnumbered"]

_STOP = Word(".", ".")
_BEHIND = frozenset({")", ".", ":", ","})
_LETTERS = "abcdefgh"


def unnumbered(words: Phrase) -> Phrase:
    """A full stop in place of each number of a list; other numbers are left alone."""
    flat = keys(words)
    if any(_headed(flat, i) for i in range(len(flat))):
        return _without_headings(words, flat)
    words = _uncleft(words)
    flat = keys(words)
    ranked = [i for i in range(len(flat) - 2) if _ranked(flat, i)]
    if len(ranked) > 1:
        return _without_ranks(words, ranked)
    marks = _numbered(flat, tuple(str(n) for n in range(1, 10))) or _numbered(flat, tuple(_LETTERS))
    if len(marks) < 2:
        return words
    result: list[Word] = []
    for index, word in enumerate(words):
        if index in marks:
            if any(other.is_word for other in result):
                result.append(_STOP)
            continue
        if index - 1 in marks or (word.key == "(" and index + 1 in marks):
            continue
        result.append(word)
    return tuple(result)


def _numbered(flat: tuple[str, ...], labels: tuple[str, ...]) -> set[int]:
    """Where the numbers of a list stand, which count up from the first without a gap."""
    found: list[int] = []
    for index in range(len(flat) - 1):
        wanted = len(found) < len(labels) and flat[index] == labels[len(found)]
        begins = index == 0 or not flat[index - 1].isalpha() or flat[index + 1] == ")"
        if wanted and flat[index + 1] in _BEHIND and begins:
            found.append(index)
    return set(found)


_STEPS = frozenset({"step", "stop", "point", "task", "item", "number", "job", "no", "part", "order"})
_COUNTED = frozenset({"one", "two", "three", "four", "five", "six", *(str(n) for n in range(1, 10))})


def _headed(flat: tuple[str, ...], index: int) -> bool:
    """Whether "step 1:" stands here."""
    opens = index == 0 or not flat[index - 1].isalnum()
    return (
        opens
        and flat[index] in _STEPS
        and flat[index + 1 : index + 2] != ()
        and (flat[index + 1] in _COUNTED and flat[index + 2 : index + 3] in {(":",), (",",), (".",)})
    )


def _without_headings(words: Phrase, flat: tuple[str, ...]) -> Phrase:
    result: list[Word] = []
    index = 0
    while index < len(words):
        if _headed(flat, index):
            while result and not result[-1].is_word:
                result.pop()
            if result:
                result.append(_STOP)
            index += 3
            continue
        result.append(words[index])
        index += 1
    return tuple(result)


_RANKS = frozenset({"first", "second", "third", "fourth", "fifth", "next", "last", "final"})


def _ranked(flat: tuple[str, ...], index: int) -> bool:
    """Whether "second stop" stands here, in front of what it is."""
    return (
        flat[index] in _RANKS
        and flat[index + 1] in _STEPS | {"thing", "one"} | ({"up"} if flat[index] == "next" else set())
        and (index == 0 or flat[index - 1] not in {"a", "my", "every"})
    )


def _without_ranks(words: Phrase, ranked: list[int]) -> Phrase:
    result: list[Word] = []
    index = 0
    while index < len(words):
        if index in ranked:
            while result and (not result[-1].is_word or result[-1].key in {"the", "and", "then"}):
                result.pop()
            if result:
                result.append(_STOP)
            index += 2
            while index < len(words) and (
                not words[index].is_word or words[index].key in {"is", "will", "be"}
            ):
                index += 1
            continue
        result.append(words[index])
        index += 1
    return tuple(result)


_DOING = frozenset({
    "you", "do", "to", "i", "want", "need", "we", "should", "have", "will", "must", "can", "is", "going",
    "please", "for", "visit", "see", "check", "inspect", "go",
})  # fmt: skip
_FIRST = frozenset({"first", "second", "next", "third"})
_ENDS = frozenset({".", "!", ";", "\n"})


def _uncleft(words: Phrase) -> Phrase:
    """For "the last thing you do is V" "V last", for "the first thing I want is V" "first V"."""
    flat = keys(words)
    for index in range(len(flat) - 3):
        link = _cleft_link(flat, index)
        if not link:
            continue
        start = link + 1
        while flat[start : start + 1] in {("to",), ("that",), ("you",), (":",), (",",)}:
            start += 1
        end = next((i for i in range(start, len(flat)) if flat[i] in _ENDS or _goes_on(flat, i)), len(flat))
        if start >= end:
            continue
        order, rank = words[start:end], flat[index + 1]
        said = (*order, Word("last", "last")) if rank in {"last", "final"} else order
        said = (Word("first", "first"), *order) if rank == "first" else said
        return _uncleft((*words[:index], *said, *words[end:]))
    return words


def _cleft_link(flat: tuple[str, ...], index: int) -> int:
    """Where "is" stands in "the last thing you do is ..."; 0 if it is not like that."""
    if flat[index] != "the" or flat[index + 1] not in _FIRST | {"last", "final", "only"}:
        return 0
    if flat[index + 2] == "is" and flat[:index].count("last") + flat[:index].count("first") > 0:
        # "..., the first is B".
        return index + 2
    if flat[index + 2] not in {"thing", "stop", "step", "job", "task", "place"}:
        return 0
    link = next((i for i in range(index + 3, min(index + 9, len(flat))) if flat[i] == "is"), 0)
    return link if link and set(flat[index + 3 : link]) <= _DOING else 0


def _goes_on(flat: tuple[str, ...], index: int) -> bool:
    """Whether a comma stands here, and behind it what comes in another place."""
    behind = flat[index + 1 : index + 4]
    if flat[index] != "," or len(behind) < 3:
        return False
    rank = behind[1:2] if behind[0] == "the" else behind[2:3] if behind[:2] == ("and", "the") else ()
    return bool(rank) and rank[0] in _FIRST | {"last", "final"}
