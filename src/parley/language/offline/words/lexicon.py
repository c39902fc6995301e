"""The word lists of the offline engine, read once from `data/` (general English, nothing about any world)."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cache, cached_property
from typing import Any

from parley.language.word_lists import load_data, written_out

__all__ = ["Lexicon", "PhraseTable", "lexicon"]


class PhraseTable:
    """Phrases of one or more words, found longest first."""

    def __init__(self, phrases: Mapping[str, str]) -> None:
        self._table = {tuple(phrase.split()): value for phrase, value in phrases.items()}
        self._longest = max((len(key) for key in self._table), default=0)
        self._by_first: dict[str, int] = {}
        for key in self._table:
            self._by_first[key[0]] = max(self._by_first.get(key[0], 0), len(key))

    @classmethod
    def of(cls, phrases: Iterable[str]) -> PhraseTable:
        """A table whose values are the phrases themselves; "(a|b) c" stands for "a c" and "b c"."""
        return cls({one: one for phrase in phrases for one in written_out(phrase)})

    def __contains__(self, words: object) -> bool:
        return words in self._table

    def match(self, words: tuple[str, ...], start: int = 0) -> tuple[int, str] | None:
        """The longest phrase that begins at `start`: how many words, and its value."""
        if start >= len(words) or words[start] not in self._by_first:
            return None
        for length in range(min(self._by_first[words[start]], len(words) - start), 0, -1):
            value = self._table.get(words[start : start + length])
            if value is not None:
                return length, value
        return None

    def match_end(self, words: tuple[str, ...]) -> int:
        """How many words at the end of `words` form a phrase (the longest); 0 if none."""
        for length in range(min(self._longest, len(words)), 0, -1):
            if words[len(words) - length :] in self._table:
                return length
        return 0


@dataclass(frozen=True)
class Lexicon:
    """What is known about English words."""

    determiners: frozenset[str]
    quantifiers: frozenset[str]
    free_choice: frozenset[str]
    person_pronouns: frozenset[str]
    operator_pronouns: frozenset[str]
    thing_pronouns: frozenset[str]
    place_pronouns: frozenset[str]
    be: frozenset[str]
    auxiliaries: frozenset[str]
    location_verbs: frozenset[str]
    transition_verbs: frozenset[str]
    placing_verbs: frozenset[str]
    person_words: frozenset[str]
    generic_things: frozenset[str]
    question_starts: frozenset[str]
    insults: frozenset[str]
    jokes: frozenset[str]
    incidents: frozenset[str]
    """What people report for somebody to look at."""
    ordinals: Mapping[str, int]
    numbers: Mapping[str, int]
    places: PhraseTable
    """Prepositions of place."""
    goals: PhraseTable
    """Prepositions before where something goes."""
    goals_and_places: frozenset[str]
    """First words of the prepositions of place."""
    adverbs: PhraseTable
    polite: PhraseTable
    requests: PhraseTable
    wants: PhraseTable
    reporting: PhraseTable
    corrections: PhraseTable
    greetings: PhraseTable
    thanks: PhraseTable
    farewells: PhraseTable
    verbs: PhraseTable
    """Verb (base form, several words possible) -> ``class:verb``."""
    verb_classes: Mapping[str, frozenset[str]]
    irregular: Mapping[str, str]
    plurals: Mapping[str, str]
    contractions: Mapping[str, str]
    is_subjects: frozenset[str]
    """Words whose ``'s`` is always "is"."""
    after_is: frozenset[str]
    """Words before which ``'s`` is "is" and no possessive."""
    states: frozenset[str]
    """What things are said to be, after a short "is"."""
    """Small words of other languages."""
    prohibitions: PhraseTable
    everybody: PhraseTable
    your_choice: PhraseTable
    told: frozenset[str]
    often_mistyped: frozenset[str]
    meaningful: frozenset[str]
    """Words of these lists that carry meaning of their own."""
    nouns: frozenset[str]
    """Common nouns, never taken for a typing error of another."""
    hazards: frozenset[str]
    """What a person should decide about when it is seen."""
    effects: Mapping[str, str]
    action_words: Mapping[str, str]
    synonyms: Mapping[str, frozenset[str]]
    """Word or compound -> words of the same meaning, itself included."""
    kinds: Mapping[str, frozenset[str]]
    needs: Mapping[str, str]
    need_words: Mapping[str, str]
    need_phrases: Mapping[str, str]
    vocabulary: frozenset[str]
    """Every word that occurs in the lists above: never taken for a typing error."""

    @cached_property
    def small(self) -> frozenset[str]:
        """The words of the vocabulary that are no nouns."""
        return self.vocabulary - self.nouns


