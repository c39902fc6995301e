"""Steps that bring the robot somewhere, and what all tasks share."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, field, replace

from parley.language.offline.facts.remembering import find_fact
from parley.language.offline.scene.scene import OPERATOR, Place, Scene, UnclearError
from parley.language.offline.tasks.catalogue import Catalogue, call, parameter_role, text_inputs
from parley.language.offline.tasks.commands import Command
from parley.language.offline.tasks.fill import arguments
from parley.language.offline.tasks.roles import number_inputs, pose_inputs
from parley.language.offline.words.naming import name_words
from parley.language.offline.words.nouns import bare, noun_phrase
from parley.language.offline.words.saying import the, where_is
from parley.language.offline.words.text import Phrase, keys, lemma, plain, singular, tokens
from parley.messages.chat import ActionCall
from parley.messages.status import ActionInfo
from parley.world.geometry import Pose2D

__all__ = ["FORWARD", "Going", "UnableError", "coordinates", "pose_values"]

FORWARD = frozenset(["forward", "forwards", "backward", "backwards", "ahead", "left", "right", "around"])
"""Directions, which are no places."""


class UnableError(Exception):
    """No action of the catalogue does that; never leaves the offline engine."""

    def __init__(self, what: str) -> None:
        self.what = what
        super().__init__(what)


@dataclass
class Going:
    """The steps for one message so far, and how to go somewhere."""

    scene: Scene
    steps: list[ActionCall] = field(default_factory=list)
    will: list[str] = field(default_factory=list)
    """What the robot will do, in words that follow "I will"."""
    notes: list[str] = field(default_factory=list)
    """Sentences said before that."""
    here: str = ""
    """Where the steps so far have brought the robot."""
    carried: Phrase = ()
    """What the robot has on board by now."""
    holds: bool = False
    """Whether what is brought somewhere is handed to somebody there by the next order."""
    beside: bool = False
    """Whether what is added is to be done while driving: then nothing is driven to for it."""
    seen: Phrase = ()
    """What the step before looked for."""

    @property
    def catalogue(self) -> Catalogue:
        """The robot's actions."""
        return self.scene.catalogue

    def _go(self, command: Command) -> None:
        if self.catalogue.mover is None:
            raise UnableError(plain(command.clause))
        over = command.verb.endswith(" over")
        if not command.place and over and not self.scene.places and self.scene.things:
            # "What is written on the A? Go over and read it."
            command = replace(command, place=self.scene.things[-1])
        if not command.place and self.scene.places and (not self.steps or over):
            # "The gym. Go."
            command = replace(command, place=self.scene.places[-1])
        if not command.place:
            raise UnclearError("Where should I go?")
        numbers = coordinates(command.place)
        if numbers is not None:
            self._go_to_numbers(numbers, _third(command.place))
            return
        if keys(command.place) in {("here",), ("me",), ("us",), ("operator",)}:
            self.travel(self._recipient_place(OPERATOR), "come to you")
            return
        if keys(command.place)[0] in FORWARD and len(command.place) < 5 and not self._grounds(command.place):
            raise UnableError("be steered by directions or distances")
        if keys(command.place) in {
            ("where", "you", "were"),
            ("where", "you", "started"),
            ("start",),
            ("where", "you", "came", "from"),
        }:
            self._back(command)
            return
        middle = None if command.verb == "patrol" else self._middle(command.place)
        if middle is not None:
            self._go_to_numbers(middle)
            return
        for member in self.scene.several(command.place):
            place = self.scene.place(member)
            if place.value != self.here:
                self.travel(place, f"go to {place.label}")

    def _middle(self, phrase: Phrase) -> tuple[float, float] | None:
        """For "between A and B": the point halfway."""
        noun = noun_phrase(phrase)
        if noun.core or "between" not in noun.relation or len(noun.anchors) != 2:
            return None
        items = [self.scene.place(anchor).item for anchor in noun.anchors]
        if items[0] is None or items[1] is None:
            return None
        return (items[0].x_m + items[1].x_m) / 2, (items[0].y_m + items[1].y_m) / 2

    def _go_to_numbers(self, numbers: tuple[float, ...], third: str = "yaw") -> None:
        mover = self.catalogue.mover
        values = (
            None
            if mover is None
            else _numbers_for(mover, dict(zip(("x", "y", third), numbers, strict=False)))
        )
        if mover is None or values is None:
            raise UnableError("drive to coordinates")
        where = f"x {numbers[0]:g} m, y {numbers[1]:g} m"
        self.steps.append(call(mover, values, f"go to {where}"))
        self.will.append(f"go to {where}")

    def _grounds(self, phrase: Phrase) -> bool:
        return self.scene.ground(phrase).outcome != "none"

    def travel(self, place: Place, why: str) -> None:
        """Bring the robot to a place."""
        mover = self.catalogue.mover
        if mover is None:
            raise UnableError("drive")
        texts = [
            name for name in text_inputs(mover) if parameter_role(name) in {"place", "object"}
        ] or text_inputs(mover)
        if texts:
            steps: list[ActionCall] | None = [call(mover, {texts[0]: place.value}, why)]
        else:
            steps = self.catalogue.chain(mover, {}, place.value, why)
        if steps is None and place.item is not None:
            values = _numbers_for(mover, {"x": place.item.x_m, "y": place.item.y_m})
            steps = None if values is None else [call(mover, values, why)]
        if steps is None:
            raise UnableError("drive there")
        self.steps += [s if s.reason else _with_reason(s, _reason(place, why)) for s in steps]
        self.will.append(f"go to {place.label}")
        if place.via is not None:
            self.scene.use(place.via)
        self.here = place.value
        self.scene.places.append(tokens(place.value))
        self.scene.mention(tokens(place.value))

    def _back(self, command: Command) -> None:
        if (
            command.kind == "back"
            and command.place
            and keys(command.place)[0] not in {"where", "home", "here", "me"}
        ):
            self._go(replace(command, kind="motion"))
            return
        home, _ = find_fact(tokens("home"), self.scene.facts)
        if keys(command.place)[:1] == ("home",) or "home" in command.verb:
            known = home is not None or self._grounds(tokens("home"))
            if known or ("back" not in command.verb and command.verb != "return"):
                self.travel(self.scene.place(tokens("home")), "go home")
                return
        mover, pose = self.catalogue.mover, self.scene.situation.robot_pose
        with_me = keys(command.place)[:1] == ("me",)
        if with_me and (pose is None or mover is None or self._known_operator()):
            self.travel(self._recipient_place(OPERATOR), "come back to you")
            return
        if mover is None:
            raise UnableError("drive")
        values = pose_values(mover, pose) if pose is not None else None
        if values is None:
            raise UnclearError("I cannot note down where I am now. Where should I go back to?")
        self.steps.append(call(mover, values, "come back to where I am now"))
        self.will.append("come back here")
        self.here = ""

    def _known_operator(self) -> bool:
        """Whether it is remembered where the operator is; who sends the robot off is where it is now."""
        return self.scene.remembered_place(OPERATOR) is not None or bool(self.scene.hints)

    def _recipient_place(self, recipient: Phrase) -> Place:
        if self._grounds(recipient):
            return self.scene.place(recipient)
        place = self.scene.remembered_place(recipient) or self.scene.told_place(recipient)
        if place is not None:
            return place
        if keys(recipient) == ("operator",):
            raise UnclearError("Where are you? Tell me, and I will remember it.")
        raise UnclearError(f"{where_is(plain(recipient))}?", about=recipient)

    def _place_or_here(self, phrase: Phrase) -> Place | None:
        """Where something is; None if it is said to be where the robot will be."""
        phrase = self.scene.referent(phrase)
        elsewhere = self.scene.whole(phrase) or self.scene.beside(phrase)  # "the floor in room 2"
        if self.here and not self._grounds(phrase) and elsewhere is None:
            fact, _ = find_fact(phrase, self.scene.facts)
            if fact is None:
                return None
        return self.scene.place(phrase)

    def _just_arrived(self) -> bool:
        mover = self.catalogue.mover
        return bool(self.here and self.steps) and mover is not None and self.steps[-1].name == mover.name

    def _stand_at(self, place: Place | None) -> None:
        elsewhere = place is not None and place.value != self.here and not self.beside
        if place is not None and elsewhere and self.catalogue.mover is not None:
            self.travel(place, f"go to {place.label}")

    def _said(self, info: ActionInfo, words: str, why: str) -> list[ActionCall]:
        texts = text_inputs(info)
        provider = self.catalogue.handed_over(info, texts[0]) if texts else None
        if provider is not None:
            # "Grip (object_id)" after "detect (label)": what the words name has to be found first.
            found = self.catalogue.chain(provider, {}, words, "") or []
            last = self.steps[-len(found) :] if found else []
            known = [(s.name, s.input_parameters) for s in last] == [
                (s.name, s.input_parameters) for s in found
            ]
            return [*(() if known else found), call(info, {}, why)]
        steps = self.catalogue.chain(info, self._told_to(texts, words), words, why)
        if steps is None:
            raise UnableError(why)
        return steps

    def _told_to(self, texts: Sequence[str], words: str) -> dict[str, str]:
        """What an action is told; an input for a place besides another one takes where the robot is."""
        where = [name for name in texts if parameter_role(name) == "place"]
        told = next((name for name in texts if name not in where), next(iter(texts), ""))
        here = {name: self.here for name in where if name != told and self.here}
        return {told: words, **here} if told else {}

    def _invoke(self, info: ActionInfo, command: Command) -> None:
        """Use an action as its own catalogue entry says."""
        values = arguments(info, command, self.scene)
        words = plain(command.place or command.theme or command.words)
        missing = [name for name in text_inputs(info) if name not in values]
        topic = {singular(word) for word in name_words(info.name)}
        about = {singular(word.key) for word in bare(tokens(words))}
        if words and about <= topic and not self._grounds(tokens(words)):
            words = ""
        if missing and not words and self.here and parameter_role(missing[0]) in {"place", "object"}:
            values[missing[0]] = words = self.here
            missing = missing[1:]
        if missing and not words:
            raise UnclearError(f"What should I {command.verb}?")
        steps = self.catalogue.chain(info, values, words, plain(command.clause))
        numbers = [n for n, k in info.inputs.items() if k == "number" and n not in values and "::" not in n]
        unsaid = [name for name in numbers if name not in info.optional]
        if steps is None and unsaid:
            name = " ".join(name_words(unsaid[0]))
            raise UnclearError(f"What should the {name} be for “{plain(command.clause)}”? Please name it.")
        if steps is None:
            raise UnableError(plain(command.clause))
        self.steps += steps
        self.will.append(_saying(info, command))
        for phrase in (command.place, command.theme, command.recipient):
            self.scene.mention(bare(phrase))


