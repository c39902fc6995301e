"""When everything that an operator asked of a robot is done, so that it can say so, once. Pure."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Final

from parley.agents.chat.texts import SAY_CARRY_ON
from parley.gate.heard import left_out
from parley.messages.status import ActionInfo, PlanStep, PlanUpdate
from parley.sentences import sentence

__all__ = ["Finishing"]

_SHORT_S: Final = 3.0
"""Robot time within which whoever asked is still looking."""
_NO_DEEDS: Final = frozenset({"locates", "asks_operator"})
_NAMED: Final = 3
"""How many steps are named."""


@dataclass(slots=True)
class _Job:
    """What one robot does from the moment it begins until nothing is left."""

    state: str = "idle"
    began_s: float = 0.0
    answered: int = 0
    """How many of its questions were answered."""
    failed: list[PlanStep] = field(default_factory=list)
    """The plan as it was when a step of it failed."""


class Finishing:
    """Follows the plans of all robots.

    Only work that moves a robot and that takes a while, or several steps, is worth a word; what was stopped
    or cancelled is not finished, and what was left out is named. What was done is named by the steps
    themselves: the words of an order do not tell what has become of it.

    Args:
        now_s: Robot time.
    """

    def __init__(self, now_s: Callable[[], float]) -> None:
        self._now_s = now_s
        self._jobs: dict[str, _Job] = {}

    def on_update(self, update: PlanUpdate, catalogue: Sequence[ActionInfo]) -> str:
        """A robot's plan changed; returns what is to be said about it, or an empty text."""
        job = self._jobs.setdefault(update.target, _Job())
        was, job.state = job.state, update.state
        if update.state in ("idle", "awaiting_approval"):
            ended = was not in ("idle", "awaiting_approval")
            text = self._told(job, update.steps, catalogue) if ended else ""
            job.failed = []
            return text
        if was in ("idle", "awaiting_approval"):
            job.began_s = self._now_s()
        if update.state == "held":
            job.failed = list(update.steps)
        asking = {info.name for info in catalogue if "asks_operator" in info.effects}
        done = sum(step.state == "finished" and step.action.name in asking for step in update.steps)
        before, job.answered = job.answered, done
        # Whoever did what it had asked for waits for it to go on.
        return sentence(SAY_CARRY_ON) if was == update.state == "paused" and done > before else ""

    def _told(self, job: _Job, steps: Sequence[PlanStep], catalogue: Sequence[ActionInfo]) -> str:
        done = [step for step in steps if step.state == "finished"]
        moving = {info.name for info in catalogue if "moves" in info.effects}
        if any(step.state in ("stopped", "failed") for step in steps):
            return ""
        left = [*left_out(steps), *_less(done, job.failed)]
        if not left and not any(step.action.name in moving for step in done):
            return ""
        if not left and len(steps) < 2 and self._now_s() - job.began_s < _SHORT_S:
            return ""
        if left:
            return sentence("I have finished. I left out: {what}.", what="; ".join(_named(left, catalogue)))
        named = _named(done, catalogue)
        what = "; ".join(named[:_NAMED])
        if len(named) > _NAMED:
            what = sentence("{first} and {count} more", first=what, count=len(named) - _NAMED)
        return sentence("I have finished: {what}.", what=what)


def _said(step: PlanStep) -> str:
    return step.label or step.action.reason or step.action.name


def _less(done: Sequence[PlanStep], once: Sequence[PlanStep]) -> list[PlanStep]:
    """Of the plan that had failed, what was left out in the end."""
    known, here = {step.id for step in once}, {step.id for step in done}
    spare = [step.action.name for step in done if step.id not in known]  # done in the place of others
    left = []
    for step in once:
        if step.id in here or step.state in ("skipped", "finished"):
            continue
        if step.action.name in spare:
            spare.remove(step.action.name)
        else:
            left.append(step)
    return left


def _named(steps: Sequence[PlanStep], catalogue: Sequence[ActionInfo]) -> list[str]:
    """What people read of steps, each once; without searches and questions, unless there is nothing else."""
    small = {info.name for info in catalogue if info.effects and set(info.effects) <= _NO_DEEDS}
    named = [_said(step) for step in steps if step.action.name not in small] or [_said(s) for s in steps]
    return list(dict.fromkeys(named))
