"""What the operator sees, computed from messages alone: no transport, no terminal, no clock of its own.

Every ``on_...`` method takes one message and returns the lines that it adds to the conversation.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Final

from parley.messages.chat import ChatFeedback, ReplyDraft
from parley.messages.status import (
    ActorStatus,
    GraphEvent,
    PlanProposal,
    PlanStep,
    PlanUpdate,
    Rejection,
    StopReport,
    Trouble,
)
from parley.sentences import SpokenLanguage, in_language, sentence
from parley.terminal.lines import Fragments, Line, LineKind
from parley.terminal.plan import Progress, call_in_words, compare, is_over, lines_of, plan_rows, step_row

__all__ = ["LOST_AFTER_S", "OperatorView", "Question", "RobotView"]

_KINDS: dict[str, LineKind] = {"response": "said", "info": "said", "request": "asked", "error": "problem"}

MOODS: Final = {
    "idle": "ready",
    "running": "working",
    "paused": "paused",
    "held": "waiting for you",
    "awaiting_approval": "waiting for your yes",
    "question": "waiting for your answer",
    "stopped": "stopped, /reset lets it move again",
    "lost": "no contact",
}
"""`RobotView.mood` in words."""
STOPS: Final = {
    "received": "{robot} is stopping. To let it move again: /reset, then “carry on”.",
    "at_rest": "{robot} stands still.",
    "moving": "{robot} does not stand yet.",
    "silent": "{robot} does not answer. Look whether it stands.",
    "reset": "{robot} may move again. Write “carry on” to go on.",
}
NOT_RELEASED: Final = "{robot} has not heard that it is released and stays stopped. Write /reset again."
"""`StopReport.state` in words."""
_DRAFT_CHARS = 70

ANSWERS_WITHIN_S = 2.0
"""Wall time in which a robot that is told to stop says that it was."""
LOST_AFTER_S = 2.0
"""Wall time without a heartbeat, of which there is one a second, after which a robot does not answer."""


@dataclass(frozen=True, slots=True)
class Question:
    """What a robot asked and nobody has answered yet."""

    id: str
    """May be empty: other programs' questions have none."""
    text: str = ""
    choices: tuple[str, ...] = ()


@dataclass(slots=True)
class RobotView:
    """One robot as the operator sees it."""

    name: str
    state: str = "idle"
    """`ActorStatus.state` of the last heartbeat."""
    stop: str = ""
    """The emergency stop in force, as it said last."""
    seen_s: float = 0.0
    """Wall time of the last heartbeat."""
    is_here: bool = False
    """Whether it ever sent a heartbeat; others may speak of robots that do not exist."""
    is_lost: bool = False
    trouble: Trouble = ""
    plan: PlanUpdate | None = None
    progress: Progress | None = None
    pending: list[Question | PlanProposal] = field(default_factory=list)
    """Questions and proposals that await the operator, oldest first."""
    spoke_since: bool = False
    """Whether it said something else since it asked for a yes: then a yes may mean that."""
    draft: str = ""
    """The reply that it is writing, as far as it is."""
    offered: tuple[str, ...] = ()
    """Choices of the robot's last word, where it was no question."""

    @property
    def question(self) -> Question | None:
        """The open question that was asked last, if there is one."""
        return next((item for item in reversed(self.pending) if isinstance(item, Question)), None)

    @property
    def mood(self) -> str:
        """What it is doing, a key of `MOODS`."""
        if self.is_lost:
            return "lost"
        if self.state == "stopped":
            return "stopped"
        if self.question is not None:
            return "question"
        if self.plan is not None and self.plan.state != "idle":
            return self.plan.state
        return "running" if self.state == "running" else "idle"

    @property
    def is_busy(self) -> bool:
        """Whether it does something that needs nothing from the operator."""
        return self.mood == "running"

    @property
    def may_move(self) -> bool:
        """Whether an emergency stop could still make a difference."""
        return not self.is_lost and (self.state in ("running", "paused") or self.mood == "running")


