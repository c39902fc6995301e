"""When everything that an operator asked of a robot is done, so that it can say so, once. Pure."""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass, field
from typing import Final

from parley.messages.chat import ActionCall
from parley.messages.status import ActionInfo, PlanDecision, PlanProposal, PlanStep, PlanUpdate
from parley.sentences import listed, sentence

__all__ = ["Finishing"]

_SHORT_S: Final = 3.0
"""Robot time within which whoever asked is still looking."""
_WORDS_CHARS: Final = 120
_NAMED: Final = 3
"""How many requests are repeated word for word."""


@dataclass(slots=True)
class _Job:
    """What one robot does from the moment it begins until nothing is left."""

    state: str = "idle"
    graph_name: str = ""
    steps: int = 0
    began_s: float = 0.0
    failed: list[PlanStep] = field(default_factory=list)
    """The plan as it was when a step of it failed."""
    words: list[str] = field(default_factory=list)
    """What was asked for."""
    unclear: str = ""
    """What was asked for and had to be asked back about."""
    edited: bool = False
    """A person changed the steps, so the words do not tell any more what is done."""
    asked: str = ""
    """What was asked for last and is not in the plan yet."""
    instead: bool = False
    """Whether that takes the place of what was asked for before."""
    offered: dict[str, str] = field(default_factory=dict)
    """What was asked for and waits for a yes, by proposal."""


class Finishing:
    """Follows the plans of all robots.

    Only work that moves a robot and that takes a while, or several steps, is worth a word; what was stopped
    or cancelled is not finished, and what was left out is named.

    Args:
        now_s: Robot time.
    """

    def __init__(self, now_s: Callable[[], float]) -> None:
        self._now_s = now_s
        self._jobs: dict[str, _Job] = {}

    def on_order(self, target: str, words: str, *, instead: bool = False) -> None:
        """An order goes to the planner.

        Args:
            target: The robot.
            words: The operator's.
            instead: Whether it takes the place of what failed and was given up.
        """
        job = self._job(target)
        job.asked = _together(job.unclear, words)
        job.unclear, job.instead = "", instead

    def on_answer(self, target: str, words: str, *, asks_back: bool) -> None:
        """A message was answered with words alone.

        Args:
            target: The robot.
            words: The operator's.
            asks_back: Whether they were an order that is not clear yet: what is said next belongs to it.
        """
        job = self._job(target)
        job.unclear = _together(job.unclear, words) if asks_back else ""

    def on_proposal(self, proposal: PlanProposal) -> None:
        """What was asked for last waits for a yes."""
        job = self._job(proposal.target)
        if proposal.id not in job.offered:
            job.offered[proposal.id], job.asked = job.asked, ""

    def on_decision(self, decision: PlanDecision) -> None:
        """A person decided about a proposal, or changed a plan."""
        job = self._job(decision.target)
        words = job.offered.pop(decision.id, "")
        if decision.decision == "approve":
            job.asked = words
        job.edited = job.edited or decision.decision == "edit"

    def on_update(self, update: PlanUpdate, catalogue: Sequence[ActionInfo]) -> str:
        """A robot's plan changed; returns what is to be said about it, or an empty text."""
        job = self._job(update.target)
        was, job.state = job.state, update.state
        if update.state in ("idle", "awaiting_approval"):
            ended = was not in ("idle", "awaiting_approval")
            text = self._told(job, update.steps, catalogue) if ended else ""
            if ended:
                job.words, job.edited, job.steps, job.failed = [], False, 0, []
            return text
        if was in ("idle", "awaiting_approval"):
            job.began_s = self._now_s()
        if job.asked and (update.graph_name != job.graph_name or len(update.steps) > job.steps):
            job.words = [*([] if job.instead else job.words), job.asked]
            job.failed = [] if job.instead else job.failed
            job.asked, job.instead = "", False
        job.graph_name, job.steps = update.graph_name, len(update.steps)
        if update.state == "held":
            job.failed = list(update.steps)
        return ""

    def _told(self, job: _Job, steps: Sequence[PlanStep], catalogue: Sequence[ActionInfo]) -> str:
        done = [step.action for step in steps if step.state == "finished"]
        moving = {info.name for info in catalogue if "moves" in info.effects}
        if any(step.state in ("stopped", "failed") for step in steps):
            return ""
        left = [*_skipped(steps), *_less(done, job.failed)]
        if not left and not any(c.name in moving for c in done):
            return ""
        if not left and len(steps) < 2 and self._now_s() - job.began_s < _SHORT_S:
            return ""
        finding = {info.name for info in catalogue if info.only_finds}
        if left:
            named = [step.label or step.action.name for step in left if step.action.name not in finding]
            named = named or [step.label or step.action.name for step in left]
            return sentence("I have finished. I left out: {what}.", what="; ".join(dict.fromkeys(named)))
        return sentence("I have finished: {what}.", what=_named(job, done, finding))

    def _job(self, target: str) -> _Job:
        return self._jobs.setdefault(target, _Job())


def _skipped(steps: Sequence[PlanStep]) -> list[PlanStep]:
    """What was left out, but for what a condition excluded, and for what was only put off and done later."""
    left = []
    for at, step in enumerate(steps):
        later = {_said(other) for other in steps[at + 1 :] if other.state == "finished"}
        excluded = step.action.flow is not None and step.action.flow.if_ is not None
        if step.state == "skipped" and not excluded and _said(step) not in later:
            left.append(step)
    return left


def _said(step: PlanStep) -> str:
    return step.label or step.action.reason or step.action.name


def _less(done: Sequence[ActionCall], once: Sequence[PlanStep]) -> list[PlanStep]:
    """Of the plan that had failed, what was left out in the end."""
    names = [call.name for call in done]
    left = []
    for step in reversed(once):
        if step.action.name in names:
            names.remove(step.action.name)
        elif step.state != "skipped":
            left.append(step)
    return left[::-1]


def _named(job: _Job, done: Sequence[ActionCall], finding: Collection[str]) -> str:
    words = list(dict.fromkeys(_short(text) for text in job.words))
    if job.edited or not words:
        words = list(dict.fromkeys(c.reason or c.name for c in done if c.name not in finding))
    named = [sentence("“{words}”", words=text.strip().rstrip(".")) for text in words[:_NAMED]]
    if len(words) > _NAMED:
        return sentence("{first} and {count} more", first=listed(named), count=len(words) - _NAMED)
    return (
        named[0]
        if len(named) == 1
        else sentence("{first} and {last}", first=listed(named[:-1]), last=named[-1])
    )


def _together(order: str, answer: str) -> str:
    """An order and what was answered when it was asked about."""
    return f"{order.strip().rstrip('.')} – {answer}" if order else answer


def _short(text: str) -> str:
    return text if len(text) <= _WORDS_CHARS else f"{text[:_WORDS_CHARS].rstrip()} …"
