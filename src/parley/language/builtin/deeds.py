"""From one wish to deeds: an action for its frame, or steps that amount to it."""

from __future__ import annotations

from dataclasses import dataclass, replace

from parley.language.builtin.amounts import Amount, amount_of
from parley.language.builtin.checks import Look, check
from parley.language.builtin.decision import Ask, Deed
from parley.language.builtin.doing import Doing, followed, slot_of, spoken
from parley.language.builtin.grounding import WITHIN, Value
from parley.language.builtin.handling import HANDLED, is_place
from parley.language.builtin.judging import asked
from parley.language.builtin.lexicon import is_somebody, lemmas, stem
from parley.language.builtin.saying import with_article
from parley.language.builtin.spans import Filler
from parley.language.builtin.structure import Part
from parley.language.builtin.things import Mention, head_of, link
from parley.language.builtin.tokens import TITLES
from parley.language.builtin.wishes import OwnAction, Wish, owned
from parley.language.lexicon import word_set
from parley.messages.status import Kind
from parley.umrf.kinds import parameters_of

__all__ = ["Builder"]

_LEFT_OUT_OF = "I do not know what “{}” is left out of. Can you say it otherwise?"
_LOGIC = {"C": "a condition", "W": "a time"}
_MOST_TIMES = 10
_BESIDE_M = 1.0
"""So near a thing counts as being at a place."""


def _as(filler: Filler, role: str, other: str) -> Filler:
    """A role as another one, if it is that."""
    return replace(filler, role=other) if filler.role == role else filler


def _seen_where(where: Filler) -> Filler:
    """What is to be looked at, where only a place is told: that as a whole, or "what is under it"."""
    if where.words[0] in WITHIN | {"into", "through", "round", "around"}:
        return replace(where, role="T")
    return replace(where, role="K", words=("what", "is", *where.words), said=f"what is {where.text}")


