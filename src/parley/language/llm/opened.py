"""What language engines that are made of others share: all of it is open, or nothing is."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import AbstractAsyncContextManager, AsyncExitStack
from types import TracebackType
from typing import Self

__all__ = ["Opened"]


class Opened:
    """Opens its parts in order and closes them in reverse, also those opened before one that fails.

    Args:
        parts: What it consists of; what needs no opening is passed over.
    """

    def __init__(self, parts: Sequence[object]) -> None:
        self._parts = tuple(parts)
        self._stack = AsyncExitStack()

    async def __aenter__(self) -> Self:
        async with AsyncExitStack() as opening:
            for part in self._parts:
                if isinstance(part, AbstractAsyncContextManager):
                    await opening.enter_async_context(part)
            self._stack = opening.pop_all()
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        await self._stack.aclose()
