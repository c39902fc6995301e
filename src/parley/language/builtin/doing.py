"""What is done by the action that is made for it: what its inputs hold, and where it is done."""

from __future__ import annotations

from dataclasses import dataclass

from parley.language.builtin.checks import seen_at
from parley.language.builtin.decision import Ask, Deed
from parley.language.builtin.grounding import Value
from parley.language.builtin.handling import Handling
from parley.language.builtin.lexicon import stem
from parley.language.builtin.skills import Skill
from parley.language.builtin.spans import Filler
from parley.language.builtin.ways import typed
from parley.language.builtin.wishes import Wish
from parley.umrf.kinds import parameters_of, words_of_name

__all__ = ["Doing", "slot_of"]


@dataclass(slots=True)
class Doing(Handling):
    """Makes the deeds of one action, with the way to where it is done."""

    def direct(self, wish: Wish, skill: Skill, values: dict[str, Value]) -> list[Deed] | Ask:
        """By the action that is made for it."""
        arguments: dict[str, str | float] = {}
        said: dict[str, str] = {}
        before = self._to_people(wish, values)
        gloss = self.lexicon.frames[wish.frame].gloss
        for role, value in values.items():
            slot = slot_of(skill, role, values)
            if slot is not None and role == "T" and "L" in values and self._takes_place(skill, slot, value):
                slot = None  # "how many boxes are on the shelf": the shelf is what is counted through
            if slot is not None and slot not in arguments:
                given = typed(value, skill.action, slot)
                if given is None:
                    return Ask(f"I cannot {gloss} with “{value.said}”. Can you say it otherwise?")
                arguments[slot], said[role] = given, value.said
                continue
            led = self._without_slot(wish, role, value, skill)
            if isinstance(led, Ask):
                return led
            before += led
        if set(skill.action.inputs) - set(arguments) - set(skill.action.optional):
            return Ask(f"I can {gloss}, but I need to know more: what, or where?")
        way = self._to_be_there(wish, skill, values)
        if isinstance(way, Ask):
            return way
        if wish.frame in ("TAKE", "FIND") and "T" in values:
            self.held += [values["T"].argument] if wish.frame == "TAKE" else []
            self.in_hand = values["T"] if wish.frame == "TAKE" else self.in_hand
            self.sought = (self.at, values["T"].argument)
        deed = Deed(wish.frame, skill, arguments, said)
        if "looks" in skill.action.effects or wish.frame in ("LOOK", "FIND"):
            self.last_check = deed
        return [*before, *way, deed]

    @staticmethod
    def _takes_place(skill: Skill, slot: str, value: Value) -> bool:
        """Whether an input takes a place, and a value is none."""
        return parameters_of(skill.action)[slot].kind == "place" and not (value.things or value.place)

    def _to_people(self, wish: Wish, values: dict[str, Value]) -> list[Deed]:
        """The way to whom something is done with, if it was told where they are."""
        who = "R" if wish.frame in ("SAY", "GIVE", "ANSWER") else "T"
        person = values.get(who)
        if wish.frame not in _TO_PEOPLE or person is None or "GO" not in self.skills:
            return []
        if (where := values.get("L") or (values.get("S") if wish.frame == "FOLLOW" else None)) is not None:
            way = self.nearing(where)
        else:
            now = person.place is not None and person.place.memory not in self.situation.memory
            told = person.place is not None if wish.frame == "SAY" else wish.frame == "GIVE"
            way = self.way_to_thing(person if told or now else None)  # who is led may be called
        return [] if isinstance(way, Ask) or not way else [*way, *self.met(person, wish.one(who))]

    def _without_slot(self, wish: Wish, role: str, value: Value, skill: Skill) -> list[Deed] | Ask:
        """What comes of a role that no input of an action takes: a way, or nothing at all."""
        meant = role == "T" and self._is_meant_anyway(wish, skill)
        if meant or (wish.frame in ("SAY", "ANSWER") and role == "R" and self.at):
            return []
        there = role in "SL" or wish.frame in ("CHARGE", "PUT")
        way = self.nearing(value) if there and "GO" in self.skills else None
        if isinstance(way, list):
            return way
        if wish.frame in _LOOSE:
            self.unheeded(value.said)
        elif value.argument != "operator" or wish.frame in _TOLD:
            gloss = self.lexicon.frames[wish.frame].gloss
            return way or Ask(f"I can {gloss}, but I do not know what to do about {value.said}.")
        return []

    def _to_be_there(self, wish: Wish, skill: Skill, values: dict[str, Value]) -> list[Deed] | Ask:
        """The way to what is looked at, or handled by an action of which only the name is known."""
        goes = skill.is_only_named and wish.frame in _ON_THE_SPOT
        if wish.frame == "FIND" and ("L" in values or self.at):
            return []
        if not ("looks" in skill.action.effects or goes) or "GO" not in self.skills:
            return []
        seen = (values.get("G") if goes else None) or values.get("T") or self._seen_in(wish.one("K"))
        return seen if isinstance(seen, Ask) else self.way_to_thing(seen)

    def _is_meant_anyway(self, wish: Wish, skill: Skill) -> bool:
        """Whether a thing is what an action is about by its name: "the boxes" where it counts boxes."""
        about = {stem(word) for word in words_of_name(f"{skill.action.name} {skill.action.description}")}
        small = self.lexicon.classes["determiners"]
        return all(stem(word) in about for f in wish.all("T") for word in f.words if word not in small)

    def _seen_in(self, filler: Filler | None) -> Value | Ask | None:
        """Where "how it is" is seen: what that names, else what was spoken of, else where it is."""
        place = seen_at(self, filler.words) if filler is not None else None
        if filler is None or place is not None or self.at or {*filler.words} & _ABOUT_HERE:
            return place
        return Ask(f"Where shall I look {filler.text}?")


def slot_of(skill: Skill, role: str, values: dict[str, Value]) -> str | None:
    """The parameter for a role: its own, else that of a like role that nothing else fills."""
    if role in skill.roles:
        return skill.roles[role]
    if role == "S" and "G" not in values:
        return None  # "from the ramp" is no goal
    like = (other for other in _ALIKE.get(role, "") if other in skill.roles and other not in values)
    return next((skill.roles[other] for other in like), None)


_ALIKE = {"G": "RL", "R": "G", "K": "T", "T": "KX", "S": "G", "L": "S", "H": "T"}
"""Which other role's parameter takes what a role holds, if it is free."""
_ABOUT_HERE = frozenset({"you", "here", "there", "i"})
_TO_PEOPLE = frozenset({"SAY", "GIVE", "FOLLOW", "GUIDE", "ANSWER"})
"""What is done with somebody: where they are."""
_ON_THE_SPOT = frozenset({"LOOK", "PHOTO", "TAKE", "PUT", "FIND"})
"""What is done where the thing is: an action of which only the name is known may not drive there itself."""
_LOOSE = frozenset({"FOLLOW", "PHOTO"})
"""What is done all the same if a part of it has no place in the action; that is said."""
_TOLD = frozenset({"SAY", "ANSWER", "GIVE", "BRING"})
"""What is done for somebody in particular."""
