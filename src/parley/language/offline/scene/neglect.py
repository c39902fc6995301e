"""A place has not been looked after ("nobody has been at A since noon"): it is looked at."""

from __future__ import annotations

from parley.language.offline.facts.facts import strip_openers
from parley.language.offline.scene.report_words import phrase_of, place_named
from parley.language.offline.scene.scene import Scene
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.nouns import bare
from parley.language.offline.words.text import Phrase, keys, lemma

__all__ = ["neglected"]

_MOST_WORDS = 22
_DENIED = frozenset({"not", "nobody", "never", "no", "none", "hardly", "barely", "neither"})
_HAVING = frozenset({"has", "have", "had", "did", "got", "ever"})
_OVERDUE = frozenset({"overdue", "unchecked", "unvisited", "uninspected", "neglected", "forgotten", "unseen"})
_STOPPED = frozenset(
    {"because", "so", "if", "unless", "when", "please", "want", "wants", "should", "must", "need", "needs"}
)
_SUBJECTS = frozenset(
    {
        "nobody",
        "no",
        "none",
        "i",
        "we",
        "they",
        "somebody",
        "someone",
        "anybody",
        "anyone",
        "you",
        "it",
        "people",
    }
)


def neglected(words: Phrase, scene: Scene) -> Phrase | None:
    """The order to look that a clause about neglect means; None if it says nothing of the kind.

    Args:
        words: One clause.
        scene: What is known.
    """
    said = tuple(word for word in strip_openers(words) if word.is_word)
    flat = keys(said)
    if not 3 <= len(said) <= _MOST_WORDS or flat[0] in lexicon().question_starts or _STOPPED & set(flat):
        return None
    if not (_unseen(flat) or _long_since(flat) or _is_overdue(flat)):
        return None
    where = place_named(said, scene)
    return None if where is None else phrase_of("inspect the", bare(said[where[0] : where[1]]))


def _unseen(flat: tuple[str, ...]) -> bool:
    """For "nobody has been at A", "we have not looked at A for days", "A has not been checked yet"."""
    at = next((i for i, key in enumerate(flat) if key in _DENIED), -1)
    if at < 0 or not _HAVING & set(flat[: at + 4]):
        return False
    return any(_visits(flat, i) for i in range(1, len(flat)))


def _long_since(flat: tuple[str, ...]) -> bool:
    """For "it is a week since anybody looked at A"."""
    if "since" in flat[2:-2]:
        at = flat.index("since", 2)
        return flat[0] in {"it", "that"} and any(_visits(flat, i) for i in range(at + 1, len(flat)))
    return False


def _is_overdue(flat: tuple[str, ...]) -> bool:
    """For "A is overdue (for a check)", "A has gone unchecked"."""
    return bool(_OVERDUE & set(flat[1:])) and bool(
        (lexicon().be | {"gone", "went", "looks", "feels"}) & set(flat[1:])
    )


def _visits(flat: tuple[str, ...], at: int) -> bool:
    """Whether a word is how somebody has been to a place, or has looked at it."""
    word = flat[at]
    if word in {"been", "gone", "was", "round", "passed"}:
        behind = flat[at + 1 : at + 3]
        return word != "was" and any(key in _TO for key in behind) and not _done(flat, at + 1)
    base = lemma(word)
    if base == word and word not in {"set", "look", "check", "inspect", "visit"}:
        return False
    found = lexicon().verbs.match((base, *flat[at + 1 :]))
    kind = found[1].partition(":")[0] if found is not None else ""
    return kind in {"look", "whether"} or base in {"visit", "patrol", "attend"}


_TO = frozenset(
    {
        "to",
        "at",
        "in",
        "by",
        "near",
        "round",
        "past",
        "over",
        "into",
        "along",
        "through",
        "down",
        "up",
        "inside",
    }
)


def _done(flat: tuple[str, ...], at: int) -> bool:
    """Whether what stands there is something else that was done ("been painted at A")."""
    return at < len(flat) and flat[at].endswith("ed")