def _saying(info: ActionInfo, command: Command) -> str:
    """The clause in the robot's words."""
    if command.kind in {"transfer", "place"} and command.theme:
        whom = f" to {the(plain(command.recipient))}" if command.recipient else ""
        verb = "hand over" if command.recipient else "put down"
        return f"{verb} {the(plain(command.theme))}{whom}".replace("the operator", "you").replace(
            "to operator", "to you"
        )
    if command.clause[0].key.endswith("ing"):
        base = lemma(command.clause[0].key)
        return f"{base} {plain(command.clause[1:])}".strip()
    return plain(command.clause).lower() if command.clause[0].is_capital else plain(command.clause)


def _reason(place: Place, why: str) -> str:
    """Why coordinates are needed: what for matters to people when there is more to it than going there."""
    going = why.startswith(("go to", "come", "go home"))
    return f"find out where {place.label} is" + ("" if going else f", to {why}")


def _with_reason(step: ActionCall, reason: str) -> ActionCall:
    """The same step with a reason."""
    return step.model_copy(update={"reason": reason})


_AROUND_NUMBERS = frozenset(
    {
        "x",
        "y",
        "z",
        "and",
        "coordinates",
        "coordinate",
        "position",
        "point",
        "pose",
        "at",
        "map",
        "m",
        "meters",
        "metres",
    }
    | {"the", "is", "facing", "heading", "theta", "yaw", "angle", "with", "an", "a", "of"}
)