@cache
def lexicon() -> Lexicon:
    """The one lexicon."""
    words, verbs, thesaurus = load_data("words"), load_data("verbs"), load_data("thesaurus")
    special = {"irregular", "effects", "action_words"}
    classes = {name: frozenset(listed) for name, listed in verbs.items() if name not in special}
    # Earlier classes win where a verb is listed twice.
    table: dict[str, str] = {}
    for name, listed in verbs.items():
        if name not in special | {"drop_step", "forget", "remember"}:
            for verb in listed:
                table.setdefault(verb, f"{name}:{verb}")
    openers = words["openers"]
    sets = {
        name: frozenset(words[name])
        for name in (
            "determiners",
            "quantifiers",
            "free_choice",
            "person_pronouns",
            "operator_pronouns",
            "thing_pronouns",
            "place_pronouns",
            "be",
            "auxiliaries",
            "location_verbs",
            "transition_verbs",
            "placing_verbs",
            "person_words",
            "generic_things",
            "question_starts",
            "insults",
            "jokes",
            "incidents",
            "told",
            "often_mistyped",
            "meaningful",
        )
    }
    return Lexicon(
        **sets,
        ordinals={word: int(number) for word, number in words["ordinals"].items()},
        numbers={word: int(number) for word, number in words["numbers"].items()},
        places=PhraseTable.of(words["place_prepositions"]),
        goals=PhraseTable.of(words["goal_prepositions"]),
        goals_and_places=frozenset(
            text.split()[0]
            for text in (*words["goal_prepositions"], *words["place_prepositions"])
            if text != "of"
        ),
        adverbs=PhraseTable.of(words["adverbs"]),
        polite=PhraseTable.of(openers["polite"]),
        requests=PhraseTable.of(openers["request"]),
        wants=PhraseTable.of(openers["wants"]),
        reporting=PhraseTable.of(words["reporting"]),
        corrections=PhraseTable.of(words["corrections"]),
        greetings=PhraseTable.of(words["greetings"]),
        thanks=PhraseTable.of(words["thanks"]),
        farewells=PhraseTable.of(words["farewells"]),
        verbs=PhraseTable(table),
        verb_classes=classes,
        irregular=verbs["irregular"],
        plurals=words["plurals"],
        contractions=words["contractions"]["words"],
        is_subjects=frozenset(words["contractions"]["subjects"]),
        after_is=frozenset(words["contractions"]["before"]),
        states=frozenset(words["contractions"]["states"]),
        prohibitions=PhraseTable.of(words["prohibitions"]),
        everybody=PhraseTable.of(words["everybody"]),
        your_choice=PhraseTable.of(words["your_choice"]),
        nouns=frozenset(thesaurus["nouns"]),
        hazards=frozenset(thesaurus["hazards"]),
        effects=verbs["effects"],
        action_words=verbs["action_words"],
        synonyms=_synonyms(thesaurus["same"]),
        kinds={name: frozenset(listed) for name, listed in thesaurus["kinds"].items()},
        needs=thesaurus["needs"],
        need_words=thesaurus["need_words"],
        need_phrases=thesaurus["need_phrases"],
        vocabulary=frozenset(_words_of([words, verbs, thesaurus])),
    )


def _synonyms(lines: list[list[str]]) -> dict[str, frozenset[str]]:
    table: dict[str, set[str]] = {}
    for line in lines:
        for word in line:
            table.setdefault(word, set()).update(line)
    return {word: frozenset(same) for word, same in table.items()}


def _words_of(value: Any) -> Iterable[str]:
    if isinstance(value, str):
        yield from value.split()
    elif isinstance(value, list):
        for item in value:
            yield from _words_of(item)
    else:
        for key, item in value.items():
            yield from key.split()
            yield from _words_of(item)
