"""One failed step until it is settled: what was asked, said and tried. Pure; the error handler wires it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Final, Literal

from parley.errors import FailureCode
from parley.gate.cards import for_next
from parley.language.base import ErrorSituation, Turn
from parley.messages.chat import ActionCall, ChatAction
from parley.messages.failure import ErrorHandlingMessage
from parley.messages.incident import Incident, IncidentAttempt
from parley.messages.memory import MemoryEntry
from parley.messages.status import ActionInfo, ActorStatus, PlanUpdate
from parley.sentences import sentence
from parley.world.geometry import Pose2D
from parley.world.object_map import MapObject

__all__ = [
    "MAX_ALONE",
    "Ending",
    "Repair",
    "ending_of",
    "failed_situation",
    "left_over_text",
    "memory_query",
    "steps_left",
]

MAX_ALONE: Final = 3
"""Corrections of one step that are tried without asking; then the operator is asked."""

MAX_NOTED: Final = 100
"""Attempts in a record; somebody may talk for hours with a robot that waits."""
_MAX_TURNS: Final = 100

Ending = Literal["open", "solved", "skipped", "cancelled", "replaced", "held"]

_CODE_WORDS: Final[dict[FailureCode, str]] = {
    FailureCode.NO_MATCH: "cannot find, cannot see, not there, missing, unknown",
    FailureCode.AMBIGUOUS: "several, which one, not sure",
    FailureCode.UNREACHABLE: "cannot reach, no way, closed",
    FailureCode.BLOCKED: "blocked, in the way, stuck, obstacle",
    FailureCode.TIMED_OUT: "takes too long, late, slow",
    FailureCode.UNAVAILABLE: "does not answer, not available",
    FailureCode.NOT_CAPABLE: "cannot do, not able",
    FailureCode.ATTENTION: "see, find, notice, problem, danger",
    FailureCode.DECLINED: "say no, refuse",
    FailureCode.NOT_UNDERSTOOD: "not understand",
    FailureCode.FORBIDDEN: "not allowed, forbidden, must not",
    FailureCode.HARDWARE: "broken, does not work, fails",
    FailureCode.INTERNAL: "error, goes wrong, fails",
}
"""How people speak of a failure when they teach what is to be done about it."""


@dataclass(slots=True)
class Repair:
    """One failed step and what was said about it."""

    failure: ErrorHandlingMessage
    incident: Incident
    attempts: int = 0
    """Questions asked so far, over all failures of this step in a row."""
    alone: int = 0
    """Corrections tried without asking, over all failures of this step in a row."""
    question: ChatAction | None = None
    """What was asked last; it may have to be repeated."""
    question_id: str = ""
    """Open question, empty when none is."""
    seen_held: bool = False
    """Whether the plan was reported as held since; before that, its reports are older than the failure."""
    dialogue: list[Turn] = field(default_factory=list)
    tried: list[tuple[ActionCall, ...]] = field(default_factory=list)
    """Corrections that were carried out; the last may still be under way."""

    @classmethod
    def begin(
        cls, failure: ErrorHandlingMessage, *, incident_id: str, unix_ms: int, label: str = ""
    ) -> Repair:
        """The repair of a step that failed for the first time."""
        incident = Incident(
            id=incident_id,
            robot=failure.target,
            graph_name=failure.failure_id.rpartition("/")[0],
            step=failure.action_called,
            label=label,
            code=failure.code,
            message=failure.error_message,
            opened_unix_ms=unix_ms,
        )
        return cls(failure, incident)

    def again(self, failure: ErrorHandlingMessage) -> None:
        """The step failed once more: what was tried did not help."""
        self.failure, self.question, self.question_id, self.seen_held = failure, None, "", False
        self.incident = self.incident.model_copy(
            update={"code": failure.code, "message": failure.error_message}
        )

    def is_repeated_by(self, failure: ErrorHandlingMessage) -> bool:
        """Whether `failure` is one of this step, or of what was tried in its place, with nothing achieved."""
        if len(failure.umrf_queue) < len(self.failure.umrf_queue):
            return False
        steps = [self.failure.action_called, *(self.tried[-1] if self.tried else ())]
        return _key(failure.action_called) in {_key(step) for step in steps}

    def is_known(self, correction: ChatAction) -> bool:
        """Whether a correction was tried already, in vain."""
        keys = [_key(step) for step in correction.queue]
        return bool(keys) and any([_key(step) for step in tried] == keys for tried in self.tried)

    def outcome(self, update: PlanUpdate) -> Ending:
        """How the correction ended, by what the planner reports; `open` while it is under way."""
        states = [step.state for step in update.steps]
        if update.state == "held":
            return "open"
        if update.state == "idle":
            return "cancelled" if "stopped" in states else "solved"
        wanted = len(self.failure.completed) + (len(self.tried[-1]) if self.tried else 0)
        same = update.graph_name == self.incident.graph_name
        return "solved" if same and states.count("finished") >= wanted else "open"

    def note_turn(self, turn: Turn) -> None:
        """Take over what was said; very old turns are forgotten."""
        self.dialogue.append(turn)
        del self.dialogue[:-_MAX_TURNS]

    def note_correction(self, correction: Sequence[ActionCall]) -> None:
        """Take over what is carried out now in place of the step (nothing: the step as it was)."""
        self.tried.append(tuple(correction) or (self.failure.action_called,))
        del self.tried[:-_MAX_TURNS]

    # -- the record ------------------------------------------------------------------------------------

    def note_asked(self, question: str, unix_ms: int) -> None:
        """Write down that the operator was asked."""
        self._note(IncidentAttempt(kind="asked", asked=question, unix_ms=unix_ms))
        self.incident = self.incident.model_copy(update={"questions": self.incident.questions + 1})

    def note_answered(self, reply: str) -> None:
        """Write down what the operator said."""
        self._renew(answered=reply)

    def note_tried(self, text: str, *, alone: bool, unix_ms: int) -> None:
        """Write down what is tried now."""
        if alone or not self.incident.attempts:
            self._note(IncidentAttempt(kind="alone", tried=text, unix_ms=unix_ms))
        else:
            self._renew(tried=text)

    def note_end(self, ending: Ending, unix_ms: int, note: str = "") -> None:
        """Write down how it ended."""
        changes = {"ending": ending, "closed_unix_ms": unix_ms, "note": note or self.incident.note}
        self.incident = self.incident.model_copy(update=changes)

    def _note(self, attempt: IncidentAttempt) -> None:
        first, later = self.incident.attempts[:1], self.incident.attempts[1:]
        attempts = (*first, *later[2 - MAX_NOTED :], attempt)
        self.incident = self.incident.model_copy(update={"attempts": attempts})

    def _renew(self, **changes: str) -> None:
        if not self.incident.attempts:
            return
        *earlier, last = self.incident.attempts
        renewed = (*earlier, last.model_copy(update=changes))
        self.incident = self.incident.model_copy(update={"attempts": renewed})


def ending_of(correction: ChatAction) -> Ending:
    """How a failure ends by a correction; `open` while it has to be seen whether it helps."""
    commands = {command.command for command in correction.system_cmd}
    if "clear" in commands:
        return "replaced" if correction.queue else "cancelled"
    if correction.queue or "start" in commands:
        return "open"
    return "held" if commands & {"stop", "pause"} else "skipped"


def failed_situation(
    failure: ErrorHandlingMessage,
    *,
    memory: Sequence[MemoryEntry],
    objects: Sequence[MapObject],
    status: ActorStatus | None,
) -> ErrorSituation:
    """What is known about a failed step before anything was said about it."""
    pose = status.pose if status is not None else None
    return ErrorSituation(
        error_message=failure.error_message,
        failed_action=failure.action_called,
        code=failure.code,
        details=failure.details,
        completed=failure.completed,
        results=failure.results,
        pending=failure.umrf_queue,
        steps=failure.steps,
        order=failure.order,
        memory=tuple(memory),
        objects=tuple(objects),
        robot=failure.target,
        robot_pose=Pose2D(pose.x, pose.y, pose.yaw) if pose is not None else None,
        catalogue=status.catalogue if status is not None else (),
    )


def left_over_text(incident: Incident) -> str:
    """About a failure that was not settled when the program ended, for the operator."""
    return sentence(
        "I was started anew before this was settled: {problem} Please give the order again if it still "
        "holds.",
        problem=incident.message,
    )


def memory_query(failure: ErrorHandlingMessage, reply: str | None) -> str:
    """What to look up in memory about a failure: its words, what people call such a thing, the answer."""
    step = failure.action_called
    values = [str(p.value) for p in step.input_parameters.values() if p.type == "string" and p.has_data]
    parts = [failure.error_message, *values, step.reason, _CODE_WORDS[failure.code], reply or ""]
    return "\n".join(part for part in parts if part)


def steps_left(calls: Sequence[ActionCall], catalogue: Sequence[ActionInfo]) -> str:
    """What is still to be done, for the operator."""
    calls = [call for call, hidden in zip(calls, for_next(calls, catalogue), strict=True) if not hidden]
    reasons = [call.reason for call in calls if call.reason]
    if not reasons:
        several = sentence("{count} steps are left.", count=len(calls))
        return several if len(calls) != 1 else sentence("One step is left.")
    return sentence("Left to do: {steps}.", steps="; ".join(reasons))


def _key(step: ActionCall) -> tuple[object, ...]:
    """What makes two steps the same, whatever was filled in from steps before.

    The reason only tells steps without words apart: a model gives another one each time.
    """
    words = tuple(
        (name, str(p.value)) for name, p in sorted(step.input_parameters.items()) if p.type == "string"
    )
    return step.name, words, "" if words else step.reason
