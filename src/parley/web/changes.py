"""The numbered log of changes: what a client missed is here, and what is too old is not."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Sequence
from itertools import islice

from parley.web.models import Change

__all__ = ["ChangeLog", "newest_only"]


class ChangeLog:
    """Numbers changes and keeps the newest.

    Args:
        run: Names this log; another process has another one.
        limit: How many changes are kept.
    """

    def __init__(self, run: str, *, limit: int = 5000) -> None:
        self.run, self.seq = run, 0
        self._kept: deque[Change] = deque(maxlen=limit)
        self._listeners: list[Callable[[], None]] = []

    def add(self, change: Change) -> None:
        """Number `change` and tell the listeners that there is something new."""
        self.seq += 1
        self._kept.append(change.model_copy(update={"seq": self.seq}))
        for listener in self._listeners:
            listener()

    def listen(self, listener: Callable[[], None]) -> None:
        """Call `listener` after each change; it must return at once."""
        self._listeners.append(listener)

    def since(self, seq: int) -> list[Change] | None:
        """What changed after number `seq`, each thing once; None if that is not known any more."""
        missing = self.seq - seq
        if missing < 0 or missing > len(self._kept):
            return None
        return newest_only(list(islice(reversed(self._kept), missing))[::-1])


def newest_only(changes: Sequence[Change]) -> list[Change]:
    """Of several changes of one thing only the last; the order of those that stay is kept."""
    seen: set[tuple[str, ...]] = set()
    kept: list[Change] = []
    for change in reversed(changes):
        key = _key(change)
        if key not in seen:
            seen.add(key)
            kept.append(change)
    return kept[::-1]


def _key(change: Change) -> tuple[str, ...]:
    match change.kind:
        case "robot":
            return ("robot", change.robot.name)
        case "robot_gone":
            return ("robot", change.name)
        case "chat":
            return ("chat", change.entry.id)
        case "plan":
            return ("plan", change.plan.robot, change.plan.graph_name)
        case "plan_gone":
            return ("plan", change.robot, change.graph_name)
        case "proposal":
            return ("proposal", change.proposal.id)
        case "proposal_gone":
            return ("proposal", change.id)
        case "feed":
            return ("feed", change.feed.robot, change.feed.name)
        case "memory":
            return ("memory", change.event, change.name)
        case "incident":
            return ("incident", change.incident.id)
        case "rejection":
            return ("rejection", str(change.seq))
