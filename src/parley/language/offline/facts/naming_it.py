"""What "it" is in words that only a memory can tell: "we need A, go to whoever has it", "where it is"."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Protocol

from parley.language.offline.facts.remembering import Remembered
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.nouns import noun_phrase
from parley.language.offline.words.text import Phrase, Word, keys

__all__ = ["with_it_named"]

_WHERE = frozenset({"where", "wherever"})
_WHO = frozenset({"whoever", "who", "that", "with", "person"})
_FURTHEST = 4


class _Owned(Protocol):
    """What belongs to somebody."""

    @property
    def thing(self) -> Phrase:
        """What it is called."""


def with_it_named(words: Phrase, owned: Iterable[_Owned], facts: Sequence[Remembered]) -> Phrase:
    """A message with "it" by its name, where "whoever has it" or "where it is" is to be looked up.

    Args:
        words: All words and punctuation.
        owned: What is remembered to be somebody's.
        facts: What is remembered.
    """
    flat = keys(words)
    at = next((i for i in range(2, len(flat)) if flat[i] in {"it", "them"} and _is_sought(flat, i)), 0)
    if not at:
        return words
    known = [item.thing for item in owned]
    known += [
        item.fact.subject for item in facts if item.fact.is_location and not _is_name(item.fact.subject)
    ]
    said: list[tuple[int, Phrase]] = []
    for thing in known:
        core = noun_phrase(thing).core
        ends = (i + len(core) for i in range(at - len(core)) if core and flat[i : i + len(core)] == core)
        said += ((end, thing) for end in ends)
    if not said:
        return words
    named = max(said, key=lambda found: (found[0], len(found[1])))[1]
    return (*words[:at], Word("the", "the"), *named, *words[at + 1 :])


def _is_sought(flat: tuple[str, ...], at: int) -> bool:
    """Whether "it" stands in "where it is" or "whoever has it"."""
    if flat[at - 1] in _WHERE:
        return flat[at + 1 : at + 2] != () and flat[at + 1] in lexicon().be | lexicon().location_verbs
    before = flat[max(0, at - _FURTHEST) : at]
    somebody = "whoever" in before or any(
        flat[i] in lexicon().person_words | {"one", "those"} and flat[i + 1] in _WHO
        for i in range(max(0, at - _FURTHEST), at - 1)
    )
    return somebody and not {",", ".", "and"} & set(
        before[before.index("whoever") if "whoever" in before else 1 :]
    )


def _is_name(phrase: Phrase) -> bool:
    return all(word.is_capital for word in phrase)
