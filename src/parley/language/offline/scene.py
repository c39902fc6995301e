"""What a message is understood against: the map, what is remembered, what was mentioned, earlier answers."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

from parley.language.base import Grounding, Situation
from parley.language.offline.catalogue import Catalogue
from parley.language.offline.choosing import choose_object
from parley.language.offline.facts import Fact, read_statement
from parley.language.offline.grounding import describe, ground_phrase
from parley.language.offline.lexicon import lexicon
from parley.language.offline.nouns import NounPhrase, bare, coordinated, noun_phrase
from parley.language.offline.relative import described_by_facts
from parley.language.offline.remembering import Remembered, find_fact, memory_name, remembered
from parley.language.offline.saying import listing, the
from parley.language.offline.text import Phrase, Word, keys, plain, singular, tokens
from parley.messages.memory import MemoryEntry
from parley.world.object_map import MapObject

__all__ = ["Place", "Scene", "UnclearError"]

_MAX_HOPS = 3
_ALL_OF_THEM = frozenset(
    tuple(text.split())
    for text in (
        "both",
        "all",
        "both of them",
        "all of them",
        "all three",
        "all of those",
        "both of those",
        "every one",
        "each",
        "each of them",
    )
)
OPERATOR = (Word("operator", "operator"),)


class UnclearError(Exception):
    """Something has to be asked before anything is done; never leaves the offline engine."""

    def __init__(self, question: str, choices: Sequence[str] = ()) -> None:
        self.question, self.choices = question, tuple(choices)
        super().__init__(question)


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
class Scene:
    """One situation while it is being understood; collects what was used."""

    situation: Situation
    catalogue: Catalogue
    facts: list[Remembered]
    """Newest first."""
    hints: list[str] = field(default_factory=list)
    """Answers to questions that were asked about this message before, oldest first."""
    learned: list[Fact] = field(default_factory=list)
    """Facts that those answers stated."""
    sources: list[str] = field(default_factory=list)
    things: list[Phrase] = field(default_factory=list)
    """Mentioned, newest last."""
    persons: list[Phrase] = field(default_factory=list)
    places: list[Phrase] = field(default_factory=list)
    _told: dict[tuple[tuple[str, ...], int], tuple[MapObject, tuple[Remembered, ...]] | None] = field(
        default_factory=dict
    )

    @classmethod
    def of(cls, situation: Situation, hints: Sequence[str] = ()) -> Scene:
        """The scene of a situation."""
        return cls(situation, Catalogue(situation.catalogue), remembered(situation.memory), list(hints))

    @property
    def objects(self) -> tuple[MapObject, ...]:
        """The map."""
        return self.situation.objects

    def add_fact(self, fact: Fact, name: str) -> None:
        """Use a fact of the same message at once."""
        self.facts.insert(0, Remembered(fact, MemoryEntry(name=name, data=fact.sentence)))

    def use(self, item: Remembered) -> None:
        """Note that a memory was used."""
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
            self._told[key] = described_by_facts(phrase, self.objects, self.facts)
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
        if any(
            keys(f.fact.subject) == flat and f.fact.sentence.lower().startswith(flat[0]) for f in self.facts
        ):
            return True
        return all(word.is_capital for word in phrase) and len(flat) <= 2 and flat[0] not in lex.vocabulary

    def mention(self, phrase: Phrase) -> None:
        """Remember what was spoken of, for pronouns."""
        if not phrase:
            return
        if self.is_person(phrase):
            if keys(phrase)[0] not in lexicon().operator_pronouns | lexicon().person_pronouns:
                self.persons.append(phrase)
        elif keys(phrase)[0] not in lexicon().thing_pronouns | lexicon().place_pronouns:
            self.things.append(phrase)

    def referent(self, phrase: Phrase) -> Phrase:
        """What a pronoun stands for; other phrases come back unchanged.

        Raises:
            UnclearError: Nothing was mentioned that it could stand for.
        """
        lex = lexicon()
        flat = keys(bare(phrase))
        if len(flat) != 1:
            return phrase
        word = flat[0]
        if word in lex.operator_pronouns:
            return OPERATOR
        if word in lex.person_pronouns and self.persons and word not in {"them", "they"}:
            return self.persons[-1]
        if word in {"him", "he", "she", "her"}:
            named = self._only_person_told()
            if named:
                return named
            raise UnclearError("Who do you mean?")
        if word in {"it", "that", "this", "them", "they", "those", "these"}:
            if word in {"them", "they"} and not self.things and self.persons:
                return self.persons[-1]
            if self.things:
                return self.things[-1]
            raise UnclearError("What do you mean by that? Please name it.")
        if word == "there":
            if self.places or self.things:
                return (self.places or self.things)[-1]
            raise UnclearError("Where do you mean? Please name the place.")
        return phrase

    def _only_person_told(self) -> Phrase:
        """The one remembered person whose name stands in this message or the one before."""
        said = " ".join(
            [*(turn.content for turn in self.situation.history[-2:]), self.situation.message]
        ).lower()
        names = {
            keys(item.fact.subject): item.fact.subject
            for item in self.facts
            if " ".join(keys(item.fact.subject)) in said and item.fact.subject[0].is_capital
        }
        persons = [subject for subject in names.values() if self.is_person(subject)]
        return persons[0] if len(persons) == 1 else ()

    def place(self, phrase: Phrase, *, hops: int = 0, via: Remembered | None = None) -> Place:
        """Where something is, from the operator's own words (or a remembered fact's, then `via` is given).

        Raises:
            UnclearError: Several things are meant, or nothing is known.
        """
        phrase = self.referent(self._other(phrase))
        remembered_words = via is not None
        found = self.ground(phrase)
        if found.outcome == "match":
            item = found.candidates[0]
            return Place(describe(item, self.objects), item, via)
        whole = self.whole(phrase)
        if whole is not None:
            return Place(describe(whole, self.objects), whole, via)
        if found.outcome == "ambiguous":
            # What a memory leaves open is found out on the way; only the operator's own words are asked.
            if remembered_words:
                return Place(plain(bare(phrase)), None, via)
            item = self.pick(phrase, found.candidates)
            return Place(describe(item, self.objects), item)
        if hops < _MAX_HOPS:
            place = self.remembered_place(phrase, hops)
            if place is not None:
                return place
        if not remembered_words and self.objects:
            told = self.told_place(phrase, found.candidates)
            if told is not None:
                return told
        if remembered_words or not self.objects:
            return Place(plain(bare(phrase)), None, via)
        raise self.unknown(phrase, found.candidates)

    def whole(self, phrase: Phrase) -> MapObject | None:
        """For "the handle of the door", the door: what is no object itself may be a part of one."""
        flat = keys(phrase)
        if "of" not in flat[1:-1] or find_fact(phrase, self.facts)[0] is not None:
            return None
        if ground_phrase(phrase[: flat.index("of", 1)], self.objects).outcome != "none":
            return None
        found = self.ground(phrase[flat.index("of", 1) + 1 :])
        return found.candidates[0] if found.outcome == "match" else None

    def told_place(self, phrase: Phrase, near: Sequence[MapObject] = ()) -> Place | None:
        """Where the operator's answer to an earlier question puts something; it is remembered."""
        for index, hint in enumerate(self.hints):
            meant = choose_object(near, hint, self.objects, self.situation.robot_pose) if near else None
            if meant is not None:
                del self.hints[index]
                return Place(describe(meant, self.objects), meant)
            where = place_said(tokens(hint))
            if where is None:
                continue
            del self.hints[index]
            relation, words = where
            fact = Fact(
                phrase, words, relation, sentence=f"{the(plain(phrase))} is {relation} {the(plain(words))}"
            )
            fact = replace(fact, sentence=fact.sentence[0].upper() + fact.sentence[1:])
            self.learned.append(fact)
            known = Remembered(fact, MemoryEntry(name=memory_name(fact, self.facts), data=fact.sentence))
            return self.place(words, hops=1, via=known)
        return None

    def remembered_place(self, phrase: Phrase, hops: int = 0) -> Place | None:
        """Where something is remembered to be.

        Raises:
            UnclearError: Different things of that name are remembered.
        """
        fact, several = find_fact(phrase, self.facts)
        if several:
            labels = [
                f"{the(plain(f.fact.subject))} {f.fact.relation} {the(plain(f.fact.place))}" for f in several
            ]
            stand_ins = [
                MapObject(id="?" * (i + 1), description=label, x_m=0.0, y_m=0.0)
                for i, label in enumerate(labels)
            ]
            chosen = self._hinted(stand_ins)
            if chosen is None:
                raise UnclearError(f"Do you mean {listing(labels, 'or')}?", labels)
            fact = several[stand_ins.index(chosen)]
        if fact is None:
            return None
        self.use(fact)
        return replace(self.place(fact.fact.place, hops=hops + 1, via=fact), via=fact)

    def _other(self, phrase: Phrase) -> Phrase:
        """The one of two like things that was not mentioned last, for "the other (one)"."""
        words = tuple(w for w in bare(phrase) if w.key not in {"one", "ones"})
        if not words or words[0].key != "other":
            return phrase
        for thing in reversed(self.things):
            last = ground_phrase(thing, self.objects, self.situation.robot_pose)
            if last.outcome != "match":
                continue
            head = words[1:] or tokens(last.candidates[0].class_name) or thing[-1:]
            rest = [i for i in ground_phrase(head, self.objects).candidates if i not in last.candidates]
            if len(rest) == 1:
                return tokens(describe(rest[0], self.objects))
            return head
        return words[1:] or phrase

    def pick(self, phrase: Phrase, candidates: Sequence[MapObject]) -> MapObject:
        """One of several equals: by quantifier or an earlier answer; otherwise it is asked.

        Raises:
            UnclearError: With the choices.
        """
        noun = noun_phrase(phrase)
        hinted = self._hinted(candidates)
        if hinted is not None:
            return hinted
        if noun.quantifier in lexicon().free_choice:
            pose = self.situation.robot_pose
            return (
                min(candidates, key=lambda i: (i.x_m - pose.x_m) ** 2 + (i.y_m - pose.y_m) ** 2)
                if pose
                else candidates[0]
            )
        choices = [describe(item, self.objects) for item in candidates]
        raise UnclearError(
            f"I know {len(choices)} of those: {listing([the(c) for c in choices])}. Which one do you mean?",
            choices,
        )

    def _hinted(self, candidates: Sequence[MapObject]) -> MapObject | None:
        for index, hint in enumerate(self.hints):
            chosen = choose_object(candidates, hint, self.objects, self.situation.robot_pose)
            if chosen is not None:
                del self.hints[index]
                return chosen
        return None

    def unknown(self, phrase: Phrase, near: Sequence[MapObject] = ()) -> UnclearError:
        """The question about something that is neither on the map nor remembered."""
        name = the(plain(bare(phrase)))
        if near:
            known = listing([the(describe(item, self.objects)) for item in near], "or")
            return UnclearError(
                f"I do not know where {name} is. Do you mean {known}?",
                [describe(i, self.objects) for i in near],
            )
        return UnclearError(f"I do not know where {name} is. Tell me where it is, and I will remember it.")

    def several(self, phrase: Phrase) -> list[Phrase]:
        """The things a phrase names one by one: "A and B", "all chairs", "both", "every X except Y"."""
        told = self.told_apart(phrase)
        if told is not None:
            return [tokens(describe(told, self.objects))]
        phrase = self._uncounted(phrase)
        everything = next((h for h in self.hints if keys(bare(tokens(h.lower()))) in _ALL_OF_THEM), None)
        if everything is not None:
            found = self.ground(phrase)
            if found.outcome == "ambiguous":
                self.hints.remove(everything)
                return [tokens(describe(item, self.objects)) for item in found.candidates]
        members: list[Phrase] = []
        whole = ground_phrase(phrase, self.objects, self.situation.robot_pose)
        if whole.outcome == "match" and not noun_phrase(phrase).quantifier:
            return [phrase]
        if "or" in keys(phrase):
            return [self._either(phrase)]
        parts = [phrase] if "between" in keys(phrase) else coordinated(phrase)
        quantified = next((word for word in phrase[:1] if word.key in lexicon().quantifiers), None)
        for index, part in enumerate(parts or [phrase]):
            if index == 0 and quantified and part[:1] != (quantified,):
                part = (quantified, *part)
            members.extend(self._expanded(part))
        return members

    def _uncounted(self, phrase: Phrase) -> Phrase:
        """For "the two doors" "the doors", if there are as many."""
        noun = noun_phrase(phrase)
        words = bare(phrase)
        while words and words[0].key in lexicon().quantifiers:
            words = bare(words[1:])
        first = noun.core[0] if noun.core else ""
        if not (first.isdigit() and len(words) > 1 and self._is_plural(noun) and words[0].key != first + "."):
            return phrase
        counted = ground_phrase(words[1:], self.objects, self.situation.robot_pose)
        return words[1:] if len(counted.candidates) == int(first) else phrase

    def _either(self, phrase: Phrase) -> Phrase:
        """One of "A or B", as an earlier answer says.

        Raises:
            UnclearError: Nobody said which.
        """
        options: list[Phrase] = []
        for part in coordinated(tuple(word for word in phrase if word.key != "either")):
            found = lexicon().goals.match(keys(part))
            options.append(bare(part[found[0] :]) if found and found[0] < len(part) else part)
        names = [plain(option) for option in options]
        stand_ins = [MapObject("?" * (i + 1), name, 0.0, 0.0) for i, name in enumerate(names)]
        chosen = self._hinted(stand_ins)
        if chosen is not None:
            return options[stand_ins.index(chosen)]
        raise UnclearError(f"Which one do you mean: {listing([the(name) for name in names], 'or')}?", names)

    def _expanded(self, phrase: Phrase) -> list[Phrase]:
        noun = noun_phrase(phrase)
        plural = self._is_plural(noun)
        if not plural and noun.quantifier not in lexicon().quantifiers | {"rest"}:
            return [phrase]
        if noun.quantifier == "rest" and not noun.core:
            like = {item.class_name for item in self._mentioned()}
            others = [i for i in self.objects if i.class_name in like and i not in self._mentioned()]
            return [tokens(describe(item, self.objects)) for item in others]
        if not noun.core and self.things:
            phrase = self.things[-1]
            noun = noun_phrase(phrase)
        found = ground_phrase(noun.phrase or phrase, self.objects, self.situation.robot_pose)
        if found.outcome == "none":
            return [phrase]
        left_out = ground_phrase(noun.excluded, self.objects).candidates if noun.excluded else ()
        if noun.quantifier == "rest":
            left_out = self._mentioned()
        if noun.excluded and not left_out:
            raise self.unknown(noun.excluded)
        return [
            tokens(item.id) if describe(item, self.objects) == item.id else tokens(item.description)
            for item in found.candidates
            if item not in left_out
        ]

    def _mentioned(self) -> tuple[MapObject, ...]:
        """The objects spoken of so far, for "the rest".

        Raises:
            UnclearError: None were.
        """
        spoken = [
            ground_phrase(t, self.objects, self.situation.robot_pose) for t in (*self.things, *self.places)
        ]
        found = tuple(
            item for grounding in spoken for item in grounding.candidates if grounding.outcome == "match"
        )
        if not found:
            raise UnclearError("The rest of what? Please name it.")
        return found

    def _is_plural(self, noun: NounPhrase) -> bool:
        if not noun.phrase:
            return False
        last = next((w for w in reversed(noun.phrase[: len(noun.core)]) if w.is_word), noun.phrase[-1])
        return singular(last.key) != last.key and len(last.key) > 3


def place_said(answer: Phrase) -> tuple[str, Phrase] | None:
    """Relation and place of an answer to "where": "in the box", "it is on the desk", "the desk"."""
    fact = read_statement(answer)
    if fact is not None and fact.is_location:
        return fact.relation, fact.place
    words = bare(answer)
    found = lexicon().places.match(keys(words))
    if found is not None and found[0] < len(words):
        return found[1], bare(words[found[0] :])
    return ("at", words) if 0 < len(words) <= 5 and keys(words)[0] not in _NO_PLACES else None


_NO_PLACES = frozenset(
    {
        "yes",
        "no",
        "i",
        "ok",
        "okay",
        "maybe",
        "you",
        "what",
        "where",
        "why",
        "never",
        "forget",
        "nothing",
        "nowhere",
    }
)
