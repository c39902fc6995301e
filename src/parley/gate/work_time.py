"""How long a robot worked at one thing. Pure; one object per graph."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Final

from parley.messages.status import GraphEvent, PlanStep

__all__ = ["WorkTime"]

_AT_WORK: Final = frozenset({"RUNNING", "PAUSE_REQUESTED", "STOPPING"})


class WorkTime:
    """The time in which at least one step was at work.

    While the robot stands, or waits for an answer or a yes, none is: what asks people works at nothing.
    """

    def __init__(self) -> None:
        self._began: dict[str, int] = {}
        """What is at work -> since when."""
        self._asking: set[str] = set()
        self._since_ms = self._worked_ms = 0

    def on_node(self, event: GraphEvent) -> None:
        """A step changes its state."""
        if event.state not in _AT_WORK:
            self._rests(event.node, event.unix_ms)
        elif event.node not in self._began and event.node not in self._asking:
            self._since_ms = self._since_ms if self._began else event.unix_ms
            self._began[event.node] = event.unix_ms

    def on_steps(self, steps: Iterable[PlanStep]) -> None:
        """The planner says which steps wait for people; it may say so only after they began."""
        for step in steps:
            if step.state == "waiting" and step.node not in self._asking:
                self._asking.add(step.node)
                self._rests(step.node, self._began.get(step.node, 0))

    def worked_ms(self, until_ms: int) -> int:
        """How long, up to that moment."""
        return self._worked_ms + (max(0, until_ms - self._since_ms) if self._began else 0)

    def _rests(self, node: str, at_ms: int) -> None:
        if self._began.pop(node, None) is not None and not self._began:
            self._worked_ms += max(0, at_ms - self._since_ms)
