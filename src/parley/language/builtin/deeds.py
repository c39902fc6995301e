"""From one wish to deeds: its roles grounded by type, an action for its frame, or steps that amount to it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from parley.language.base import Situation
from parley.language.builtin.amounts import Amount, amount_of, direction_of
from parley.language.builtin.decision import Ask, Deed, Note
from parley.language.builtin.facts import Place, known_place
from parley.language.builtin.lexicon import Lexicon, stem
from parley.language.builtin.owned import owned
from parley.language.builtin.saying import with_article
from parley.language.builtin.skills import Skill, Skills
from parley.language.builtin.things import Mention, link, noun_phrase
from parley.language.builtin.wishes import Filler, Wish
from parley.messages.status import Kind
from parley.world.object_map import MapObject

__all__ = ["Builder"]

_LOGIC = {"C": "a condition", "U": "“until”", "W": "a time", "E": "an exception", "O": "how often"}
_MOVABLE = frozenset(
    {"TAKE", "BRING", "GIVE", "PUT", "FIND", "COUNT", "POUR", "CUT", "MIX", "COOK", "DO", "MAKE"}
)


@dataclass(frozen=True, slots=True)
class Value:
    """What a role holds: the argument, how the reply says it, and which things of the map it may be."""

    argument: str
    said: str
    things: tuple[MapObject, ...] = ()
    place: Place | None = None
    """Where it is remembered to be."""
    amount: Amount | None = None


@dataclass(slots=True)
class Builder:
    """Makes the deeds of one message; knows what was spoken of before."""

    situation: Situation
    skills: Skills
    lexicon: Lexicon
    known: Sequence[Place]
    last_thing: Value | None = None
    last_person: Value | None = None
    notes: list[Note] = field(default_factory=list)

    def deeds(self, wish: Wish) -> list[Deed] | Ask:
        """The deeds of a wish, or a question."""
        logic = next((_LOGIC[filler.role] for filler in wish.fillers if filler.role in _LOGIC), "")
        logic = logic or next((text for f in wish.fillers if (text := self._beyond(f))), "")
        if wish.negated or wish.otherwise or logic:
            what = "what not to do" if wish.negated else logic or "“otherwise”"
            return Ask(
                f"I understand that there is {what} in this, and I cannot plan that yet. What shall I do now?"
            )
        if wish.own is not None:
            return owned(wish.own, self._grounds)
        frame = self.lexicon.frames.get(wish.frame)
        strange = next(
            (f for f in wish.fillers if frame and f.role not in frame.roles and f.role not in "AMPWI"), None
        )
        if frame is None or strange is not None:
            unclear = strange.text if strange else wish.verb
            return Ask(f"I do not understand what “{unclear}” is in this. Please say it otherwise.")
        twice = next((f for f in wish.fillers if len(wish.all(f.role)) > 1 and f.role not in "AMP"), None)
        if twice is not None:
            both = " and ".join(f"“{filler.text}”" for filler in wish.all(twice.role))
            return Ask(f"I do not understand how {both} go together here. Please say it otherwise.")
        values: dict[str, Value] = {}
        for filler in wish.fillers:
            if (
                filler.role == "T"
                and filler.words[-1] in ("yourself", "itself")
                and wish.frame in ("CONNECT", "DISC", "CHARGE")
            ):
                continue
            value = self._value(wish, filler)
            if isinstance(value, Ask):
                return value
            if value is not None:
                values[filler.role] = value
        for role in "LSGT":
            self.last_thing = values[role] if role in values and values[role].things else self.last_thing
        self.last_thing = values.get("T", self.last_thing)
        for filler in wish.all("M") + wish.all("P"):
            self.unheeded(filler.text)
        return self._planned(wish, values)

    def _grounds(self, filler: Filler, kind: Kind, about: frozenset[str]) -> tuple[str, str] | Ask:
        """What words mean for an input of an action of the robot's own, of which more is said `about` it."""
        filler = self._within(filler, about)
        mention = link(filler.words, filler.head, self.situation.objects, self.lexicon)
        if any(word in filler.words for word in self.lexicon.classes["quantifiers"] | {"and", "or"}):
            return Ask(
                f"I do not know yet how to do that with “{filler.text}”. Which one shall I begin with?"
            )
        if kind == "person" and not {*filler.words} & _CLAUSE:
            found: Value | Ask = self._person(filler, mention)
        elif mention.kind == "none" and kind != "place" and self._is_plain(filler, about):
            found = Value(mention.text, with_article(mention.text))
        else:
            found = self._thing("OWN", filler, mention)
        if isinstance(found, Ask):
            return found
        if found.place is not None and kind != "person":
            where = link(found.place.where, found.place.head, self.situation.objects, self.lexicon)
            if where.kind == "one":
                self._used(found.place)
                text = where.things[0].description
                found = Value(text, with_article(text), where.things)
        self.last_thing = found if kind != "person" else self.last_thing
        return found.argument, found.said

    def _within(self, filler: Filler, about: frozenset[str]) -> Filler:
        """What remains where the first part says again what the action is about: "the door of crate 2"."""
        at = filler.words.index("of") if "of" in filler.words[:-1] else 0
        small = self.lexicon.classes["determiners"]
        if not at or not all(stem(word) in about for word in filler.words[:at] if word not in small):
            return filler
        words = filler.words[at + 1 :]
        return Filler(filler.role, filler.start + at + 1, filler.end, len(words) - 1, words)

    def _is_plain(self, filler: Filler, about: frozenset[str]) -> bool:
        """Whether words may name a thing that no map holds: few, and the map holds nothing of its kind."""
        objects = self.situation.objects
        kinds = {stem(word) for item in objects for word in item.description.split() if len(word) > 2}
        small = self.lexicon.classes["prepositions"] - {"of", "the"}
        return (
            not kinds & about
            and len(filler.words) <= 6
            and not _CLAUSE & {*filler.words}
            and not small & {*filler.words[1:]}
        )

    def _beyond(self, filler: Filler) -> str:
        """What in a role cannot be planned yet: all of several, between two, a condition that is no check."""
        if filler.role in "XKMAP":
            return ""
        among = {*filler.words} & self.lexicon.classes["quantifiers"]
        if among or filler.words[0] == "between":
            return f"“{next(iter(among), 'between')}”"
        return "“or”" if "or" in filler.words else ""

    def unheeded(self, text: str) -> None:
        """A part that no action takes, such as the manner: it is said."""
        self.notes.append(Note(f"I cannot take “{text}” into account."))

    def told_about(self, name: tuple[str, ...]) -> None:
        """Somebody of whom something was told just now."""
        if name:
            text = " ".join(name)
            self.last_person = Value(text, with_article(text), (), known_place(name, self.known))

    def loose(self, filler: Filler) -> None:
        """Something that is spoken of before it is wanted."""
        if filler.role == "T":
            value = self._thing(
                "BELOC", filler, link(filler.words, filler.head, self.situation.objects, self.lexicon)
            )
            self.last_thing = value if isinstance(value, Value) else self.last_thing

    # -- values --

    def _value(self, wish: Wish, filler: Filler) -> Value | Ask | None:
        kind = self.lexicon.frames[wish.frame].roles.get(filler.role, "text")
        if kind == "direction" or (kind == "thing" and filler.role == "H"):
            direction = direction_of(filler.words, self.lexicon)
            if direction is None:
                return Ask(f"Which direction is “{filler.text}”?")
            return Value(direction, direction)
        if kind in ("distance", "angle", "duration"):
            amount = amount_of(filler.words)
            if amount is None or amount.kind not in (kind, "number"):
                return Ask(f"How much is “{filler.text}”? Please say a number and its unit.")
            if amount.kind == "number" and kind == "distance":
                return Ask(f"{amount} of what: metres, feet?")
            text = str(amount) if amount.unit else f"{amount} degrees"
            return Value(text, text, amount=amount)
        if kind == "text":
            return Value(filler.text, filler.text)
        mention = link(filler.words, filler.head, self.situation.objects, self.lexicon)
        if kind == "person":
            return self._person(filler, mention)
        return self._thing(wish.frame, filler, mention)

    def _person(self, filler: Filler, mention: Mention) -> Value | Ask:
        if mention.kind == "pronoun":
            return self.last_person or Ask(f"Who is “{filler.text}”?")
        if mention.kind in ("speaker", "here"):
            return Value("operator", "you")
        name, rest = noun_phrase(filler.words, filler.head, self.lexicon)
        text = " ".join((*name, *rest))
        found = Value(text, with_article(text), mention.things, known_place(name, self.known))
        self.last_person = found
        return found

    def _thing(self, frame: str, filler: Filler, mention: Mention) -> Value | Ask:
        if mention.kind == "pronoun":
            before = self.last_person if mention.text in self.lexicon.classes["persons"] else self.last_thing
            return before or Ask(f"What do you mean by “{filler.text}”?")
        if mention.kind in ("speaker", "here"):
            return Value("operator", "you")
        name, rest = noun_phrase(filler.words, filler.head, self.lexicon)
        if mention.kind == "one":
            thing = mention.things[0]
            return Value(thing.description, with_article(thing.description), mention.things)
        if mention.kind == "part":
            return Value(mention.text, with_article(mention.text), mention.things)
        if mention.kind in ("several", "unclear"):
            names = tuple(dict.fromkeys(thing.description for thing in mention.things))
            rest = () if mention.kind == "unclear" else rest
            marked = {word for thing in self.situation.objects for word in thing.description.lower().split()}
            rest = tuple(word for word in rest if word in marked or word in self.lexicon.classes["parts"])
            if not rest and not self._finds_out() and len(names) > 1:
                return Ask(
                    f"Which one do you mean: {' or '.join(with_article(n) for n in names[:6])}?", names[:6]
                )
            if not rest and not self._finds_out():
                return Ask(
                    f"There are {len(mention.things)} things called “{names[0]}”. Which one do you mean?"
                )
            return Value(mention.text, with_article(mention.text), mention.things)
        place = known_place(name, self.known)
        if place is not None:
            return Value(place.thing, with_article(place.thing), (), place)
        if (
            frame in _MOVABLE
            and filler.role == "T"
            and (frame in ("FIND", "COUNT", "DO", "MAKE") or rest or not self.situation.objects)
        ):
            return Value(mention.text, with_article(mention.text))
        if frame in ("PHOTO", "BELOC"):
            return Value(mention.text, with_article(mention.text))
        return Ask(f"I do not know any “{mention.text}” here. Which thing or place do you mean?")

    def _finds_out(self) -> bool:
        """Whether an action of the robot asks which of several things is meant, when it comes to that."""
        return "LOCATE" in self.skills

    # -- steps --

    def _planned(self, wish: Wish, values: dict[str, Value]) -> list[Deed] | Ask:
        if wish.frame in ("MOVE", "TURN"):
            missing = self._steering(wish, values)
            if missing is not None:
                return missing
        if wish.frame == "GO" and "N" in values and "G" in values:
            return Ask(f"Shall I go to {values['G'].said}, or only {values['N'].said} in that direction?")
        if wish.frame == "BRING" and not {"R", "G"} & set(values) and wish.verb.split()[0] not in _TO_ME:
            return Ask("Where shall I bring it?")
        if wish.frame == "GO":
            return self._way(values.get("G") or values.get("L"))
        if wish.frame == "FACE" and "G" in values:
            values["T"] = values.pop("G")
        if wish.frame == "FACE" and "H" in values:
            values["T"] = values.pop("H")
        skill = self.skills.get(wish.frame)
        if skill is not None:
            return self._direct(wish, skill, values)
        other = _WAYS.get(wish.frame)
        if other is not None:
            return other(self, values)
        gloss = self.lexicon.frames[wish.frame].gloss
        return Ask(f"I have no action to {gloss}. What else can I do for you?")

    def _steering(self, wish: Wish, values: dict[str, Value]) -> Ask | None:
        """What has to be said of a movement; "forward" and "back" may be in the verb."""
        if "H" not in values:
            backing = any(
                word in ("back", "backup", "reverse", "backing", "reversing") for word in wish.verb.split()
            )
            if wish.frame == "MOVE" and (backing or "N" in values):
                values["H"] = Value("back", "back") if backing else Value("forward", "forward")
            elif wish.frame == "TURN" and "around" in wish.verb.split():
                values["H"] = Value("around", "around")
            elif wish.frame == "TURN" and values.get("N", Value("", "")).argument in (
                "180 degrees",
                "360 degrees",
            ):
                values["H"] = Value("left", "left")
            else:
                return Ask("To the left or to the right?" if wish.frame == "TURN" else "Which direction?")
        if "N" not in values and values["H"].argument != "around":
            return Ask(
                "By how many degrees shall I turn?" if wish.frame == "TURN" else "How far shall I move?"
            )
        return None

    def _direct(self, wish: Wish, skill: Skill, values: dict[str, Value]) -> list[Deed] | Ask:
        """By the action that is made for it."""
        arguments: dict[str, str | float] = {}
        said: dict[str, str] = {}
        before: list[Deed] = []
        gloss = self.lexicon.frames[wish.frame].gloss
        for role, value in values.items():
            slot = _slot(skill, role, values)
            if slot is not None and slot not in arguments:
                given = _typed(value, skill.action.inputs[slot])
                if given is None:
                    return Ask(f"I cannot {gloss} with “{value.said}”. Please say it otherwise.")
                arguments[slot], said[role] = given, value.said
                continue
            way = self._way(value) if role in "SL" and "GO" in self.skills else None
            if isinstance(way, list):
                before += way
            elif wish.frame in _LOOSE:
                self.unheeded(value.said)
            else:
                return way or Ask(f"I can {gloss}, but I do not know what to do about {value.said}.")
        if set(skill.action.inputs) - set(arguments) - set(skill.action.optional):
            return Ask(f"I can {gloss}, but I need to know more: what, or where?")
        if "looks" in skill.action.effects and "GO" in self.skills:
            before += self._way_to_thing(values.get("T") or self._spoken_of(wish.one("K")))
        return [*before, Deed(wish.frame, skill, arguments, said)]

    def _way(self, goal: Value | None) -> list[Deed] | Ask:
        skill = self.skills.get("GO")
        if skill is None or goal is None:
            return Ask("Where to?" if skill else "I cannot drive anywhere.")
        if goal.place is not None:
            self._used(goal.place)
            text = " ".join(goal.place.where)
            mention = link(goal.place.where, goal.place.head, self.situation.objects, self.lexicon)
            if mention.kind == "one":
                text = mention.things[0].description
            goal = Value(text, with_article(text), mention.things)
        said = {"G": goal.said}
        if not skill.takes_pose:
            slot = skill.roles.get("G")
            return [Deed("GO", skill, {slot: goal.argument}, said)] if slot else Ask("Where to?")
        locate = self.skills.get("LOCATE")
        if locate is None or not locate.roles:
            return Ask("I cannot find out where that is.")
        if goal.argument == "operator" or not goal.things:
            unknown = "you are" if goal.argument == "operator" else f"{goal.said} is"
            return Ask(f"I do not know where {unknown}. Which place is it near?")
        return [
            Deed("GO", locate, {next(iter(locate.roles.values())): goal.argument}, said, hidden=True),
            Deed("GO", skill, {}, said),
        ]

    def _way_to_thing(self, thing: Value | None) -> list[Deed]:
        """The way to what is to be looked at, if it is known where that is."""
        if thing is None or not (thing.things or thing.place):
            return []
        way = self._way(thing)
        return [] if isinstance(way, Ask) else way

    def _spoken_of(self, filler: Filler | None) -> Value | None:
        """The one thing of the map that a statement names, if it names one."""
        said = {stem(word) for word in filler.words} if filler else set()
        names = [(item, (item.description, *item.aliases)) for item in self.situation.objects]
        found = [item for item, texts in names if any({stem(w) for w in t.split()} <= said for t in texts)]
        if len(found) != 1:
            return None
        return Value(found[0].description, with_article(found[0].description), tuple(found))

    def _used(self, place: Place) -> None:
        note = Note(f"I remember: {place.memory.data.rstrip('.')}.", place.memory.name)
        if note not in self.notes:
            self.notes.append(note)

    def _look_for(self, values: dict[str, Value]) -> list[Deed] | Ask:
        thing, look = values.get("T"), self.skills.get("LOOK")
        if thing is None or look is None:
            return Ask("I cannot look for things." if look is None else "What shall I look for?")
        way: list[Deed] | Ask = []
        if "L" in values or "S" in values:
            way = self._way(values.get("L") or values["S"])
        elif thing.place is not None or thing.things:
            way = self._way(thing)
        else:
            return Ask(f"I do not know where {thing.said} is. Where shall I look?")
        if isinstance(way, Ask):
            return way
        return [
            *way,
            Deed("FIND", look, {next(iter(look.roles.values())): thing.argument}, {"T": thing.said}),
        ]

    def _take(self, values: dict[str, Value]) -> list[Deed] | Ask:
        thing, ask = values.get("T"), self.skills.get("ASK")
        if thing is None or ask is None or not ask.roles:
            return Ask("I cannot pick things up." if thing else "What shall I take?")
        found = self._look_for(values)
        if isinstance(found, Ask):
            return found
        question = f"I cannot pick things up. Please put {thing.said} on me and tell me when it is done."
        slot = next(iter(ask.roles.values()))
        return [*found, Deed("ASK", ask, {slot: question}, {"R": "you", "X": f"to put {thing.said} on me"})]

    def _bring(self, values: dict[str, Value]) -> list[Deed] | Ask:
        goal = values.get("R") or values.get("G")
        taken = self._take({role: value for role, value in values.items() if role not in "RG"})
        if isinstance(taken, Ask):
            return taken
        if goal is None:
            return Ask("Where shall I bring it?")
        way = self._way(goal)
        return way if isinstance(way, Ask) else [*taken, *way]


