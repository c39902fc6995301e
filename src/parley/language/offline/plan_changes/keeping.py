"""Beginning the plan once more from its start: "start over", "from the top"."""

from __future__ import annotations

from parley.language.offline.facts.facts import strip_openers
from parley.language.offline.words.text import Phrase, keys

__all__ = ["restarts"]

_RESTARTING = frozenset({
    "start", "begin", "restart", "redo", "do", "repeat", "run", "go", "take", "back", "it", "all",
    "everything", "the", "whole", "thing", "lot", "round", "tour", "plan", "list", "mission", "job",
    "route", "patrol", "entire", "that", "this", "of", "again", "over", "anew", "afresh", "once", "more",
    "from", "scratch", "top", "beginning", "very", "zero", "one", "step", "square", "first", "to", "let",
    "us", "and", "then", "please", "now", "just", "forget", "scrap", "cancel", "stop", "drop", "abandon",
    "right", "you", "were", "doing", "i", "want", "need", "with", "everything's", "item", "second", "time",
    "fresh", "a", "new", "could", "can", "would", "better",
})  # fmt: skip
"""Of these words alone consists what asks to begin the plan again."""
_FROM_START = frozenset(
    (lead, *where)
    for lead in ("from", "at", "to", "with")
    for where in (
        ("the", "top"), ("the", "beginning"), ("the", "very", "beginning"), ("the", "start"), ("scratch",),
        ("zero",), ("square", "one"), ("step", "one"), ("the", "first", "step"), ("the", "first", "one"),
    )
)  # fmt: skip


def restarts(words: Phrase) -> bool:
    """Whether the plan is to be begun once more from its start."""
    flat = keys(word for word in strip_openers(words) if word.is_word)
    said = set(flat)
    if not flat or not said <= _RESTARTING:
        return False
    start = any(flat[i : i + n] in _FROM_START for i in range(len(flat)) for n in (2, 3, 4))
    if start and said & {"back", "start", "begin", "again", "over", "from", "restart", "redo", "repeat"}:
        return True
    again = bool(said & {"again", "over", "anew", "afresh", "more"})
    if "restart" in said or (again and bool(said & {"start", "begin"})):
        return True
    return bool(said & {"all", "everything", "whole", "entire", "plan", "round"}) and (
        bool(said & {"redo", "repeat"}) or (again and bool(said & {"do", "run", "go", "once"}))
    )
