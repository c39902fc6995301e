"""A language engine that plays a script: for tests, rehearsals and bug reports, wherever a `Language` fits.

What is not in the script is answered by the engine behind it, or with a `LanguageError`.
"""

from __future__ import annotations

import asyncio
from collections import defaultdict, deque
from collections.abc import Sequence
from typing import Any, Literal

from parley.errors import LanguageError
from parley.language.base import (
    DraftHandler,
    ErrorSituation,
    Grounding,
    InspectionReport,
    Language,
    ReplyReading,
    Situation,
)
from parley.messages.chat import ChatAction
from parley.messages.memory import MemoryEntry
from parley.robots.base import CameraImage
from parley.world.geometry import Pose2D
from parley.world.object_map import MapObject, ObjectMap

__all__ = ["Question", "ScriptedLanguage"]

Question = Literal["interpret", "select_memories", "resolve", "ground", "inspect", "read_reply"]


class ScriptedLanguage:
    """Gives prepared answers, in order, per question.

    Args:
        behind: Answers what is not in the script.
    """

    def __init__(self, behind: Language | None = None) -> None:
        self._behind = behind
        self._script: dict[str, deque[Any]] = defaultdict(deque)
        self.asked: list[tuple[Question, Any]] = []
        """Every question with its first argument, in order."""

    @property
    def label(self) -> str:
        """See `Language.label`."""
        return "scripted"

    @property
    def sees_pictures(self) -> bool:
        """See `Language.sees_pictures`."""
        return True

    def will(self, question: Question, *answers: Any) -> None:
        """Prepare answers: values, exceptions to raise, or an `asyncio.Event` to wait for before the next."""
        self._script[question].extend(answers)

    async def _answer(self, question: Question, asked: Any, *rest: Any) -> Any:
        self.asked.append((question, asked))
        prepared = self._script[question]
        while prepared:
            answer = prepared.popleft()
            if isinstance(answer, asyncio.Event):
                await answer.wait()
            elif isinstance(answer, Exception):
                raise answer
            else:
                return answer
        if self._behind is None:
            raise LanguageError(f"the script has no answer to {question}")
        return await getattr(self._behind, question)(asked, *rest)

    async def interpret(self, situation: Situation, *, on_draft: DraftHandler | None = None) -> ChatAction:
        """See `Language.interpret`; texts in the script before the answer are drafts of its reply."""
        prepared = self._script["interpret"]
        while prepared and isinstance(prepared[0], str):
            draft = prepared.popleft()
            if on_draft is not None:
                on_draft(draft)
        answer: ChatAction = await self._answer("interpret", situation)
        return answer

    async def select_memories(self, query: str, index: Sequence[MemoryEntry]) -> list[str]:
        """See `Language.select_memories`; without a script everything is selected."""
        if not self._script["select_memories"] and self._behind is None:
            return [entry.name for entry in index]
        answer: list[str] = await self._answer("select_memories", query, index)
        return answer

    async def resolve(self, situation: ErrorSituation) -> ChatAction:
        """See `Language.resolve`."""
        answer: ChatAction = await self._answer("resolve", situation)
        return answer

    async def ground(
        self, description: str, objects: Sequence[MapObject], pose: Pose2D | None = None
    ) -> Grounding:
        """See `Language.ground`."""
        answer: Grounding = await self._answer("ground", description, objects, pose)
        return answer

    async def inspect(
        self, image: CameraImage, request: str, rules: Sequence[str] = (), known: ObjectMap | None = None
    ) -> InspectionReport:
        """See `Language.inspect`."""
        answer: InspectionReport = await self._answer("inspect", image, request, rules, known)
        return answer

    async def read_reply(self, question: str, reply: str, choices: Sequence[str] = ()) -> ReplyReading:
        """See `Language.read_reply`."""
        answer: ReplyReading = await self._answer("read_reply", question, reply, choices)
        return answer
