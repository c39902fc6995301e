"""Commands in the order in which they came, without keeping the loop for long."""

from __future__ import annotations

import asyncio
from collections import Counter, deque
from collections.abc import Callable
from typing import Final

import structlog

__all__ = ["Inbox", "Work"]

log = structlog.get_logger(__name__)

Work = Callable[[], None]
"""Carries out one command."""

TURN_S: Final = 0.0005
"""Wall time in a turn of the loop after which no more is begun in it; graphs that were started in one turn
stay together in the loop, and wait for each other at each step."""


class Inbox:
    """Commands for `TURN_S` per turn of the loop, and at least one.

    Commands for the same graph keep their order. A light one for a graph that nothing waits for is carried
    out at once, so it overtakes heavy ones for other graphs.
    """

    def __init__(self) -> None:
        self._waiting: deque[tuple[str, Work]] = deque()
        self._names: Counter[str] = Counter()
        self._turn: asyncio.Handle | None = None

    def put(self, name: str, work: Work, *, light: bool = False) -> None:
        """Carry out `work` on the graph of that name, now or later; it tells its own errors."""
        if light and not self._names[name]:
            work()
            return
        self._waiting.append((name, work))
        self._names[name] += 1
        if self._turn is None:
            self._take_turn()

    def close(self) -> None:
        """Drop what waits."""
        if self._turn is not None:
            self._turn.cancel()
        self._waiting.clear()
        self._names.clear()

    def _take_turn(self) -> None:
        """Do what this turn has time for; it is used up even if nothing is left, as more may come in it."""
        self._turn = None
        if not self._waiting:
            return
        loop = asyncio.get_running_loop()
        until_s = loop.time() + TURN_S
        self._turn = loop.call_soon(self._take_turn)
        self._step()
        while self._waiting and loop.time() < until_s:
            self._step()

    def _step(self) -> None:
        name, work = self._waiting.popleft()
        try:
            work()
        except Exception:
            # The border of the engine: a defect in one command must not silence the others, but must be seen.
            log.exception("command failed", graph=name)
        self._names[name] -= 1
        if not self._names[name]:
            del self._names[name]
