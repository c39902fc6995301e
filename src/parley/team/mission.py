"""What has become of each part of an order to a team, and how it ended. Pure.

A part is told by its order: the steps of a robot's plan say which order they carry out. What was once seen
of a part is kept, as a plan forgets its steps when the next begins.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Final

from parley.language.builtin.lexicon import lemmas
from parley.messages.status import PlanProposal, PlanStep, PlanUpdate
from parley.messages.team import OVER, WAITS_FOR, MissionInfo, MissionPart, PartState
from parley.sentences import Sentence, listed, sentence, together

__all__ = ["KEPT", "MissionBook", "Part"]

KEPT: Final = 8
"""So many missions that are over are still told of."""
ENDED: Final = "“{words}” has ended."
_ENDED: Final = frozenset({"finished", "skipped", "stopped"})
_ALL_OF_IT: Final = {
    *("all", "every", "each", "both", "everything", "of", "the", "your", "our", "it", "that", "this", "them"),
    *("two", "three", "four", "five", "six", "work", "job", "mission", "round", "place"),
}
"""Words that tell nothing of a mission from the rest of it."""


@dataclass(slots=True)
class Part:
    """One robot's part, and what was seen of its steps."""

    info: MissionPart
    given_to: str = ""
    """Who is to do it instead, if its robot gives it up."""
    seen: dict[str, PlanStep] = field(default_factory=dict)
    """By id, as they were when they were seen last."""
    first: frozenset[str] = frozenset()
    """Those of the first plan; the others came in their place."""

    def set(self, state: PartState, **more: object) -> None:
        """It is so now."""
        self.info = self.info.model_copy(update={"state": state, **more})

    def see(self, own: Sequence[PlanStep], update: PlanUpdate) -> None:
        """Steps of it are in the plan of its robot."""
        self.first = self.first or frozenset(step.id for step in own)
        self.seen |= {step.id: step for step in own}
        shown = [step for step in own if not step.for_next and step.action.name != WAITS_FOR]
        done = sum(step.state == "finished" for step in shown)
        current = next((step for step in own if step.state not in _ENDED | {"queued"}), None)
        if current is not None and current.for_next:
            at = own.index(current)
            current = next((step for step in own[at:] if not step.for_next), current)
        label = _said(current) if current is not None else ""
        told = {"done": done, "count": len(shown), "label": label, "proposal": ""}
        if all(step.state in _ENDED for step in own):
            self.end(own, **told)
        elif any(step.state == "failed" for step in own):
            self.set("held", **told)
        elif update.state == "paused":
            self.set("paused", **told)
        elif current is not None and current.action.name == WAITS_FOR:
            self.set("waiting", **told)
        elif current is not None or done:
            self.set("running", **told)
        else:
            self.set("queued", **told)

    def end(self, own: Sequence[PlanStep] = (), **told: object) -> None:
        """Nothing more comes of it; what was not done is named."""
        here = {step.id for step in own}
        left = [step for step in own if step.state != "finished" and step.action.name != WAITS_FOR]
        spare = [s.action.name for s in own if s.state == "finished" and s.id not in self.first]
        for identity, step in self.seen.items():
            over = step.state == "finished" or step.action.name == WAITS_FOR
            if identity in here or identity not in self.first or over:
                continue
            if step.action.name in spare:
                spare.remove(step.action.name)
            else:
                left.append(step)
        lines = tuple(dict.fromkeys(_said(step) for step in left if not step.for_next))
        if not self.seen:
            lines = self.info.lines
        state: PartState = "done" if self.seen and not left else "given" if self.given_to else "undone"
        self.set(state, **{**told, "left": () if state == "done" else lines, "label": "", "proposal": ""})

    @property
    def far(self) -> tuple[list[str], list[str]]:
        """What of it is done, and what is not, as people read it."""
        done = [_said(step) for step in self.shown if step.state == "finished"]
        if self.info.state in OVER:
            return done if self.seen or self.info.state != "done" else [*self.info.lines], [*self.info.left]
        left = [_said(step) for step in self.shown if step.state not in _ENDED]
        return done, left if self.seen else [*self.info.lines]

    @property
    def shown(self) -> list[PlanStep]:
        """Its steps that people read of."""
        return [step for step in self.seen.values() if not step.for_next and step.action.name != WAITS_FOR]


