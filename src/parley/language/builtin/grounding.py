"""Roles grounded by their types: things and sets of the map, persons, amounts, directions, texts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

from parley.language.base import Situation
from parley.language.builtin.amounts import Amount, amount_of, direction_of
from parley.language.builtin.decision import Ask, Deed, Note
from parley.language.builtin.facts import Place, known_place, told_set
from parley.language.builtin.in_rooms import group_of_rooms, things_inside
from parley.language.builtin.lexicon import Lexicon, is_somebody, stem, stems
from parley.language.builtin.saying import as_said, which_one, with_article
from parley.language.builtin.sets import Group, apart, group, without
from parley.language.builtin.skills import Skills
from parley.language.builtin.spans import Filler
from parley.language.builtin.spatial import beside, picked
from parley.language.builtin.things import Mention, head_of, kind_of, link, main_word, noun_phrase, whole_of
from parley.language.builtin.tokens import Token, point_of, tokenize
from parley.language.builtin.wishes import Wish
from parley.language.dialogue.map_words import distance_m, in_room, named, same_kind
from parley.language.dialogue.speaker import name_of
from parley.language.lexicon import word_set
from parley.world.object_map import MapObject

__all__ = ["WITHIN", "Grounder", "Value"]

_ELSEWHERE = word_set("at by near beside behind outside")
_MOVABLE = word_set("TAKE BRING GIVE PUT FIND COUNT POUR CUT MIX COOK DO MAKE")


@dataclass(frozen=True, slots=True)
class Value:
    """What a role holds: the argument, how the reply says it, and which things of the map it may be."""

    argument: str
    said: str
    things: tuple[MapObject, ...] = ()
    place: Place | None = None
    """Where it is remembered to be."""
    amount: Amount | None = None
    point: tuple[float, float] | None = None
    """Where it is on the map, in metres, if it was told by its numbers."""
    each: tuple[Value, ...] = ()
    """One for each of several, if it is a set."""


_IN_ROOMS = frozenset({"GO", "BRING", "LOOK", "FIND"})
"""What is done in a room as a whole."""


@dataclass(slots=True)
class Grounder:
    """Says what the roles of one message hold; knows what was spoken of before."""

    situation: Situation
    skills: Skills
    lexicon: Lexicon
    known: Sequence[Place]
    last_thing: Value | None = None
    last_person: Value | None = None
    notes: list[Note] = field(default_factory=list)
    last_check: Deed | None = None
    """What was to be looked at last."""
    at: str = ""
    """Where the robot is after the deeds so far; empty: nobody knows."""
    left_out: tuple[str, ...] = ()
    """Words that name the exception from the next set."""
    bound: Value | None = None
    """Which one of a set is meant just now, by "it" and "there" and by the set itself."""
    whole: Value | None = None
    """The set that was spoken of last."""
    before: MapObject | None = None
    """What was spoken of last before this message."""
    doubts: tuple[Ask, str] | None = None
    """What is not certain, and the words that were not understood: the deeds are only offered then."""
    mentioned: list[MapObject] = field(default_factory=list)
    """Things that were named so far, whatever is done with them."""
    tells: bool = False
    """Whether the message tells facts, too: they may say where things are."""
    behind: Wish | None = None
    """What is wanted next in the same breath."""
    refused: list[tuple[str, str]] = field(default_factory=list)
    """Frame and thing of what is not to be done."""

    def value(self, wish: Wish, filler: Filler) -> Value | Ask | None:
        """What a role of a wish holds, by the type that the frame gives it."""
        kind = self.lexicon.frames[wish.frame].roles.get(filler.role, "text")
        if kind == "direction" or (kind == "thing" and filler.role == "H"):
            direction = direction_of(filler.words, self.lexicon)
            if direction is None:
                return Ask(f"Which direction is “{filler.text}”?")
            return Value(direction, direction)
        if kind in ("distance", "angle", "duration"):
            amount = _BITS.get(kind) if {*filler.words} <= _A_BIT else amount_of(filler.words)
            if amount is None or amount.kind not in (kind, "number"):
                return Ask(f"How much is “{filler.text}”? Please say a number and its unit.")
            if amount.kind == "number" and kind == "distance":
                return Ask(f"{amount} of what: metres, feet?")
            text = str(amount) if amount.unit else f"{amount} degrees"
            return Value(text, text, amount=amount)
        if kind == "text":
            return Value(filler.text, filler.text)
        plain, filler = filler, self._one_like_it(wish, filler)
        mention = link(filler.words, filler.head, self.situation.objects, self.lexicon)
        lost = mention.kind == "none" and filler.words[filler.head] in ("one", "ones")
        if lost or (filler is not plain and mention.things == (self._it(),)):  # "the one" is another one
            return self._unknown(filler.text, wish.frame, sought=True)
        if kind == "person":
            return self._person(filler, mention)
        thing = wish.one("T") if wish.frame in ("LOOK", "FIND") and filler.role in "GL" else None
        known = (
            thing is not None and link(thing.words, thing.head, self.situation.objects, self.lexicon).things
        )
        placed = wish.has("SL") if wish.frame != "LOOK" else any(f.words[0] in WITHIN for f in wish.all("L"))
        return self._thing("" if known else wish.frame, filler, mention, placed=placed)

    def _it(self) -> MapObject | None:
        """The thing that was spoken of last."""
        last = self.last_thing.things if self.last_thing is not None else ()
        return last[0] if len(last) == 1 else self.before

    def _one_like_it(self, wish: Wish, filler: Filler) -> Filler:
        """For "the one in the yard", "the one next to it": one of the kind that was spoken of last."""
        words = filler.words
        at = words.index("one") if "one" in words else len(words)
        it = self._it()
        where = next((one.words for one in wish.fillers if one.role in "LS" and one is not filler), ())
        where = words[at + 1 :] or (() if {"this", "that"} & {*words} else where)
        if it is None or not where or at == len(words):
            return filler
        name = it.description.lower().split()
        told = (*words[:at], name[head_of(name, self.lexicon)], *where)
        return replace(filler, words=told, head=at, said=" ".join(told))

    def _person(self, filler: Filler, mention: Mention) -> Value | Ask:
        if mention.kind == "pronoun":
            return self.last_person or Ask(f"Who is “{filler.text}”?")
        if mention.kind in ("speaker", "here"):
            return self.speaker()
        name, rest = noun_phrase(filler.words, filler.head, self.lexicon)
        text = as_said(" ".join((*name, *rest)), filler.text)
        found = Value(text, with_article(text), mention.things, known_place(name, self.known))
        self.last_person = self.called(filler, found)
        return self.last_person

    def called(self, filler: Filler, who: Value) -> Value:
        """Somebody who is called by a name, in small letters too: "kim", and not "the kim"."""
        led = {*filler.words[: filler.head]} & self.lexicon.classes["determiners"]
        if led or who.things or is_somebody(filler.words[filler.head]):
            return who
        return replace(who, said=who.said.removeprefix("the "))

    def speaker(self) -> Value:
        """Whoever speaks, where they said they are."""
        name = name_of(self.situation).lower().split()
        return Value("operator", "you", place=known_place(name, self.known))

    def _thing(self, frame: str, filler: Filler, mention: Mention, *, placed: bool = False) -> Value | Ask:
        """A thing or a place; `placed`: where it is, is said."""
        before = self._spoken_of(filler, mention) or _at_point(filler)
        before = before or self._room_of_somebody(filler)
        before = before or self._room(frame, filler) or self._home(frame, filler, mention)
        if before is not None:
            return before
        objects, lexicon = self.situation.objects, self.lexicon
        there = things_inside(filler.words, objects, self.situation.rooms, lexicon)
        is_there = mention.kind == "one" and mention.things[0] in there
        if there and not is_there and self.group(filler.words) is None:
            return self._one_of(there)
        inside = self._in_room(frame, filler) if mention.kind != "one" else None
        if inside is not None:
            return self._one_of((inside,))
        near = self._beside(filler, mention.things) if mention.kind == "several" else None
        if near is not None:
            return self._one_of((near,))
        several = self._others(filler) or self.group(filler.words, self.left_out)
        several = several or self._told_list(filler, mention)
        if several is not None:
            return self._several(several)
        described = picked(filler.words, objects, lexicon, self.situation.robot_pose)
        if described is not None:
            return self._one_of(described.things)
        if self.left_out or {*filler.words} & lexicon.classes["quantifiers"]:
            return Ask(f"I do not know which ones you mean by “{filler.text}”. Please name them.")
        if mention.kind in ("speaker", "here"):
            return self.speaker()
        known = mention if mention.things else self._part_of(frame, filler, mention)
        if known is not None:
            return self._mentioned(filler, known)
        name, rest = noun_phrase(filler.words, filler.head, lexicon)
        place = known_place(name, self.known) if "'s" not in rest[:1] else None
        if place is not None:
            called = as_said(place.thing, place.memory.data)
            return Value(called, with_article(called), (), place)
        looked_for = frame in ("FIND", "COUNT", "DO", "MAKE") or rest or not objects or placed
        searched = {"FIND", frame} <= {*self.skills} and not self.tells  # who does not know where may search
        looked_for = looked_for or searched
        looked_for = looked_for or (frame in self.skills and self.skills[frame].is_by_hand)
        movable = frame in _MOVABLE and filler.role == "T" and looked_for
        movable = movable and not {*filler.words[1:]} & lexicon.classes["me"]
        # It may be right in front of the robot, but not at a place that nobody knows.
        here = {"you", *self.lexicon.classes["me"]} - ({"you"} if "behind" in rest else set())
        elsewhere = not {*rest}.isdisjoint(_ELSEWHERE) and {*rest}.isdisjoint(here)
        photo = frame == "PHOTO" and not self._akin(mention.text) and not elsewhere
        if movable or photo or frame == "BELOC" or (frame == "LOOK" and placed):
            called = as_said(mention.text, filler.text)
            return Value(called, with_article(called))
        return self._unknown(
            as_said(mention.text, filler.text), frame, sought=frame in _MOVABLE and filler.role == "T"
        )

    def _part_of(self, frame: str, filler: Filler, mention: Mention) -> Mention | None:
        """A part that no map knows of a thing that it knows, where that is only looked at."""
        if frame not in ("LOOK", "PHOTO") or filler.role != "T":
            return None
        whole = whole_of(filler.words, filler.head, self.situation.objects, self.lexicon)
        return Mention("part", mention.text, (whole,)) if whole is not None else None

    def _mentioned(self, filler: Filler, mention: Mention) -> Value | Ask:
        """What is named, or a part of it; a place is the whole: no map knows its sides."""
        if mention.kind == "part" and filler.role not in "GLS":
            text = as_said(mention.text, filler.text)
            return Value(text, with_article(text), mention.things)
        if mention.kind == "part":
            self.unheeded(mention.text)
        return self._one_of(mention.things)

    def _unknown(self, text: str, frame: str, *, sought: bool) -> Ask:
        """That nothing is called so, with what is near and known: nobody knows all that a robot knows."""
        if text[:1].isupper():
            return Ask(f"I do not know where {text} is. Please tell me where.", where=text)
        if sought:
            return Ask(f"I know of no “{text}”. Please tell me where to find it.", where=f"the {text}")
        if akin := self._akin(text):
            kind = akin[0] if len(akin) == 1 else text.split(" ")[-1]  # what an answer is put in place of
            about = self.situation.message.replace(text, kind)
            return Ask(f"I do not know any “{text}” here. {which_one(akin)}", akin, about=about)
        leads = frame == "GO"
        pose, objects = self.situation.robot_pose, self.situation.objects
        near = sorted(objects, key=lambda item: distance_m(item, pose)) if pose is not None else objects
        names = list(dict.fromkeys(with_article(item.description) for item in near))[:_SHOWN]
        unknown = f"I do not know any “{text}” here{', so I cannot go there' if leads else ''}."
        named = f"{', '.join(names[:-1])} or {names[-1]}, for example." if len(names) > 1 else ""
        shown = f" {'I can go to' if leads else 'I know'} {named}" if named else ""
        return Ask(f"{unknown}{shown} Which {'place' if leads else 'thing or place'} do you mean?")

    def _akin(self, text: str) -> tuple[str, ...]:
        """What there is of the kind of something that is described as nothing is: "the torn crate"."""
        name, objects = stems(text.lower().split()), self.situation.objects
        known = {item.description: kind_of(stems(item.description.lower().split())) for item in objects}
        akin = [told for told, words in known.items() if len(name) > 1 and main_word(words) == name[-1]]
        begun = [told for told in known if len(name) > 1 and told.lower().startswith(f"{text.lower()} ")]
        half = [told for told, words in known.items() if name[0] == words[0] != main_word(words)]
        return tuple(
            akin[:6] or begun[:6] or half * (len(half) == 1)
        )  # "the loading bay" may be the loading area

    def _spoken_of(self, filler: Filler, mention: Mention) -> Value | Ask | None:
        """What was spoken of before, if words like "it" and "there" mean that."""
        leads = self.lexicon.classes["prepositions"] - {"outside", "out", "past"}
        small = {*filler.words} <= _BACK_TO | leads
        each = {*filler.words} <= _BACK_TO | self.lexicon.classes["prepositions"] | {"each", "of", "one"}
        if self.bound is not None and (mention.kind == "pronoun" or each or self.names_set(filler)):
            return self.bound
        if mention.kind == "pronoun" and {*filler.words} <= _SEVERAL:
            return self._those(filler)
        if mention.kind == "pronoun":
            person = mention.text in self.lexicon.classes["persons"]
            told = self.last_thing if self.last_thing is not None and self.last_thing.place else None
            before = (self.last_person or told) if person else self.last_thing
            return before or Ask(f"What do you mean by “{filler.text}”?")
        if small:
            return self.last_thing or Ask(f"Where is “{filler.text}”?")
        return None

    def _those(self, filler: Filler) -> Value | Ask:
        """What "them" means: several things of this message or the last one, or one that is many ("cups")."""
        last = self.last_thing
        mugs = last is not None and last.things[:1] != (self.before,)  # "take the mugs and bring them"
        if last is not None and (last.each or not last.things or last.said.endswith("s") or mugs):
            return last
        said = [turn.content for turn in self.situation.history if turn.role == "operator"][-1:]
        before = [
            one.things for text in said for one in named(tokenize(text), self.situation.objects, self.lexicon)
        ]
        things = tuple(dict.fromkeys(thing for found in before if len(found) == 1 for thing in found))
        if len(things) > 1 and all(len(found) == 1 for found in before):
            return self._several(Group(things))
        return Ask(f"Which ones do you mean by “{filler.text}”?")

    def _beside(self, filler: Filler, things: Sequence[MapObject]) -> MapObject | None:
        """Of several things the one beside what was spoken of before: "the chair next to it"."""
        it = self._it()
        if it is None or it in things or not {*filler.words} & self.lexicon.classes["pronouns"]:
            return None
        return beside(it, things)

    def _room(self, frame: str, filler: Filler) -> Value | None:
        """A room of the map as a goal, by its whole name; a thing that is called so goes before."""
        if not _may_be_room(frame, filler):
            return None
        small = self.lexicon.classes["prepositions"] | self.lexicon.classes["determiners"]
        name = [word for word in filler.words if word not in small]
        things = {item.description.lower() for item in self.situation.objects}
        found = [room for room in self.situation.rooms if room.description.lower().split() == name]
        if len(found) != 1 or " ".join(name) in things:
            return None
        return Value(found[0].description, with_article(found[0].description), (found[0],))

    def _room_of_somebody(self, filler: Filler) -> Value | Ask | None:
        """Where somebody lives, as it was told: "his room", "Kim's room"; never another room of the map."""
        leads = self.lexicon.classes["prepositions"] - {"'s"}
        *whose, room = [word for word in filler.words if word not in leads] or [""]
        if room != "room" or (whose[-1:] != ["'s"] and whose not in (["his"], ["her"], ["their"])):
            return None
        if named := whose[-1:] == ["'s"]:
            place = known_place(whose[:-1], self.known)
        else:
            place = self.last_person.place if self.last_person is not None else None
        if place is None:
            return None if named else Ask("Whose room do you mean?")
        called = as_said(place.thing, place.memory.data)
        return Value(called, with_article(called), (), place)

    def _home(self, frame: str, filler: Filler, mention: Mention) -> Value | Ask | None:
        """Where it charges as its home, if nothing else is called so."""
        if frame != "GO" or mention.things or {*filler.words} - {"to", "back"} != {"home"}:
            return None
        dock = link(("charging", "dock"), 1, self.situation.objects, self.lexicon).things
        return self._one_of(dock) if len(dock) == 1 else None

    def _in_room(self, frame: str, filler: Filler) -> MapObject | None:
        """Of a room as a goal the nearest thing in it, where the map has no rooms but things tell of them."""
        if not _may_be_room(frame, filler):
            return None
        return self.inside(filler.words)

    def group(self, words: Sequence[str], left_out: Sequence[str] = ()) -> Group | None:
        """The set that words name, by a room or by themselves; None if they name none."""
        objects, rooms = self.situation.objects, self.situation.rooms
        told = group_of_rooms(words, objects, rooms, self.lexicon, left_out)
        return told or group(words, objects, self.lexicon, left_out)

    def is_by_room(self, words: Sequence[str]) -> bool:
        """Whether words name things of the map by the room in which they are."""
        objects, rooms = self.situation.objects, self.situation.rooms
        several = group_of_rooms(words, objects, rooms, self.lexicon)
        return several is not None or bool(things_inside(words, objects, rooms, self.lexicon))

    def inside(self, words: Sequence[str]) -> MapObject | None:
        """The nearest thing in the room that words name, if they name one."""
        small = self.lexicon.classes["prepositions"] | self.lexicon.classes["determiners"]
        room = " ".join(word for word in words if word not in small)
        inside = in_room(room, self.situation.objects, self.situation.robot_pose)
        return inside[0] if inside and len(room) > 1 else None

    def _one_of(self, things: Sequence[MapObject]) -> Value | Ask:
        """One thing of the map, by its id if others are called the same; or the question which one it is."""
        if len(things) > 1:
            return self._which([thing.description for thing in things], len(things))
        thing = things[0]
        self.mentioned.append(thing)
        same = [other for other in self.situation.objects if other.description == thing.description]
        name = thing.description if len(same) == 1 else thing.id
        return Value(name, with_article(thing.description), (thing,))

    def _others(self, filler: Filler) -> Group | None:
        """For "the other gates", "the rest of the boxes": those of a kind that were not named before."""
        if not {*filler.words} & {"other", "others", "rest", "remaining"}:
            return None
        words = [word for word in filler.words if word not in ("other", "rest", "remaining", "of")]
        family = group(["all", *words], self.situation.objects, self.lexicon)
        objects, spoken = self.situation.objects, self.mentioned or ([self.before] if self.before else [])
        if (family is None or family.doubt) and spoken:  # "the other two", of what was spoken of before
            alike = tuple(item for item in objects if same_kind(item, spoken[-1]))
            left = len([item for item in alike if item not in spoken])
            count = amount_of(words[-1:])
            family = Group(alike) if count is not None and count.value == left else None
        if family is None or family.doubt or not any(thing in spoken for thing in family.things):
            return Group(doubt=f"Which ones do you mean by “{filler.text}”?")
        return Group(tuple(thing for thing in family.things if thing not in spoken))

    def _told_list(self, filler: Filler, mention: Mention) -> Group | None:
        """The things of a list that was told, by what they were called there."""
        if mention.kind == "one":
            return None
        known = self.situation
        words, inner = apart(filler.words, self.lexicon)
        things = told_set(words, known.memory, known.objects, self.lexicon)
        left_out = [*inner, *self.left_out]
        whole = Group(things) if things else None
        return without(whole, left_out, self.lexicon) if whole is not None and left_out else whole

    def _several(self, several: Group) -> Value | Ask:
        self.left_out = ()
        self.mentioned += several.things
        if several.doubt or not several.things:
            doubt = several.doubt or "Then nothing is left. Which ones do you mean?"
            return Ask(doubt, tuple(thing.description for thing in several.choices))
        each = tuple(Value(one.description, with_article(one.description), (one,)) for one in several.things)
        if len(each) == 1:
            return each[0]
        said = " and ".join([", ".join(one.said for one in each[:-1]), each[-1].said])
        return Value(said, said, several.things, each=each)

    def _which(self, names: Sequence[str], count: int) -> Ask:
        """The question which of several things is meant."""
        names = tuple(dict.fromkeys(names))
        if len(names) == 1:
            return Ask(f"There are {count} things called “{names[0]}”. Which one do you mean?")
        return Ask(which_one(names[:6]), names[:6])

    def is_person(self, fillers: Sequence[Filler], value: Value) -> bool:
        """Whether somebody is meant: by a name, by what the map says, or by a word for people."""
        spoken_of = self.lexicon.classes["persons"] | _SEVERAL
        if value is self.last_person and fillers and {*fillers[0].words} <= spoken_of:
            return True
        if value.things or not fillers:
            return bool(value.things) and all(one.class_name == "person" for one in value.things)
        name, _ = noun_phrase(fillers[0].words, fillers[0].head, self.lexicon)
        said = fillers[0].text.split()
        named = any(word[:1].isupper() and word.lower() in name for word in said)
        first = next(
            (word for word in fillers[0].words if word not in self.lexicon.classes["determiners"]), ""
        )
        people = (name and is_somebody(name[-1])) or is_somebody(first)  # "someone raising a hand"
        return named or bool(people) or value.argument == "operator"

    def is_placed(self, filler: Filler) -> bool:
        """Whether a role tells one thing from others by where it is."""
        placed = picked(filler.words, self.situation.objects, self.lexicon, self.situation.robot_pose)
        return placed is not None and len(placed.things) == 1

    def joined(self, wish: Wish) -> Wish:
        """With one role instead of two that touch, where both together tell one thing by where it is."""
        found: list[Filler] = []
        for filler in wish.fillers:
            last = found[-1] if found else None
            if (
                last is not None
                and last.end == filler.start
                and last.role in "TGL"
                and filler.role in "TGLSRP"
            ):
                words, said = (*last.words, *filler.words), f"{last.text} {filler.text}"
                both = Filler(last.role, last.start, filler.end, last.head, words, last.share, said)
                if self.is_placed(both) or self._is_whole_name(both):
                    found[-1] = both
                    continue
            found.append(filler)
        return replace(wish, fillers=tuple(found))

    def _is_whole_name(self, filler: Filler) -> bool:
        """Whether a role is the name of one thing of the map, word for word; its parts alone may be none."""
        said = stems(filler.words[filler.words[0] == "the" :])
        return sum(said == stems(item.description.split()) for item in self.situation.objects) == 1

    def is_called(self, filler: Filler) -> bool:
        """Whether a role is a name of something on the map, or of a set, and nothing else."""
        several = self.group(filler.words)
        found = link(filler.words, filler.head, self.situation.objects, self.lexicon)
        names = {stem(w) for one in found.things for n in (one.description, *one.aliases) for w in n.split()}
        return not several.doubt if several is not None else {stem(word) for word in filler.words} <= names

    def names_place(self, wish: Wish) -> bool:
        """Whether a wish says where it is done: by a place, or by a thing that the map knows."""
        said = [word for filler in wish.fillers for word in filler.words]
        tokens = [Token(word, at, at + 1) for at, word in enumerate(said)]
        several = any(map(self.names_set, wish.fillers))
        return several or wish.has("LGS") or bool(named(tokens, self.situation.objects, self.lexicon))

    def names_set(self, filler: Filler, without: Sequence[str] = ()) -> bool:
        """Whether a role holds several things, among them what is named as left out."""
        found = self.group(filler.words, without)
        return found is not None and not (without and found.doubt)

    def is_one(self, filler: Filler) -> bool:
        """Whether a role names one thing of the map, and no set."""
        one = link(filler.words, filler.head, self.situation.objects, self.lexicon).kind == "one"
        return one and not self.names_set(filler)

    def knows(self, filler: Filler) -> bool:
        """Whether a role names something of the map, with all of its words."""
        if filler.role not in "TGLS":
            return False
        several = self.group(filler.words)
        if several is not None or self.is_placed(filler):
            return several is None or not several.doubt
        named = link(filler.words, filler.head, self.situation.objects, self.lexicon)
        name, rest = noun_phrase(filler.words, filler.head, self.lexicon)
        if named.kind != "one" or " ".join((*name, *rest)) == named.things[0].description.lower():
            return named.kind == "one"
        return not rest and len(name) <= len(named.things[0].description.split()) + 1

    def names_same(self, words: Sequence[str], wishes: Sequence[Wish]) -> bool:
        """Whether words name what one of these wishes is about."""
        named = link(words, len(words) - 1, self.situation.objects, self.lexicon).things
        fillers = [filler for wish in wishes for filler in wish.fillers if filler.role in "TGLSR"]
        others = [link(f.words, f.head, self.situation.objects, self.lexicon).things for f in fillers]
        return any(thing in things for thing in named for things in others)

    def recall(self, thing: MapObject | Place | None, person: Place | None) -> None:
        """What was spoken of before this message."""
        if isinstance(thing, Place):
            name = as_said(thing.thing, thing.memory.data)
            self.last_thing = Value(name, with_article(name), (), thing)
        elif thing is not None:
            self.before = thing
            self.last_thing = Value(thing.description, with_article(thing.description), (thing,))
        if person is not None:
            name = as_said(person.thing, person.memory.data)
            self.last_person = Value(name, with_article(name), (), person)

    def told_about(self, name: tuple[str, ...]) -> None:
        """Somebody of whom something was told just now."""
        if name and name[-1] not in self.lexicon.classes["persons"] | self.lexicon.classes["pronouns"]:
            text = as_said(" ".join(name), self.situation.message)
            self.last_person = Value(text, with_article(text), (), known_place(name, self.known))

    def loose(self, filler: Filler) -> None:
        """Something that is spoken of before it is wanted."""
        if filler.role == "T":
            value = self._thing(
                "BELOC", filler, link(filler.words, filler.head, self.situation.objects, self.lexicon)
            )
            self.last_thing = value if isinstance(value, Value) else self.last_thing

    def unheeded(self, text: str) -> None:
        """A part that no action takes, such as the manner: it is said."""
        self.notes.append(Note(f"I cannot take “{text}” into account."))

    def forbidden(self, wish: Wish) -> None:
        """What is not to be done."""
        for filler in wish.all("T") + wish.all("G"):
            named = self.group(filler.words)
            mention = link(filler.words, filler.head, self.situation.objects, self.lexicon)
            things = named.things if named is not None else mention.things
            self.mentioned += things
            self.refused += [(wish.frame, thing.description or thing.id) for thing in things]
        self.left_undone(" ".join([wish.verb, *(filler.text for filler in wish.fillers)]))

    def left_undone(self, text: str) -> None:
        """Something that is not wanted: it is said."""
        self.notes.append(Note(f"I leave that out: “{text}”."))


_A_BIT = word_set("a the little bit tad touch just slightly tiny")
_BITS = {"distance": Amount(0.3, "m"), "angle": Amount(30, "degrees")}
"""How much "a bit" is: a step, and as far as one looks round a corner."""


def _may_be_room(frame: str, filler: Filler) -> bool:
    """Whether a role may be filled by a room: a goal, where something is, or what is looked at."""
    return frame in _IN_ROOMS and (filler.role in "GL" or (frame == "LOOK" and filler.role == "T"))


def _at_point(filler: Filler) -> Value | None:
    point = point_of(filler.words)
    if point is None:
        return None
    text = f"point ({point[0]:g}, {point[1]:g})"
    return Value(text, f"the {text}", point=point)


WITHIN = frozenset({"in", "on", "inside", "within", "at", "from"})
"""Where something is; "by" and "between" tell which one it is."""
_SHOWN = 3
"""So many things are named to whoever asked for one that nobody knows."""
_SEVERAL = frozenset({"them", "these", "those", "they"})
_BACK_TO = frozenset({"there", "it", "them", "these", "those", "they", "over"})
"""Words that mean what was spoken of last."""