@dataclass(slots=True)
class Builder(Doing):
    """Makes the deeds of one message."""

    def deeds(self, wish: Wish) -> list[Deed] | Ask:
        """The deeds of a wish, or a question."""
        self.whole = None
        if wish.own is not None:
            often = self._logic(wish) or self.times(wish)
            self._excepted(wish)
            made = often if isinstance(often, Ask) else self._owned(wish, wish.own)
            return made if isinstance(made, Ask) or isinstance(often, Ask) else made * often
        wish = self._seen(wish)
        times = self._strange(wish) or self.times(wish)
        if isinstance(times, Ask):
            return times
        wish = self._placed(self._gathered(wish))
        thing, handles = wish.one("T"), wish.frame in (*HANDLED, "BRING")
        spoken_of = thing is not None and {*thing.words} <= self.lexicon.classes["pronouns"]
        if handles and spoken_of and self.in_hand is not None:
            self.last_thing = self.in_hand  # "take the box, go to the desk and put it there"
        values = self._values(wish)
        if isinstance(values, Ask):
            return values
        places = {*values} == {"T"} and all(map(is_place, values["T"].things or [None]))
        if wish.frame == "TAKE" and places and "take" in lemmas(wish.verb):
            wish, values = replace(wish, frame="GO"), {"G": values["T"]}  # "take aisle 3": that way
        if wish.frame == "LOOK" and {*values} == {*"LK"} and values["L"].each:
            values["T"] = values.pop("L")  # places that are looked at for something: each is looked at
        several = [value for value in values.values() if value.each]
        through = wish.frame == "FIND" and {*values} == {*"TL"}
        if len(several) > 1 or (several and not through and (wish.frame in _ONCE or {*"LS"} & {*values})):
            return Ask(f"Do you mean all of them: {several[-1].said}? Please say it for one after the other.")
        for filler in wish.all("M") + wish.all("P"):
            self.unheeded(filler.text)
        if several:
            self.whole = several[0]
            made = self._for_each(wish, values, several[0])
        else:
            sought = values.get("T") if wish.frame == "FIND" else None
            if sought is not None and (self._is_met(wish) or self.is_person(wish.all("T"), sought)):
                values["T"] = self.last_person = self.called(wish.all("T")[0], sought)
            for role in "LSGT":
                told = role in values and (values[role].things or values[role].point)
                self.last_thing = values[role] if told else self.last_thing
            self.last_thing = values.get("T", self.last_thing)
            made = self._planned(wish, values)
        return made if isinstance(made, Ask) else self._repeated(wish, made, times)

    @staticmethod
    def _repeated(wish: Wish, made: list[Deed], times: int) -> list[Deed]:
        """So many times; another picture is taken where it stands."""
        if wish.frame == "PHOTO":
            return [deed for deed in made for _ in range(times if deed.frame == "PHOTO" else 1)]
        return made * times

    @staticmethod
    def _is_met(wish: Wish) -> bool:
        """Whether who is found is to be met: nobody meets a thing."""
        return {*lemmas(wish.verb.split()[-1])} == {"meet"} if wish.verb else False

    def _seen(self, wish: Wish) -> Wish:
        """Whom the map does not know is looked for, and what is to be shown is looked at without a camera."""
        thing = wish.one("T")
        looks = wish.frame == "LOOK" and not wish.has("TKL")
        looks = looks or (
            wish.frame == "GO" and "look" in {w for v in wish.verb.split()[:1] for w in lemmas(v)}
        )
        if looks and wish.has("G"):  # "look by the gate"
            wish = replace(wish, frame="LOOK", fillers=tuple(_as(f, "G", "L") for f in wish.fillers))
        where = wish.one("L")
        if wish.frame == "LOOK" and where is not None and not wish.has("TK") and self._leads(where):
            there = _seen_where(self._by_name(where))
            wish = replace(wish, fillers=tuple(there if f is where else f for f in wish.fillers))
        if wish.frame == "PHOTO" and thing is not None and thing.words[0] in _WHATEVER:
            wish = replace(wish, fillers=tuple(self._behind_what(f) for f in wish.fillers))
        if wish.frame == "PHOTO" and "PHOTO" not in self.skills and {*wish.verb.split()} & {"show", "see"}:
            wish = replace(wish, frame="LOOK")
        if wish.frame == "LOOK" and thing is not None and not wish.has("K") and "FIND" in self.skills:
            known = link(thing.words, thing.head, self.situation.objects, self.lexicon).things
            if is_somebody(thing.words[thing.head]) and not known:
                return replace(wish, frame="FIND")
        return wish

    def _leads(self, where: Filler) -> bool:
        """Whether a word tells on which side of one place it is: "under the ramp", not "there"."""
        small = self.lexicon.classes["there"] | self.lexicon.classes["here"] | {"here"}
        leads = where.words[0] in self.lexicon.classes["prepositions"] and len(where.words) > 1
        return leads and where.words[-1] not in small and not self.names_set(where)

    def _by_name(self, where: Filler) -> Filler:
        """Where something is that was spoken of before, by its name: "under it"."""
        it = self._it() if where.words[-1] == "it" else None
        if it is None:
            return where
        words = (*where.words[:-1], "the", *it.description.lower().split())
        return replace(where, words=words, head=len(words) - 1, said=" ".join(words))

    def _behind_what(self, filler: Filler) -> Filler:
        """The place alone of "what is behind the gate", "whoever is at the gate"."""
        leads = self.lexicon.classes["prepositions"] - {"is", "are", "'s"}
        at = next((n for n, word in enumerate(filler.words) if n and word in leads), 0)
        if filler.words[0] not in _WHATEVER or not at or at + 1 == len(filler.words):
            return filler
        words = filler.words[at + 1 :]
        place = replace(filler, words=words, head=head_of(words, self.lexicon), said=" ".join(words))
        return place if link(words, place.head, self.situation.objects, self.lexicon).things else filler

    def _gathered(self, wish: Wish) -> Wish:
        """With things and the room in which they are as one role: "check all crates in the yard"."""
        thing, where = wish.one("T"), wish.one("L")
        if thing is None or where is None or wish.frame not in ("LOOK", "PHOTO"):
            return wish
        words = (*thing.words, *where.words)
        if not self.is_by_room(words):
            return self._looked_for_there(wish, thing, where)
        both = replace(thing, words=words, said=f"{thing.text} {where.text}")
        rest = tuple(filler for filler in wish.fillers if filler not in (thing, where))
        return replace(wish, fillers=(*rest, both))

    def _looked_for_there(self, wish: Wish, thing: Filler, where: Filler) -> Wish:
        """Things of which the map has none at the place that is told: they are what is looked for there."""
        at = link(where.words, where.head, self.situation.objects, self.lexicon)
        several = self.group(thing.words)
        if wish.frame != "LOOK" or wish.has("K") or at.kind != "one" or several is None or several.doubt:
            return wish
        if any(at.things[0].gap_m(item.x_m, item.y_m) <= _BESIDE_M for item in several.things):
            return wish
        rest = tuple(filler for filler in wish.fillers if filler is not thing)
        return replace(wish, fillers=(*rest, replace(thing, role="K")))

    def _placed(self, wish: Wish) -> Wish:
        """With the place of who or what no map holds as a role of its own: "the cup on the desk"."""
        goal = wish.one("G") if wish.frame in ("GO", "BRING", "GIVE") and not wish.has("RL") else None
        parts = self._standing(goal, "L") if goal is not None else ()
        if parts and self.is_person([parts[0]], Value("", "")):  # "to Kim by the gate"
            rest = (filler for filler in wish.fillers if filler is not goal)
            if wish.frame != "GO":
                wish = replace(wish, fillers=(*rest, replace(parts[0], role="R"), parts[1]))
            elif "FIND" in self.skills:  # who is gone to is met there
                wish = replace(wish, frame="FIND", fillers=(*rest, replace(parts[0], role="T"), parts[1]))
        for about in _STANDING.get(wish.frame, "") if "GO" in self.skills else "":
            one, roles = wish.one(about), self.lexicon.frames[wish.frame].roles
            role = next((role for role in ("SL" if about == "T" else "L") if role in roles), "")
            parts = self._standing(one, role) if one is not None and role and not wish.has(role) else ()
            if parts and wish.frame == "LOOK" and parts[1].words[0] not in WITHIN:
                parts = ()
            wish = (
                replace(wish, fillers=(*(f for f in wish.fillers if f is not one), *parts)) if parts else wish
            )
        return wish

    def _standing(self, named: Filler, role: str) -> tuple[Filler, ...]:
        """Who or what is named, and the place that is told with it; nothing if none is."""
        words, small = named.words, self.lexicon.classes["prepositions"] - {"of"}
        leads = [at for at in range(named.head + 1, len(words)) if words[at] in small]
        if not leads or link(words, named.head, self.situation.objects, self.lexicon).things:
            return ()
        if self.is_by_room(words):
            return ()
        at = next((at for at in leads if self._is_where(words[at:])), 0)
        if not at:
            return ()
        where = head_of(words[at:], self.lexicon)
        middle, text = named.start + at, " ".join(named.text.split()[:at])
        return (
            replace(named, end=middle, words=words[:at], said=text),
            Filler(role, middle, named.end, where, words[at:], named.share),
        )

    def _is_where(self, words: tuple[str, ...]) -> bool:
        """Whether words name one place of the map, or a room."""
        found = link(words, head_of(words, self.lexicon), self.situation.objects, self.lexicon)
        return found.kind == "one" or self.inside(words) is not None

    def _logic(self, wish: Wish) -> Ask | None:
        """What of its logic no plan takes."""
        if wish.has("U") and wish.frame not in ("WAIT", "FOLLOW"):
            return Ask(f"I cannot do that “{wish.all('U')[0].text}” by myself. What shall I do now?")
        logic = next((_LOGIC[filler.role] for filler in wish.fillers if filler.role in _LOGIC), "")
        logic = logic or next((text for f in wish.fillers if (text := self._beyond(f))), "")
        if wish.otherwise or logic:
            what = logic or "“otherwise”"
            return Ask(f"There is {what} in this, and I cannot plan that yet. What shall I do now?")
        return None

    def _strange(self, wish: Wish) -> Ask | None:
        """Why a wish as a whole cannot be planned."""
        if (logic := self._logic(wish)) is not None:
            return logic
        late = next((f.text.removeprefix("whether ") for f in wish.all("K")), "")
        if late.startswith("when ") and wish.frame == "LOOK":  # "tell me when you are there"
            return Ask(f"I cannot tell by myself when “{late[5:]}” is. What shall I do now?")
        frame = self.lexicon.frames.get(wish.frame)
        known = {*frame.roles, *"AMPWIOE"} if frame else set()
        strange = next((filler for filler in wish.fillers if filler.role not in known), None)
        if frame is None or strange is not None:
            unclear = strange.text if strange else wish.verb
            return Ask(f"I do not understand what “{unclear}” is in this. Can you say it otherwise?")
        twice = next((f for f in wish.fillers if len(wish.all(f.role)) > 1 and f.role not in "AMPE"), None)
        if twice is not None:
            both = " and ".join(f"“{filler.text}”" for filler in wish.all(twice.role))
            return Ask(f"I do not understand how {both} go together here. Can you say it otherwise?")
        alone = wish.frame in _BY_ITSELF and wish.frame not in self.skills
        return self._cannot(wish) if alone else None  # whatever it is to be done to

    def _values(self, wish: Wish) -> dict[str, Value] | Ask:
        """What the roles of a wish hold."""
        values: dict[str, Value] = {}
        self._excepted(wish)
        for filler in wish.fillers:
            itself = filler.words[-1] in _ITSELF.get(wish.frame, ())
            if filler.role in "OE" or (filler.role == "T" and itself):
                continue
            value = self.value(wish, filler)
            if isinstance(value, Ask):
                return value
            if value is not None:
                values[filler.role] = value
        if self.left_out:
            return Ask(_LEFT_OUT_OF.format(" ".join(self.left_out)))
        return values

    def _excepted(self, wish: Wish) -> None:
        """Take up what is left out of the next set."""
        said = [word for filler in wish.all("E") for word in filler.words]
        self.left_out += tuple(word for word in said if word not in self.lexicon.classes["excepting"])

    def _owned(self, wish: Wish, own: OwnAction) -> list[Deed] | Ask:
        """The deeds of an action of the robot's own: one, or one for each of a set."""
        fillers = (one.filler for one in own.fills if one.parameter.kind in ("place", "thing"))
        several = next((f for f in fillers if self.names_set(f)), None)
        value = self._thing("DO", several, Mention("none", several.text)) if several is not None else None
        if isinstance(value, Ask):
            return value
        found: list[Deed] = []
        for one in value.each or (value,) if value is not None and self.bound is None else (self.bound,):
            before, self.bound = self.bound, one
            made = owned(own, self._grounds)
            self.bound = before
            if isinstance(made, Ask):
                return made
            if self.left_out:
                return Ask(_LEFT_OUT_OF.format(" ".join(self.left_out)))
            looks = "looks" in own.action.effects and "GO" in self.skills
            found += [*self.way_to_thing(one or self.last_thing if looks else None), *made]
        return found

    def _grounds(self, filler: Filler, kind: Kind, about: frozenset[str]) -> tuple[str, str] | Ask:
        """What words mean for an input of an action of the robot's own, of which more is said `about` it."""
        filler = self._within(filler, about)
        mention = link(filler.words, filler.head, self.situation.objects, self.lexicon)
        if self.bound is not None and self.names_set(filler):
            return self.bound.argument, self.bound.said
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
                self.used(found.place)
                text = where.things[0].description
                found = Value(text, with_article(text), where.things)
        self.last_thing = found if kind != "person" else self.last_thing
        return found.argument, found.said

    def _within(self, filler: Filler, about: frozenset[str]) -> Filler:
        """What remains without a part that says again what the action is about: "the door of crate 2"."""
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

    @property
    def each(self) -> tuple[Value, ...]:
        """The things of the set that the last wish was about."""
        return self.whole.each if self.whole is not None else ()

    def _for_each(self, wish: Wish, values: dict[str, Value], several: Value) -> list[Deed] | Ask:
        """The same for one after the other."""
        if wish.frame == "FIND" and several is values.get("L"):
            return self._searched(wish, values)
        found: list[Deed] = []
        for one in several.each:
            made = self._planned(
                wish, {role: one if value is several else value for role, value in values.items()}
            )
            if isinstance(made, Ask):
                return made
            found += made
        self.last_thing = several
        return found

    def _searched(self, wish: Wish, values: dict[str, Value]) -> list[Deed] | Ask:
        """Looking for something at several places: for boxes at each, for the red one until it is seen."""
        places = values["L"]
        if asked(f"{places.argument} for {values['T'].argument}").unwanted and "LOOK" in self.skills:
            for_it = {"T": places, "K": values["T"]}
            parts = [self._looked_through({**for_it, "T": place}) for place in places.each]
        else:
            parts = [self._planned(wish, {**values, "L": place}) for place in places.each]
        found: list[Deed] = []
        seen: Deed | None = None
        for made in parts:
            if isinstance(made, Ask):
                return made
            found += made if seen is None else [replace(deed, check=seen, holds=False) for deed in made]
            seen = found[-1] if made[-1].frame == "FIND" else None
        self.last_thing, self.last_check = values["T"], None  # no single look says whether it was seen
        return found

    def times(self, wish: Wish) -> int | Ask:
        """How often a wish is to be done."""
        often = wish.all("O")
        shots = wish.verb.split()[1:-1] if wish.frame == "PHOTO" else []  # "take two pictures"
        text = often[0].text if often else next((word for word in shots if amount_of([word]) is not None), "")
        if not text:
            return 1
        words = [word for word in text.split() if word not in ("times", "rounds", "time", "for")]
        amount = amount_of(words) if words else None
        count = int(amount.value) if amount is not None and amount.kind == "number" else 0
        if len(often) > 1 or not 1 <= count <= _MOST_TIMES:
            return Ask(f"I cannot do that “{text}” by myself. Shall I do it once, now?")
        return count

    def _beyond(self, filler: Filler) -> str:
        """What in a role cannot be planned yet: a place between two, an alternative."""
        if filler.role in "XKMAP":
            return ""
        if "between" in filler.words and not self.is_placed(filler):
            return "“between”"
        return "“or”" if "or" in filler.words else ""

    def check(self, part: Part) -> Look | Ask:
        """The deeds that find out whether a condition holds."""
        goes = next(
            (w for w in part.reading.wishes if w.act == "order" and w.frame == "GO" and w.has("G")), None
        )
        if goes is not None and goes.start > 1:
            return Ask(f"Where does it end, what “{part.text}” depends on? Please say it in two sentences.")
        return check(self, part.low, part.text)

    def _planned(self, wish: Wish, values: dict[str, Value]) -> list[Deed] | Ask:
        missing = self._missing(wish, values)
        if missing is not None:
            return missing
        if wish.frame == "GO":
            leads_back = not values and {*wish.verb.split()} & {"back", "return"}
            return self.way_back() if leads_back else self.way(values.get("G") or values.get("L"))
        if wish.frame == "WAIT":
            return self.wait(wish, values)
        if wish.frame == "LOOK" and "K" in values and self._states(wish):
            return self._checked(wish, values)
        if wish.frame == "LOOK" and {*values} == {"T"} and self._is_room(values["T"]):
            return self._looked_around(wish, values["T"])
        if wish.frame == "LOOK" and "K" in values and {*"TL"} & {*values}:
            return self._looked_through(values)
        for role in "GH":
            if wish.frame == "FACE" and role in values:
                values["T"] = values.pop(role)
        meant = self.as_meant(wish, values)
        if isinstance(meant, Ask):
            return meant
        searched = self.searched(*meant)
        made = self._by_action(*meant)
        return made if isinstance(made, Ask) else [*searched, *made]

    def _by_action(self, wish: Wish, values: dict[str, Value]) -> list[Deed] | Ask:
        """By the action that is made for it, or by several."""
        skill = self.skills.get(wish.frame)
        if skill is not None and "T" in values and self.lexicon.frames[wish.frame].roles.get("T") == "thing":
            skill = skill.fitting(self.is_person(wish.all("T"), values["T"]))
        other = _BY_HAND.get(wish.frame) if "TAKE" in self.skills else None
        handled = wish.frame in (*HANDLED, "BRING") and "T" in values
        if handled and (which := self._not_held(wish, values)) is not None:
            return which
        if skill is not None and (other is None or not self._is_fetched(wish, values)):
            return self.direct(wish, skill, values)
        other = other or _WAYS.get(wish.frame)
        if other is not None:
            return other(self, values)
        return self._cannot(wish)

    def _cannot(self, wish: Wish) -> Ask:
        """That no action does what is wanted."""
        if wish.frame == "PUT":
            return Ask("I have no arm. I can go there and tell you what I see.")
        what = wish.verb if wish.frame == "DO" and wish.verb else self.lexicon.frames[wish.frame].gloss
        return Ask(f"I have no action to {what}. What else can I do for you?")

    def _not_held(self, wish: Wish, values: dict[str, Value]) -> Ask | None:
        """The question what is meant by "it", which was a place or a thing of an earlier message."""
        thing = values["T"]
        if "S" in values and wish.frame == "GIVE" and "TAKE" not in self.skills:
            return Ask("I cannot pick things up.")
        said = wish.all("T")[0].words
        if said[0] in TITLES | {"miss"} or is_somebody(said[wish.all("T")[0].head]):
            return Ask(f"I do not pick up people. What shall I do with {thing.said}?")
        if thing.things and wish.frame in ("GIVE", "PUT") and all(map(is_place, thing.things)):
            return Ask(f"I cannot bring {thing.said}. What shall I do there?")
        before = self.before is not None and thing.things == (self.before,)
        if (
            not (before and {*said} <= self.lexicon.classes["pronouns"] and "TAKE" in self.skills)
            or thing.argument in self.held
        ):
            return None
        return Ask(f"What do you mean by “{wish.all('T')[0].text}”? Please say its name.")

    def _is_fetched(self, wish: Wish, values: dict[str, Value]) -> bool:
        """Whether something is to be handed over that is not held yet, or to somebody who is elsewhere."""
        thing = values.get("T")
        if thing is None or wish.frame == "TAKE" or (wish.frame == "PUT" and thing.argument in self.held):
            return False
        there = thing.things or thing.place or {*"SL"} & {*values} or self.sought[1] == thing.argument
        return wish.frame == "GIVE" or (bool(there) and self.finding() is not None)

    def _missing(self, wish: Wish, values: dict[str, Value]) -> Ask | None:
        """What has to be said before a wish is certain."""
        if wish.frame in ("MOVE", "TURN"):
            return self._steering(wish, values)
        skill = self.skills.get(wish.frame)
        if wish.frame == "SAY" and skill is not None:
            return spoken(wish, values, self)
        if wish.frame == "FOLLOW" and skill is not None and skill.is_for_persons:
            return followed(wish, values, self)
        if wish.frame == "GO" and "N" in values and "G" in values:
            return Ask(f"Shall I go to {values['G'].said}, or only {values['N'].said} in that direction?")
        things = values["T"].things if "T" in values else ()
        if wish.frame == "BRING" and things and all(map(is_place, things)):
            return Ask(f"I cannot bring {values['T'].said}. What shall I do there?")
        if wish.frame != "BRING" or {"R", "G"} & set(values) or wish.verb.split()[0] in _TO_ME:
            return None
        if not self.is_handed_on(values):
            return Ask("Where shall I bring it?")
        return None

    @staticmethod
    def _states(wish: Wish) -> bool:
        """Whether it is to be seen if something is so: "whether ...", "make sure ..."."""
        sure = "sure" in wish.verb.split() and not wish.has("TL") and len(wish.all("K")[0].words) > 2
        return sure or wish.all("K")[0].words[0] in ("if", "whether", "that")

    def _checked(self, wish: Wish, values: dict[str, Value]) -> list[Deed] | Ask:
        """Looking whether something is so."""
        thing, said = values.get("T") or values.get("L"), wish.all("K")[0]
        if said.words[0] == "that" and any(filler.end == said.start for filler in wish.fillers):
            return Ask(f"I do not understand what “{said.text}” belongs to. Can you say it in other words?")
        way = self.way_to_thing(thing)
        self.last_thing = thing or self.last_thing
        opens = said.words[0] in ("if", "whether", "that")
        looked = check(self, said.words[opens:], said.text.partition(" ")[2] if opens else said.text)
        return looked if isinstance(looked, Ask) else [*way, *looked.deeds]

    def _is_room(self, value: Value) -> bool:
        return bool(value.things) and {*value.things} <= {*self.situation.rooms}

    def _looked_around(self, wish: Wish, room: Value) -> list[Deed] | Ask:
        """Looking around in a room: at what there is to be seen, for nothing is missing there."""
        way, what = self.way_to_thing(room), f"what can be seen in {room.said}"
        made = self._by_action(wish, {"K": Value(what, what)})
        return made if isinstance(made, Ask) else [*way, *made]

    def _looked_through(self, values: dict[str, Value]) -> list[Deed] | Ask:
        """Looking through something for something else: "check the yard for leaks"."""
        place, skill = values.get("T") or values["L"], self.skills.get("LOOK")
        slot = skill.roles.get("T") or skill.roles.get("K") if skill is not None else None
        if skill is None or not slot:
            return Ask(f"I have no action to look through {place.said}.")
        sought = values["K"].argument.removeprefix("for ")
        said = {"T": place.said, "K": f"for {sought}"}
        deed = Deed("LOOK", skill, {slot: f"{place.argument} for {sought}"}, said)
        self.last_check = deed
        return [*self.way_to_thing(place), deed]

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
        if (which := self._turned_around(values)) is not None:
            return which
        if "N" not in values and values["H"].argument == "back" and {*wish.verb.split()} & _RETURNING:
            return Ask("Back to which place? Or how far shall I move back?")
        if "N" in values or values["H"].argument == "around" or self._may_stay_open(wish.frame):
            return None
        return Ask("By how many degrees shall I turn?" if wish.frame == "TURN" else "How far shall I move?")

    def _may_stay_open(self, frame: str) -> bool:
        """Whether the action knows by itself how far, and it is only on the way to what is wanted there."""
        skill, behind = self.skills.get(frame), self.behind
        slot = skill.roles.get("N", "") if skill is not None else ""
        wanted = behind is not None and behind.has("TK") and behind.frame not in (*_ONCE, "FACE", "PHOTO")
        return wanted and skill is not None and slot in skill.action.optional

    def _turned_around(self, values: dict[str, Value]) -> Ask | None:
        """For "turn around" where an action knows but left and right: half a turn."""
        skill = self.skills.get("TURN")
        slot = slot_of(skill, "H", values) if skill is not None and values["H"].argument == "around" else None
        choices = parameters_of(skill.action)[slot].choices if skill is not None and slot else ()
        if "left" not in choices or "around" in choices:
            return None
        if "N" in values:
            return Ask("To the left or to the right?")
        values["H"] = Value("left", "left")
        values["N"] = Value("180 degrees", "180 degrees", amount=Amount(180, "degrees"))
        return None


