"""What somebody feels about what follows: that it is wanted ("I'd feel better if"), or that it is unknown.

The words before what is asked for may be any, as long as something in them says that it is asked for and
nothing that it is not. The words are data (`data/attitudes.yaml`).
"""

from __future__ import annotations

from functools import cache

from parley.language.offline.words.lexicon import PhraseTable
from parley.language.word_lists import load_data

__all__ = ["begins_unknown", "is_refused", "speaks_for_itself", "wants", "wants_to_know"]

_OWN = frozenset({
    "i", "we", "it", "you", "that", "this", "there", "would", "could", "might", "may", "will", "can",
    "should", "any", "is", "do", "are", "how", "what", "why", "fancy", "care", "no", "some", "if", "maybe",
    "perhaps", "better", "best", "suppose", "feel", "hoping", "worth", "time", "high", "about",
})  # fmt: skip
_ADDRESSED = frozenset({"you", "someone", "somebody", "anyone", "anybody", "robot", "one", "yourself", "us"})
_PROPOSING = frozenset(
    {("why", "not"), ("why", "do", "not"), ("how", "about"), ("how", "would", "you", "feel", "about")}
)


@cache
def _table(kind: str) -> PhraseTable:
    return PhraseTable.of(load_data("attitudes")[kind])


def _has(kind: str, lead: tuple[str, ...]) -> bool:
    return any(_table(kind).match(lead, at) is not None for at in range(len(lead)))


def is_refused(lead: tuple[str, ...]) -> bool:
    """Whether words say that what follows is not wanted."""
    return _has("refused", lead)


def wants(lead: tuple[str, ...]) -> bool:
    """Whether words say that what follows is wanted, of the robot or of whoever will do it.

    Args:
        lead: Lower case words.
    """
    why = {"why", "how"} & set(lead[:2]) and not _PROPOSING & {lead[:2], lead[:3], lead[:5]}
    if why or is_refused(lead):
        return False
    return _has("asked", lead) or (_has("mood", lead) and _has("good", lead))


def speaks_for_itself(lead: tuple[str, ...]) -> bool:
    """Whether whoever is to do it is the robot or anybody, and not whom the words are about."""
    return bool(_ADDRESSED & set(lead)) or lead[0] in _OWN


def wants_to_know(lead: tuple[str, ...]) -> bool:
    """Whether words say that the answer to what follows is not known and wanted."""
    then = _has("past", lead) and not {"wondering", "asking"} & set(lead)
    return _has("unknown", lead) and not then and lead[0] not in {"do", "did", "have", "how", "when", "why"}


def begins_unknown(rest: tuple[str, ...]) -> bool:
    """Whether words say what is unknown ("whether S", "how long S is") and can be looked at."""
    about = rest[1:2]
    return _has("asking", rest[:1]) and bool(about) and about[0] not in {"to", "you", "i", "we", "my", "your"}
