"""Several language engines, one after the other: the next is asked when one cannot answer."""

from __future__ import annotations

from collections.abc import Awaitable, Callable, Sequence
from typing import Final, TypeVar

import structlog

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
from parley.language.llm.failures import DeclinedError
from parley.language.llm.opened import Opened
from parley.messages.chat import ChatAction
from parley.messages.memory import MemoryEntry
from parley.robots.base import CameraImage
from parley.sentences import sentence, together
from parley.world.geometry import Pose2D
from parley.world.object_map import MapObject, ObjectMap

__all__ = ["BACK", "GONE", "ChainLanguage", "signed"]

log = structlog.get_logger(__name__)

R = TypeVar("R")

GONE: Final = "(My usual language service gives no answer; I work with a simpler one meanwhile.)"
"""Said once, when another engine steps in."""
BACK: Final = "(My usual language service answers again.)"
"""Said once, when it is over."""


def signed(answer: ChatAction, engine: Language) -> ChatAction:
    """The answer with who gave it."""
    return answer if answer.engine else answer.model_copy(update={"engine": engine.label})


class ChainLanguage(Opened):
    """Asks the first engine; what it cannot answer goes to the next. A refusal is final.

    Args:
        engines: In the order in which they are asked; at least one.
    """

    def __init__(self, engines: Sequence[Language]) -> None:
        super().__init__(engines)
        self.engines = tuple(engines)
        self._told = False

    @property
    def label(self) -> str:
        """See `Language.label`."""
        first, *others = [engine.label for engine in self.engines]
        return f"{first}; if it gives no answer: {', then '.join(others)}" if others else first

    @property
    def sees_pictures(self) -> bool:
        """See `Language.sees_pictures`."""
        return any(engine.sees_pictures for engine in self.engines)

    async def _first(self, ask: Callable[[Language], Awaitable[R]]) -> tuple[R, bool]:
        """The first answer, and whether it is the first engine's."""
        failures: list[LanguageError] = []
        for engine in self.engines:
            try:
                return await ask(engine), not failures
            except DeclinedError:
                raise
            except LanguageError as error:
                log.warning("language engine gave no answer", engine=engine.label, error=str(error))
                failures.append(error)
        raise failures[0]

    async def interpret(self, situation: Situation, *, on_draft: DraftHandler | None = None) -> ChatAction:
        """See `Language.interpret`."""

        async def ask(engine: Language) -> ChatAction:
            return signed(await engine.interpret(situation, on_draft=on_draft), engine)

        return self._noticed(*await self._first(ask))

    async def resolve(self, situation: ErrorSituation) -> ChatAction:
        """See `Language.resolve`."""

        async def ask(engine: Language) -> ChatAction:
            return signed(await engine.resolve(situation), engine)

        return self._noticed(*await self._first(ask))

    def _noticed(self, answer: ChatAction, usual: bool) -> ChatAction:
        """The answer, and that another engine gives it than the last one, if that is so."""
        if usual is not self._told:
            return answer
        self._told = not usual
        told = together(sentence(BACK if usual else GONE), answer.message_response)
        return answer.model_copy(update={"message_response": told})

    async def select_memories(self, query: str, index: Sequence[MemoryEntry]) -> list[str]:
        """See `Language.select_memories`."""
        return (await self._first(lambda engine: engine.select_memories(query, index)))[0]

    async def ground(
        self, description: str, objects: Sequence[MapObject], pose: Pose2D | None = None
    ) -> Grounding:
        """See `Language.ground`."""
        return (await self._first(lambda engine: engine.ground(description, objects, pose)))[0]

    async def inspect(
        self, image: CameraImage, request: str, rules: Sequence[str] = (), known: ObjectMap | None = None
    ) -> InspectionReport:
        """See `Language.inspect`."""
        return (await self._first(lambda engine: engine.inspect(image, request, rules, known)))[0]

    async def read_reply(self, question: str, reply: str, choices: Sequence[str] = ()) -> ReplyReading:
        """See `Language.read_reply`."""
        return (await self._first(lambda engine: engine.read_reply(question, reply, choices)))[0]