_CLAUSE = frozenset(
    {"'s", "'", "how", "what", "whether", "who", "whoever", "whatever", "which", "where", "when", "rest"}
)
"""Words with which a description begins that is more than a name."""
_TO_ME = frozenset({"bring", "fetch", "get", "retrieve", "go", "give", "want", "find"})
"""Verbs of bringing that mean the speaker if nobody is named."""
_LOOSE = frozenset({"FOLLOW", "PHOTO"})
"""What is done all the same if a part of it has no place in the action; that is said."""
_METRES = {"m": 1.0, "cm": 0.01, "mm": 0.001, "feet": 0.3048, "inches": 0.0254, "yards": 0.9144}
_SECONDS = {"s": 1.0, "min": 60.0, "h": 3600.0}


def _slot(skill: Skill, role: str, values: dict[str, Value]) -> str | None:
    """The parameter for a role: its own, else that of a like role that nothing else fills."""
    if role in skill.roles:
        return skill.roles[role]
    like = (other for other in _ALIKE.get(role, "") if other in skill.roles and other not in values)
    return next((skill.roles[other] for other in like), None)


def _typed(value: Value, kind: str) -> str | float | None:
    """What is given to a parameter of a type; None if it cannot be: numbers are metres, degrees, seconds."""
    if kind == "string":
        return value.argument
    if kind != "number" or value.amount is None:
        return None
    scale = (_METRES | _SECONDS).get(value.amount.unit, 1.0)
    return round(value.amount.value * scale, 4)


_ALIKE = {"G": "RL", "R": "G", "K": "T", "T": "KX", "S": "G", "L": "S", "H": "T"}
"""Which other role's parameter takes what a role holds, if it is free."""
_WAYS = {"FIND": Builder._look_for, "TAKE": Builder._take, "BRING": Builder._bring, "GIVE": Builder._bring}
"""How frames are done without an action of their own."""
