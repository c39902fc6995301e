"""Chat entries become durable first and visible then, in the order they came, many with one write."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Iterable
from types import TracebackType
from typing import Self

import structlog

from parley.errors import StoreError
from parley.web.models import ChatEntry
from parley.web.store import KeptPicture, WebStore

__all__ = ["Keeper"]

log = structlog.get_logger(__name__)


class Keeper:
    """Writes in the background. Use as ``async with``; leaving it writes what waits.

    Args:
        store: Where to.
        show: Gets each entry once it is durable. One that cannot be stored is shown all the same: that a
            robot said something matters more than that it is kept.
    """

    def __init__(self, store: WebStore, show: Callable[[ChatEntry], None]) -> None:
        self._store, self._show = store, show
        self._waiting: list[ChatEntry] = []
        self._pictures: list[KeptPicture] = []
        self._arrived = asyncio.Event()
        self._closing = False
        self._task: asyncio.Task[None] | None = None

    async def __aenter__(self) -> Self:
        self._task = asyncio.create_task(self._run(), name="web keeper")
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._closing = True
        self._arrived.set()
        if self._task is not None:
            await asyncio.gather(self._task, return_exceptions=True)

    def put(self, entry: ChatEntry) -> None:
        """Store and then show `entry`; returns at once."""
        self._waiting.append(entry)
        self._arrived.set()

    def put_pictures(self, pictures: Iterable[KeptPicture]) -> None:
        """Store them together with the entries that are put next."""
        self._pictures += pictures

    async def _run(self) -> None:
        while self._waiting or not self._closing:
            await self._arrived.wait()
            self._arrived.clear()
            batch, self._waiting = self._waiting, []
            pictures, self._pictures = self._pictures, []
            if not batch:
                continue
            try:
                await self._store.keep(batch, pictures)
            except StoreError as error:
                log.error("chat not stored", entries=len(batch), problem=str(error))
            for entry in batch:
                self._show(entry)
