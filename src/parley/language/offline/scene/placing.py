"""Where things are: on the map, by what is remembered, by what the operator answered."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace

from parley.language.offline.facts.facts import Fact, read_statement
from parley.language.offline.facts.owning import holder_of
from parley.language.offline.facts.redirecting import Redirect, is_habit, redirects
from parley.language.offline.facts.remembering import Remembered, find_fact, memory_name
from parley.language.offline.scene.choosing import choose_object
from parley.language.offline.scene.grounding import describe, ground_phrase
from parley.language.offline.scene.known import Place, UnclearError
from parley.language.offline.scene.links import worked_with
from parley.language.offline.scene.referring import Referring
from parley.language.offline.words.lexicon import lexicon
from parley.language.offline.words.nouns import bare, noun_phrase
from parley.language.offline.words.saying import listing, the
from parley.language.offline.words.text import Phrase, keys, plain, tokens
from parley.language.word_lists import load_data
from parley.messages.memory import MemoryEntry
from parley.world.object_map import MapObject

__all__ = ["PARTS", "Placing"]

_MAX_HOPS = 3
_HOME = frozenset(
    {("home",), ("base",), ("home", "base"), ("your", "place"), ("own", "place"), ("home", "position")}
)
_DOCK = tokens("charging dock")


@dataclass
class Placing(Referring):
    """How a phrase becomes a place."""

    _closings: dict[int, list[tuple[int, Redirect, MemoryEntry]]] = field(default_factory=dict)
    """What is said of places that cannot be used, by the number of facts that were known."""

    def place(self, phrase: Phrase, *, hops: int = 0, via: Remembered | None = None) -> Place:
        """Where something is, from the operator's own words (or a remembered fact's, then `via` is given).

        Raises:
            UnclearError: Several things are meant, or nothing is known.
        """
        place = self._place(phrase, hops=hops, via=via)
        place = self._told_of(place) if via is None else self._redirected(place, via, hops)
        source = "words as they are" if place.item is None else f"{place.item.id} on the map"
        told = f", from the memory {place.via.entry.name}" if place.via is not None else ""
        self.trace.note("argument", f"“{plain(phrase)}” is “{place.value}” ({source}{told})")
        return place

    def _place(self, phrase: Phrase, *, hops: int = 0, via: Remembered | None = None) -> Place:
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
                chosen = self._hinted(found.candidates) if self.hints else None
                name = describe(chosen, self.objects) if chosen is not None else plain(bare(phrase))
                return Place(name, chosen, via)
            item = self.pick(phrase, found.candidates)
            return Place(describe(item, self.objects), item)
        beside = self.beside(phrase)
        if beside is not None:
            # Where somebody is said to be now counts, whatever is remembered.
            return Place(describe(beside, self.objects), beside, via)
        if hops < _MAX_HOPS:
            place = self.remembered_place(phrase, hops)
            if place is not None:
                return place
        other = self._home(phrase) or self._without_tail(phrase)
        if other is not None:
            return Place(describe(other, self.objects), other, via)
        if not remembered_words and self.objects:
            told = self.told_place(phrase, found.candidates)
            if told is not None:
                return told
        if remembered_words or not self.objects:
            return Place(plain(bare(phrase)), None, via)
        raise self.unknown(phrase, found.candidates)

    def _redirected(self, place: Place, via: Remembered, hops: int) -> Place:
        """What a fact leads to, or what is remembered to be used in its place since then."""
        age = self._age(via.entry)
        for told, redirect, item in self._said_of_closing(place):
            if redirect.reopened or (told < age and (redirect.moved or not is_habit(via.fact.sentence))):
                break
            self.use(item)
            if redirect.other and hops < _MAX_HOPS:
                return replace(self.place(redirect.other, hops=hops + 1, via=item), via=via)
        return place

    def _told_of(self, place: Place) -> Place:
        """A place that was named; that it is remembered to be closed is said besides."""
        said = next(iter(self._said_of_closing(place)), None)
        if said is not None and place.via is None and not said[1].reopened and not said[1].moved:
            self.use(said[2])
        return place

    def closing_of(self, fact: Remembered) -> Remembered | None:
        """What is remembered to be used in the place that a fact names, for an answer."""
        if not fact.fact.place:
            return None
        place = Place(plain(fact.fact.place), next(iter(self.ground(fact.fact.place).candidates), None))
        age = self._age(fact.entry)
        said = next(iter(self._said_of_closing(place)), None)
        if said is None or said[1].reopened or not said[1].other:
            return None
        return said[2] if said[0] > age or is_habit(fact.fact.sentence) else None

    def _age(self, entry: MemoryEntry) -> int:
        memory = self.situation.memory
        return next((i for i in range(len(memory)) if memory[i].name == entry.name), len(memory))

    def _said_of_closing(self, place: Place) -> Iterator[tuple[int, Redirect, Remembered]]:
        """What is remembered of whether a place can be used, the latest first, each with its age."""
        count = len(self.facts)
        if count not in self._closings:
            memory = self.situation.memory
            known = {entry.name for entry in memory}
            fresh = [item.entry for item in reversed(self.facts) if item.entry.name not in known]
            self._closings[count] = list(redirects((*memory, *fresh)))
        for age, redirect, entry in self._closings[count]:
            about = self.ground(redirect.place)
            same = about.outcome == "match" and about.candidates[0] == place.item
            if same or keys(redirect.place) == keys(bare(tokens(place.value))):
                yield age, redirect, Remembered(Fact(redirect.place, sentence=entry.data.rstrip(" .")), entry)

    def beside(self, phrase: Phrase) -> MapObject | None:
        """For "(next to) the man at the desk": the desk; for "the floor in the hall" the hall."""
        noun = noun_phrase(phrase)
        if not noun.core and len(noun.anchors) == 1:
            noun = noun_phrase(noun.anchors[0])
        part = bool(noun.core) and noun.core[-1] in PARTS and noun.relation in {"in", "at", "inside", "near"}
        somebody = part or (noun.core[-1:] != () and noun.core[-1] in lexicon().person_words)
        if len(noun.anchors) != 1 or not (somebody or self.is_person(noun.phrase[: len(noun.core)])):
            return None
        found = self.ground(noun.anchors[0])
        return found.candidates[0] if found.outcome == "match" else None

    def _home(self, phrase: Phrase) -> MapObject | None:
        """For "home", where that is no place of the map: where the robot charges, if that is one place."""
        if keys(bare(phrase)) not in _HOME:
            return None
        docks = [
            item for item in self.objects if ground_phrase(_DOCK, [item], strict=True).outcome == "match"
        ]
        return docks[0] if len(docks) == 1 else None

    def whole(self, phrase: Phrase) -> MapObject | None:
        """For "the handle of the door", the door: what is no object itself may be a part of one."""
        flat = keys(phrase)
        owner = next((i for i, word in enumerate(flat[:-1]) if word.endswith("'s")), -1)
        if owner >= 0 and find_fact(phrase, self.facts)[0] is None:
            # "The door's handle", "room 2's window".
            last = phrase[owner]
            stem = replace(last, key=last.key.removesuffix("'s"), raw=last.raw.removesuffix("'s"))
            found = self.ground((*phrase[:owner], stem))
            return found.candidates[0] if found.outcome == "match" else None
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
            return self._place_of_holder(phrase, hops)
        self.use(fact)
        return replace(self.place(fact.fact.place, hops=hops + 1, via=fact), via=fact)

    def _place_of_holder(self, phrase: Phrase, hops: int) -> Place | None:
        """Where whoever has it is ("A has the key"), or what somebody is remembered to work with."""
        worked = worked_with(phrase, self.objects, self.facts)
        if worked is not None:
            self.use(worked[1])
            return Place(describe(worked[0], self.objects), worked[0], worked[1])
        held = holder_of(phrase, self.facts) if hops < _MAX_HOPS else None
        place = self.remembered_place(held.owner, hops + 1) if held is not None else None
        if place is None or held is None:
            return None
        # What is at that place is the thing, though the fact is about whoever has it.
        via = replace(held.source, fact=replace(held.source.fact, subject=held.thing))
        self.use(via)
        return replace(place, via=via)

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
        named = self._named_before(candidates)
        if len(named) == 1:
            return named[0]
        choices = [describe(item, self.objects) for item in candidates]
        raise UnclearError(
            f"I know {len(choices)} of those: {listing([the(c) for c in choices])}. Which one do you mean?",
            choices,
        )

    def _named_before(self, candidates: Sequence[MapObject]) -> list[MapObject]:
        """Those that the same message has named already: "open the left door, ..., then shut the door"."""
        said = (ground_phrase(thing, self.objects) for thing in self.things[self.heard :])
        ids = {one.candidates[0].id for one in said if one.outcome == "match"}
        return [item for item in candidates if item.id in ids]

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
                about=phrase,
            )
        text = f"I do not know where {name} is. Tell me where it is, and I will remember it."
        return UnclearError(text, about=phrase)

    def _without_tail(self, phrase: Phrase) -> MapObject | None:
        """For "the hall waiting for the bus", "the door for the parcel": the thing that comes first."""
        flat = keys(phrase)
        for end in range(len(flat) - 1, 0, -1):
            if flat[end] not in _TAILS and not (flat[end].endswith("ing") and len(flat[end]) > 5):
                continue
            found = self.ground(phrase[:end])
            if found.outcome == "match":
                return found.candidates[0]
        return None


PARTS = frozenset(load_data("names")["parts"])
"""What things have parts of: their door, their lid."""
_TAILS = frozenset({",", "for", "and", "because", "until", "till", "so", "who", "as", "with", "while"})


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
