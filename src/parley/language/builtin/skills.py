"""Which frame each action of a catalogue is, and which role each of its parameters: once for each catalogue.

What an action's maker says of it decides, read by the tagger; effects and the types of a place, where there
are. A name decides nothing beside that. Where there is nothing else, its verb must be one of the lexicon's,
and the tagger must see that in verb and inputs.
"""

from __future__ import annotations

import json
import re
from collections import OrderedDict
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from parley.language.builtin.labels import OTHER
from parley.language.builtin.lexicon import Lexicon
from parley.language.builtin.tagger import Tagger
from parley.messages.status import ActionInfo
from parley.pairing import best_pairs
from parley.umrf.kinds import is_word_for, parameters_of, words_of_name

__all__ = ["Skill", "SkillTable", "Skills"]

_SURE = 0.5
_LEAST = 0.1
_MARGIN = 20.0
"""So much likelier two opposite actions must be as they are than exchanged."""
_RIVAL = 0.15
"""If so much speaks for the opposite, an action is not used."""
_OPPOSITES = {"ON": "OFF", "OPEN": "CLOSE", "CONNECT": "DISC", "TAKE": "PUT"}
_OPPOSITES |= {other: one for one, other in _OPPOSITES.items()}
_TOO_MANY = 0.2
"""What is left of a belief where an action has more parameters than a frame has roles."""
_KEPT = 64
_EFFECTS = {
    "locates": "LOCATE", "follows": "FOLLOW", "moves": "GO", "looks": "LOOK", "asks_operator": "ASK",
}  # fmt: skip
_ROLES = {
    "MOVE": "HN", "TURN": "HN", "FACE": "T", "LOCATE": "G", "GO": "G", "LOOK": "TK", "ASK": "X", "PHOTO":
    "T", "SAY": "XR", "ANSWER": "TX", "WAIT": "D", "OPEN": "T", "CLOSE": "T", "FOLLOW": "TD", "FIND": "TL",
    "ON": "TL", "OFF": "TL", "GUIDE": "TGS", "BRING": "TRGS", "COOK": "TLI", "MIX": "TIL",
}  # fmt: skip


_THINGS = frozenset({"object", "objects", "obj", "item", "items", "thing", "things", "something", "anything"})
_STEERED = frozenset({"distance", "angle", "direction", "number", "duration"})
_BARE = frozenset({OTHER, "PHOTO", "WAIT", "CHARGE", "LOOK", "FOLLOW"})
"""What an action without inputs may be; any other frame says of what."""


@dataclass(frozen=True, slots=True)
class Skill:
    """An action that does what a frame wants."""

    action: ActionInfo
    frame: str
    roles: dict[str, str]
    """Role -> parameter."""
    share: float = 1.0
    other: Skill | None = None
    """One of the same kind for persons, where this is for things; or the other way round."""

    @property
    def is_for_persons(self) -> bool:
        """Whether what it is about is a person by its type."""
        name = self.roles.get("T", "")
        if self.is_only_named and self.names_person:
            return True
        return name in self.action.inputs and parameters_of(self.action)[name].kind == "person"

    @property
    def is_by_hand(self) -> bool:
        """Whether it takes what is before the robot, or puts down what it has: no map need know that."""
        return bool({"grasps", "places"} & {*self.action.effects})

    @property
    def names_person(self) -> bool:
        """Whether its maker speaks of people, and of nothing else that it is about."""
        said = {*words_of_name(f"{self.action.name} {self.action.description}")}
        return any(is_word_for(word, "person") for word in said) and not said & _THINGS

    @property
    def is_only_named(self) -> bool:
        """Whether its maker says nothing of it: nobody knows whether it drives to what it is about."""
        return not (self.action.description or self.action.phrases or self.action.effects)

    def fitting(self, person: bool) -> Skill | None:
        """This one or the other, for a person or for a thing; None if neither takes such."""
        if self.other is not None:
            return self if self.names_person is person else self.other
        return None if self.is_for_persons and not person else self

    @property
    def takes_pose(self) -> bool:
        """Whether it wants coordinates, which another action finds."""
        return any("::" in name for name in self.action.inputs)


Skills = dict[str, Skill]


