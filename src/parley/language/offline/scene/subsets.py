"""Parts of a group that an exception tells: "apart from A, check all doors", "check nothing but A"."""

from __future__ import annotations

from parley.language.offline.scene.group_words import exception_at
from parley.language.offline.words.text import Phrase, Word, keys, singular

__all__ = ["only_exception", "with_exception_behind"]

_ALL = frozenset({"all", "every", "each", "everything", "both"})


def only_exception(words: Phrase) -> Phrase:
    """For "do not check any door but door 2", "check nothing except A": "check door 2", "check A"."""
    flat = keys(words)
    for at in range(len(flat) - 4):
        begins = not at or not words[at - 1].is_word or flat[at - 1] in {"and", "but", "so", "please"}
        denied = 2 if flat[at : at + 2] == ("do", "not") else int(flat[at] == "never")
        some = next(
            (i for i in range(at + denied + 1, min(at + denied + 5, len(flat))) if flat[i] in _ANY), 0
        )
        if not begins or not some or bool(denied) is (flat[some] in _NOTHING):
            continue
        limit = min(some + _LONGEST_KIND, len(flat))
        out = next((i for i in range(some + 1, limit) if exception_at(flat, i)), 0)
        if not out or any(not word.is_word for word in words[at:out]):
            continue
        wanted = words[out + exception_at(flat, out) :]
        label = wanted[:1] and (wanted[0].key.isdigit() or len(wanted[0].key) == 1)
        last = words[out - 1]
        kind = (Word(singular(last.key), singular(last.raw)),) if label and out > some + 1 else ()
        link = (Word("to", "to"),) if flat[some] in {"anywhere", "nowhere"} else ()
        return (*words[:at], *words[at + denied : some], *link, *kind, *wanted)
    return words


_NOTHING = frozenset({"nothing", "nowhere", "none", "no"})
_ANY = _NOTHING | {"any", "anything", "anywhere"}
_LONGEST_KIND = 5


def with_exception_behind(words: Phrase) -> Phrase:
    """For "apart from A, check all doors": "check all doors except A"."""
    flat = keys(words)
    lead = 0 if flat[:1] in {("but",), ("bar",)} else exception_at(flat, 0)
    comma = next((i for i in range(lead + 1, len(flat)) if flat[i] == ","), 0) if lead else 0
    end = next((i for i in range(comma + 1, len(flat)) if flat[i] in {",", ".", "!", "?", "then"}), len(flat))
    if not comma or comma > lead + 8 or not _ALL & set(flat[comma + 1 : end]):
        return words
    return (*words[comma + 1 : end], Word("except", "except"), *words[lead:comma], *words[end:])
