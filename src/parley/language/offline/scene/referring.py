"""What pronouns and "the other one" stand for."""

from __future__ import annotations

from dataclasses import dataclass

from parley.language.offline.scene.grounding import describe, ground_phrase
from parley.language.offline.scene.known import OPERATOR, Known, UnclearError
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.nouns import bare, noun_phrase
from parley.language.offline.words.text import Phrase, Word, keys, tokens
from parley.language.word_lists import load_data

__all__ = ["Referring"]

_PORTIONS = frozenset(
    (word,)
    for word in (
        "glass",
        "cup",
        "mug",
        "sip",
        "drop",
        "slice",
        "piece",
        "portion",
        "bite",
        "bowl",
        "plate",
    )
)
_TITLES = frozenset(load_data("units")["titles"])
_SOME = frozenset({("some",), ("one",), ("a", "few"), ("some", "more"), ("another", "one"), ("one", "more")})


@dataclass
class Referring(Known):
    """How words point at what was mentioned."""

    def referent(self, phrase: Phrase) -> Phrase:
        """What a pronoun stands for; other phrases come back unchanged.

        Raises:
            UnclearError: Nothing was mentioned that it could stand for.
        """
        lex = lexicon()
        flat = keys(bare(phrase))
        said = keys(phrase)
        some = (said in _SOME or said[-2:] == ("of", "them")) and len(said) < 5
        if (some and self.things) or (flat[:1] in _PORTIONS and len(flat) == 1 and self._is_edible()):
            return self.things[-1]
        if len(flat) != 1:
            return self._where_somebody_is(phrase)
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
            raise UnclearError(f"What do you mean by “{word}”? Please name it.")
        if word == "there":
            if self.places or self.things:
                return (self.places or self.things)[-1]
            raise UnclearError("Where do you mean? Please name the place.")
        return phrase

    def _where_somebody_is(self, phrase: Phrase) -> Phrase:
        """For "where he is" whoever is meant; other phrases come back unchanged."""
        who = next((word for word in phrase if word.key in {"he", "she", "it", "they"}), None)
        asks = keys(bare(phrase))[:1] in {("where",), ("wherever",)} and len(phrase) < 5
        return self.referent((who,)) if asks and who is not None else phrase

    def _is_edible(self) -> bool:
        """Whether what was spoken of last can be had by the glass or the slice."""
        last = noun_phrase(self.things[-1]).core[-1:] if self.things else ()
        kinds = lexicon().kinds
        return bool(last) and (last[0] in kinds.get("drink", ()) or last[0] in kinds.get("food", ()))

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
        return persons[0] if len(persons) == 1 else self._only_person_said()

    def _only_person_said(self) -> Phrase:
        """The one person that this message speaks of, by name or by what they are ("the driver")."""
        words = tokens(self.situation.message)
        robots = {key for name in self.situation.robots for key in keys(tokens(name))}
        found: dict[tuple[str, ...], Phrase] = {}
        for index in range(len(words) - 1):
            person = words[index : index + 2]
            if person[1].key in robots or not person[1].is_word:
                continue
            titled = person[0].key in _TITLES and person[1].key not in lexicon().vocabulary
            called = person[0].key in lexicon().determiners and self.is_person(person[1:])
            if titled or called:
                found[keys(bare(person))] = person
        return next(iter(found.values())) if len(found) == 1 else ()

    def _other(self, phrase: Phrase) -> Phrase:
        """The one of two like things that was not mentioned last, for "the other (one)"."""
        following = self._following(phrase)
        if following:
            return following
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

    def _following(self, phrase: Phrase) -> Phrase:
        """For "the next one" after "room 1": room 2, if there is one."""
        flat = keys(bare(phrase))
        if flat[:1] not in {("next",), ("following",), ("previous",)} or len(flat) > 2:
            return ()
        for thing in reversed(self.things):
            last = ground_phrase(thing, self.objects, self.situation.robot_pose)
            words = tokens(last.candidates[0].description) if last.outcome == "match" else ()
            if not words or not words[-1].key.isdigit() or flat[1:] not in {(), ("one",), (words[0].key,)}:
                continue
            label = str(int(words[-1].key) + (-1 if flat[0] == "previous" else 1))
            wanted = (*words[:-1], Word(label, label))
            if ground_phrase(wanted, self.objects).outcome == "match":
                return wanted
        return ()