@dataclass(slots=True)
class _Mission:
    info: MissionInfo
    parts: list[Part]

    @property
    def shown(self) -> MissionInfo:
        return self.info.model_copy(update={"parts": tuple(part.info for part in self.parts)})

    @property
    def is_over(self) -> bool:
        return all(part.info.state in OVER for part in self.parts)


class MissionBook:
    """All missions.

    Args:
        close: Gets each mission that has ended, once, with its closing line.
    """

    def __init__(self, close: Callable[[MissionInfo, Sentence], str]) -> None:
        self._close = close
        self._missions: dict[str, _Mission] = {}

    @property
    def shown(self) -> tuple[MissionInfo, ...]:
        """As others see them, oldest first."""
        return tuple(mission.shown for mission in self._missions.values())

    def begin(self, info: MissionInfo) -> None:
        """A team is told to do something."""
        self._missions[info.id] = _Mission(info, [Part(part) for part in info.parts])
        over = [name for name, mission in self._missions.items() if mission.is_over]
        for name in over[:-KEPT]:
            del self._missions[name]

    def restore(self, missions: Sequence[MissionInfo]) -> None:
        """What an earlier process followed; what goes on is seen again when its robots tell of it."""
        for info in missions:
            mission = self._missions[info.id] = _Mission(info, [Part(part) for part in info.parts])
            for part in mission.parts:
                if part.info.state not in OVER:
                    part.set("interrupted", proposal="")

    def relieve(self, robot: str, others: Sequence[MissionPart]) -> bool:
        """Others do what is left of a robot's part; whether it has one that is not over."""
        for mission in reversed(self._missions.values()):
            for part in mission.parts:
                if part.info.robot == robot and part.info.state not in OVER:
                    part.given_to = ", ".join(other.robot for other in others)
                    new = [other.model_copy(update={"instead_of": robot}) for other in others]
                    mission.parts += [Part(other) for other in new]
                    return True
        return False

    def beside(self, robot: str) -> list[MissionPart]:
        """What others still do of the newest mission that a robot has a part of."""
        for mission in reversed(self._missions.values()):
            going = [part.info for part in mission.parts if part.info.state not in OVER]
            if any(part.robot == robot for part in going):
                return [part for part in going if part.robot != robot]
        return []

    def progress(self, what: str = "", *, ended: bool = True) -> Sentence | None:
        """How far the newest mission is that has to do with `what`; None: there is none.

        Args:
            what: Something, or several of a kind, in a person's words; empty: all of it.
            ended: Whether "all" may mean one that has ended, as nobody is at anything else.
        """
        named = [{word, *lemmas(word)} for word in _words(what) - _ALL_OF_IT]
        for mission in reversed(self._missions.values()):
            told = [(part.info, *part.far) for part in mission.parts]
            every = [line for _, done, left in told for line in (*done, *left)]
            about = [line for line in every if all(forms & _words(line) for forms in named)]
            if about and (named or ended or not mission.is_over):
                each = [
                    one
                    for info, *lines in told
                    for one in _far(info, *([line for line in some if line in about] for some in lines))
                ]
                words = sentence("Not all of “{words}” is done yet.", words=mission.info.words)
                if mission.is_over:
                    words = sentence(ENDED, words=mission.info.words)
                if not any(info.state in ("undone", "refused") for info, *_ in told) and mission.is_over:
                    words = closing(mission.info.words, [info for info, *_ in told])
                return together(*((words,) if len(about) == len(every) else ()), *each)
        return None

    def going(self, robot: str) -> MissionPart | None:
        """The newest part of a robot that is not over."""
        parts = [part.info for part in self._parts() if part.info.robot == robot]
        return next((part for part in reversed(parts) if part.state not in OVER), None)

    def of(self, order: str) -> MissionInfo | None:
        """The mission of which an order is a part."""
        for mission in self._missions.values():
            if order and any(part.info.order == order for part in mission.parts):
                return mission.shown
        return None

    def refuse(self, order: str) -> None:
        """A part is not done at all."""
        for part in self._of(order):
            if part.info.state not in OVER:
                part.set("refused", left=part.info.lines)
        self._look()

    def drop(self, order: str, robot: str) -> None:
        """A robot was told to drop an order, or (empty) all; of what is not known nothing else will tell."""
        for part in self._parts():
            mine = part.info.robot == robot and order in ("", part.info.order)
            if mine and part.info.state == "interrupted":
                part.end()
        self._look()

    def on_proposal(self, proposal: PlanProposal) -> None:
        """Steps of a part wait for a yes."""
        for part in self._of(proposal.order):
            if proposal.target == part.info.robot and not part.seen:
                told = {"proposal": proposal.id, "count": len(proposal.lines), "steps": proposal.steps}
                part.set("asked", **told)

    def on_update(self, update: PlanUpdate) -> None:
        """The plan of a robot changed."""
        begun = {step.order for step in update.steps}  # a yes may end what went before it, and then begin
        for mission in self._missions.values():
            for part in mission.parts:
                goes_on = part.info.state not in OVER or part.seen
                anew = part.info.order in begun and not mission.info.closing
                if part.info.robot == update.target and (goes_on or anew):
                    self._take(part, update)
        self._look()

    def on_presence(self, robot: str, *, there: bool) -> None:
        """A robot came or left."""
        for part in self._parts():
            if part.info.robot != robot or part.info.state in OVER:
                continue
            if not there:
                part.set("away")
            elif part.info.state == "away":
                part.set("interrupted")
        self._look()

    def _take(self, part: Part, update: PlanUpdate) -> None:
        own = [step for step in update.steps if step.order == part.info.order]
        waits = part.info.proposal and (update.waits is None or part.info.proposal in update.waits)
        if own:
            part.see(own, update)
        elif part.info.state in OVER or waits:
            return
        elif part.seen or part.info.state in ("asked", "waiting") or (
            part.info.state == "interrupted" and update.steps
        ):  # fmt: skip
            part.end()

    def _look(self) -> None:
        for mission in self._missions.values():
            if mission.is_over and not mission.info.closing:
                text = self._close(mission.shown, closing(mission.info.words, mission.shown.parts))
                mission.info = mission.info.model_copy(update={"closing": text})

    def _parts(self) -> list[Part]:
        return [part for mission in self._missions.values() for part in mission.parts]

    def _of(self, order: str) -> list[Part]:
        return [part for part in self._parts() if order and part.info.order == order]


