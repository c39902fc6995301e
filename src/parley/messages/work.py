"""How long a step has worked and about when it will be done, from what its engine tells. Pure."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from parley.messages.status import GraphEvent

__all__ = ["Work"]

_AT_WORK: Final = frozenset({"RUNNING", "PAUSE_REQUESTED", "STOPPING"})
_LEAST_SHARE: Final = 0.1
"""Before a step has come so far since it got going nobody knows yet how long it takes."""


@dataclass(slots=True)
class Work:
    """Of one step; the page and what robots say read the same, or they would tell two times for one way."""

    ms: int = 0
    """How long it worked until `since_unix_ms`, without the time while it stood still."""
    since_unix_ms: int = 0
    """0 while it does not work."""
    ends_unix_ms: int = 0
    """About when it is done if it goes on like that; 0 while nobody knows."""
    _going: tuple[float, int] | None = None
    """How far it was, and after how long, when it got going: turning round first does not make it slow."""

    def on_event(self, event: GraphEvent) -> None:
        """A transition or progress of the step."""
        if event.kind == "progress":
            self._estimate(event.progress, event.unix_ms)
            return
        works = event.state in _AT_WORK
        if self.since_unix_ms and not works:
            self.ms += max(0, event.unix_ms - self.since_unix_ms)
            self.since_unix_ms = self.ends_unix_ms = 0
        elif not self.since_unix_ms and works:
            self.since_unix_ms = event.unix_ms

    def left_s(self, now_unix_ms: int) -> float | None:
        """How long it may still take; None: nobody knows."""
        left_ms = self.ends_unix_ms - now_unix_ms
        return left_ms / 1000 if left_ms > 0 else None

    def _estimate(self, share: float | None, unix_ms: int) -> None:
        if share is None:  # it waits, nobody knows how long
            self.ends_unix_ms, self._going = 0, None
        if share is None or not self.since_unix_ms:
            return
        gone_ms = self.ms + unix_ms - self.since_unix_ms
        if self._going is None or share <= self._going[0]:
            self._going = (share, gone_ms)
            return
        done = share - self._going[0]
        if done >= _LEAST_SHARE:
            self.ends_unix_ms = unix_ms + round((gone_ms - self._going[1]) * (1.0 - share) / done)
