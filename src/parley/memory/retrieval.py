"""What is looked for in the memory and how the finds are ranked. Pure: no database, no clock.

The full-text index answers one term at a time ("the newest memories with this word"), never "everything that
matches anything": that keeps a search fast however common its words are. From those answers the finds are
scored here, BM25-like: a word weighs the more the fewer memories hold it.
"""

from __future__ import annotations

import math
import re
import unicodedata
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from parley.messages.memory import MemoryEntry

__all__ = [
    "MAX_COMMON_TERMS",
    "MAX_TERMS",
    "Hits",
    "common_terms",
    "final_order",
    "fts_phrase",
    "name_key",
    "query_terms",
    "scores",
    "telling",
    "words",
]

MAX_TERMS = 24
"""A longer request is searched by its first words; nobody names more things at once."""

MAX_COMMON_TERMS = 4
"""How many common words are followed beyond their newest memories."""

_STOP_WORDS = frozenset(
    re.findall(
        r"\w+",
        """a about all also am an and any anything are as at be been being but by can could did do does doing
        done for from get go got had has have he her here hers him his how i if in into is it its just know
        let me my no not now of off ok on onto or our out over please remember she should so some something
        tell than that the their them then there these they this those to too up us was we were what when
        where whether which who whom whose why will with would yes you your""",
    )
)
"""Words that say nothing about what a memory is about."""

_WORD = re.compile(r"[^\W_]+")
_CAMEL = re.compile(r"(?<=[a-z0-9])(?=[A-Z])")
_LABEL = re.compile(r"[^\W\d_]|\d+[^\W\d_]?")
"""A letter or number that tells things of one kind apart: area *A*, room *12*, gate *3b*."""


def words(text: str) -> list[str]:
    """The words of a text or of a name like ``boxLocation`` or ``box_location``, in lower case."""
    return _WORD.findall(unicodedata.normalize("NFKC", _CAMEL.sub(" ", text)).lower())


def name_key(name: str) -> str:
    """What two spellings of one name have in common."""
    return " ".join(words(name)) or name.lower()


def query_terms(query: str) -> list[tuple[str, ...]]:
    """What to look for: each telling word, and each word together with the letter or number behind it.

    Examples:
        >>> query_terms("Where is the box in area B?")
        [('box',), ('area',), ('area', 'b')]
    """
    found: dict[tuple[str, ...], None] = {}
    before = ""
    for word in words(query[: MAX_TERMS * 100]):
        telling = word not in _STOP_WORDS
        label = _LABEL.fullmatch(word) is not None
        if label and before:
            found[(before, word)] = None
        if telling and not (label and before):
            found[(word,)] = None
        before = word if telling and not label else ""
    return list(found)[:MAX_TERMS]


def fts_phrase(term: Sequence[str]) -> str:
    """A term as an FTS5 string; quoting makes every character harmless."""
    text = " ".join(term).replace('"', '""')
    return f'"{text}"'


@dataclass(frozen=True, slots=True)
class Hits:
    """What the index answered for one term.

    Attributes:
        ids: Memories that hold the term, newest (largest) first; a common term's older ones may be missing.
        complete: Whether these are all.
    """

    ids: tuple[int, ...]
    complete: bool

    def weight(self, newest_id: int) -> float:
        """How telling the term is (BM25's inverse document frequency), of about `newest_id` memories.

        How often a common term occurs is estimated from how far back its newest occurrences reach.
        """
        count = float(len(self.ids))
        if not self.complete and self.ids:
            count *= newest_id / max(newest_id - self.ids[-1] + 1, 1)
        return math.log(1.0 + (max(newest_id - count, 0.0) + 0.5) / (count + 0.5))


def scores(
    found: Mapping[tuple[str, ...], Iterable[int]], weights: Mapping[tuple[str, ...], float]
) -> dict[int, float]:
    """Add up the weights of the terms that each memory holds."""
    total: dict[int, float] = {}
    for term, ids in found.items():
        for identity in set(ids):
            total[identity] = total.get(identity, 0.0) + weights[term]
    return total


def common_terms(
    hits: Mapping[tuple[str, ...], Hits], weights: Mapping[tuple[str, ...], float]
) -> list[tuple[str, ...]]:
    """The terms whose older memories are not known yet, the most telling first; only so many as matter."""
    common = [term for term, hit in hits.items() if not hit.complete]
    return sorted(common, key=weights.__getitem__, reverse=True)[:MAX_COMMON_TERMS]


def telling(
    terms: Iterable[tuple[str, ...]], weights: Mapping[tuple[str, ...], float]
) -> list[tuple[str, ...]]:
    """Those terms that weigh something beside the others.

    A word that nearly every memory holds changes nothing, and looking for it would take longest.
    """
    least = 0.2 * max(weights.values(), default=0.0)
    return [term for term in terms if weights[term] > least]


def final_order(
    candidates: Sequence[tuple[int, float, MemoryEntry]], weights: Mapping[tuple[str, ...], float]
) -> list[MemoryEntry]:
    """Order candidates (id, score, memory) best first; of equals the newest.

    A word in the name counts half as much again, and long texts, which hold every word, count less.
    """

    def value(candidate: tuple[int, float, MemoryEntry]) -> tuple[float, int]:
        identity, score, entry = candidate
        name = words(entry.name)
        bonus = sum(0.5 * weights[term] for term in weights if _holds(name, term))
        length = len(entry.data) / 6 if entry.type == "text" else 0.0
        return (score + bonus) / (1.0 + 0.25 * math.log1p(length / 30)), identity

    return [entry for _, _, entry in sorted(candidates, key=value, reverse=True)]


def _holds(name: Sequence[str], term: Sequence[str]) -> bool:
    """Whether a name holds a term, endings aside (box, boxes)."""
    return all(any(_akin(part, word) for part in name) for word in term)


def _akin(one: str, other: str) -> bool:
    short, long = sorted((one, other), key=len)
    return short == long or (len(short) >= 3 and len(long) - len(short) <= 2 and long.startswith(short))
