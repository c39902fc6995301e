"""What a robot says while a plan waits for a person's yes, and what counts as a yes or a no. Pure."""

from __future__ import annotations

import math
import re
import unicodedata
from collections.abc import Sequence
from typing import Final

from parley.messages.chat import ActionCall
from parley.messages.status import PlanDecision, PlanProposal, PlanUpdate, PoseInfo
from parley.sentences import sentence, together

__all__ = ["CHANGED", "REFUSED", "SHALL_I", "Offered", "as_wish", "assent_of", "offered_again", "past_offer"]

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

_MOVED_M: Final = 0.5
"""Farther from where it was, a robot counts as being somewhere else."""

_AT_ONCE: Final = "remember|forget|keep|note|not|never|leave|drop|stop|wait|pause|skip|no longer"
"""What follows "I will" where it is done without waiting for a yes, or is not done."""
_ANNOUNCED: Final = re.compile(rf"\b(?:I will|I'll|I’ll|I am going to|I'm going to)\b(?! (?:{_AT_ONCE})\b)")


def as_wish(message: str, calls: Sequence[ActionCall]) -> str:
    """What the robot would do, made of what it says it will do.

    Args:
        message: The words of the language engine, which does not know that a person is asked first.
        calls: The steps. Where the words announce nothing in a way that can be told here, these are named.
    """
    wish, count = _ANNOUNCED.subn("I would", message)
    if count:
        return wish.strip()
    steps = "; ".join(dict.fromkeys(call.reason or call.name for call in calls))
    return sentence("This is what I would do: {steps}.", steps=steps.rstrip("."))


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


_YES: Final = frozenset({
    "yes", "yes please", "yes do", "yes do it", "yes do that", "yes go ahead", "yeah", "yep", "yup", "ok",
    "okay", "sure", "of course", "agreed", "fine", "alright", "all right", "do it", "do that", "do so",
    "please do", "go for it", "you may", "approved", "sounds good", "that is fine", "jah", "jaa", "jah palun",
    "olgu", "sobib", "tee nii", "tee ära",
})  # fmt: skip
_NO: Final = frozenset({
    "no", "nope", "no thanks", "no thank you", "no do not", "do not", "do not do it", "do not do that",
    "please do not", "rather not", "better not", "never mind", "leave it", "no leave it", "rejected", "ei",
    "ei aitäh", "ära tee", "ei ära tee", "pole vaja",
})  # fmt: skip


def assent_of(text: str, names: Sequence[str] = ()) -> bool | None:
    """Whether a whole utterance is a yes (True) or a no (False); None for everything else.

    Args:
        text: What the operator said.
        names: Names of robots, which may be called before or after.
    """
    if "?" in text:
        return None
    low = re.sub(r"\bdon['’]?t\b", "do not", unicodedata.normalize("NFC", text).casefold())
    words = [word for word in re.split(r"\W+", low.replace("that's", "that is")) if word]
    called = {part for name in names for part in name.casefold().split()}
    said = " ".join(word for word in words if word not in called)
    bare = said.removeprefix("please ").removesuffix(" please").removesuffix(" thanks")
    if said in _YES or bare in _YES:
        return True
    return False if said in _NO or bare in _NO else None


def _apart_m(one: PoseInfo, other: PoseInfo) -> float:
    return math.hypot(one.x - other.x, one.y - other.y)


class Offered:
    """Which proposals of each robot wait, so that a yes or a no that is said can be handed on."""

    def __init__(self) -> None:
        self._waiting: dict[str, list[str]] = {}
        self._states: dict[str, str] = {}

    def on_proposal(self, proposal: PlanProposal) -> None:
        """Steps wait for a yes."""
        waiting = self._waiting.setdefault(proposal.target, [])
        if proposal.id not in waiting:
            waiting.append(proposal.id)

    def on_decision(self, decision: PlanDecision) -> None:
        """Somebody decided."""
        waiting = self._waiting.get(decision.target, [])
        if decision.id in waiting:
            waiting.remove(decision.id)

    def on_update(self, update: PlanUpdate) -> None:
        """A plan changed: nothing waits where no plan is, nor where a robot was told to begin."""
        was, self._states[update.target] = self._states.get(update.target, "idle"), update.state
        if update.state == "idle" or (was == "awaiting_approval" != update.state):
            self._waiting.pop(update.target, None)

    def decided(self, target: str, said: str, names: Sequence[str]) -> PlanDecision | None:
        """What `said` decides about what was proposed last; None if it decides nothing."""
        waiting = self._waiting.get(target)
        assent = assent_of(said, names) if waiting else None
        if not waiting or assent is None:
            return None
        return PlanDecision(id=waiting[-1], target=target, decision="approve" if assent else "reject")
