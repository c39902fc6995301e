"""What language engines that are made of others share: all of it is open, or nothing is."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import AbstractAsyncContextManager, AsyncExitStack

from parley.opening import OpenedTogether

__all__ = ["Opened"]


class Opened(OpenedTogether):
    """Opens those of its parts that need it.

    Args:
        parts: What it consists of; what needs no opening is passed over.
    """

    def __init__(self, parts: Sequence[object]) -> None:
        super().__init__()
        self._parts = tuple(parts)

    async def _open(self, stack: AsyncExitStack) -> None:
        for part in self._parts:
            if isinstance(part, AbstractAsyncContextManager):
                await stack.enter_async_context(part)
