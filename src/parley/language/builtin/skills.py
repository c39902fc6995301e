"""Which frame each action of a catalogue is, and which role each of its parameters: once for each catalogue.

Names decide nothing: what an action's maker says of it does, read by the tagger; effects, where there are.
"""

from __future__ import annotations

import json
import re
from collections import OrderedDict
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import linear_sum_assignment

from parley.language.builtin.labels import OTHER
from parley.language.builtin.lexicon import Lexicon
from parley.language.builtin.tagger import Tagger
from parley.messages.status import ActionInfo

__all__ = ["Skill", "SkillTable", "Skills"]

_SURE = 0.5
_RIVAL = 0.15
"""If so much speaks for the opposite, an action is not used."""
_OPPOSITES = {"ON": "OFF", "OPEN": "CLOSE", "CONNECT": "DISC", "TAKE": "PUT"}
_OPPOSITES |= {other: one for one, other in _OPPOSITES.items()}
_KEPT = 64
_EFFECTS = {"locates": "LOCATE", "moves": "GO", "looks": "LOOK", "asks_operator": "ASK"}
_ROLES = {
    "MOVE": "HN", "TURN": "HN", "FACE": "T", "LOCATE": "G", "GO": "G", "LOOK": "TK", "ASK": "X", "PHOTO":
    "T", "SAY": "XR", "ANSWER": "TX", "WAIT": "D", "OPEN": "T", "CLOSE": "T", "FOLLOW": "T", "FIND": "TL",
    "ON": "TL", "OFF": "TL", "GUIDE": "TGS", "BRING": "TRGS", "COOK": "TLI", "MIX": "TIL",
}  # fmt: skip


@dataclass(frozen=True, slots=True)
class Skill:
    """An action that does what a frame wants."""

    action: ActionInfo
    frame: str
    roles: dict[str, str]
    """Role -> parameter."""
    share: float = 1.0

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
        key = json.dumps([(a.name, sorted(a.inputs), a.description, a.effects) for a in catalogue])
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
        rows, columns = linear_sum_assignment(-np.log(table + 1e-4))
        found: Skills = {}
        for row, column in zip(rows, columns, strict=True):
            action, frame = catalogue[int(row)], frames[column]
            rival = beliefs[row].get(_OPPOSITES.get(frame, ""), 0.0)
            if table[row, column] >= _SURE and rival < _RIVAL:
                found[frame] = Skill(action, frame, self._roles(action, frame), float(table[row, column]))
        return found

    def _belief(self, action: ActionInfo) -> dict[str, float]:
        """How much each frame fits an action, of one."""
        said = next((frame for effect, frame in _EFFECTS.items() if effect in action.effects), None)
        if said is not None:
            return {said: 1.0}
        if not action.description:
            return {}
        sentences = [part for part in re.split(r"(?<=[.;])\s+", action.description) if part][:2]
        texts = [action.description, *(sentences if len(sentences) > 1 else [])]
        for text in texts:
            if text not in self._described:
                self._described[text] = self._tagger.describe([text])[0]
        first = self._described[texts[0]]
        if len(texts) == 1:
            return first
        return {frame: max(share, self._described[texts[1]][frame]) for frame, share in first.items()}

    def _roles(self, action: ActionInfo, frame: str) -> dict[str, str]:
        """Which parameter takes which role: names hint, the order decides between equals."""
        known = self._lexicon.frames.get(frame)
        roles = list(_ROLES.get(frame) or (known.roles if known else "T"))
        names = [name for name in action.inputs if "::" not in name]
        if not names:
            return {}
        table = np.zeros((len(names), len(roles)))
        for row, name in enumerate(names):
            words = re.findall(r"[a-z]+|\d+", re.sub(r"(?<=[a-z0-9])(?=[A-Z])", " ", name).lower())
            for column, role in enumerate(roles):
                hits = sum(word in self._lexicon.hints.get(role, ()) for word in words)
                table[row, column] = hits - 0.1 * abs(row - column) - 0.02 * column
        rows, columns = linear_sum_assignment(-table)
        return {roles[column]: names[row] for row, column in zip(rows, columns, strict=True)}
