"""Whether anybody subscribes to a topic, so that what nobody looks at costs nothing."""

from __future__ import annotations

import asyncio
from collections.abc import Iterable
from typing import Self

from parley.transport.base import Transport

__all__ = ["Watched"]


class Watched:
    """Knows whether one of some topics has a subscriber. Use as ``with``.

    Args:
        transport: Where the topics are.
        names: Names of the topics.
    """

    def __init__(self, transport: Transport, names: Iterable[str]) -> None:
        self._transport, self._names = transport, frozenset(names)
        self._watched = asyncio.Event()

    def __enter__(self) -> Self:
        self._forget = self._transport.on_endpoints_changed(self._look)
        self._look()
        return self

    def __exit__(self, *exc: object) -> None:
        self._forget()

    async def wait(self) -> None:
        """Return as soon as somebody subscribes, at once if somebody does."""
        await self._watched.wait()

    def _look(self) -> None:
        ends = self._transport.endpoints()
        if any(end.role == "subscription" and end.name in self._names for end in ends):
            self._watched.set()
        else:
            self._watched.clear()