_WHATEVER = word_set("what whatever who whoever")
_STANDING = {
    "BRING": "TR", "TAKE": "T", "GIVE": "TR", "FIND": "T", "FOLLOW": "T", "PHOTO": "T", "GUIDE": "T",
    "SAY": "R", "PUT": "T", "ANSWER": "R", "COUNT": "T", "LOOK": "T",
}  # fmt: skip
"""Who or what may stand somewhere that is said with the name."""
_CLAUSE = word_set("'s ' how what whether who whoever whatever which where when rest")
"""Words with which a description begins that is more than a name."""
_RETURNING = frozenset({"go", "come", "get", "head", "drive", "return"})
_ITSELF = {frame: frozenset({"yourself", "itself"}) for frame in ("CONNECT", "DISC")}
_ITSELF["CHARGE"] = frozenset({"yourself", "itself", "battery", "batteries"})
"""What is not a thing but the robot that does it, by frame."""
_TO_ME = frozenset({"bring", "fetch", "get", "retrieve", "go", "give", "want", "find"})
"""Verbs of bringing that mean the speaker if nobody is named."""
_ONCE = frozenset({"SAY", "ASK", "WAIT", "TURN", "MOVE", "CONNECT", "DISC", "MIX", "ANSWER", "FOLLOW"})
"""What is not done to one thing after the other."""


_BY_ITSELF = word_set("OPEN CLOSE ON OFF CONNECT DISC CLEAN POUR CUT MIX COOK MAKE")
"""Frames that are done by an action of their own or not at all."""
_WAYS = {"FIND": Builder.look_for, "TAKE": Builder.take, "BRING": Builder.bring, "GIVE": Builder.bring}
"""How frames are done without an action of their own."""
_BY_HAND = {"TAKE": Builder.take, "GIVE": Builder.bring, "PUT": Builder.bring}
"""How they are done with one, where the robot has hands."""