class OperatorView:
    """Everything an operator is shown of all robots, in the language that they read.

    What robots say is put into it too, and what is sent back stays as it was: choices and steps.
    """

    def __init__(self, language: SpokenLanguage = "en") -> None:
        self.language = language
        self.robots: dict[str, RobotView] = {}
        self.selected = ""
        """Name of the robot that is spoken to; empty as long as none is known."""
        self.replies = 0
        """Counts what robots said, so that a reader of prepared lines can wait for an answer."""
        self._own_stops: set[str] = set()
        self._silent_s: dict[str, float | None] = {}
        """Robots that have not answered a stop -> since when, in wall time."""
        self._unreleased_s: dict[str, float | None] = {}
        """The same for a release."""

    def say(self, template: str, **values: object) -> str:
        """A sentence of the terminal's own, with ``{names}`` filled in."""
        return in_language(sentence(template, **values), self.language)

    @property
    def here(self) -> list[RobotView]:
        """The robots that have said that they are there."""
        return [robot for robot in self.robots.values() if robot.is_here]

    @property
    def current(self) -> RobotView | None:
        """The robot that is spoken to."""
        return self.robots.get(self.selected)

    def select(self, name: str) -> RobotView | None:
        """Speak to the robot of that name, upper or lower case; None if there is none."""
        found = next((robot for robot in self.here if robot.name.lower() == name.lower()), None)
        if found is not None:
            self.selected = found.name
        return found

    def note_own_stop(self, stop_id: str, targets: Sequence[str] = ()) -> None:
        """Remember a stop command of this operator, who was told about it already; no targets means all."""
        self._own_stops.add(stop_id)
        named = targets or [robot.name for robot in self.here]
        self._silent_s |= dict.fromkeys(named)
        for name in named:
            self._unreleased_s.pop(name, None)

    def note_own_release(self, targets: Sequence[str] = ()) -> None:
        """Remember whom this operator released, of those who are stopped; no targets means all."""
        named = targets or [robot.name for robot in self.here]
        stopped = [robot.name for robot in self.here if robot.state == "stopped"]
        self._unreleased_s |= dict.fromkeys(name for name in named if name in stopped)

    def known_stops(self) -> tuple[str, ...]:
        """The emergency stops that this operator knows of, by id."""
        return tuple(sorted({robot.stop for robot in self.here if robot.stop} | self._own_stops))

    def on_feedback(self, feedback: ChatFeedback) -> list[Line]:
        """A robot speaks."""
        self.replies += 1
        for name in feedback.targets:
            _hear(self._robot(name), feedback)
        sources = ", ".join(name.replace("_", " ") for name in feedback.sources)
        told = [
            self.say("remembered: {names}", names=sources) if sources else "",
            feedback.engine.partition(" (")[0],
        ]
        footnote = " · ".join(filter(None, told))
        return [
            Line(
                "asked" if feedback.choices or feedback.asks_back else _KINDS[feedback.type],
                in_language(feedback.message, self.language),
                speaker=", ".join(feedback.targets) or "Parley",
                choices=self.choices(feedback.choices),
                footnote=footnote,
            )
        ]

    def on_draft(self, draft: ReplyDraft) -> list[Line]:
        """A robot's reply grows; it stands in the live view until the whole of it comes."""
        for name in draft.targets:
            self._robot(name).draft = draft.message
        return []

    def on_plan(self, message: PlanUpdate | PlanProposal) -> list[Line]:
        """A plan is proposed or has changed."""
        robot = self._robot(message.target)
        if isinstance(message, PlanProposal):
            return self._propose(robot, message)
        before, robot.plan = robot.plan, message
        was = before.state if before is not None else "idle"
        if message.waits is not None:
            robot.pending = [
                item
                for item in robot.pending
                if not isinstance(item, PlanProposal) or item.id in message.waits
            ]
        elif was == "awaiting_approval" != message.state:
            robot.pending = [item for item in robot.pending if not isinstance(item, PlanProposal)]
        if was != "idle" and message.state == "idle":
            robot.pending.clear()
        is_new, ended = compare(before, message)
        lines = [Line("step", step_row(step, self.language)) for step in ended]
        to_come = [step for step in lines_of(message.steps) if not is_over(step)]
        if is_new and to_come and message.state != "awaiting_approval":
            lines += self._plan(robot, to_come)
        return lines

    def on_event(self, event: GraphEvent) -> list[Line]:
        """A step gets on or ends; only the live view changes."""
        robot = self._robot(event.actor)
        if event.kind == "progress":
            robot.progress = Progress(event.node, event.progress, event.progress_text)
        elif robot.progress is not None and event.node in ("", robot.progress.node):
            robot.progress = None
        return []

    def on_status(self, status: ActorStatus, now_s: float) -> list[Line]:
        """A heartbeat: robots come, go and change their state. `now_s` is wall time."""
        if status.state == "leaving":
            return self._leave(status.actor)
        robot = self._robot(status.actor)
        is_new, was_lost = not robot.is_here, robot.is_lost
        falls_silent = status.trouble == "silent" != robot.trouble
        robot.is_here, robot.is_lost, robot.trouble = True, False, status.trouble
        robot.state, robot.stop, robot.seen_s = status.state, status.stop, now_s
        self.selected = self.selected or robot.name
        if is_new:
            return [Line("note", self.say("{robot} is here.", robot=robot.name))]
        if falls_silent:
            return [Line("problem", self.say(STOPS["silent"], robot=robot.name))]
        return [Line("note", self.say("{robot} is in contact again.", robot=robot.name))] if was_lost else []

    def tick(self, now_s: float, *, late_s: float = 0.0) -> list[Line]:
        """Time passes: notice who has fallen silent.

        Args:
            now_s: Wall time.
            late_s: How much later than it wanted the caller comes: so long nobody was heard here.
        """
        lines: list[Line] = []
        for robot in self.here:
            robot.seen_s = min(now_s, robot.seen_s + max(0.0, late_s))
            if not robot.is_lost and now_s - robot.seen_s > LOST_AFTER_S:
                robot.is_lost = True
                lines.append(Line("problem", self.say("No contact with {robot}.", robot=robot.name)))
        for waiting, words in ((self._silent_s, STOPS["silent"]), (self._unreleased_s, NOT_RELEASED)):
            for name, since_s in list(waiting.items()):
                if since_s is None:
                    waiting[name] = now_s
                elif now_s - since_s > ANSWERS_WITHIN_S:
                    del waiting[name]
                    lines.append(Line("problem", self.say(words, robot=name)))
        return lines

    def on_stop_report(self, report: StopReport) -> list[Line]:
        """A robot says what became of an emergency stop."""
        robot = self._robot(report.actor)
        self._silent_s.pop(report.actor, None)
        if report.state == "reset":
            self._unreleased_s.pop(report.actor, None)
        if report.state != "reset":
            robot.state = "stopped"
        elif robot.state == "stopped":
            robot.state = "paused"
        if report.state == "received" and report.id in self._own_stops:
            return []
        return [Line("note", self.say(STOPS[report.state], robot=robot.name))]

    def on_rejection(self, rejection: Rejection) -> list[Line]:
        """Something was refused; the operator hears it without the vocabulary of engineers."""
        if self._is_told_otherwise(rejection):
            return []
        self.replies += 1
        robot = rejection.target or "Parley"
        if any(problem.code == "stop_latched" for problem in rejection.problems):
            return [
                Line(
                    "problem",
                    self.say("{robot} was stopped by the emergency stop. Write /reset first.", robot=robot),
                )
            ]
        if rejection.what == "chat_interface_input" and rejection.problems:
            return [
                Line(
                    "problem",
                    self.say(
                        "That could not be read, and nothing was changed: {problem}",
                        problem=rejection.problems[0].message,
                    ),
                )
            ]
        return [
            Line("problem", self.say("{robot} could not accept that, and nothing was changed.", robot=robot))
        ]

    def plan_lines(self, robot: RobotView) -> list[Line]:
        """The whole plan of a robot for the conversation."""
        steps = robot.plan.steps if robot.plan is not None else ()
        if not steps:
            return [Line("note", self.say("{robot} has nothing to do.", robot=robot.name))]
        return self._plan(robot, steps)

    def toolbar(self) -> list[Fragments]:
        """The live rows below the prompt: who does what, and the plan of the robot that is spoken to."""
        current = self.current
        others = [robot for robot in self.here if robot is not current]
        rows: list[Fragments] = []
        if current is not None:
            rows.append([("class:robot", f" {self._mood(current)}")])
        if current is not None and current.draft:
            rows.append([("class:dim", f" … {_end_of(current.draft)}")])
        if others:
            rows.append([("class:dim", f" {' · '.join(self._mood(robot) for robot in others)}")])
        if current is not None and current.plan is not None and current.plan.state != "idle":
            rows += plan_rows(current.plan.steps, self.language, current.progress)
        return rows

    def choices(self, choices: Sequence[str]) -> tuple[str, ...]:
        """Answers that are offered, as they are shown."""
        return tuple(in_language(choice, self.language) for choice in choices)

    def _robot(self, name: str) -> RobotView:
        return self.robots.setdefault(name, RobotView(name))

    def _mood(self, robot: RobotView) -> str:
        return f"{robot.name}: {self.say(MOODS[robot.mood])}"

    def _is_told_otherwise(self, rejection: Rejection) -> bool:
        """Whether a node speaks of it in the conversation: those do, except of what they cannot read."""
        if any(problem.code == "invalid_message" for problem in rejection.problems):
            return False
        robot = self.robots.get(rejection.source)
        if robot is None:
            return True
        return robot.plan is not None and robot.plan.graph_name == rejection.graph_name != ""

    def _propose(self, robot: RobotView, proposal: PlanProposal) -> list[Line]:
        """Show the steps that wait for a yes; the robot says the words that go with them itself."""
        if proposal in robot.pending:
            return []  # told again for somebody who came later
        self.replies += 1
        robot.pending = [item for item in robot.pending if item.id != proposal.id]
        robot.pending.append(proposal)
        robot.spoke_since = False
        heading = Line("heading", self.say("{robot} would do this:", robot=robot.name))
        lines = proposal.lines or tuple(map(call_in_words, proposal.steps))
        rows = [
            Line("step", f"{number}. {in_language(text, self.language)}")
            for number, text in enumerate(lines, 1)
        ]
        return [heading, *rows, Line("asked", self.say("Answer yes or no."))]

    def _plan(self, robot: RobotView, steps: Sequence[PlanStep]) -> list[Line]:
        """A heading and the steps; those to come are numbered as operators call them ("the second")."""
        lines = [Line("heading", self.say("{robot}'s plan:", robot=robot.name))]
        number = 0
        for step in lines_of(steps):
            number += 0 if is_over(step) else 1
            progress = robot.progress if robot.progress and robot.progress.node == step.node else None
            lines.append(Line("step", step_row(step, self.language, number=number, progress=progress)))
        return lines

    def _leave(self, name: str) -> list[Line]:
        if name not in self.robots:
            return []
        del self.robots[name]
        lines = [Line("note", self.say("{robot} has left.", robot=name))]
        if self.selected == name:
            self.selected = next((robot.name for robot in self.here), "")
            lines += (
                [Line("note", self.say("You are now talking to {robot}.", robot=self.selected))]
                if self.selected
                else []
            )
        return lines


def _end_of(text: str) -> str:
    """What was written last, on one row."""
    flat = " ".join(text.split())
    return flat if len(flat) <= _DRAFT_CHARS else f"…{flat[-_DRAFT_CHARS:]}"


def _hear(robot: RobotView, feedback: ChatFeedback) -> None:
    """Keep what a robot's words ask for; a question without an id lasts until the robot's next words."""
    settled = {feedback.closes} if feedback.closes else set()
    if feedback.type in ("response", "error"):
        robot.draft = ""
    if feedback.type != "info":
        robot.spoke_since = not feedback.asks_yes
    if feedback.type in ("request", "response"):
        settled.add("")
    robot.pending = [
        item for item in robot.pending if isinstance(item, PlanProposal) or item.id not in settled
    ]
    if feedback.type == "request":
        robot.pending.append(Question(feedback.id, feedback.message, feedback.choices))
    if feedback.type in ("request", "response") or feedback.choices:
        robot.offered = feedback.choices if feedback.type != "request" else ()
