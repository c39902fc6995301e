"""What a robot says while a plan waits for a person's yes, and what counts as a yes or a no. Pure."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Final

from parley.gate.assent import assent_of
from parley.latest import Latest
from parley.messages.chat import ChatFeedback, ChatInput
from parley.messages.status import PlanDecision, PlanProposal, PlanUpdate, PoseInfo
from parley.sentences import Sentence, listed, sentence, together

__all__ = [
    "CHANGED",
    "REFUSED",
    "SHALL_I",
    "Offered",
    "begun",
    "counted",
    "offered_again",
    "past_offer",
    "wish_of",
]

SHALL_I: Final = sentence("Shall I?")
REFUSED: Final = "All right, I will not do it."
CHANGED: Final = "All right, I will do it the way you changed it."

_PLAN_LEFT: Final = sentence(
    "I was started anew while a plan waited for your yes. Nothing of it has been done, and things may have "
    "changed since, so please look at it again."
)
_REPAIR_LEFT: Final = sentence(
    "I was started anew while a way out of what failed waited for your yes. Nothing of it has been done, and "
    "things may have changed since, so please look at it again."
)

_TOLD: Final = 3
"""So many steps of many are said once more when they begin."""
_MOVED_M: Final = 0.5
"""Farther from where it was, a robot counts as being somewhere else."""


def wish_of(lines: Sequence[str], why: str = "") -> str:
    """What the robot would do, made of what it will really do.

    Args:
        lines: One per step as people read them, written by our code.
        why: Why it is asked though the policy would not ask; may be empty.
    """
    wish = sentence("This is what I would do: {steps}.", steps=counted(lines))
    return together(sentence("I ask first: {why}.", why=why), wish) if why else wish


def begun(lines: Sequence[str]) -> str:
    """What a yes starts, said when it was given: of many steps, which were just read, the first ones."""
    if len(lines) <= _TOLD + 1:
        return sentence("All right: {steps}.", steps=counted(lines))
    steps = sentence("{first} and {count} more", first=counted(lines[:_TOLD]), count=len(lines) - _TOLD)
    return sentence("All right: {steps}.", steps=steps)


def counted(lines: Sequence[str]) -> str:
    """Steps as people read them, with their numbers if there are several."""
    if len(lines) == 1:
        return _ended(lines[0])
    return listed([sentence("{number}. {step}", number=n, step=_ended(x)) for n, x in enumerate(lines, 1)])


def _ended(label: str) -> str:
    return label.rstrip(".") if not isinstance(label, Sentence) else label


def offered_again(wish: str, before: PoseInfo | None, now: PoseInfo | None, *, repairs: bool) -> str:
    """What the operator is told about a plan that an earlier process left waiting.

    Args:
        wish: What the robot would do.
        before: Where it was when it proposed that, if known.
        now: Where it is.
        repairs: Whether it is about a step that failed.
    """
    away = before is not None and now is not None and _apart_m(before, now) > _MOVED_M
    moved = sentence("I am not where I was then.") if away else ""
    return together(_REPAIR_LEFT if repairs else _PLAN_LEFT, moved, wish, SHALL_I)


def past_offer(wish: str) -> str:
    """About a plan that waited when the earlier process ended and cannot be carried out any more."""
    return sentence(
        "I was started anew while a plan waited for your yes. It is not possible any more, so I dropped it: "
        "“{wish}” Please give the order again if it still holds.",
        wish=wish,
    )


def _apart_m(one: PoseInfo, other: PoseInfo) -> float:
    return math.hypot(one.x - other.x, one.y - other.y)


class Offered:
    """Which proposals of each robot wait, so that a yes or a no that is said can be handed on."""

    def __init__(self) -> None:
        self._waiting: dict[str, list[PlanProposal]] = {}
        self._asked: Latest[str, bool] = Latest()
        self._early: set[str] = set()
        """Robots that asked about something that is still on its way here."""

    def on_proposal(self, proposal: PlanProposal) -> None:
        """Steps wait for a yes; one in words counts once the robot has asked about them."""
        waiting = self._waiting.setdefault(proposal.target, [])
        if all(other.id != proposal.id for other in waiting):
            self._asked[proposal.target] = proposal.target in self._early
            self._early.discard(proposal.target)
            waiting.append(proposal)

    def on_decision(self, decision: PlanDecision) -> None:
        """Somebody decided."""
        waiting = self._waiting.get(decision.target, [])
        waiting[:] = [proposal for proposal in waiting if proposal.id != decision.id]

    def on_update(self, update: PlanUpdate) -> None:
        """A plan changed: what was replaced or given up waits no more, and nothing where no plan is."""
        waiting = self._waiting.get(update.target, [])
        if update.waits is not None:
            waiting[:] = [proposal for proposal in waiting if proposal.id in update.waits]
        if update.state == "idle":
            self._waiting.pop(update.target, None)

    def on_said(self, feedback: ChatFeedback) -> None:
        """A robot speaks: a yes counts for what it said last, so only if that was the question."""
        for target in feedback.targets:
            asked = self._asked[target] = feedback.asks_yes
            (self._early.add if asked and self.newest(target) is None else self._early.discard)(target)

    def is_asked(self, target: str) -> bool:
        """Whether the question about what waits is the last thing the robot said."""
        return self._asked.get(target, False)

    def newest(self, target: str) -> PlanProposal | None:
        """What was proposed last of what waits."""
        waiting = self._waiting.get(target)
        return waiting[-1] if waiting else None

    def decided(self, target: str, said: ChatInput, names: Sequence[str]) -> PlanDecision | None:
        """What a message decides about what was proposed last; None if it decides nothing."""
        newest = self.newest(target)
        if newest is None:
            return None
        assent = assent_of(said.message, names, to_see=bool(newest.why))
        if assent is None:
            return None
        return PlanDecision(
            id=newest.id,
            target=target,
            decision="approve" if assent else "reject",
            digest=newest.digest,
            by=said.who,
        )