class SkillTable:
    """The skills of catalogues that were seen already."""

    def __init__(self, tagger: Tagger, lexicon: Lexicon) -> None:
        self._tagger = tagger
        self._lexicon = lexicon
        self._known: OrderedDict[str, Skills] = OrderedDict()
        self._described: dict[str, dict[str, float]] = {}

    def of(self, catalogue: Sequence[ActionInfo]) -> Skills:
        """What a robot with these actions can do, by frame."""
        key = json.dumps([(a.name, a.inputs, a.optional, a.description, a.effects) for a in catalogue])
        found = self._known.get(key)
        if found is None:
            found = self._known[key] = self._match(catalogue)
            if len(self._known) > _KEPT:
                self._known.popitem(last=False)
        return found

    def _match(self, catalogue: Sequence[ActionInfo]) -> Skills:
        if not catalogue:
            return {}
        beliefs = [self._belief(action) for action in catalogue]
        frames = sorted({frame for belief in beliefs for frame in belief} - {OTHER})
        table = np.array([[belief.get(frame, 0.0) for frame in frames] for belief in beliefs])
        found: Skills = {}
        chosen = {frames[column]: row for row, column in best_pairs(np.log(table + 1e-4).tolist())}
        for frame, row in chosen.items():
            share = beliefs[row].get(frame, 0.0)
            if self._is_told_apart(frame, row, chosen, beliefs) and share >= _LEAST:
                found[frame] = Skill(catalogue[row], frame, self._roles(catalogue[row], frame), share)
        for row, belief in enumerate(beliefs):
            if row not in {chosen.get(frame) for frame in found}:
                self._beside(found, catalogue[row], belief)
        return found

    def _beside(self, found: Skills, action: ActionInfo, belief: dict[str, float]) -> None:
        """Add an action to one of the same kind, where one is for persons and the other for things."""
        frame = max(belief, key=lambda name: belief[name], default=OTHER)
        first = found.get(frame)
        if first is None or first.other is not None or belief[frame] < _SURE:
            return
        second = Skill(action, frame, self._roles(action, frame), belief[frame])
        if second.names_person is not first.names_person:
            found[frame] = replace(first, other=second)

    @staticmethod
    def _is_told_apart(
        frame: str, row: int, chosen: dict[str, int], beliefs: Sequence[dict[str, float]]
    ) -> bool:
        """Whether an action is this and not the opposite: by itself, or because another is the opposite."""
        share = beliefs[row].get(frame, 0.0)
        opposite = _OPPOSITES.get(frame, "")
        rival = beliefs[row].get(opposite, 0.0)
        other = chosen.get(opposite)
        if other is None:
            return share >= _SURE and rival < _RIVAL
        swapped = rival * beliefs[other].get(frame, 0.0)
        return share * beliefs[other].get(opposite, 0.0) > _MARGIN * swapped and share + rival >= _SURE

    def _described_as(self, description: str) -> dict[str, float]:
        """What a description says to the tagger, but for the opposite of what its verbs say."""
        words = re.findall("[a-z]+", description.lower())
        said = {name for word in words for name in self._lexicon.exactly([word])}
        found = self._tagger.describe([description])[0]
        return {
            frame: 0.0 if _OPPOSITES.get(frame) in said and frame not in said else share
            for frame, share in found.items()
        }

    def _belief(self, action: ActionInfo) -> dict[str, float]:
        """How much each frame fits an action, of one."""
        said = next((frame for effect, frame in _EFFECTS.items() if effect in action.effects), None)
        if said is not None and self._has_core(action, said):
            return {said: 1.0}
        if not (action.description or action.phrases):
            return self._named(action)
        if not action.description:
            return {}
        found = self._describe(action.description)
        many = len(action.inputs)
        return {
            frame: 0.0
            if not many and frame not in _BARE
            else share * (_TOO_MANY if many > len(_ROLES.get(frame, "TRGSL")) else 1.0)
            for frame, share in found.items()
        }

    def _named(self, action: ActionInfo) -> dict[str, float]:
        """What only its name and its types tell: a verb, and nothing that its inputs do not say as well."""
        posed = [any("::" in name for name in names) for names in (action.inputs, action.outputs)]
        if any(posed):
            return {"GO" if posed[0] else "LOCATE": 1.0}
        words, inputs = words_of_name(action.name), {w for name in action.inputs for w in words_of_name(name)}
        size = next((n for n in range(len(words), 0, -1) if self._lexicon.exactly(words[:n])), 0)
        known = self._lexicon.exactly(words[:size]) if size else frozenset[str]()
        plain = {word for hints in self._lexicon.hints.values() for word in hints} | inputs
        plain |= self._lexicon.classes["prepositions"]
        if not all(any(known.startswith(word) for known in plain) for word in words[size:]):
            return {}  # "obj" is the object
        kinds = [one.kind for one in parameters_of(action).values()]
        if "GIVE" in known and sorted(kinds) == ["person", "thing"]:
            return {"GIVE": 1.0}
        read = self._describe(" ".join(dict.fromkeys([*words, *sorted(inputs)])))
        found = {frame: share for frame, share in read.items() if frame in known and share >= _LEAST}
        return {frame: share / sum(found.values()) for frame, share in found.items()}

    def _describe(self, text: str) -> dict[str, float]:
        """What a text says to the tagger, read once."""
        if text not in self._described:
            self._described[text] = self._described_as(text)
        return self._described[text]

    @staticmethod
    def _has_core(action: ActionInfo, frame: str) -> bool:
        """Whether an effect tells the frame: going needs a place, looking something to look at."""
        needed = {name for name in action.inputs if name not in action.optional}
        kinds = {parameters_of(action)[name].kind for name in needed if "::" not in name}
        posed = any("::" in name for name in action.inputs)
        return posed or (bool(needed) if frame == "LOOK" else frame != "GO" or not kinds <= _STEERED)

    def _roles(self, action: ActionInfo, frame: str) -> dict[str, str]:
        """Which parameter takes which role: names hint, the order decides between equals."""
        known = self._lexicon.frames.get(frame)
        kinds = parameters_of(action)
        roles = list(_ROLES.get(frame) or (known.roles if known else "T"))
        names = [name for name in action.inputs if "::" not in name]
        if not names:
            return {}
        types = known.roles if known else {}
        table = np.zeros((len(names), len(roles)))
        for row, name in enumerate(names):
            words = re.findall(r"[a-z]+|\d+", re.sub(r"(?<=[a-z0-9])(?=[A-Z])", " ", name).lower())
            for column, role in enumerate(roles):
                hits: float = sum(word in self._lexicon.hints.get(role, ()) for word in words)
                hits += 0.5 * (kinds[name].kind == "place" == types.get(role)) * (frame == "COUNT")
                table[row, column] = hits - 0.1 * abs(row - column) - 0.02 * column
        return {roles[column]: names[row] for row, column in best_pairs(table.tolist())}
