"""Notices an event loop that is blocked, names the action that blocks it, and holds its robots meanwhile."""

from __future__ import annotations

import asyncio
import sys
import threading
from collections.abc import Callable, Sequence
from typing import Final

from parley.clock import Clock
from parley.gate.notes import note
from parley.gate.stop_line import StopLine
from parley.messages.principal import Principal
from parley.sentences import Sentence, sentence

__all__ = ["BLOCKED_S", "LoopWatchdog"]

BLOCKED_S: Final = 0.5
"""Wall time without a sign of the loop after which its robots are held."""
TELL_S: Final = 1.0
"""Only who blocks for longer is told to operators: a busy machine may hesitate."""
LOOK_S: Final = 0.1

_BY: Final = Principal(kind="program", name="watchdog")


class LoopWatchdog:
    """Watches the loop on which it is opened, from a thread of its own.

    A plain action runs in a thread, so however long it takes, the loop is not blocked.

    Args:
        line: Where the robots are held.
        robots: Whose actions run on this loop.
        clock: For the wall time.
        tell: Says something to operators; called on the loop once it is back.
    """

    def __init__(
        self, line: StopLine, robots: Sequence[str], clock: Clock, tell: Callable[[str], None]
    ) -> None:
        self._line, self._robots, self._clock, self._tell = line, tuple(robots), clock, tell
        self._closed = threading.Event()
        self._loop: asyncio.AbstractEventLoop | None = None
        self._loop_thread = 0
        self._thread = threading.Thread(target=self._watch, name="loop watchdog", daemon=True)

    def open(self) -> None:
        """Begin to watch."""
        self._loop, self._loop_thread = asyncio.get_running_loop(), threading.get_ident()
        self._thread.start()

    async def close(self) -> None:
        """Watch no longer."""
        self._closed.set()
        await asyncio.to_thread(self._thread.join)

    def _watch(self) -> None:
        assert self._loop is not None
        count = 0
        while not self._closed.wait(LOOK_S):
            answered, began_s = threading.Event(), self._clock.wall_s()
            try:
                self._loop.call_soon_threadsafe(answered.set)
                if not answered.wait(BLOCKED_S):
                    count += 1
                    self._held(f"blocked {count}", answered, began_s)
            except RuntimeError:  # the loop is closed
                return

    def _held(self, hold: str, answered: threading.Event, began_s: float) -> None:
        """Hold the robots until the loop is back, then say who kept it."""
        assert self._loop is not None
        action, where = self._culprit()
        self._line.hold(self._robots, id=hold, by=_BY)
        note("loop blocked", action=action, where=where)
        while not (answered.wait(LOOK_S) or self._closed.is_set()):
            continue
        self._line.go_on(hold)
        blocked_s = self._clock.wall_s() - began_s
        note("loop was blocked", action=action, where=where, seconds=round(blocked_s, 2))
        if action and blocked_s > TELL_S and not self._closed.is_set():
            self._loop.call_soon_threadsafe(self._tell, _told(action, blocked_s))

    def _culprit(self) -> tuple[str, str]:
        """The action at work on the loop, empty if it is none, and the place in the code."""
        assert self._loop is not None
        task = asyncio.current_task(self._loop)
        graph, slash, node = task.get_name().rpartition("/") if task is not None else ("", "", "")
        frame = sys._current_frames().get(self._loop_thread)
        code = frame.f_code if frame is not None else None
        where = f"{code.co_name} ({code.co_filename}:{frame.f_lineno})" if code and frame else ""
        is_action = graph and slash and not graph.startswith("sub ")  # who hears a topic has one, too
        return (node if is_action else ""), where


def _told(action: str, blocked_s: float) -> Sentence:
    return sentence(
        "For {seconds} seconds I could hear nobody, because {action} kept everything waiting. I stood still "
        "meanwhile.",
        seconds=f"{blocked_s:.1f}",
        action=action.rpartition("_")[0] or action,
    )
