"""The one door through which plain (blocking) actions leave the loop."""

from __future__ import annotations

import asyncio
import contextvars
import threading
from collections.abc import Callable
from typing import Any, TypeVar

__all__ = ["in_thread"]

T = TypeVar("T")


async def in_thread(name: str, function: Callable[..., T], /, *args: Any, **kwargs: Any) -> T:
    """Run `function` in a thread of its own and wait for it.

    A thread each, and a daemon: an action that never returns must neither keep a place in a pool nor keep the
    process from ending. Cancelling the wait abandons the thread, so tell the action to stop before.

    Args:
        name: Name of the thread, for debuggers.
        function: What to run; it sees the caller's context variables.
        *args: Its arguments.
        **kwargs: Its keyword arguments.
    """
    loop = asyncio.get_running_loop()
    done: asyncio.Future[T] = loop.create_future()
    context = contextvars.copy_context()

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
        result, error = None, None
        try:
            result = context.run(function, *args, **kwargs)
        except BaseException as caught:  # noqa: BLE001 - carried to whoever waits
            error = caught
        if not loop.is_closed():
            loop.call_soon_threadsafe(settle, result, error)
        result = error = None  # what was raised knows this frame: without this a circle

    threading.Thread(target=work, name=name, daemon=True).start()
    return await done
