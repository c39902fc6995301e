"""The numbered log of changes: what a client missed is here, and what is too old is not."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable

from parley.web.models import Change

__all__ = ["ChangeLog"]


class ChangeLog:
    """Numbers changes and keeps the newest one of each thing: it carries the thing as it is now.

    Args:
        run: Names this log; another process has another one.
        limit: How many things are remembered; those that changed least lately are forgotten.
    """

    def __init__(self, run: str, *, limit: int = 5000) -> None:
        self.run, self.seq = run, 0
        self._limit, self._forgotten = limit, 0
        self._kept: OrderedDict[tuple[str, ...], Change] = OrderedDict()
        self._listeners: list[Callable[[], None]] = []

    def add(self, change: Change) -> None:
        """Number `change` and tell the listeners that there is something new."""
        self.seq += 1
        numbered = change.model_copy(update={"seq": self.seq})
        key = _key(numbered)
        self._kept[key] = numbered
        self._kept.move_to_end(key)
        if len(self._kept) > self._limit:
            _, oldest = self._kept.popitem(last=False)
            self._forgotten = oldest.seq
        for listener in self._listeners:
            listener()

    def listen(self, listener: Callable[[], None]) -> None:
        """Call `listener` after each change; it must return at once."""
        self._listeners.append(listener)

    def since(self, seq: int) -> list[Change] | None:
        """What changed after number `seq`, each thing once; None if that is not known any more."""
        if not self._forgotten <= seq <= self.seq:
            return None
        missing: list[Change] = []
        for change in reversed(self._kept.values()):
            if change.seq <= seq:
                break
            missing.append(change)
        return missing[::-1]


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
        case "proposal" | "proposal_gone":
            return ("proposal", change.proposal.id if change.kind == "proposal" else change.id)
        case "feed":
            return ("feed", change.feed.robot, change.feed.name)
        case "memory":
            return ("memory", change.event, change.name)
        case "favourites" | "info" | "missions" | "rules":
            return (change.kind,)
        case "incident":
            return ("incident", change.incident.id)
        case "rejection":
            return ("rejection", str(change.seq))
