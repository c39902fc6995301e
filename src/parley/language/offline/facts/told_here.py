"""What a message tells before it asks for something: it holds at once ("A has the key. Go to A")."""

from __future__ import annotations

from parley.language.offline.facts.facts import read_statement
from parley.language.offline.facts.remembering import ONLY_NOW, Remembered
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.text import Phrase, keys
from parley.messages.memory import MemoryEntry

__all__ = ["told_here"]

_STOPS = frozenset({".", ";", "!"})
_LEAST = 3


def told_here(words: Phrase) -> list[Remembered]:
    """The facts that a message states in sentences of their own before its end, the last one first.

    Args:
        words: All words and punctuation.
    """
    told: list[Remembered] = []
    start = 0
    for end in (i for i, word in enumerate(words) if word.key in _STOPS):
        sentence, start = words[start:end], end + 1
        if start < len(words) - 1 and lexicon().be.isdisjoint(keys(sentence[:1])):
            told += _read(sentence)
    return told[::-1]


def _read(sentence: Phrase) -> list[Remembered]:
    """The fact in a sentence, or both of those that "and" joins."""
    flat = keys(sentence)
    at = flat.index("and") if "and" in flat[_LEAST:] else 0
    halves = [sentence[:at], sentence[at + 1 :]] if at else []
    facts = [read_statement(half) for half in halves if len(half) >= _LEAST]
    if len(facts) < len(halves) or not halves or None in facts:
        facts = [read_statement(sentence)] if len(sentence) >= _LEAST else []
    entries = ((fact, MemoryEntry(name=ONLY_NOW, data=fact.sentence)) for fact in facts if fact is not None)
    return [Remembered(fact, entry) for fact, entry in entries]