def closing(words: str, parts: Sequence[MissionPart]) -> Sentence:
    """How a mission ended: what of it was not done is named.

    What was begun is left out only because somebody said so; what was refused, nobody wanted so.
    """
    missed = [part for part in parts if part.state in ("undone", "refused")]
    if not missed:
        return sentence("All of “{words}” is done.", words=words)
    told: Mapping[PartState, str] = {
        "undone": "{robot} left out: {steps}.",
        "refused": "{robot} had to leave its part: {steps}.",
    }
    refused = any(part.state == "refused" for part in missed)
    ended = "“{words}” has ended, and not all of it is done." if refused else ENDED
    return together(
        sentence(ended, words=words),
        *(sentence(told[part.state], robot=part.robot, steps=listed(part.left)) for part in missed),
    )


def _far(info: MissionPart, done: Sequence[str], left: Sequence[str]) -> list[Sentence]:
    """How far a robot is with its part."""
    told = [sentence("{robot} has done: {steps}.", robot=info.robot, steps=listed(done))] if done else []
    if info.state == "interrupted":
        return [*told, sentence("What has become of the part of {robot} is not known.", robot=info.robot)]
    if left and info.state not in OVER:
        told.append(sentence("{robot} still has to do: {steps}.", robot=info.robot, steps=listed(left)))
    elif left and info.state != "given":
        told.append(sentence("{robot} left out: {steps}.", robot=info.robot, steps=listed(left)))
    return told


def _words(text: str) -> set[str]:
    return {*re.findall(r"\w+", text.lower())}


def _said(step: PlanStep) -> str:
    return step.label or step.action.reason or step.action.name
