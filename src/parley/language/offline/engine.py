"""The offline language engine: the interface, answered by analysis instead of a model."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from parley.language.base import (
    DraftHandler,
    ErrorSituation,
    Grounding,
    InspectionReport,
    ReplyReading,
    Situation,
)
from parley.language.offline import interpreter
from parley.language.offline.facts import recall
from parley.language.offline.repair import recovery, replies
from parley.language.offline.repair.asides import about_failure
from parley.language.offline.repair.reordering import instead_of_answer
from parley.language.offline.scene import grounding
from parley.language.offline.tasks import pictures
from parley.language.offline.words.explaining import Decision, Trace
from parley.language.offline.words.proper import Proper, unmarked
from parley.messages.chat import ChatAction
from parley.messages.memory import MemoryEntry
from parley.messages.status import ActionInfo
from parley.robots.base import CameraImage
from parley.world.geometry import Pose2D
from parley.world.object_map import MapObject

__all__ = ["OfflineLanguage"]


_BLIND = "I cannot see what is in a picture that you send; I only keep it."


def _is_steered(info: ActionInfo) -> bool:
    """Whether it drives by a distance: this engine would take any "go" for it."""
    return "moves" in info.effects and any(told.kind == "distance" for told in info.parameters.values())


class OfflineLanguage:
    """Understands operators' English without model and network; deterministic, stateless, quick.

    It asks rather than guesses, and uses only the actions of the catalogue it is given.
    """

    @property
    def label(self) -> str:
        """See `Language.label`."""
        return "built-in language engine (offline, no model: plain English only)"

    @property
    def sees_pictures(self) -> bool:
        """See `Language.sees_pictures`."""
        return False

    async def interpret(self, situation: Situation, *, on_draft: DraftHandler | None = None) -> ChatAction:
        """See `Language.interpret`."""
        return self.explain(situation)[0]

    def explain(self, situation: Situation) -> tuple[ChatAction, tuple[Decision, ...]]:
        """As `interpret`, with what was decided on the way, in order."""
        known = tuple(info for info in situation.catalogue if not _is_steered(info))
        situation = replace(situation, catalogue=known)
        proper = Proper.of(situation)
        if proper is not None:
            situation = proper.situation(situation)
        trace = Trace()
        failure = situation.failure
        aside = about_failure(failure, situation.message) if failure is not None else None
        if aside is None and situation.question and failure is None:
            aside = instead_of_answer(situation, interpreter.interpret)
        answer = aside or interpreter.interpret(situation, trace)
        if any(picture.sent for picture in situation.pictures):
            answer = answer.model_copy(update={"message_response": f"{answer.message_response} {_BLIND}"})
        if proper is None:
            return answer, tuple(trace.decisions)
        told = tuple(Decision(decision.about, unmarked(decision.text)) for decision in trace.decisions)
        return unmarked(answer), told

    async def select_memories(self, query: str, index: Sequence[MemoryEntry]) -> list[str]:
        """See `Language.select_memories`."""
        return recall.select_memories(query, index)

    async def resolve(self, situation: ErrorSituation) -> ChatAction:
        """See `Language.resolve`."""
        proper = Proper.of(situation)
        return (
            recovery.resolve(situation)
            if proper is None
            else unmarked(recovery.resolve(proper.failure(situation)))
        )

    async def ground(
        self, description: str, objects: Sequence[MapObject], pose: Pose2D | None = None
    ) -> Grounding:
        """See `Language.ground`."""
        return grounding.ground(description, objects, pose)

    async def inspect(self, image: CameraImage, request: str, rules: Sequence[str] = ()) -> InspectionReport:
        """See `Language.inspect`.

        Raises:
            LanguageError: The robot has no detector, so nothing can be said about its pictures.
        """
        return pictures.inspect(image, request)

    async def read_reply(self, question: str, reply: str, choices: Sequence[str] = ()) -> ReplyReading:
        """See `Language.read_reply`."""
        return replies.read_reply(reply, choices, question)
