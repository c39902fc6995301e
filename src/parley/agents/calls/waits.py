"""Which robots wait for a person, for how long, and whom that calls by now. Pure: the time is handed in."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from parley.agents.questions import OpenQuestions
from parley.latest import Latest
from parley.messages.chat import ChatFeedback, ChatInput
from parley.messages.status import PlanProposal, PlanUpdate
from parley.sentences import Sentence, listed, sentence

__all__ = ["Due", "Waits"]


@dataclass(frozen=True, slots=True)
class Due:
    """A robot that has waited so long that somebody is to be called."""

    stage: int
    robot: str
    text: Sentence
    waited_s: float


class Waits:
    """What waits, and which calls were made for it.

    Args:
        after_s: For each stage how long something must have waited.
    """

    def __init__(self, after_s: Sequence[float]) -> None:
        self.questions = OpenQuestions()
        self._after_s = after_s
        self._which: Latest[str, ChatFeedback] = Latest()
        """Replies that ask for what an order lacks, until the robot says or hears something else."""
        self._asked_last: Latest[str, ChatFeedback] = Latest()
        self._proposals: Latest[str, list[PlanProposal]] = Latest()
        self._since: dict[str, float] = {}
        self._called: set[tuple[str, int]] = set()

    def on_feedback(self, feedback: ChatFeedback) -> None:
        """A robot asks, or asks no more."""
        self.questions.on_feedback(feedback)
        for robot in feedback.targets if feedback.type == "response" else ():
            self._which.pop(robot, None)
            if feedback.asks_back:
                self._which[robot] = self._asked_last[robot] = feedback
            last = self._asked_last.get(robot)
            if last is not None and feedback.still_asks and last.reply_to == feedback.still_asks:
                self._which[robot] = last

    def on_input(self, said: ChatInput) -> None:
        """Somebody is there."""
        self.questions.on_input(said)
        for robot in said.targets:
            self._which.pop(robot, None)

    def on_plan(self, told: PlanUpdate | PlanProposal) -> None:
        """A plan waits for a yes, or does not any more."""
        before = self._proposals.get(told.target) or []
        if isinstance(told, PlanProposal):
            self._proposals[told.target] = [one for one in before if one.id != told.id] + [told]
        elif told.waits is not None or told.state == "idle":
            self._proposals[told.target] = [one for one in before if one.id in (told.waits or ())]

    def due(self, now_s: float) -> list[Due]:
        """The calls that are to be made now; each is given once."""
        waiting = {key: (robot, text) for key, robot, text in self._waiting()}
        self._since = {key: self._since.get(key, now_s) for key in waiting}
        self._called = {call for call in self._called if call[0] in waiting}
        found = [
            ((key, stage), Due(stage, robot, text, now_s - self._since[key]))
            for key, (robot, text) in waiting.items()
            for stage, after_s in enumerate(self._after_s)
            if now_s - self._since[key] >= after_s and (key, stage) not in self._called
        ]
        self._called |= {call for call, _ in found}
        return [due for _, due in found]

    def _waiting(self) -> Iterable[tuple[str, str, Sentence]]:
        for robot in self.questions.robots():
            if (asked := self.questions.newest(robot)) is not None:
                yield f"{robot} {asked.id}", robot, _asks(robot, asked)
        for robot, asked in self._which.items():
            yield f"{robot} {asked.id} {asked.reply_to}", robot, _asks(robot, asked)
        for robot, proposals in self._proposals.items():
            for one in proposals:
                what = listed(one.lines)
                yield one.id, robot, sentence("{robot} waits for a yes: {what}", robot=robot, what=what)


def _asks(robot: str, asked: ChatFeedback) -> Sentence:
    return sentence("{robot} asks: {what}", robot=robot, what=asked.message)
