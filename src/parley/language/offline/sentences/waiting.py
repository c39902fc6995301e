"""Waiting for somebody somewhere: "wait for me in the hall" is being there."""

from __future__ import annotations

from collections.abc import Callable

from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.text import Phrase, Word, keys

__all__ = ["waiting_there"]

IsStop = Callable[[Phrase], bool]

_GO = (Word("go", "go"), Word("to", "to"))
_LONGEST_WHO = 3


def waiting_there(words: Phrase, is_stop: IsStop) -> Phrase:
    """The same message with going to where somebody is to be waited for.

    Args:
        words: All words and punctuation.
        is_stop: Whether words name one thing on the map.
    """
    flat = keys(words)
    for index in range(len(flat) - 3):
        if flat[index : index + 2] != ("wait", "for"):
            continue
        for at in range(index + 3, min(index + 3 + _LONGEST_WHO, len(flat) - 1)):
            found = lexicon().places.match(flat, at)
            start = at + (found[0] if found is not None else 0)
            named = found is not None and any(is_stop(words[start : start + n]) for n in range(1, 6))
            if named and all(word.is_word for word in words[index:at]) and not _counts(flat[index + 2 : at]):
                return (*words[:index], *_GO, *words[start:])
    return words


def _counts(flat: tuple[str, ...]) -> bool:
    return any(word.isdigit() or word in lexicon().numbers for word in flat) or flat[:1] == ("a",)