def coordinates(phrase: Phrase) -> tuple[float, ...] | None:
    """Two numbers, or three with a heading, if the phrase says nothing but where on the map they are."""
    numbers = tuple(
        float(word.key.replace(",", ".")) for word in phrase if re.fullmatch(r"-?\d+(?:[.,]\d+)?", word.key)
    )
    others = {word.key for word in phrase if word.is_word and not word.key.lstrip("-")[:1].isdigit()}
    return numbers if len(numbers) in {2, 3} and others <= _AROUND_NUMBERS else None


def _third(phrase: Phrase) -> str:
    """What a third number is: a height if it is named so, else a heading."""
    return "z" if any(word.key == "z" for word in phrase) else "yaw"


def _numbers_for(mover: ActionInfo, place: dict[str, float]) -> dict[str, float] | None:
    """A place as values of an action's numeric inputs; None if it has others as well."""
    axes = pose_inputs(mover)
    if set(number_inputs(mover)) - set(axes) - set(mover.optional):
        return None
    values = {
        name: round(place.get(axis, 0.0), 4)
        for name, axis in axes.items()
        if axis in place or name not in mover.optional
    }
    return values or None


def pose_values(mover: ActionInfo, pose: Pose2D) -> dict[str, float] | None:
    """A pose as values of an action's numeric inputs; None if it has others."""
    position = {"x": pose.x_m, "y": pose.y_m, "z": 0.0}
    heading = {
        "r": 0.0,
        "p": 0.0,
        "y": pose.yaw_rad,
        "roll": 0.0,
        "pitch": 0.0,
        "yaw": pose.yaw_rad,
        "theta": pose.yaw_rad,
    }
    values: dict[str, float] = {}
    for name, kind in mover.inputs.items():
        leaf = name.split("::")[-1].lower()
        table = heading if "orient" in name.lower() or leaf in heading.keys() - position.keys() else position
        if kind != "number" or leaf not in table:
            return None
        values[name] = round(table[leaf], 4)
    return values or None
