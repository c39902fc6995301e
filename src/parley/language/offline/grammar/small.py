"""Small words and verbs, by what they do in a sentence."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache, lru_cache
from typing import Any

from parley.language.offline.words.lexicon import PhraseTable, lexicon
from parley.language.offline.words.order import phrases_due
from parley.language.offline.words.text import lemma
from parley.language.word_lists import load_data

__all__ = ["Small", "base", "is_past", "small", "verb_class"]


@dataclass(frozen=True)
class Small:
    """What the grammar knows of English."""

    verbs: Mapping[str, str]
    """Base form -> go, look, search, whether, count, leave_out or other."""
    deeds: Mapping[str, str]
    """Noun for what is done ("a look") -> class."""
    light: frozenset[str]
    """Verbs that make an order of such a noun ("have a look")."""
    always: frozenset[str]
    frame: frozenset[str]
    subjects: frozenset[str]
    addressees: frozenset[str]
    wishes: frozenset[str]
    past_frames: frozenset[str]
    questions: frozenset[str]
    needs: frozenset[str]
    prepositions: frozenset[str]
    adverbs: frozenset[str]
    determiners: frozenset[str]
    conjunctions: frozenset[str]
    existence: frozenset[str]
    people: frozenset[str]
    stop_what: frozenset[str]
    talk: frozenset[str]
    """Verbs that order nothing."""
    leave_out: PhraseTable
    backwards: PhraseTable
    ensuring: PhraseTable
    """Seeing that something is so, in so many words ("make certain")."""
    idioms: PhraseTable
    """What may stand anywhere and says nothing ("if I were you")."""
    go_on: PhraseTable
    """Going, in so many words ("pop your head")."""
    sets: Mapping[str, frozenset[str]]
    """Words by what they do in one place of the grammar."""
    subordinators: PhraseTable
    sequence: PhraseTable
    before_that: PhraseTable
    back_reference: PhraseTable
    corrections: PhraseTable
    same: PhraseTable


@cache
def small() -> Small:
    """The one list."""
    data = load_data("grammar")
    table: dict[str, str] = {}
    for name in ("look", "search", "count", "whether", "leave_out", "go", "go_to", "other"):
        for verb in data["verbs"][name]:
            table.setdefault(verb, name)
    deeds = {noun: name for name, nouns in data["deeds"].items() for noun in nouns}
    sets: dict[str, Any] = {
        name: frozenset(data[name])
        for name in ("light", "always", "frame", "subjects", "addressees", "wishes", "past_frames",
                     "questions", "needs", "prepositions", "adverbs", "determiners", "conjunctions",
                     "existence", "people", "stop_what", "talk")
    }  # fmt: skip
    tables: dict[str, Any] = {
        name: PhraseTable.of(data[name])
        for name in ("subordinators", "back_reference", "corrections", "same",
                     "leave_out", "go_on", "ensuring", "idioms", "backwards")
    }  # fmt: skip
    tables["sequence"] = PhraseTable.of(
        [
            *data["sequence"],
            *phrases_due("following", "next", "counting", "late", "closing", "opening", "back"),
            *("before anything else", "before you do anything else", "before doing anything else"),
        ]
    )
    tables["before_that"] = PhraseTable.of([*data["before_that"], *phrases_due("earlier")])
    special = {name: frozenset(words) for name, words in data["sets"].items()}
    return Small(verbs=table, deeds=deeds, sets=special, **sets, **tables)


@cache
def _verbs() -> frozenset[str]:
    known = frozenset(small().verbs)
    listed = {verb.split()[0] for verbs in lexicon().verb_classes.values() for verb in verbs}
    closed = lexicon().question_starts | lexicon().determiners | lexicon().be | lexicon().auxiliaries
    return known | frozenset(listed - closed - small().prepositions - small().adverbs - {"not"})


@lru_cache(maxsize=8192)
def base(word: str) -> str:
    """The base form of a verb; the word itself if it is none that is known."""
    return lemma(word, _verbs())


def verb_class(word: str) -> str:
    """What a verb in any form asks for; "" if it is none."""
    return small().verbs.get(base(word), "other" if base(word) in _verbs() else "")


def is_past(word: str) -> bool:
    """Whether it can only be what was done ("went", "looked"), no order."""
    form = base(word)
    return form != word and not word.endswith(("ing", "s")) and bool(verb_class(word))
