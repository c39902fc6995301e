"""Places that are closed, moved or stood in for: "A is closed, use B", "everything from A is now in B".

What is remembered to be in such a place is looked for in the other one; the later word counts.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cache, lru_cache

from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.nouns import bare
from parley.language.offline.words.text import Phrase, keys, singular, tokens, written_out
from parley.language.word_lists import load_data
from parley.messages.memory import MemoryEntry

__all__ = ["Redirect", "is_habit", "read_redirect", "redirects"]

_LONGEST = 5
_MARKS = frozenset({".", ",", ";", ":", "!", "-", "(", ")", "\n", "and", "so", "but", "therefore", "while"})
_NOBODY = frozenset(
    {"i", "you", "he", "she", "it", "they", "we", "there", "this", "that", "if", "when", "who"}
)
_INSTEAD = (("instead", "of"), ("in", "place", "of"), ("in", "lieu", "of"), ("rather", "than"))
_STANDS_IN = (
    ("is", "replacing"),
    ("is", "standing", "in", "for"),
    ("replaces",),
    ("stands", "in", "for"),
    ("substitutes", "for"),
    ("serves", "as"),
)
_REPLACED = (("replaced", "by"), ("replaced", "with"))
_HABITS = frozenset({"stored", "kept", "keep", "belong", "belongs", "live", "usually", "always", "normally"})


@dataclass(frozen=True, slots=True)
class Redirect:
    """What one sentence says about a place that cannot be used, or can be used again."""

    place: Phrase
    other: Phrase = ()
    """What takes its place; empty if that is not said."""
    reopened: bool = False
    moved: bool = False
    """Whether what was there is elsewhere now, rather than the place shut."""


def redirects(memory: Sequence[MemoryEntry]) -> Iterator[tuple[int, Redirect, MemoryEntry]]:
    """What memories say about such places, the latest first, each with its position in `memory`."""
    for age in range(len(memory) - 1, -1, -1):
        entry = memory[age]
        found = read_redirect(entry.data) if entry.type == "text" else None
        if found is not None:
            yield age, found, entry


def is_habit(sentence: str) -> bool:
    """Whether a sentence says where things are as a rule, not where they are seen now."""
    return bool(_HABITS & set(keys(tokens(sentence))))


@lru_cache(maxsize=4096)
def read_redirect(text: str) -> Redirect | None:
    """What a text says about a place that is closed, moved, stood in for or open again; else None."""
    words = tokens(written_out(text.strip()[:400]))
    if not words or words[-1].key == "?" or keys(words)[0] in {"if", "when", "whenever", "unless"}:
        return None
    return _in_place_of(words) or _moved(words) or _closed(words)


@cache
def _lists() -> dict[str, tuple[tuple[str, ...], ...]]:
    data = load_data("redirecting")
    return {
        kind: tuple(sorted((tuple(str(text).split()) for text in data[kind]), key=len, reverse=True))
        for kind in data
    }


def _size(kind: str, flat: tuple[str, ...], at: int) -> int:
    """How many words of a list stand there."""
    return next((len(one) for one in _lists()[kind] if flat[at : at + len(one)] == one), 0)


def _name_at(words: Phrase, start: int) -> Phrase:
    """The name that begins there, without what is said of how long."""
    flat = keys(words)
    end = start
    while end < len(words) and flat[end] not in _MARKS and end - start <= _LONGEST:
        verb = flat[end] in lexicon().be | lexicon().auxiliaries
        ends = flat[end] == "on" or _size("passing", flat, end) or _size("using", flat, end)
        if verb or (end > start and ends):
            break
        end += 1
    return _named(words[start:end])


def _name_before(words: Phrase, end: int) -> Phrase:
    """The name that ends there, from the mark before it."""
    flat = keys(words)
    while end and _size("passing", flat, end - 1):
        end -= 1
    start = next((i + 1 for i in range(end - 1, -1, -1) if flat[i] in _MARKS), 0)
    opening = _size("using", flat, start) if start < end else 0
    return _named(words[start + opening : end])


def _named(words: Phrase) -> Phrase:
    """The name that words are, from the last article on if there are too many; empty if they are none."""
    found = bare(words)
    flat = keys(found)
    if len(found) > _LONGEST:
        at = max((i for i, key in enumerate(flat) if key in lexicon().determiners), default=0)
        found, flat = bare(found[at:]), keys(bare(found[at:]))
    verbs = lexicon().be | lexicon().auxiliaries | {"not", "has", "have"}
    known = 0 < len(found) <= _LONGEST and not (_NOBODY | verbs) & set(flat)
    return found if known and all(word.is_word for word in found) else ()


def _in_place_of(words: Phrase) -> Redirect | None:
    """For "use B instead of A", "instead of A use B", "B replaces A", "A is replaced by B"."""
    flat = keys(words)
    for at in range(len(flat)):
        of = next((len(one) for one in _INSTEAD if flat[at : at + len(one)] == one), 0)
        if of:
            old = _name_at(words, at + of)
            new = _used(words, 0, at) or _used(words, at + of + len(old), len(words))
            if old and new:
                return Redirect(old, new)
        stands = next((len(one) for one in _STANDS_IN if flat[at : at + len(one)] == one), 0)
        old, new = _name_at(words, at + stands), _name_before(words, at)
        if stands and old and new:
            return Redirect(old, new)
        by = next((len(one) for one in _REPLACED if flat[at : at + len(one)] == one), 0)
        link = next((i for i in range(at) if flat[i] in lexicon().be | {"has", "have"}), 0) if by else 0
        old, new = _name_before(words, link), _name_at(words, at + by)
        if by and link and old and new:
            return Redirect(old, new)
    return None


def _used(words: Phrase, start: int, end: int) -> Phrase:
    """What is to be used, by what stands between two words ("we use B", "B is used")."""
    flat = keys(words)
    for at in range(start, end):
        size = _size("using", flat, at)
        if not size:
            continue
        before = flat[at - 1] in lexicon().be and flat[at] == "used" if at else False
        named = _name_before(words, at - 1) if before else _name_at(words[:end], at + size)
        if named:
            return named
    return ()


def _moved(words: Phrase) -> Redirect | None:
    """For "everything from A has been moved to B", "A moved to B", "A is temporarily in B"."""
    flat = keys(words)
    link = next(
        (i for i in range(1, len(flat)) if flat[i] in lexicon().be | {"has", "have"} or _goes(flat, i)), 0
    )
    if link and flat[link - 1] in {"that", "which", "what"}:
        # "Everything that was in A is now in B".
        link = next((i for i in range(link + 1, len(flat)) if flat[i] in lexicon().be | {"has"}), 0)
    subject = words[:link]
    if not link or any(not word.is_word for word in subject):
        return None
    at = link
    told = False
    while at < len(flat) and (
        flat[at] in lexicon().be | {"has", "have", "been"} or _size("passing", flat, at) or _goes(flat, at)
    ):
        told = told or bool(_size("passing", flat, at)) or _goes(flat, at)
        at += _size("passing", flat, at) or 1
    place = lexicon().places.match(flat, at)
    size = 1 if flat[at : at + 1] == ("to",) else place[0] if place is not None else 0
    old, every = _all_of(subject)
    new = _name_at(words, at + size)
    later = told or bool(_size("passing", flat, at + size + len(new)))
    return Redirect(old, new, moved=True) if size and old and new and (every or later) else None


def _goes(flat: tuple[str, ...], at: int) -> bool:
    return (flat[at],) in _lists()["moved"]


def _all_of(subject: Phrase) -> tuple[Phrase, bool]:
    """The place whose things are spoken of, and whether it is named so ("everything from A", "A")."""
    flat = keys(subject)
    if not ({singular(key) for key in flat[:3]} | set(flat[:3])) & {one[0] for one in _lists()["everything"]}:
        return _named(subject), False
    at = next((i for i in range(1, len(flat) - 1) if flat[i] in {"from", "in", "of", "at"}), 0)
    return (_named(subject[at + 1 :]), True) if at else ((), False)


def _closed(words: Phrase) -> Redirect | None:
    """For "A is closed (, use B instead)", "A closed for maintenance, using B", "A is open again"."""
    flat = keys(words)
    for at in range(1, len(flat)):
        for kind in ("closed", "open"):
            size = _size(kind, flat, at)
            place = _shut_place(words, at) if size else ()
            if not place:
                continue
            if (kind == "open") != ("not" in flat[:at]):
                return Redirect(place, reopened=True)
            end = _of_closing(words, at, size, place)
            other = (
                _used(words, end, len(words)) or _elsewhere(words, end) or _used(words, 0, at - len(place))
            )
            return Redirect(place, other)
    return None


def _elsewhere(words: Phrase, start: int) -> Phrase:
    """Where what belongs there is meanwhile: "(A is closed,) its guests are in B for now"."""
    flat = keys(words)
    for at in range(start, len(flat) - 2):
        place = lexicon().places.match(flat, at + 1) if flat[at] in lexicon().be else None
        named = _name_at(words, at + 1 + place[0]) if place is not None else ()
        if named and any(_size("passing", flat, i) for i in range(start, len(flat))):
            return named
    return ()


def _of_closing(words: Phrase, at: int, size: int, place: Phrase) -> int:
    """Where what is said of the closing ends."""
    after = keys(words[at + size : at + size + len(place) + 1])
    return at + size + (len(after) if keys(place) == after[-len(place) :] else 0)


def _shut_place(words: Phrase, at: int) -> Phrase:
    """What is closed there: what stands before it, or behind "we have closed"."""
    flat = keys(words)
    if (
        at
        and flat[at - 1] in _NOBODY | {"have", "had"}
        and flat[0] in {"we", "they", "i", "somebody", "someone"}
    ):
        return _name_at(words, at + 1)
    end = at
    links = lexicon().be | {"has", "have", "been", "can", "must", "should", "will", "stays", "remains", "got"}
    while end and (flat[end - 1] in links | {"not"} or _size("passing", flat, end - 1)):
        end -= 1
    linked = any(key in links for key in flat[end:at])
    start = next((i + 1 for i in range(end - 1, -1, -1) if flat[i] in _MARKS), 0)
    place = _named(words[start:end])
    opening = not linked and flat[at] in {"open", "free", "full", "working", "used", "using", "available"}
    return () if opening else place
