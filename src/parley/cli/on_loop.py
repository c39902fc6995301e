"""How commands run on a loop, so that what they opened is closed whoever tells them to end."""

from __future__ import annotations

import asyncio
import os
import signal
import socket
import sys
import threading
import time
from collections.abc import Callable, Coroutine, Iterator
from contextlib import contextmanager
from types import FrameType
from typing import Any, Final, TypeVar

__all__ = ["BEAT_S", "PULSE", "interruptible", "on_loop"]

T = TypeVar("T")

PULSE: Final = "PARLEY_PULSE"
"""Environment variable with the number of a pipe on which whoever started a process hears that it works."""
BEAT_S: Final = 1.0
"""Wall time between two signs of life there."""

_NUDGE_S: Final = 0.2
_PATIENCE_S: Final = 5.0
"""How long the closing has before Ctrl-C, pressed again, cuts it short."""


def on_loop(work: Coroutine[Any, Any, T]) -> T:
    """Run `work` as `asyncio.run` does, but let Ctrl-C and SIGTERM end it in order, however often they come.

    Raises:
        SystemExit: One of them came; with the exit code that shells have for it.
    """
    if threading.current_thread() is not threading.main_thread():  # signals are not ours there
        return asyncio.run(work)
    ending = _Ending()
    with _handled_by(ending.told):
        try:
            result = asyncio.run(ending.bounded(work))
        except asyncio.CancelledError:
            if not ending.number:
                raise
    if ending.number:
        raise SystemExit(128 + ending.number)
    return result


class _Ending:
    """What a signal does to a command on a loop."""

    def __init__(self) -> None:
        self.number = 0
        """Of the signal that came first; 0 as long as none did."""
        self._told_s = 0.0
        self._loop: asyncio.AbstractEventLoop | None = None
        self._task: asyncio.Task[Any] | None = None

    async def bounded(self, work: Coroutine[Any, Any, T]) -> T:
        """Carry out `work`, unless the signal was there first."""
        self._loop, self._task = asyncio.get_running_loop(), asyncio.current_task()
        if self.number:
            work.close()
            raise asyncio.CancelledError
        beating = asyncio.create_task(_beat(), name="pulse")
        try:
            with _woken(self._loop):
                return await work
        finally:
            beating.cancel()

    def told(self, number: int, _: FrameType | None) -> None:
        """A signal came."""
        now_s = self._loop.time() if self._loop is not None else 0.0
        if self.number:
            if now_s - self._told_s > _PATIENCE_S:
                os._exit(128 + number)
            return
        self.number, self._told_s = number, now_s
        if self._loop is not None and self._task is not None and not self._loop.is_closed():
            self._task.cancel()
            self._loop.call_soon_threadsafe(lambda: None)  # wakes a loop that waits


@contextmanager
def _woken(loop: asyncio.AbstractEventLoop) -> Iterator[None]:
    """Let a signal wake the loop also if it comes in the moment in which that begins to wait.

    Python's own handler would run only when the wait is over.
    """
    if sys.platform == "win32":  # its loop does so itself, and reads no sockets of others
        yield
        return
    ours, theirs = socket.socketpair()
    with ours, theirs:
        ours.setblocking(False)
        theirs.setblocking(False)
        before = signal.set_wakeup_fd(theirs.fileno(), warn_on_full_buffer=False)
        loop.add_reader(ours, ours.recv, 64)
        try:
            yield
        finally:
            loop.remove_reader(ours)
            signal.set_wakeup_fd(before)


async def _beat() -> None:
    """Give signs of life to whoever wants them, and end in order where they are not there any more."""
    pulse = os.environ.pop(PULSE, "")  # whom this one starts, that pipe does not reach
    try:
        while pulse.isdigit():
            os.write(int(pulse), b".")
            await asyncio.sleep(BEAT_S)
    except BrokenPipeError:  # started again, they would find every place taken by those they lost
        os.kill(os.getpid(), signal.SIGTERM)


@contextmanager
def interruptible() -> Iterator[None]:
    """For a wait that holds up everything, a loop too: Ctrl-C and SIGTERM break it off at once.

    Raises:
        SystemExit: One of them came.
        CancelledError: One came right before.
    """
    with _handled_by(_raise), _nudged():
        if (task := _current_task()) is not None and task.cancelling():
            raise asyncio.CancelledError
        yield


@contextmanager
def _nudged() -> Iterator[None]:
    """Break off a system call again and again: a signal right before it is heard in between only."""
    if sys.platform == "win32":  # it has no such timer
        yield
        return
    began_s = time.monotonic()
    handler = signal.signal(signal.SIGALRM, lambda *_: None)
    left_s, every_s = signal.setitimer(signal.ITIMER_REAL, _NUDGE_S, _NUDGE_S)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, handler)
        if left_s:  # somebody else's
            signal.setitimer(signal.ITIMER_REAL, max(left_s - (time.monotonic() - began_s), 0.001), every_s)


def _raise(number: int, _: FrameType | None) -> None:
    raise SystemExit(128 + number)


def _current_task() -> asyncio.Task[Any] | None:
    try:
        return asyncio.current_task()
    except RuntimeError:  # there is no loop
        return None


@contextmanager
def _handled_by(handler: Callable[[int, FrameType | None], None]) -> Iterator[None]:
    """Give both signals to `handler` meanwhile; what the process was told to ignore stays ignored."""
    numbers = (signal.SIGINT, signal.SIGTERM)
    before = [(number, signal.getsignal(number)) for number in numbers]
    mine = [(number, then) for number, then in before if then is not signal.SIG_IGN]
    try:
        for number, _ in mine:
            signal.signal(number, handler)
        yield
    finally:
        for number, then in mine:
            signal.signal(number, then)
