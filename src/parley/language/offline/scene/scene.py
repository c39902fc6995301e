"""What a message is understood against: the map, what is remembered, what was mentioned, earlier answers."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from parley.language.base import Situation
from parley.language.offline.facts.remembering import remembered
from parley.language.offline.scene.grounding import describe, ground_phrase
from parley.language.offline.scene.known import OPERATOR, Place, UnclearError
from parley.language.offline.scene.marks import members_of
from parley.language.offline.scene.placing import PARTS, Placing, place_said
from parley.language.offline.scene.states import all_in_state
from parley.language.offline.tasks.catalogue import Catalogue
from parley.language.offline.words.explaining import Trace
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.nouns import NounPhrase, bare, coordinated, noun_phrase, split_exception
from parley.language.offline.words.saying import listing, the
from parley.language.offline.words.text import Phrase, Word, keys, plain, singular, tokens
from parley.world.object_map import MapObject

__all__ = ["OPERATOR", "Place", "Scene", "UnclearError", "place_said"]

_ALL_OF_THEM = frozenset(
    tuple(text.split())
    for text in (
        "both",
        "all",
        "both of them",
        "them both",
        "them all",
        "all of these",
        "both of these",
        "each of those",
        "every one of them",
        "all of them",
        "all three",
        "all of those",
        "both of those",
        "every one",
        "each",
        "each of them",
    )
)

_HAS_ITS_OWN = frozenset((word,) for word in ("in", "at", "of", "inside"))
_ARTICLES = frozenset({"the", "a", "an", "this", "that"})
_LONGEST_PLACE = 5
_REACH_M = 1.5
"""How near to a place something stands that is said to be at it, metres."""


@dataclass
class Scene(Placing):
    """A whole situation; here the things that one phrase names together."""

    @classmethod
    def of(cls, situation: Situation, hints: Sequence[str] = (), trace: Trace | None = None) -> Scene:
        """The scene of a situation."""
        known = Catalogue.of(situation.catalogue), remembered(situation.memory)
        return cls(situation, *known, list(hints), trace=Trace() if trace is None else trace)

    def several(self, phrase: Phrase) -> list[Phrase]:
        """The things a phrase names one by one: "A and B", "all chairs", "both", "every X except Y"."""
        together = members_of(phrase, self.objects) if len(bare(phrase)) == 1 else []
        if together:
            return [tokens(describe(item, self.objects)) for item in together]
        told = self.told_apart(phrase)
        if told is not None:
            return [tokens(describe(told, self.objects))]
        so = self._by_state(phrase)
        if so:
            return so
        phrase = self._uncounted(phrase)
        phrase = _apposed(phrase)
        series = self._series(phrase) or self._all_as_answered(phrase)
        if series:
            return series
        members: list[Phrase] = []
        whole = ground_phrase(phrase, self.objects, self.situation.robot_pose)
        if whole.outcome == "match" and not noun_phrase(phrase).quantifier:
            return [phrase]
        if "or" in keys(phrase):
            return [self._either(phrase)]
        named, exception = split_exception(phrase)
        listed = coordinated(named)
        # "All boxes except the red one and the blue one"; in "A and B but not C" nothing is left out.
        whole_list = "between" in keys(phrase) or (exception and len(listed) == 1)
        parts = [phrase] if whole_list else listed if exception else coordinated(phrase)
        if whole.outcome == "none":
            parts = [p for part in parts for p in (self._side_by_side(part) or [part])]
        quantified = next((word for word in phrase[:1] if word.key in lexicon().quantifiers), None)
        for index, part in enumerate(parts or [phrase]):
            before = parts[index - 1] if index else ()
            if len(part) == 1 and len(before) > 1 and _is_label(part[0]) and _is_label(before[-1]):
                # "Boxes 2 and 3".
                part = parts[index] = (*before[:-1], *part)
            if index == 0 and quantified and part[:1] != (quantified,):
                part = (quantified, *part)
            members.extend(self._expanded(part))
        gone = self._excepted(noun_phrase(phrase).excluded, ()) if exception and not whole_list else ()
        return [m for m in members if not gone or ground_phrase(m, self.objects).candidates != gone[:1]]

    def _by_state(self, phrase: Phrase) -> list[Phrase]:
        """For "every door that is not locked": those that are remembered not to be."""
        so = all_in_state(phrase, self.objects, self.facts) if noun_phrase(phrase).quantifier else None
        for fact in so[1] if so is not None else ():
            self.use(fact)
        return [tokens(describe(item, self.objects)) for item in so[0]] if so is not None else []

    def _all_as_answered(self, phrase: Phrase) -> list[Phrase]:
        """All that are meant, where the operator answered "both" or "all of them"."""
        everything = next((h for h in self.hints if keys(bare(tokens(h.lower()))) in _ALL_OF_THEM), None)
        found = self.ground(phrase) if everything is not None else None
        if everything is None or found is None or found.outcome != "ambiguous":
            return []
        self.hints.remove(everything)
        return [tokens(describe(item, self.objects)) for item in found.candidates]

    def far_from(self, core: tuple[str, ...], anchor: Phrase) -> bool:
        """Whether all things on the map that are called so are far from a place."""
        there = ground_phrase(anchor, self.objects, strict=True)
        words = tuple(Word(part, part) for part in core)
        if there.outcome != "match" or not words:
            return False
        place = there.candidates[0]
        if not set(keys(anchor)) & set(place.description.lower().split()):
            # "In the north-east".
            return False
        reach_m = _REACH_M + math.hypot(place.width_m, place.height_m) / 2
        try:
            called = self.several(words)
        except UnclearError:
            # "The rest" of nothing that was spoken of.
            return False
        return bool(called) and all(
            math.hypot(item.x_m - place.x_m, item.y_m - place.y_m) > reach_m
            for one in called
            for item in self.ground(one).candidates
        )

    def has_its_own(self, words: Phrase, at: int, end: int) -> bool:
        """Whether what is named by one word is said to be at a place far from all that are called so.

        "The door of the shed" is no door of the map where that one is far from the shed.

        Args:
            words: All words and punctuation.
            at: Where the word stands.
            end: Where what it names ends.
        """
        if end - at != 1 or words[at].key in lexicon().determiners:
            return False
        sizes = range(_LONGEST_PLACE, 0, -1)
        start = end + 1
        while start < len(words) and words[start].key in _ARTICLES:
            start += 1
        behind = keys(words[end : end + 1]) in _HAS_ITS_OWN
        found = [words[start : start + size] for size in sizes] if behind else []
        found += [words[at - size : at] for size in sizes if size <= at]
        named = (p for p in found if p and all(w.is_word and w.key not in _ARTICLES for w in p))
        place = next((p for p in named if ground_phrase(p, self.objects, strict=True).outcome == "match"), ())
        return bool(place) and self.far_from(keys(words[at:end]), place)

    def is_part(self, word: Word) -> bool:
        """Whether a word may mean a part of anything, and the map knows it for a kind at most.

        "The cabin. Is the door shut?" asks for the cabin's, where an entrance is of the kind "door".
        """
        part = singular(word.key)
        if part not in PARTS:
            return False
        found = ground_phrase((word,), self.objects, strict=True).candidates
        called = {singular(one.key) for item in found for one in tokens(item.description)}
        return part not in called

    @staticmethod
    def with_part(words: Phrase, size: int) -> int:
        """How many of the first words name a thing and its part, where `size` name the thing.

        "Is the cabin door shut?": not the cabin is, but its door, whatever doors the map knows.
        """
        return size + (size + 1 < len(words) and singular(words[size].key) in PARTS)

    def _side_by_side(self, phrase: Phrase) -> list[Phrase]:
        """For "the desk the door the box": things named one after the other without any mark."""
        words = bare(phrase)
        if len(words) < 2 or ground_phrase(phrase, self.objects).outcome == "match":
            return []
        parts: list[Phrase] = []
        at = 0
        while at < len(words) and len(words) < 16:
            sizes = range(min(4, len(words) - at), 0, -1)
            named = (bare(words[at : at + size]) for size in sizes)
            sized = zip(sizes, named, strict=True)
            found = next(((n, p) for n, p in sized if p and self._is_called(p)), None)
            if found is None:
                return []
            parts.append(found[1])
            at += found[0]
        return parts if len(parts) > 1 else []

    def _is_called(self, phrase: Phrase) -> bool:
        first = keys(phrase)[0] not in lexicon().small or len(phrase) > 1
        return first and ground_phrase(phrase, self.objects, strict=True).outcome == "match"

    def _series(self, phrase: Phrase) -> list[Phrase]:
        """For "boxes 2 to 4": each of them, as far as they are on the map."""
        words = bare(phrase)
        flat = keys(words)
        if len(flat) < 4 or flat[-2] not in {"to", "through", "till", "until"}:
            return []
        if not (
            flat[-1].isdigit() and flat[-3].isdigit() and int(flat[-3]) < int(flat[-1]) <= int(flat[-3]) + 50
        ):
            return []
        numbers = (Word(str(n), str(n)) for n in range(int(flat[-3]), int(flat[-1]) + 1))
        members = [(*words[:-3], number) for number in numbers]
        return [member for member in members if ground_phrase(member, self.objects).outcome == "match"]

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
        together = members_of(phrase, self.objects) if len(phrase) == 1 else []
        if together:
            return [tokens(describe(item, self.objects)) for item in together]
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
        pointless = not noun.quantifier and set(noun.core) <= {"one", "ones"}
        if pointless and len(found.candidates) == len(self.objects) > 3:
            raise UnclearError("Which ones do you mean? Please name them.")
        excluded = noun.excluded
        if keys(excluded[:1]) == ("one",) and noun_phrase(excluded).anchors:
            # "All lamps except the one in the hall": the lamp in the hall.
            excluded = (*noun.phrase[: len(noun.core)], *excluded[1:])
        left_out = self._excepted(excluded, found.candidates)
        if noun.quantifier == "rest":
            left_out = self._mentioned()
        if noun.excluded and not left_out:
            raise self.unknown(noun.excluded)
        return [
            tokens(item.id) if describe(item, self.objects) == item.id else tokens(item.description)
            for item in found.candidates
            if item not in left_out
        ]

    def _excepted(self, excluded: Phrase, found: Sequence[MapObject]) -> tuple[MapObject, ...]:
        """What is left out: "the red one", "boxes 2 and 3", "the first"."""
        flat = tuple(word for word in keys(bare(excluded)) if word != "one")
        if len(flat) == 1 and found and (flat[0] == "last" or flat[0] in lexicon().ordinals):
            index = -1 if flat[0] == "last" else lexicon().ordinals[flat[0]] - 1
            return (found[index],) if index < len(found) else ()
        parts: list[Phrase] = []
        for part in coordinated(excluded):
            before = parts[-1] if parts else ()
            alike = len(part) == 1 and len(before) > 1 and _is_label(part[0]) and _is_label(before[-1])
            parts.append((*before[:-1], *part) if alike else part)
        return tuple(item for part in parts for item in ground_phrase(part, self.objects).candidates)

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


def _apposed(phrase: Phrase) -> Phrase:
    """For "the red box, the one by the door": the red box by the door."""
    flat = keys(phrase)
    at = next((i for i in range(1, len(flat) - 3) if flat[i : i + 3] == (",", "the", "one")), 0)
    noun = noun_phrase(phrase[:at]) if at else None
    if noun is None or noun.anchors or noun.quantifier or len(coordinated(phrase[:at])) > 1:
        return phrase
    return (*phrase[:at], *phrase[at + 3 :])


def _is_label(word: Word) -> bool:
    return word.key.isdigit() or len(word.key) == 1
