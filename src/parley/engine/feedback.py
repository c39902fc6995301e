"""The compatible feedback topic: whole graphs, coalesced, the last state always sent (12)."""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Final

from parley.clock import Clock
from parley.messages.ros import UmrfGraphFeedback
from parley.umrf.executor import GraphRun
from parley.umrf.io import GraphWriter
from parley.umrf.model import ENDED, Graph, GraphState

__all__ = ["Feedback"]

INTERVAL_S: Final = 0.008
"""What changes within it is told at its end, so that a free loop tells everything within 10 ms."""

_REST_FACTOR: Final = 9
"""Writing takes a tenth of the time at most, so that large graphs and many of them leave time for actions."""

_MANY: Final = 200
"""If more graphs than this wait, there is no rest, as all that wait are kept for so long; and several are
written in one turn of the loop, as starts may take the most of each."""

_TURN_S: Final = 0.0005
"""Wall time in a turn of the loop after which nothing more is written in it."""

_SLICE: Final = 50
"""So many nodes are written in one turn of the loop, about a millisecond; a stop must not wait longer."""

_RESTING: Final = ENDED | {GraphState.HALTED}


@dataclass(slots=True, eq=False)
class _Due:
    run: GraphRun
    writer: GraphWriter = field(default_factory=GraphWriter)
    timer: asyncio.Handle | None = None
    """Set while its interval is not over."""
    waits: bool = False
    """Whether it stands in the queue, or its timer will put it there."""
    not_before_s: float = 0.0
    """Wall time from which the next message may be sent."""


class Feedback:
    """Publishes a graph soon after it changed: at once if it was quiet, else when its interval is over.

    Args:
        actor: Goes into each message.
        clock: For the wall time.
        publish: Where the messages go.
        interval_s: At most one message per graph in this wall time.
    """

    def __init__(
        self,
        actor: str,
        clock: Clock,
        publish: Callable[[UmrfGraphFeedback], None],
        *,
        interval_s: float = INTERVAL_S,
    ) -> None:
        self._actor, self._clock, self._publish, self._interval_s = actor, clock, publish, interval_s
        self._due: dict[str, _Due] = {}
        self._queue: deque[_Due] = deque()
        self._next: asyncio.Handle | None = None
        self._free_s = 0.0
        """Wall time from which any message may be written."""

    def changed(self, run: GraphRun) -> None:
        """Something about `run` is different now."""
        due = self._due.get(run.name)
        if due is None or due.run is not run:
            if due is not None:
                self._withdraw(due)
            due = self._due[run.name] = _Due(run)
        if due.waits:
            return
        due.waits = True
        wait_s = due.not_before_s - self._clock.wall_s()
        if wait_s > 0:
            due.timer = asyncio.get_running_loop().call_later(wait_s, self._enqueue, due)
        else:
            self._enqueue(due)

    def close(self) -> None:
        """Send what is still due, and nothing more."""
        if self._next is not None:
            self._next.cancel()
            self._next = None
        self._queue.clear()
        for due in list(self._due.values()):
            if due.waits:
                self._withdraw(due)
                self._send(due, due.run.snapshot())
        self._due.clear()

    def _withdraw(self, due: _Due) -> None:
        if due.timer is not None:
            due.timer.cancel()
            due.timer = None
        if due in self._queue:
            self._queue.remove(due)
        due.waits = False

    def _enqueue(self, due: _Due) -> None:
        due.timer = None
        self._queue.append(due)
        self._go_on()

    def _go_on(self) -> None:
        if self._queue and self._next is None:
            wait_s = max(0.0, self._free_s - self._clock.wall_s())
            self._next = asyncio.get_running_loop().call_later(wait_s, self._work)

    def _work(self) -> None:
        """Write a slice of the first in the queue; of a crowd as many as the turn has time for."""
        self._next = None
        until_s = self._clock.wall_s() + _TURN_S
        while self._queue:
            self._write(self._queue[0])
            if len(self._queue) < _MANY or self._clock.wall_s() >= until_s:
                break
        self._go_on()

    def _write(self, due: _Due) -> None:
        """Write a slice of what is due, and send it if that was the last slice."""
        began_s, graph = self._clock.wall_s(), due.run.snapshot()
        if due.writer.prepare(graph, _SLICE):
            self._queue.popleft()
            due.waits = False
            self._send(due, graph)
            now_s = self._clock.wall_s()
            due.not_before_s = now_s + self._interval_s
            rest = _REST_FACTOR if len(self._queue) < _MANY else 0
            self._free_s = now_s + rest * (now_s - began_s)
            if graph.state in _RESTING and due.run.idle:
                self._forget(due)

    def _send(self, due: _Due, graph: Graph) -> None:
        self._publish(UmrfGraphFeedback(actor=self._actor, history=(due.writer.write(graph),)))

    def _forget(self, due: _Due) -> None:
        """A graph at rest may never change again: neither it nor its text is kept for that."""
        if self._due.get(due.run.name) is due:
            del self._due[due.run.name]
