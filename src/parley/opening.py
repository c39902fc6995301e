"""What consists of several parts: all of it is open, or nothing is."""

from __future__ import annotations

from abc import ABC, abstractmethod
from contextlib import AsyncExitStack
from types import TracebackType
from typing import Self

__all__ = ["OpenedTogether"]


class OpenedTogether(ABC):
    """Opens its parts in order and closes them in reverse, also those opened before one that fails."""

    def __init__(self) -> None:
        self._stack = AsyncExitStack()

    async def __aenter__(self) -> Self:
        async with AsyncExitStack() as stack:
            await self._open(stack)
            self._stack = stack.pop_all()
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        await self._stack.aclose()

    @abstractmethod
    async def _open(self, stack: AsyncExitStack) -> None:
        """Open everything on the stack."""
