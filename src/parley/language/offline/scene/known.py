"""What is known while a message is being understood: the map, facts, what was mentioned."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import lru_cache

from parley.language.base import Grounding, Situation
from parley.language.offline.facts.facts import Fact
from parley.language.offline.facts.remembering import ONLY_NOW, Remembered, speaks_of_several
from parley.language.offline.scene.grounding import ground_phrase
from parley.language.offline.scene.group_nouns import Uncounted
from parley.language.offline.scene.relative import described_by_facts
from parley.language.offline.scene.states import in_state
from parley.language.offline.tasks.catalogue import Catalogue
from parley.language.offline.words.explaining import Trace
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.nouns import bare
from parley.language.offline.words.quantities import is_measure
from parley.language.offline.words.saying import the
from parley.language.offline.words.text import Phrase, Word, keys, singular, tokens
from parley.language.word_lists import load_data
from parley.messages.memory import MemoryEntry
from parley.world.object_map import MapObject

__all__ = ["ONLY_NOW", "OPERATOR", "Known", "Place", "UnclearError"]

OPERATOR = (Word("operator", "operator"),)


class UnclearError(Exception):
    """Something has to be asked before anything is done; never leaves the offline engine."""

    def __init__(
        self, question: str, choices: Sequence[str] = (), *, about: Phrase = (), lost: bool = False
    ) -> None:
        self.question, self.choices = question, tuple(choices)
        self.about = about
        """The words that are asked about, where it is some thing or place that is not known."""
        self.lost = lost
        """Whether nothing was understood at all."""
        super().__init__(question)


def _described_person(flat: tuple[str, ...]) -> bool:
    """For "the person wearing red", "the man with the hat", "the guest who is waving"."""
    lex = lexicon()
    at = next((i for i, word in enumerate(flat[:4]) if singular(word) in lex.person_words), -1)
    if at < 0 or any(word in lex.verb_classes["motion"] for word in flat[:at]):
        return False
    following = flat[at + 1 : at + 2]
    return following in {("with",), ("who",), ("whose",)} or (
        following[:1] != () and following[0].endswith("ing")
    )


_TITLES = frozenset(load_data("people")["titles"])
_TRADES = tuple(load_data("people")["trades"])
_MAYBE_TRADES = tuple(load_data("people")["maybe_trades"])
_HIM = frozenset({"he", "she", "him", "his", "her", "hers", "who", "whom"})
_SHORTEST_TRADE = 6


@lru_cache(maxsize=512)
def _is_of_trade(word: str, message: str) -> bool:
    """Whether a noun that no list has is somebody: by how it ends, or as the only "him" of a message."""
    lex, word = lexicon(), singular(word)
    if len(word) < _SHORTEST_TRADE or word in lex.nouns or not word.endswith(_TRADES + _MAYBE_TRADES):
        return False
    if word.endswith(_TRADES):
        return True
    said = tokens(message)
    others = any((w.is_capital and w.key not in lex.vocabulary) or w.key in lex.person_words for w in said)
    return bool(_HIM & set(keys(said))) and not others


def _is_thing(phrase: Phrase) -> bool:
    """Whether words name what somebody has, or an everyday thing ("A's pills", "apple juice")."""
    lex = lexicon()
    flat = keys(phrase)
    if len(flat) > 1 and any(word.endswith("'s") for word in flat[:-1]):
        return True
    if any(word.isdigit() for word in flat):
        return True
    if len(flat) > 1 and not any(word.is_capital for word in phrase) and flat[0] not in _TITLES:
        return True
    last = singular(flat[-1])
    everyday = last in lex.nouns or any(last in members for members in lex.kinds.values())
    return everyday and not phrase[-1].is_capital


@dataclass(frozen=True, slots=True)
class Place:
    """Somewhere the robot can be sent, or something it can be sent to."""

    value: str
    """The words to hand to an action."""
    item: MapObject | None = None
    """The object of the map, if exactly one is meant."""
    via: Remembered | None = None
    """The remembered fact that led here."""

    @property
    def label(self) -> str:
        """For sentences."""
        return the(self.value)


@dataclass
class Known:
    """One situation while it is being understood; collects what was used."""

    situation: Situation
    catalogue: Catalogue
    facts: list[Remembered]
    """Newest first."""
    hints: list[str] = field(default_factory=list)
    """Answers to questions that were asked about this message before, oldest first."""
    pending: dict[tuple[str, ...], list[int]] = field(default_factory=dict, init=False, repr=False)
    """Pending visits by the words that were found to name them."""
    learned: list[Fact] = field(default_factory=list)
    """Facts that those answers stated."""
    sources: list[str] = field(default_factory=list)
    things: list[Phrase] = field(default_factory=list)
    """Mentioned, newest last."""
    heard: int = 0
    """How many of them were spoken of before this message."""
    persons: list[Phrase] = field(default_factory=list)
    places: list[Phrase] = field(default_factory=list)
    trace: Trace = field(default_factory=Trace)
    """What was decided, for those who ask why."""
    served: set[tuple[str, ...]] = field(default_factory=set)
    """Who gets something already, by the words for them."""
    uncounted: Uncounted | None = None
    """A group that was named with a number that does not fit ("the two doors" of three)."""
    _told: dict[tuple[tuple[str, ...], int], tuple[MapObject, tuple[Remembered, ...]] | None] = field(
        default_factory=dict
    )

    @property
    def objects(self) -> tuple[MapObject, ...]:
        """The map."""
        return self.situation.objects

    def add_fact(self, fact: Fact, name: str) -> None:
        """Use a fact of the same message at once."""
        self.facts.insert(0, Remembered(fact, MemoryEntry(name=name, data=fact.sentence)))

    def use(self, item: Remembered) -> None:
        """Note that a memory was used; what is only said for this order is none."""
        if item.entry.name == ONLY_NOW:
            return
        self.trace.note("memory", f"used {item.entry.name}: {item.fact.sentence}")
        if item.entry.name not in self.sources:
            self.sources.append(item.entry.name)

    def ground(self, phrase: Phrase) -> Grounding:
        """What the phrase means on the map; what is remembered by that very name is no misspelt object."""
        told = self.told_apart(phrase)
        if told is not None:
            return Grounding("match", (told,))
        flat = keys(bare(phrase))
        remembered_so = any(keys(item.fact.subject) == flat for item in self.facts)
        return ground_phrase(phrase, self.objects, self.situation.robot_pose, strict=remembered_so)

    def told_apart(self, phrase: Phrase) -> MapObject | None:
        """The object that is described by what is remembered of it, e.g. "the chair A is on"."""
        key = keys(phrase), len(self.facts)
        if key not in self._told:
            pose, message = self.situation.robot_pose, self.situation.message
            self._told[key] = described_by_facts(phrase, self.objects, self.facts) or in_state(
                phrase, self.objects, self.facts, pose, message
            )
        found = self._told[key]
        if found is None:
            return None
        for fact in found[1]:
            self.use(fact)
        return found[0]

    def is_person(self, phrase: Phrase) -> bool:
        """Whether words name somebody rather than something."""
        lex = lexicon()
        phrase = bare(phrase)
        flat = keys(phrase)
        if len(flat) > 2 and _described_person(flat):
            return True
        if not flat or len(flat) > 3:
            return False
        if flat in {("operator",)} or (
            len(flat) == 1 and flat[0] in lex.person_pronouns | lex.operator_pronouns
        ):
            return True
        if singular(flat[-1]) in lex.person_words:
            return True
        if self.ground(phrase).outcome != "none":
            return False
        if any(keys(person) == flat for person in self.persons):
            return True
        if _is_thing(phrase):
            return False
        if len(flat) == 1 and _is_of_trade(flat[0], self.situation.message):
            return True
        if any(
            keys(f.fact.subject) == flat
            and f.fact.sentence.lower().startswith(flat[0])
            and not speaks_of_several(f.fact.sentence)
            for f in self.facts
        ):
            return True
        return all(word.is_capital for word in phrase) and len(flat) <= 2 and flat[0] not in lex.vocabulary

    def mention(self, phrase: Phrase) -> None:
        """Remember what was spoken of, for pronouns; how long or how much is no thing."""
        if not phrase or is_measure(phrase):
            return
        where = lexicon().places.match(keys(phrase))
        if where is not None and where[0] < len(phrase) and not phrase[0].is_capital:
            # "In the hall": the hall.
            phrase = phrase[where[0] :]
        if self.is_person(phrase):
            if keys(phrase)[0] not in lexicon().operator_pronouns | lexicon().person_pronouns:
                self.persons.append(phrase)
        elif keys(phrase)[0] not in lexicon().thing_pronouns | lexicon().place_pronouns:
            self.things.append(phrase)
