"""The compatible feedback topic: whole graphs, coalesced, the last state always sent (12)."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Final

from parley.clock import Clock
from parley.messages.ros import UmrfGraphFeedback
from parley.umrf.executor import GraphRun
from parley.umrf.io import GraphWriter

__all__ = ["Feedback"]

INTERVAL_S: Final = 0.02
_COST_FACTOR: Final = 10
"""Writing a graph of thousands of nodes takes a while; it may take a tenth of the time at most."""

_REMEMBERED: Final = 100
"""More graphs than this are not spaced exactly, so that names of old ones do not pile up."""


@dataclass(slots=True, eq=False)
class _Due:
    run: GraphRun
    writer: GraphWriter = field(default_factory=GraphWriter)
    timer: asyncio.Handle | None = None
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

    def changed(self, run: GraphRun) -> None:
        """Something about `run` is different now."""
        due = self._due.get(run.name)
        if due is None or due.run is not run:
            if due is not None and due.timer is not None:
                due.timer.cancel()
            due = self._due[run.name] = _Due(run)
        if due.timer is None:
            loop = asyncio.get_running_loop()
            wait_s = due.not_before_s - self._clock.wall_s()
            due.timer = loop.call_later(max(0.0, wait_s), self._send, due)

    def close(self) -> None:
        """Send what is still due, and nothing more."""
        for due in list(self._due.values()):
            if due.timer is not None:
                due.timer.cancel()
                self._send(due)
        self._due.clear()

    def _send(self, due: _Due) -> None:
        due.timer = None
        began_s = self._clock.wall_s()
        text = due.writer.write(due.run.snapshot())
        now_s = self._clock.wall_s()
        due.not_before_s = now_s + max(self._interval_s, _COST_FACTOR * (now_s - began_s))
        self._publish(UmrfGraphFeedback(actor=self._actor, history=(text,)))
        if len(self._due) > _REMEMBERED:
            self._due = {name: item for name, item in self._due.items() if item.timer is not None}
