"""From commands to steps: what the robot's own catalogue offers to do what was asked for.

The general kinds of tasks (going, looking, fetching) are put together from roles of actions; everything else
is matched against names, phrases and parameters of the catalogue. What cannot be done is said so.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field, replace

from parley.language.offline.catalogue import Catalogue, call, parameter_role, text_inputs
from parley.language.offline.commands import Command
from parley.language.offline.facts import find_fact
from parley.language.offline.fill import arguments
from parley.language.offline.grounding import ground_phrase
from parley.language.offline.lexicon import lexicon
from parley.language.offline.nouns import bare
from parley.language.offline.saying import the
from parley.language.offline.scene import OPERATOR, Place, Scene, UnclearError
from parley.language.offline.text import Phrase, keys, plain, tokens
from parley.messages.chat import ActionCall
from parley.messages.status import ActionInfo
from parley.world.geometry import Pose2D

__all__ = ["Tasks", "UnableError", "pose_values"]

_ASKING = frozenset({"it", "that", "this", "them", "there", "here", "those", "these"})
_ANYTHING = frozenset((word,) for word in ("things", "objects", "something", "stuff", "people", "anything"))
_FORWARD = frozenset(["forward", "forwards", "backward", "backwards", "ahead", "left", "right", "around"])


class UnableError(Exception):
    """No action of the catalogue does that; never leaves the offline engine."""

    def __init__(self, what: str) -> None:
        self.what = what
        super().__init__(what)


@dataclass
class Tasks:
    """The steps for one message, growing command by command."""

    scene: Scene
    steps: list[ActionCall] = field(default_factory=list)
    will: list[str] = field(default_factory=list)
    """What the robot will do, in words that follow "I will"."""
    notes: list[str] = field(default_factory=list)
    """Sentences said before that."""
    here: str = ""
    """Where the steps so far have brought the robot."""
    carried: Phrase = ()

    @property
    def catalogue(self) -> Catalogue:
        """The robot's actions."""
        return self.scene.catalogue

    def do(self, command: Command) -> None:
        """Add the steps for a command.

        Raises:
            UnclearError: Something has to be asked first.
            UnableError: Nothing in the catalogue does it.
        """
        own = self.catalogue.for_verb(command.verb)
        special = own is not None and command.kind in {"catalogue", "other"}
        if special and own is not None:
            self._invoke(own, command)
            return
        match command.kind:
            case "motion":
                self._go(command)
            case "back":
                self._back(command)
            case "look" | "whether":
                self._look(command)
            case "search" | "meet":
                self._search(command)
            case "transfer":
                self._fetch(command)
            case "grasp":
                self._grasp(command)
            case "place":
                self._place(command)
            case _:
                self._other(command)

    # -- going --

    def _go(self, command: Command) -> None:
        if not command.place:
            if self.catalogue.mover is None:
                raise UnableError("drive")
            raise UnclearError("Where should I go?")
        numbers = coordinates(command.place)
        if numbers is not None:
            self._go_to_numbers(numbers)
            return
        if keys(command.place) in {("here",), ("me",), ("us",), ("operator",)}:
            self.travel(self._recipient_place(OPERATOR), "come to you")
            return
        if keys(command.place)[0] in _FORWARD and len(command.place) < 5 and not self._grounds(command.place):
            raise UnableError("be steered by directions or distances")
        if keys(command.place) in {
            ("where", "you", "were"),
            ("where", "you", "started"),
            ("start",),
            ("where", "you", "came", "from"),
        }:
            self._back(command)
            return
        for member in self.scene.several(command.place):
            place = self.scene.place(member)
            self.travel(place, f"go to {place.label}")

    def _go_to_numbers(self, numbers: tuple[float, float]) -> None:
        mover = self.catalogue.mover
        values = None if mover is None else pose_values(mover, Pose2D(*numbers))
        if mover is None or values is None:
            raise UnableError("drive to coordinates")
        where = f"x {numbers[0]:g} m, y {numbers[1]:g} m"
        self.steps.append(call(mover, values, f"go to {where}"))
        self.will.append(f"go to {where}")

    def _grounds(self, phrase: Phrase) -> bool:
        return ground_phrase(phrase, self.scene.objects).outcome != "none"

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
        if steps is None:
            raise UnableError("drive there")
        self.steps += [s if s.reason else replace_reason(s, _reason(place, why)) for s in steps]
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
            if known or "back" not in command.verb and command.verb != "return":
                self.travel(self.scene.place(tokens("home")), "go home")
                return
        if keys(command.place)[:1] == ("me",):
            self.travel(self._recipient_place(OPERATOR), "come back to you")
            return
        mover, pose = self.catalogue.mover, self.scene.situation.robot_pose
        if mover is None:
            raise UnableError("drive")
        values = pose_values(mover, pose) if pose is not None else None
        if values is None:
            raise UnclearError("I cannot note down where I am now. Where should I go back to?")
        self.steps.append(call(mover, values, "come back to where I am now"))
        self.will.append("come back here")
        self.here = ""

    # -- looking --

    def _look(self, command: Command) -> None:
        looker = self.catalogue.with_role("look", "search")
        if looker is None:
            raise UnableError(f"{command.verb} things")
        if command.place:
            self._look_there(command, looker)
            return
        if (
            command.theme
            and set(keys(command.theme)) & _FORWARD
            and not self._grounds(command.theme[:1])
            and len(command.theme) < 3
        ):
            raise UnableError("turn my camera")
        if not command.theme:
            request = "whether " + plain(command.words) if command.kind == "whether" else "what can be seen"
            self._add_look(looker, request, "look around")
            return
        for member in self.scene.several(command.theme):
            self._look_at(member, command, looker)

    def _look_there(self, command: Command, looker: ActionInfo) -> None:
        """Something in or at a place: "the shelf for leaks", "whether the cup is on the table"."""
        whole = command.kind == "whether" and self._grounds(command.theme)
        stand = self._place_or_here(command.theme if whole else command.place)
        theme = plain(self.scene.referent(command.theme)) if command.theme else ""
        request = self._whether(command) if command.kind == "whether" else theme
        self._stand_at(stand)
        self.scene.mention(bare(command.theme))
        if command.kind == "whether":
            self._add_look(looker, request, f"check {request}")
        else:
            self._add_look(looker, request or command.verb, f"look for {theme}")

    def _look_at(self, member: Phrase, command: Command, looker: ActionInfo) -> None:
        if command.kind == "whether":
            request = self._whether(command)
            self._stand_at(self._place_or_here(member))
            self.scene.mention(bare(self.scene.referent(member)))
            self._add_look(looker, request, f"check {request}")
            return
        place = self._place_or_here(member)
        name = plain(bare(self.scene.referent(member)))
        request = place.value if place is not None and place.item is not None and place.via is None else name
        self._stand_at(place)
        self._add_look(looker, request, f"look at {the(request)}")

    def _whether(self, command: Command) -> str:
        words, asking = command.words, "how" if command.verb.endswith("how") else "whether"
        if command.theme and keys(bare(command.theme))[0] in _ASKING:
            subject = the(plain(self.scene.referent(command.theme)))
            rest = words[len(command.theme) :]
            return f"{asking} {subject} {plain(rest)}".strip()
        return f"{asking} {plain(words)}"

    def _place_or_here(self, phrase: Phrase) -> Place | None:
        """Where something is; None if it is said to be where the robot will be."""
        phrase = self.scene.referent(phrase)
        if self.here and not self._grounds(phrase):
            fact, _ = find_fact(phrase, self.scene.facts)
            if fact is None:
                return None
        return self.scene.place(phrase)

    def _stand_at(self, place: Place | None) -> None:
        if place is not None and place.value != self.here and self.catalogue.mover is not None:
            self.travel(place, f"go to {place.label}")

    def _add_look(self, looker: ActionInfo, request: str, saying: str) -> None:
        self.steps += self._said(looker, request, saying)
        self.will.append(saying)

    def _said(self, info: ActionInfo, words: str, why: str) -> list[ActionCall]:
        texts = text_inputs(info)
        steps = self.catalogue.chain(info, {texts[0]: words} if texts else {}, words, why)
        if steps is None:
            raise UnableError(why)
        return steps

    def _search(self, command: Command) -> None:
        theme = self._wanted(command.theme)
        searcher = self._searcher(theme)
        if searcher is None:
            raise UnableError("look for things")
        words = plain(theme)
        if command.place:
            self._stand_at(self._place_or_here(command.place))
        else:
            own = "search" in self.catalogue.roles(searcher)
            known = self._known_place(theme)
            if known is not None:
                self._stand_at(known)
                if known.via is not None:
                    words = (
                        plain(known.via.fact.subject) if len(known.via.fact.subject) > len(theme) else words
                    )
            elif not (own or self.here):
                raise UnclearError(f"Where should I look for {the(words)}?")
        self.scene.mention(theme)
        self._add_look(searcher, words, f"look for {the(words)}")

    def _searcher(self, theme: Phrase) -> ActionInfo | None:
        wanted = "person" if self.scene.is_person(theme) else "object"
        for info in (*self.catalogue.all_with_role("search"), *self.catalogue.all_with_role("meet")):
            roles = {parameter_role(name) for name in text_inputs(info)}
            if wanted in roles or not roles & {"person", "object"}:
                return info
        return self.catalogue.with_role("look") or self.catalogue.with_role("search")

    def _wanted(self, theme: Phrase) -> Phrase:
        if not theme:
            raise UnclearError("What should I look for?")
        return bare(self.scene.referent(theme))

    def _known_place(self, theme: Phrase) -> Place | None:
        if self._grounds(theme):
            return self.scene.place(theme)
        place = self.scene.remembered_place(theme)
        return place if place is not None else self.scene.told_place(theme)

    # -- carrying --

    def _fetch(self, command: Command) -> None:
        if not command.theme:
            raise UnclearError(f"What should I {command.verb}?")
        theme, source = self._theme(command)
        if self.scene.is_person(theme):
            self._guide(command, theme)
            return
        recipient, goal = self._destination(command)
        fetcher = self.catalogue.with_role("fetch")
        if fetcher is not None and self.catalogue.with_role("grasp") is None:
            self._invoke(fetcher, replace(command, theme=theme, recipient=recipient))
            return
        name = plain(theme)
        if keys(theme) != keys(self.carried):
            if source is not None:
                self._stand_at(source)
            self._look_for(theme)
            self._take(theme)
        self.travel(goal, f"bring {the(name)} to {self._person(recipient) if recipient else goal.label}")
        self._hand_over(theme, recipient, command)
        self.carried = ()
        self.scene.mention(recipient)
        self.scene.mention(theme)

    def _theme(self, command: Command) -> tuple[Phrase, Place | None]:
        """What is to be brought, in the words it is remembered by, and where it is."""
        need = lexicon().need_phrases.get(" ".join(keys(bare(command.theme))))
        theme = bare(self.scene.referent(tokens(need) if need else command.theme))
        if keys(theme) == keys(self.carried):
            return theme, None
        if command.source:
            return theme, self.scene.place(command.source)
        if self._grounds(theme):
            return theme, self.scene.place(theme)
        place = self.scene.remembered_place(theme)
        if place is None and not need and self.here:
            return theme, None
        place = place or self.scene.told_place(theme)
        if place is None:
            if need:
                raise UnclearError(
                    f"I do not know of {lexicon().need_words[need]}. What should I bring, and where is it?"
                )
            raise UnclearError(f"Where is {the(plain(theme))}?")
        return (place.via.fact.subject if place.via is not None and place.via.fact.subject else theme), place

    def _destination(self, command: Command) -> tuple[Phrase, Place]:
        recipient = command.recipient
        if not recipient and not command.place and command.verb in {"take", "carry", "deliver", "transport"}:
            raise UnclearError("Where should I bring it?")
        if not recipient and not command.place:
            recipient = self.scene.persons[-1] if self.scene.persons else OPERATOR
        recipient = self.scene.referent(recipient) if recipient else ()
        if command.place:
            return recipient, self.scene.place(command.place)
        return recipient, self._recipient_place(recipient)

    def _recipient_place(self, recipient: Phrase) -> Place:
        if self._grounds(recipient):
            return self.scene.place(recipient)
        place = self.scene.remembered_place(recipient) or self.scene.told_place(recipient)
        if place is not None:
            return place
        if keys(recipient) == ("operator",):
            raise UnclearError("Where are you? Tell me, and I will remember it.")
        raise UnclearError(f"Where is {the(plain(recipient))}?")

    def _person(self, recipient: Phrase) -> str:
        return "you" if keys(recipient) == ("operator",) else the(plain(recipient))

    def _look_for(self, theme: Phrase) -> None:
        looker = self._searcher(theme)
        if looker is not None:
            self._add_look(looker, plain(theme), f"look for {the(plain(theme))}")

    def _take(self, theme: Phrase) -> None:
        """Get something on board: by an action, else with the operator's help."""
        name = plain(theme)
        grasper, asker = self.catalogue.with_role("grasp"), self.catalogue.with_role("ask_operator")
        if grasper is not None:
            self.steps += self._said(grasper, name, f"take {the(name)}")
            self.will.append(f"take {the(name)}")
        elif asker is not None:
            question = f"I cannot pick things up. Please put {the(name)} on me and tell me when it is done."
            self.steps += self._said(asker, question, f"I cannot pick up {the(name)} myself")
            self.will.append(f"ask you to put {the(name)} on me, because I cannot pick things up")
        else:
            self.notes.append(f"I cannot pick things up, so somebody has to put {the(name)} on me.")
        self.carried = theme

    def _hand_over(self, theme: Phrase, recipient: Phrase, command: Command) -> None:
        giver = self.catalogue.with_role("handover") if recipient else self.catalogue.with_role("place")
        if giver is None:
            return
        self._invoke(giver, replace(command, theme=theme, recipient=recipient or command.recipient))

    def collect(self, command: Command) -> None:
        """Get something on board that the next clause says more about."""
        theme, source = self._theme(command)
        if self.catalogue.with_role("grasp", "ask_operator") is None:
            self.notes.append(f"I cannot pick things up, so somebody has to put {the(plain(theme))} on me.")
        if source is not None:
            self._stand_at(source)
        self._look_for(theme)
        if self.catalogue.with_role("grasp", "ask_operator") is not None:
            self._take(theme)
        self.carried = theme
        self.scene.mention(theme)

    def _grasp(self, command: Command) -> None:
        theme = bare(self.scene.referent(command.theme)) if command.theme else ()
        if not theme:
            raise UnclearError("What should I pick up?")
        if keys(theme) in _ANYTHING and self.catalogue.with_role("grasp") is None:
            raise UnableError(f"{command.verb} {plain(theme)}")
        if self.catalogue.with_role("grasp", "ask_operator") is None:
            raise UnableError(f"pick up {the(plain(theme))}")
        place = self.scene.place(command.source) if command.source else self._known_place(theme)
        if (
            place is None
            and command.theme[0].key not in _ASKING
            and not self.here
            and self.catalogue.with_role("grasp") is None
        ):
            raise UnclearError(f"Where is {the(plain(theme))}?")
        self._stand_at(place)
        self._take(theme)
        self.scene.mention(theme)

    def _place(self, command: Command) -> None:
        theme = bare(self.scene.referent(command.theme)) if command.theme else self.carried
        placer, asker = self.catalogue.with_role("place"), self.catalogue.with_role("ask_operator")
        if keys(theme) != keys(self.carried):
            if command.place and theme:
                self._fetch(replace(command, kind="transfer", theme=theme))
                return
            raise UnableError(f"{command.verb} {the(plain(theme)) if theme else 'things'}")
        if command.place:
            self._stand_at(self._place_or_here(command.place))
        if placer is not None:
            self._invoke(placer, replace(command, theme=theme))
        elif asker is not None:
            question = f"Please take {the(plain(theme))} off me and tell me when it is done."
            self.steps += self._said(asker, question, f"I cannot put down {the(plain(theme))} myself")
            self.will.append(f"ask you to take {the(plain(theme))} off me")
        self.carried = ()

    def _guide(self, command: Command, theme: Phrase) -> None:
        guide = self.catalogue.with_role("guide")
        if guide is None:
            raise UnableError("take people along")
        self._invoke(guide, replace(command, theme=theme, recipient=theme))

    # -- everything else --

    def _other(self, command: Command) -> None:
        info = self.catalogue.for_verb(command.verb) or self.catalogue.for_verb(command.verb.split()[0])
        info = info or self.catalogue.with_role(command.kind)
        if info is None and command.kind == "count":
            self._look(replace(command, kind="look"))
            return
        if info is None and command.kind == "wait" and self.steps:
            if any(
                word.key.isdigit() or word.key in {"until", "minute", "minutes", "seconds"}
                for word in command.words
            ):
                self.notes.append("I cannot wait for a set time, so I go on at once.")
            return
        if info is None:
            raise UnableError(plain(command.clause))
        self._invoke(info, command)

    def _invoke(self, info: ActionInfo, command: Command) -> None:
        """Use an action as its own catalogue entry says."""
        values = arguments(info, command, self.scene)
        words = plain(command.place or command.theme or command.words)
        missing = [name for name in text_inputs(info) if name not in values]
        if missing and not words:
            raise UnclearError(f"What should I {command.verb}?")
        steps = self.catalogue.chain(info, values, words, plain(command.clause))
        if steps is None:
            raise UnableError(plain(command.clause))
        self.steps += steps
        self.will.append(saying_of(info, command))
        for phrase in (command.place, command.theme, command.recipient):
            self.scene.mention(bare(phrase))


