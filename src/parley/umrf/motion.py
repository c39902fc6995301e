"""Whether the run of an action may move its robot: pausing suspends that, stopping takes it away for good.

The drive looks here for every command (`parley.robots.run_robot`), so that nothing depends on an action being
willing to stand still. Threads may ask and stop at any moment; the flags are set before anybody is told.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Final

from parley.clock import Clock

__all__ = ["GRACE_S", "Motion", "Motions"]

GRACE_S: Final = 0.5
"""Wall time that an action has to notice an emergency stop before its drive is taken away for good."""


class Motions:
    """What an emergency stop of one robot means to all its runs.

    It suspends them in the thread that stops, before the loop knows. They are let go one by one, when
    somebody resumes them, and not by the reset: between the two nothing moves.

    Args:
        clock: For the wall time.
        ignored: Told the full name of a node whose run went on commanding after the stop; in any thread.
    """

    def __init__(self, clock: Clock, ignored: Callable[[str], None]) -> None:
        self.clock, self.ignored = clock, ignored
        self.stops = self.known_stops = 0
        """Emergency stops so far, and those of them after which the graphs were paused."""
        self.known_s = 0.0
        self._latched = False

    def stop(self) -> None:
        """An emergency stop; again while it is in force changes nothing."""
        if not self._latched:
            self._latched = True
            self.stops += 1

    def release(self) -> None:
        """The stop was reset; nobody is let go by that."""
        self._latched = False

    def settle(self) -> None:
        """The graphs are paused: who still moves does so in spite of it."""
        self.known_stops, self.known_s = self.stops, self.clock.wall_s()


class Motion:
    """What one run may do."""

    def __init__(self, node: str) -> None:
        self._node = node
        self._motions: Motions | None = None
        self._granted = 0
        self._lock = threading.Lock()
        self._paused = self._revoked = False
        self._on_revoked: list[Callable[[], None]] = []
        self.on_paused: list[Callable[[], None]] = []
        """Called at each pause, in any thread, so that nobody needs to look for one."""

    def join(self, motions: Motions) -> None:
        """Belong to a robot, whose stops count from now on."""
        self._granted, self._motions = motions.known_stops, motions

    @property
    def allowed(self) -> bool:
        """Whether it may move now."""
        return not (self._revoked or self._paused or self._stopped)

    @property
    def revoked(self) -> bool:
        """Whether it may never move again."""
        return self._revoked

    @property
    def _stopped(self) -> bool:
        return self._motions is not None and self._granted != self._motions.stops

    def pause(self) -> None:
        """Not now."""
        self._paused = True
        for tell in tuple(self.on_paused):
            tell()

    def resume(self) -> None:
        """Go on, as far as no emergency stop came that the graphs do not know of yet."""
        self._paused = False
        if self._motions is not None:
            self._granted = self._motions.known_stops

    def revoke(self) -> None:
        """Never again."""
        with self._lock:
            told, self._on_revoked = self._on_revoked, []
            self._revoked = True
        for tell in told:
            tell()

    def on_revoked(self, tell: Callable[[], None]) -> Callable[[], None]:
        """Have `tell` called, in any thread, once motion is taken away; returns what forgets it."""
        with self._lock:
            if not self._revoked:
                self._on_revoked.append(tell)
                return lambda: self._forget(tell)
        tell()
        return lambda: None

    def disobeyed(self) -> None:
        """It commanded a motion that it is not allowed: after an emergency stop it loses its drive."""
        motions = self._motions
        if motions is None or self._revoked or not self._stopped or motions.stops != motions.known_stops:
            return
        if motions.clock.wall_s() - motions.known_s > GRACE_S:
            self.revoke()
            motions.ignored(self._node)

    def _forget(self, tell: Callable[[], None]) -> None:
        with self._lock:
            if tell in self._on_revoked:
                self._on_revoked.remove(tell)
