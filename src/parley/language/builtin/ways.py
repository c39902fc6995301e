"""Ways and waits: how the robot comes to a place, and how it stays there."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from parley.language.builtin.amounts import amount_of, in_unit
from parley.language.builtin.decision import Ask, Deed, Note
from parley.language.builtin.facts import Place
from parley.language.builtin.grounding import Grounder, Value
from parley.language.builtin.saying import with_article
from parley.language.builtin.skills import Skill
from parley.language.builtin.things import link
from parley.language.builtin.wishes import Wish
from parley.messages.status import ActionInfo
from parley.umrf.kinds import parameters_of

__all__ = ["Ways", "typed"]

_AMOUNTS = frozenset({"distance", "angle", "duration", "number"})


@dataclass(slots=True)
class Ways(Grounder):
    """Makes the deeds that bring the robot somewhere, or keep it there."""

    def way(self, goal: Value | None) -> list[Deed] | Ask:
        """The deeds that lead to a goal."""
        skill = self.skills.get("GO")
        if skill is None or goal is None:
            return Ask("Where to?" if skill else "I cannot drive anywhere.")
        if goal.place is not None:
            self.used(goal.place)
            text = " ".join(goal.place.where)
            mention = link(goal.place.where, goal.place.head, self.situation.objects, self.lexicon)
            inside = self.inside(goal.place.where) if mention.kind != "one" else None
            things = (inside,) if inside is not None else mention.things
            text = things[0].description if inside is not None or mention.kind == "one" else text
            goal = Value(text, with_article(text), things)
        self.at = goal.argument
        said = {"G": goal.said}
        if goal.point is not None and skill.takes_pose:
            return [self._driven(skill, *goal.point, 0.0, goal.said)]
        if not skill.takes_pose:
            slot = skill.roles.get("G")
            if slot is None:
                return Ask("Where to?")
            counts = parameters_of(skill.action)[slot].kind in _AMOUNTS
            given = typed(goal, skill.action, slot) if counts else goal.argument
            if given is None:
                return Ask(f"I cannot tell by a number where {goal.said} is.")
            return [Deed("GO", skill, {slot: given}, said)]
        locate = self.skills.get("LOCATE")
        if locate is None or not locate.roles:
            return Ask("I cannot find out where that is.")
        if goal.argument == "operator" or not goal.things:
            what = "you" if goal.argument == "operator" else goal.said
            unknown = f"I do not know where {what} is." if what != "you" else "I do not know where you are."
            return Ask(f"{unknown} Which place is it near?", where=what)
        return [
            Deed("GO", locate, {next(iter(locate.roles.values())): goal.argument}, said, hidden=True),
            Deed("GO", skill, {}, said),
        ]

    def way_back(self) -> list[Deed] | Ask:
        """The way to where the robot is now; where nothing comes before that, to where it was sent from."""
        skill, pose, said = self.skills.get("GO"), self.situation.robot_pose, "where I am now"
        if not self.at:
            orders = self.situation.dialogue.orders if self.last_check is None else ()
            pose, said = orders[-1].pose if orders else None, "where you sent me from"
        if skill is None or pose is None or not skill.takes_pose:
            return Ask("Where shall I go back to?")
        self.at = ""
        driven = self._driven(skill, pose.x_m, pose.y_m, pose.yaw_rad, said)
        return [replace(driven, text=f"come back to {said}")]

    @staticmethod
    def _driven(skill: Skill, x_m: float, y_m: float, yaw_rad: float, said: str) -> Deed:
        """Driving to where nothing has to be found."""
        ends = {"position::x": x_m, "position::y": y_m, "orientation::y": yaw_rad}
        given: dict[str, str | float] = {
            name: next((value for end, value in ends.items() if name.endswith(end)), 0.0)
            for name in skill.action.inputs
        }
        return Deed("GO", skill, given, {"G": said})

    def way_to_thing(self, thing: Value | None) -> list[Deed]:
        """The way to what is to be looked at, if it is known where that is."""
        if thing is None or not (thing.things or thing.place or thing.point):
            return []
        if len(thing.things) == 1 and thing.argument not in (thing.things[0].description, thing.things[0].id):
            whole = self._one_of(thing.things)  # the way to a part is that to the whole
            thing = whole if isinstance(whole, Value) else thing
        way = self.nearing(thing)
        return [] if isinstance(way, Ask) else way

    def nearing(self, thing: Value) -> list[Deed] | Ask:
        """The way to something, unless the robot is there already."""
        before = self.at
        way = self.way(thing)
        return [] if before and self.at == before else way

    def used(self, place: Place) -> None:
        """That a memory was used is said."""
        if place.memory not in self.situation.memory:
            return  # it was told just now
        told = [note.source for note in self.notes if note.source]
        fact = f"{place.memory.data.rstrip('.')}."
        if place.memory.name not in told:
            text = fact[:1].upper() + fact[1:] if told else f"I remember: {fact}"
            self.notes.append(Note(text, place.memory.name))

    def waiting(self, text: str, words: Sequence[str]) -> Deed | Ask:
        """Waiting: by an action for it, else until a person says when.

        Args:
            text: How the reply says it.
            words: How long; empty if it is no span of time.
        """
        skill, ask = self.skills.get("WAIT"), self.skills.get("ASK")
        amount = amount_of(words) if words else None
        if skill is not None and amount is not None and amount.kind == "duration" and "D" in skill.roles:
            slot = skill.roles["D"]
            given = typed(Value(text, text, amount=amount), skill.action, slot)
            if given is not None:
                return Deed("WAIT", skill, {slot: given}, {"D": text})
        if ask is None or not ask.roles:
            return Ask(f"I cannot wait {text} by myself. What shall I do now?")
        question = f"Please tell me when I may go on: I am to wait {text}."
        return Deed(
            "WAIT", ask, {next(iter(ask.roles.values())): question}, {"D": f"{text} (please tell me when)"}
        )

    def wait(self, wish: Wish, values: dict[str, Value]) -> list[Deed] | Ask:
        """Being somewhere for a while: the way there, then a wait if there is something to wait for."""
        place = values.get("L") or values.get("G") or values.get("T")
        if not values and wish.verb in ("stop", "halt") and not wish.has("U"):
            return Ask("Shall I drop what I am doing?") if self.situation.queue else []
        way = self.nearing(place) if place is not None and place.argument != "operator" else []
        if isinstance(way, Ask):
            return way
        until = wish.one("U")
        words = wish.one("D")
        text = f"until {until.text}" if until else f"for {values['D'].said}" if "D" in values else ""
        if until and until.words[0] in ("until", "till"):
            text = until.text
        waited = self.waiting(text or "here", words.words if words and not until else ())
        if isinstance(waited, Ask):
            return [*way] if way and not text else waited
        return [*way, waited if text else replace(waited, open_ended=True)]


def typed(value: Value, action: ActionInfo, slot: str) -> str | float | None:
    """What is given to an input, in its unit; None if it is none of its type, or not among its choices."""
    kind, told = action.inputs[slot], parameters_of(action)[slot]
    if kind == "string":
        named = {choice.lower(): choice for choice in told.choices}
        return named.get(value.argument.lower()) if named else value.argument
    if kind != "number" or value.amount is None:
        return None
    return in_unit(value.amount, told.unit)
