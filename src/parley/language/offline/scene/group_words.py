"""What stands before and behind the noun of a group: "all", "the first three", "every other", "except A"."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.quantities import is_unit
from parley.language.offline.words.text import Phrase, keys
from parley.language.word_lists import load_data

__all__ = [
    "BETTER",
    "Lead",
    "exception_at",
    "in_turn_at",
    "labels_at",
    "may_lead",
    "open_range_at",
    "parity_at",
    "read_lead",
    "stops",
]

_DATA = load_data("groups")


def _table(name: str) -> tuple[tuple[str, ...], ...]:
    return tuple(sorted((tuple(text.split()) for text in _DATA[name]), key=len, reverse=True))


_ALL, _FREE, _LIMITS, _NONE = _table("all"), _table("free"), _table("limits"), _table("none")
_OTHERS, _STEPS, _PAIRS = _table("others"), _table("every_other"), _table("pairs")
_ODD, _EVEN, _OUTER, _NEAR, _FAR = (_table(name) for name in ("odd", "even", "outer", "near", "far"))
_NUMBERED = _table("numbered")
_ODD_BEHIND, _EVEN_BEHIND = _table("odd_behind"), _table("even_behind")
_OVER, _UNDER = _table("over"), _table("under")
_EXCEPT, _IN_TURN = _table("except"), _table("in_turn")
BETTER = {
    "nearer": "nearest", "closer": "closest", "farther": "farthest", "further": "furthest",
    "bigger": "biggest", "larger": "largest", "smaller": "smallest",
}  # fmt: skip
"""What compares two things, as it is said of more."""
_THE = frozenset({"the", "these", "those", "my", "our", "your", "its", "their"})
_UP_TO = frozenset({"to", "through", "till", "until", "thru"})
_WAYS = frozenset({"up", "down", "back"})


@dataclass(slots=True)
class Lead:
    """What the words before the noun say about which of its things are meant."""

    everything: bool = False
    each: bool = False
    """Whether they are spoken of one by one."""
    free: bool = False
    """Whether anybody may choose."""
    definite: bool = False
    other: bool = False
    """Whether those that were named are left out."""
    every_other: bool = False
    parity: int = -1
    """1 odd, 0 even, 2 any numbers; -1 with or without."""
    end: str = ""
    """"first" or "last", for so many from that end."""
    where: str = ""
    """"outer", "near" or "far"."""
    count: int = 0
    ordinals: tuple[int, ...] = ()
    """Places in the row, from 1; -1 is the last."""
    of: bool = False
    listed: bool = False
    """Whether they were named one by one, so that their order counts."""
    none: bool = False
    """Whether none is meant ("no door", "not a single door")."""

    @property
    def says_something(self) -> bool:
        """Whether it tells which or how many."""
        return (
            self.everything
            or self.none
            or self.free
            or self.other
            or self.every_other
            or self.parity >= 0
            or bool(self.end or self.where or self.count or self.ordinals)
        )


def read_lead(words: Phrase, start: int) -> tuple[Lead, int]:
    """Read what stands before a noun from `start`; and where the noun begins."""
    flat, lead, at = keys(words), Lead(), start
    while at < len(flat):
        size = _one(flat, at, lead)
        if not size:
            break
        at += size
    return lead, at


def _one(flat: tuple[str, ...], at: int, lead: Lead) -> int:
    """How many words at `at` belong to the lead; what they say is noted in it."""
    size = _at(flat, at, _STEPS)
    if size:
        lead.every_other = True
        return size
    size = _at(flat, at, _NONE)
    if size:
        lead.none = True
        return size
    size = _at(flat, at, _ALL)
    if size:
        lead.everything = True
        lead.each = lead.each or flat[at] in {"each", "every"}
        lead.count = 2 if flat[at] == "both" else lead.count
        return size
    size = _at(flat, at, _FREE)
    if size and not lead.count:
        lead.free = True
        return size
    size = _at(flat, at, _OTHERS)
    if size:
        lead.other = True
        return size
    return _number(flat, at, lead) or _kind(flat, at, lead) or _small(flat, at, lead)


def _number(flat: tuple[str, ...], at: int, lead: Lead) -> int:
    limited = _at(flat, at, _LIMITS)
    if limited and _count(flat[at + limited : at + limited + 1]):
        lead.free = True
        return limited
    pair = _at(flat, at, _PAIRS)
    if pair and not lead.count:
        lead.count, lead.free = 2, True
        return pair
    count = _count(flat[at : at + 1])
    if not count or lead.count not in {0, count} or (count == 1 and not _one_of(flat, at)):
        return 0
    lead.count = count
    lead.free = lead.free or count == 1
    return 1


def _one_of(flat: tuple[str, ...], at: int) -> bool:
    """Whether "one" is a number here: "one of the doors", "one door"; "one" alone stands for a thing."""
    return flat[at] != "one" or flat[at + 1 : at + 2] not in {(), (",",), (".",), ("and",), ("or",)}


def _kind(flat: tuple[str, ...], at: int, lead: Lead) -> int:
    for table, parity in ((_ODD, 1), (_EVEN, 0), (_NUMBERED, 2)):
        size = _at(flat, at, table)
        if size:
            lead.parity = parity
            return size
    for table, where in ((_OUTER, "outer"), (_NEAR, "near"), (_FAR, "far")):
        size = _at(flat, at, table)
        counted = lead.count > 1 or _count(flat[at + size : at + size + 1]) > 1
        if size and counted:
            lead.where = where
            return size
    return _row(flat, at, lead)


def _row(flat: tuple[str, ...], at: int, lead: Lead) -> int:
    """For "first three", "first and last", "second and third"."""
    if flat[at] in {"first", "last", "final"} and _count(flat[at + 1 : at + 2]) > 1:
        lead.end = "first" if flat[at] == "first" else "last"
        return 1
    places: list[int] = []
    end = at
    while end < len(flat):
        place = _ordinal(flat[end])
        if not place:
            break
        places.append(place)
        end += 1
        joint = end
        while flat[joint : joint + 1] and flat[joint] in {",", "and", "the"}:
            joint += 1
        if joint == end or joint >= len(flat) or not _ordinal(flat[joint]):
            break
        end = joint
    if len(places) < 2:
        return 0
    lead.ordinals = tuple(places)
    return end - at


def _ordinal(word: str) -> int:
    return -1 if word == "last" else int(lexicon().ordinals.get(word, 0))


def _small(flat: tuple[str, ...], at: int, lead: Lead) -> int:
    if flat[at] in _THE:
        lead.definite = True
        return 1
    if flat[at] == "of" and lead.says_something:
        lead.of = True
        return 1
    return 0


def _count(words: tuple[str, ...]) -> int:
    if not words:
        return 0
    return int(words[0]) if _is_number(words[0]) else int(lexicon().numbers.get(words[0], 0))


def _is_number(word: str) -> bool:
    return word.isascii() and word.isdecimal() and len(word) < 7


def _at(flat: tuple[str, ...], at: int, table: tuple[tuple[str, ...], ...]) -> int:
    if at >= len(flat) or flat[at] not in _first_words(table):
        return 0
    return next((len(entry) for entry in table if flat[at : at + len(entry)] == entry), 0)


@cache
def _first_words(table: tuple[tuple[str, ...], ...]) -> frozenset[str]:
    return frozenset(entry[0] for entry in table)


@cache
def _leading() -> frozenset[str]:
    tables = (
        _ALL,
        _FREE,
        _LIMITS,
        _NONE,
        _OTHERS,
        _STEPS,
        _PAIRS,
        _ODD,
        _EVEN,
        _NUMBERED,
        _OUTER,
        _NEAR,
        _FAR,
    )
    named = {"first", "last", "final", "it", "they", "them", "those", "these", "both", "each", "that"}
    return frozenset().union(*map(_first_words, tables), _THE, named, lexicon().numbers, lexicon().ordinals)


def may_lead(word: str) -> bool:
    """Whether a group may begin with a word that names no kind of thing."""
    return word in _leading() or word.isdigit()


def exception_at(flat: tuple[str, ...], at: int) -> int:
    """How many words at `at` say that something is left out, with a comma before them."""
    comma = int(flat[at : at + 1] == (",",))
    size = _at(flat, at + comma, _EXCEPT)
    return size + comma if size else 0


def in_turn_at(flat: tuple[str, ...], at: int) -> int:
    """How many words at `at` say nothing but that it is one after the other."""
    comma = int(flat[at : at + 1] == (",",))
    size = _at(flat, at + comma, _IN_TURN)
    return size + comma if size else 0


def parity_at(flat: tuple[str, ...], at: int) -> tuple[int, int]:
    """For "with even numbers" behind a noun: 1 odd, 0 even, -1 neither; and where that ends."""
    odd, even = _at(flat, at, _ODD_BEHIND), _at(flat, at, _EVEN_BEHIND)
    return (1 if odd else 0 if even else -1), at + odd + even


def labels_at(words: Phrase, at: int) -> tuple[list[tuple[str, ...]], int]:
    """Numbers and letters in a row ("2, 3 and 5", "2 to 4", "A and C"), and where they end.

    Each part of the row is one label, or all labels of a range.
    """
    parts: list[tuple[str, ...]] = []
    end = at + (keys(words[at : at + 1]) in {("numbers",), ("number",), ("nos",), ("from",)})
    closed = False
    while True:
        part, after = _label(words, end)
        if not part:
            break
        parts.append(part)
        end = after
        joint = after
        while keys(words[joint : joint + 1]) in {(",",), ("and",), ("plus",)} and not closed:
            closed = words[joint].key != ","
            joint += 1
        if joint == after or not _label(words, joint)[0]:
            break
        end = joint
    return parts, end


def open_range_at(flat: tuple[str, ...], at: int) -> tuple[int, int, int] | None:
    """For "from 3 upwards", "above 3", "up to 3": lowest and highest number, and where that ends."""
    over, under = _at(flat, at, _OVER), _at(flat, at, _UNDER)
    limit = _count(flat[at + over + under : at + over + under + 1]) if over or under else 0
    if limit:
        return (limit + 1, 10**6, at + over + 1) if over else (0, limit - 1, at + under + 1)
    start = at + (flat[at : at + 1] == ("from",))
    upper = flat[start : start + 2] == ("up", "to") and start == at
    number = _count(flat[start + 2 * upper : start + 2 * upper + 1])
    end = start + 2 * upper + 1
    if not number:
        return None
    if upper:
        return 0, number, end
    for joint in ((), ("and",), ("or",)):
        word = flat[end + len(joint) : end + len(joint) + 1]
        if flat[end : end + len(joint)] == joint and word and word[0] in _OPEN_ENDS:
            after = end + len(joint) + 1
            if flat[after : after + 1] == ("to",):
                return None
            if joint and flat[after : after + 1] != () and flat[after] in _LOWERED:
                # "Wash car 2 and lower the gate".
                return None
            if word[0] in _ALSO_SMALL and start == at and flat[0] in lexicon().be:
                # "Is the lamp at stand 2 on?"
                return None
            if word[0] in _ALSO_SMALL and not joint and not start > at and flat[after : after + 1]:
                goes_on = flat[after] not in {",", ".", "!", "?", ";", "and", "please", "then", "for"}
                if goes_on:
                    return None
            return (number, 10**6, after) if word[0] in _UPWARDS else (0, number, after)
    return None


_UPWARDS = frozenset({"upwards", "upward", "onwards", "onward", "above", "higher", "up", "on"})
_ALSO_SMALL = frozenset({"on", "up", "down", "under"})
"""What goes on with another meaning before a noun: "machine 2 on low"."""
_LOWERED = lexicon().determiners | lexicon().thing_pronouns | {"them"}
_OPEN_ENDS = _UPWARDS | {"downwards", "below", "lower", "down", "under"}


def _label(words: Phrase, at: int) -> tuple[tuple[str, ...], int]:
    if at >= len(words):
        return (), at
    flat, word = keys(words), words[at]
    ends = word.key.split("-")
    if len(ends) == 2 and all(_is_number(part) for part in ends):
        return _range(int(ends[0]), int(ends[1])), at + 1
    number = _count((word.key,))
    if not number:
        return _letters(words, at) if _is_letter(words, at) else ((), at)
    behind = at + 1
    last = behind + _joint(flat, behind)
    ranged = last > behind and _count(flat[last : last + 1]) not in {0, number}
    if ranged and not is_unit(" ".join(flat[last + 1 : last + 2])):
        return _range(number, _count(flat[last : last + 1])), last + 1
    return (str(number),), behind


def _letters(words: Phrase, at: int) -> tuple[tuple[str, ...], int]:
    """One letter, or all of "A to C"."""
    flat = keys(words)
    last = at + 1 + _joint(flat, at + 1)
    if last > at + 1 and last < len(words) and flat[last] != flat[at] and _is_letter(words, last):
        codes = _steps(ord(flat[at]), ord(flat[last]))
        return tuple(chr(code) for code in codes), last + 1
    return (flat[at],), at + 1


def _is_letter(words: Phrase, at: int) -> bool:
    """Whether a letter is a name here and no article."""
    word = words[at]
    if len(word.key) != 1 or not word.key.isalpha():
        return False
    following = keys(words[at + 1 : at + 2])
    return word.key not in {"a", "i"} or (
        word.is_capital and following in {(), ("and",), (",",), ("to",), (".",), ("through",)}
    )


def _joint(flat: tuple[str, ...], at: int) -> int:
    """How many words at `at` stand between the ends of a range ("to", "down to", "through")."""
    way = int(flat[at : at + 1] != () and flat[at] in _WAYS)
    return way + 1 if flat[at + way : at + way + 1] and flat[at + way] in _UP_TO else 0


def _steps(first: int, last: int) -> range:
    return range(first, last + 1) if first < last else range(first, last - 1, -1)


def _range(first: int, last: int) -> tuple[str, ...]:
    return tuple(str(n) for n in _steps(first, last)) if abs(last - first) <= 50 else ()


_GOING_ON = frozenset(
    {
        "where",
        "who",
        "that",
        "which",
        "since",
        "when",
        "until",
        "beginning",
        "starting",
        "ending",
        "there",
        "and",
        "or",
        "but",
        "then",
        "please",
        "if",
        "whether",
        "for",
        "too",
        "now",
        "in",
        "at",
        "before",
        "after",
        "as",
        "also",
        "again",
        "today",
        "first",
        "last",
        "have",
        "has",
        "need",
        "needs",
        "can",
        "will",
        "should",
        "instead",
        "only",
        "while",
        "unless",
        "so",
        "because",
        "with",
        "from",
        "on",
        "to",
        "once",
    }
)


def stops(words: Phrase, at: int) -> bool:
    """Whether a noun phrase cannot go on at a word."""
    if at >= len(words) or not words[at].is_word:
        return True
    return words[at].key in _GOING_ON | lexicon().be
