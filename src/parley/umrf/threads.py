"""The one door through which plain (blocking) actions leave the loop."""

from __future__ import annotations

import asyncio
import contextvars
import functools
import os
import queue
import threading
from collections import deque
from collections.abc import Callable
from typing import Any, Final, TypeVar
from weakref import WeakKeyDictionary

__all__ = ["IDLE", "in_thread"]

T = TypeVar("T")

IDLE: Final = "waits for an action"
"""What a thread without work is called."""
KEPT_S: Final = 10.0
"""Wall time for which a thread without work waits for more."""

_idle: list[_Thread] = []
"""The newest is taken first, so that what is too many ends."""
if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_idle.clear)  # a copy of a process has none of its threads


class _Returns:
    """What was returned to one loop; many at once wake it once."""

    def __init__(self) -> None:
        self._settle: deque[Callable[[], None]] = deque()
        self._woken = False

    def put(self, loop: asyncio.AbstractEventLoop, settle: Callable[[], None]) -> None:
        """Have `settle` called on the loop; from any thread."""
        self._settle.append(settle)
        if not self._woken:
            self._woken = True
            try:
                loop.call_soon_threadsafe(self._take)
            except RuntimeError:  # the loop is closed: nobody waits any more
                self._woken = False
                self._settle.clear()

    def _take(self) -> None:
        self._woken = False  # first, so that what comes from now on wakes it again
        while self._settle:
            self._settle.popleft()()


_returns: WeakKeyDictionary[asyncio.AbstractEventLoop, _Returns] = WeakKeyDictionary()


class _Thread(threading.Thread):
    """Does one piece of work after the other; waits in `_idle` in between."""

    def __init__(self) -> None:
        super().__init__(daemon=True)
        self.work: queue.SimpleQueue[Callable[[], None]] = queue.SimpleQueue()

    def run(self) -> None:
        """Work until nothing came for `KEPT_S`."""
        while True:
            try:
                work = self.work.get(timeout=KEPT_S)
            except queue.Empty:
                try:
                    _idle.remove(self)
                except ValueError:  # taken in this moment: its work comes
                    continue
                return
            work()
            del work  # what it knows must not live until the next one


async def in_thread(name: str, function: Callable[..., T], /, *args: Any, **kwargs: Any) -> T:
    """Run `function` in a thread that does nothing else meanwhile, and wait for it.

    As many threads as there is work, kept for a while, and daemons: an action that never returns must neither
    keep a place in a pool nor keep the process from ending. Cancelling the wait abandons the thread, so tell
    the action to stop before.

    Args:
        name: What the thread is called meanwhile, for debuggers.
        function: What to run; it sees the caller's context variables.
        *args: Its arguments.
        **kwargs: Its keyword arguments.
    """
    loop = asyncio.get_running_loop()
    done: asyncio.Future[T] = loop.create_future()
    context = contextvars.copy_context()
    try:
        thread = _idle.pop()
    except IndexError:
        thread = _Thread()
    returns = _returns.setdefault(loop, _Returns())

    def settle(result: Any, error: BaseException | None) -> None:
        if done.cancelled():
            return
        if error is None:
            done.set_result(result)
        elif isinstance(error, StopIteration):  # a future cannot carry it
            done.set_exception(RuntimeError(f"StopIteration: {error}"))
        else:
            done.set_exception(error)

    def work() -> None:
        thread.name = name
        result, error = None, None
        try:
            result = context.run(function, *args, **kwargs)
        except BaseException as caught:  # noqa: BLE001 - carried to whoever waits
            error = caught
        thread.name = IDLE
        _idle.append(thread)  # before it is told, so that what follows finds it
        returns.put(loop, functools.partial(settle, result, error))
        result = error = None  # what was raised knows this frame: without this a circle

    thread.work.put(work)
    if thread.ident is None:  # new: its work is there when it begins
        thread.start()
    return await done
