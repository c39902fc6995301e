"""What is taken, carried and handed over: by actions of the robot's own, else with the help of a person."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from parley.language.builtin.decision import Ask, Deed
from parley.language.builtin.grounding import Value
from parley.language.builtin.lexicon import is_somebody
from parley.language.builtin.skills import Skill
from parley.language.builtin.spans import Filler
from parley.language.builtin.ways import Ways
from parley.language.builtin.wishes import Wish
from parley.umrf.kinds import is_word_for
from parley.world.object_map import MapObject

__all__ = ["HANDLED", "Handling", "is_place"]

HANDLED = ("TAKE", "GIVE", "PUT")
"""What is done with a thing by hand, where the robot has one."""


def is_place(thing: MapObject | None) -> bool:
    """Whether a thing of the map is a place by its class or by a word of its name."""
    words = {*thing.class_name.split(), *thing.description.lower().split()} if thing is not None else set()
    return any(is_word_for(word, "place") for word in words)


@dataclass(slots=True)
class Handling(Ways):
    """Makes the deeds by which things come from one place to another."""

    held: list[str] = field(default_factory=list)
    """What the robot has taken in this message."""
    in_hand: Value | None = None
    """What of that it took last."""
    sought: tuple[str, str] = ("", "")
    """Where and what was looked for last."""

    def as_meant(self, wish: Wish, values: dict[str, Value]) -> tuple[Wish, dict[str, Value]] | Ask:
        """A wish with the frame that what it is about asks for: people are led, and not carried."""
        who, said = values.get("T"), wish.one("T")
        if wish.frame not in ("BRING", "TAKE") or who is None or said is None:
            return wish, values
        known = who is self.last_person or {*said.words} <= self.lexicon.classes["persons"]
        known, goal = known or is_somebody(said.words[said.head]), values.get("G") or values.get("R")
        if known and "GUIDE" in self.skills:
            if goal is None:
                return Ask(f"Where shall I lead {who.said}?")
            led = {role: value for role, value in values.items() if role in "TS"}
            return replace(wish, frame="GUIDE"), led | {"G": goal}
        if wish.frame == "BRING" and "BRING" in self.skills and self.is_handed_on(values):
            return replace(wish, frame="TAKE"), {r: value for r, value in values.items() if r in "TSL"}
        if "G" not in values or "GUIDE" not in self.skills or who.things or not self.is_person([said], who):
            return wish, values
        return Ask(f"Is {who.said} somebody I shall lead there, or a thing I shall carry?")

    def is_handed_on(self, values: Mapping[str, Value]) -> bool:
        """Whether what is fetched is wanted elsewhere: "fetch the box and put it on the desk"."""
        to, behind = values.get("R") or values.get("G"), self.behind
        thing = behind.one("T") if behind is not None else None
        if behind is None or thing is None or "TAKE" not in self.skills or "G" in values:
            return False
        on = behind.frame in ("BRING", "GIVE", "PUT") and {*thing.words} <= self.lexicon.classes["pronouns"]
        return on and (to is None or to.argument == "operator")

    def searched(self, wish: Wish, values: Mapping[str, Value]) -> list[Deed]:
        """A look for what is to be handled where nobody knows where it is and an action searches."""
        thing, find = values.get("T"), self.skills.get("FIND")
        find = find.fitting(person=False) if find is not None else None
        if thing is None or wish.frame not in (*HANDLED, "BRING") or find is None or "T" not in find.roles:
            return []
        known = (
            thing.things
            or thing.place
            or thing.each
            or {*("S" if "R" in values else "SL")} & {*values}
            or (self.at and wish.frame != "GIVE")
        )
        if known or thing.argument in self.held or self.sought[1] == thing.argument:
            return []
        self.sought = (self.at, thing.argument)
        return [Deed("FIND", find, {find.roles["T"]: thing.argument}, {"T": thing.said})]

    def look_for(self, values: Mapping[str, Value]) -> list[Deed] | Ask:
        """The way to something, and a look for it."""
        thing, find = values.get("T"), self.finding()
        if thing is None or find is None:
            return Ask("I cannot look for things." if find is None else "What shall I look for?")
        way: list[Deed] | Ask = []
        if "L" in values or "S" in values:
            way = self.nearing(values.get("L") or values["S"])
        elif thing.place is not None or thing.things:
            way = self.nearing(thing)
        elif not self.at and self.sought != (self.at, thing.argument):
            return Ask(f"I do not know where to find {thing.said}. Where shall I look?", where=thing.said)
        if isinstance(way, Ask) or self.sought == (self.at, thing.argument):
            return way
        deed = Deed("FIND", find, {next(iter(find.roles.values())): thing.argument}, {"T": thing.said})
        self.last_check, self.sought = deed, (self.at, thing.argument)
        return [*way, deed]

    def finding(self) -> Skill | None:
        """The action by which things are found."""
        find = self.skills.get("FIND")
        find = find.fitting(person=False) if find is not None else None
        return find if find is not None and find.roles else self.skills.get("LOOK")

    def take(self, values: Mapping[str, Value]) -> list[Deed] | Ask:
        """Taking something where it is; by hand of a person if the robot has none."""
        thing, skill, ask = values.get("T"), self.skills.get("TAKE"), self.skills.get("ASK")
        slot = skill.roles.get("T") if skill is not None else None
        fixed = thing is not None and thing.things and all(map(is_place, thing.things))
        if thing is None or fixed or not (slot or (ask is not None and ask.roles)):
            return Ask("I cannot pick things up." if thing else "What shall I take?")
        found = self.look_for(values)
        if isinstance(found, Ask):
            return found
        self.held.append(thing.argument)
        self.in_hand = thing
        if skill is not None and skill.is_by_hand:
            found = [deed for deed in found if deed.frame == "GO"]  # it sees for itself
        if skill is not None and slot:
            return [*found, Deed("TAKE", skill, {slot: thing.argument}, {"T": thing.said})]
        assert ask is not None
        question = f"I cannot pick things up. Please put {thing.said} on me and tell me when it is done."
        asked = {next(iter(ask.roles.values())): question}
        return [*found, Deed("ASK", ask, asked, {"R": "you", "X": f"to put {thing.said} on me"})]

    def bring(self, values: Mapping[str, Value]) -> list[Deed] | Ask:
        """Taking something, the way to who or what it is for, and handing it over if an action does that."""
        if not {*"RG"} & {*values} and "TAKE" in self.skills:
            if self.behind is not None and self.behind.frame in ("BRING", "GIVE", "PUT"):
                return self.take(values)  # "fetch the box and give it to Kim"
            values = {**values, "R": self.speaker()}
        goal, thing = values.get("R") or values.get("G"), values.get("T")
        if goal is None or thing is None:
            return Ask("Where shall I bring it?" if thing is not None else "What shall I bring?")
        if (thing.things and thing.things == goal.things) or thing.argument == goal.argument:
            return Ask(f"What shall I bring to {goal.said}?")
        taken: list[Deed] | Ask = []
        if thing.argument not in self.held:
            taken = self.take(
                {role: values[role] for role in ("TS" if "R" in values else "TSL") if role in values}
            )
        way = self._way_to(goal, values) if not isinstance(taken, Ask) else []
        if isinstance(taken, Ask) or isinstance(way, Ask):
            return taken if isinstance(taken, Ask) else way
        over = (self.skills.get("GIVE") if "R" in values else None) or self.skills.get("PUT")
        if "TAKE" not in self.skills or over is None or "T" not in over.roles:
            return [*taken, *way] if way else Ask(f"I cannot hand over {thing.said}. Where shall I bring it?")
        role = "R" if "R" in values else "G"
        slot = over.roles.get(role)
        given = {over.roles["T"]: thing.argument, **({slot: goal.argument} if slot else {})}
        return [*taken, *way, Deed(over.frame, over, given, {"T": thing.said, role: goal.said})]

    def _way_to(self, goal: Value, values: Mapping[str, Value]) -> list[Deed] | Ask:
        """The way to who or what something is for; somebody who may be anywhere is looked for."""
        if "TAKE" not in self.skills or "R" not in values:
            return self.way(goal)
        if (where := values.get("L") or values.get("G")) is not None:
            return self.nearing(where)
        if goal.place is not None or goal.things:
            return self.nearing(goal)
        return [] if goal.argument == "operator" else self.met(goal, None) or self.way(goal)

    def met(self, who: Value, filler: Filler | None) -> list[Deed]:
        """A look for somebody who is only described: "the man in the hall"; a name is called."""
        find = self.skills.get("FIND")
        find = find.fitting(person=True) if find is not None else None
        described = filler is None or (
            is_somebody(filler.words[filler.head]) and not {*filler.words} & {"everyone", "everybody", "all"}
        )
        if find is None or not find.names_person or not described or who.argument == "operator":
            return []
        return [Deed("FIND", find, {next(iter(find.roles.values())): who.argument}, {"T": who.said})]