def saying_of(info: ActionInfo, command: Command) -> str:
    """The clause in the robot's words."""
    if command.kind in {"transfer", "place"} and command.theme:
        whom = f" to {the(plain(command.recipient))}" if command.recipient else ""
        verb = "hand over" if command.recipient else "put down"
        return f"{verb} {the(plain(command.theme))}{whom}".replace("the operator", "you").replace(
            "to operator", "to you"
        )
    return plain(command.clause).lower() if command.clause[0].is_capital else plain(command.clause)


def _reason(place: Place, why: str) -> str:
    """Why coordinates are needed: what for matters to people when there is more to it than going there."""
    going = why.startswith(("go to", "come", "go home"))
    return f"find out where {place.label} is" + ("" if going else f", to {why}")


def replace_reason(step: ActionCall, reason: str) -> ActionCall:
    """The same step with a reason."""
    return step.model_copy(update={"reason": reason})


def coordinates(phrase: Phrase) -> tuple[float, float] | None:
    """Two numbers, if the phrase says nothing but where on the map they are."""
    numbers = [
        float(word.key.replace(",", ".")) for word in phrase if re.fullmatch(r"\d+(?:[.,]\d+)?", word.key)
    ]
    others = {word.key for word in phrase if word.is_word and not word.key[0].isdigit()}
    known = {
        "x",
        "y",
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
        "the",
        "is",
    }
    return (numbers[0], numbers[1]) if len(numbers) == 2 and others <= known else None


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
