"""Proposals on their way to the file: written soon after they are made or decided about, in order."""

from __future__ import annotations

import asyncio
from collections import deque
from types import TracebackType
from typing import Self

import structlog

from parley.errors import StoreError
from parley.memory.proposals import KeptProposal, ProposalStore

__all__ = ["ProposalLog"]

log = structlog.get_logger(__name__)


class ProposalLog:
    """Writes behind what happens; use as ``async with``. A full disk is logged, and stops no robot.

    Args:
        store: The open file, closed by its owner; None keeps nothing.
    """

    def __init__(self, store: ProposalStore | None) -> None:
        self._store = store
        self._left: list[KeptProposal] = []
        self._waiting: deque[KeptProposal | str] = deque()
        self._writer: asyncio.Task[None] | None = None

    async def __aenter__(self) -> Self:
        if self._store is not None:
            try:
                self._left = list(await self._store.waiting())
            except (StoreError, ValueError) as error:
                log.error("proposals cannot be read", problem=str(error))
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._writer is not None:
            await asyncio.wait([self._writer])

    def take_left(self, target: str) -> list[KeptProposal]:
        """What an earlier process left of a robot, oldest first; given once."""
        found = [kept for kept in self._left if kept.proposal.target == target]
        self._left = [kept for kept in self._left if kept.proposal.target != target]
        return found

    def keep(self, kept: KeptProposal) -> None:
        """Write a proposal down."""
        self._write_soon(kept)

    def drop(self, identity: str) -> None:
        """Forget the proposal of that id."""
        self._write_soon(identity)

    def _write_soon(self, change: KeptProposal | str) -> None:
        if self._store is None:
            return
        self._waiting.append(change)
        if self._writer is None or self._writer.done():
            self._writer = asyncio.get_running_loop().create_task(self._write(self._store), name="proposals")

    async def _write(self, store: ProposalStore) -> None:
        while self._waiting:
            change = self._waiting.popleft()
            try:
                if isinstance(change, str):
                    await store.drop(change)
                else:
                    await store.keep(change)
            except StoreError as error:
                log.error("proposal not written", problem=str(error))
