"""Which remembered facts matter for a message: shared words, like words, and one hop further."""

from __future__ import annotations

from collections.abc import Sequence

from parley.language.offline.facts.protocols import may_matter
from parley.language.offline.facts.redirecting import redirects
from parley.language.offline.facts.remembering import remembered
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.text import keys, lemma, singular, split_name, tokens
from parley.messages.memory import MemoryEntry

__all__ = ["select_memories"]


def select_memories(query: str, index: Sequence[MemoryEntry]) -> list[str]:
    """Names of the memories that matter for `query`, in the order of `index`."""
    wanted = _meant(query)
    about: dict[str, set[str]] = {
        entry.name: _content(f"{' '.join(split_name(entry.name))} {entry.info} {entry.data[:500]}")
        for entry in index
    }
    chosen = {name for name, words in about.items() if words & wanted}
    said = {form for word in tokens(query) for form in (word.key, singular(word.key))}
    chosen |= {entry.name for entry in index if entry.type == "text" and may_matter(entry.data, said)}
    # A place that a chosen fact leads to may have a fact of its own ("area A is closed").
    leads_to = [
        {singular(word.key) for word in item.fact.place if word.is_word}
        for item in remembered([entry for entry in index if entry.name in chosen])
        if item.fact.is_location
    ]
    for entry in index:
        own = {singular(word.key) for word in tokens(entry.data[:500])}
        if any(place and place <= own for place in leads_to):
            chosen.add(entry.name)
    # What is used in its place may be closed itself.
    closings = list(redirects(index))
    others = {keys(said.other) for _, said, entry in closings if entry.name in chosen and said.other}
    chosen |= {entry.name for _, said, entry in closings if keys(said.place) in others}
    return [entry.name for entry in index if entry.name in chosen]


def _meant(query: str) -> set[str]:
    lex = lexicon()
    words = _content(query)
    wider = set(words)
    for word in words:
        for same in lex.synonyms.get(word, ()):
            wider.update(singular(part) for part in same.split())
        wider |= {
            singular(part) for kind in lex.kinds.get(lex.needs.get(word, word), ()) for part in kind.split()
        }
    return wider


def _content(text: str) -> set[str]:
    """The words that carry meaning."""
    lex = lexicon()
    result: set[str] = set()
    for word in tokens(text):
        key = word.key.removesuffix("'s")
        content = (
            key in lex.synonyms or key in lex.needs or key not in lex.vocabulary or key in lex.meaningful
        )
        if word.is_word and content and len(key) > 1:
            result.add(singular(key))
            result.add(lemma(key))
    return result - {"location", "place", "info", "memory", "fact", "state"}
