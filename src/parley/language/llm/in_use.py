"""The language engine in use: who interprets asks it, and it can be another one while the system runs."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Sequence
from contextlib import AbstractAsyncContextManager, AsyncExitStack

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
from parley.opening import OpenedTogether
from parley.robots.base import CameraImage
from parley.world.geometry import Pose2D
from parley.world.object_map import MapObject, ObjectMap

__all__ = ["EngineInUse"]


class EngineInUse(OpenedTogether):
    """Passes each question on to the engine that is in use when it is asked. Use as ``async with``.

    Args:
        first: The one to begin with.
        build: Makes the one of a name; may take its time.
    """

    def __init__(self, first: Language, build: Callable[[str], Language]) -> None:
        super().__init__()
        self._build, self._engine = build, first
        self._known = {"": first}
        self._changing = asyncio.Lock()
        self.chosen = ""
        """The name of the one that was put in the place of the first; empty: that is in use."""

    async def _open(self, stack: AsyncExitStack) -> None:
        await _opened(self._engine, stack)

    async def use(self, name: str) -> None:
        """Put the engine of that name in its place, for what is asked from now on; empty: the first again.

        What was asked before is answered by the one before: all stay open until this is closed.

        Raises:
            ConfigError: There is none of that name, or it lacks a library or a key.
        """
        async with self._changing:
            if name not in self._known:
                engine = await asyncio.to_thread(self._build, name)
                await _opened(engine, self._stack)
                self._known[name] = engine
            self._engine, self.chosen = self._known[name], name

    @property
    def label(self) -> str:
        """See `Language.label`."""
        return self._engine.label

    @property
    def sees_pictures(self) -> bool:
        """See `Language.sees_pictures`."""
        return self._engine.sees_pictures

    async def interpret(self, situation: Situation, *, on_draft: DraftHandler | None = None) -> ChatAction:
        """See `Language.interpret`."""
        return await self._engine.interpret(situation, on_draft=on_draft)

    async def select_memories(self, query: str, index: Sequence[MemoryEntry]) -> list[str]:
        """See `Language.select_memories`."""
        return await self._engine.select_memories(query, index)

    async def resolve(self, situation: ErrorSituation) -> ChatAction:
        """See `Language.resolve`."""
        return await self._engine.resolve(situation)

    async def ground(
        self, description: str, objects: Sequence[MapObject], pose: Pose2D | None = None
    ) -> Grounding:
        """See `Language.ground`."""
        return await self._engine.ground(description, objects, pose)

    async def inspect(
        self, image: CameraImage, request: str, rules: Sequence[str] = (), known: ObjectMap | None = None
    ) -> InspectionReport:
        """See `Language.inspect`."""
        return await self._engine.inspect(image, request, rules, known)

    async def read_reply(self, question: str, reply: str, choices: Sequence[str] = ()) -> ReplyReading:
        """See `Language.read_reply`."""
        return await self._engine.read_reply(question, reply, choices)


async def _opened(engine: Language, stack: AsyncExitStack) -> None:
    if isinstance(engine, AbstractAsyncContextManager):
        await stack.enter_async_context(engine)
