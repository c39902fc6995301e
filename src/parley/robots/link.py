"""A robot's network in a thread of its own: it goes on while the program's loop is blocked."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Callable, Coroutine
from contextlib import suppress
from typing import Any, Final, TypeVar

__all__ = ["Link"]

T = TypeVar("T")

_SLACK_S: Final = 1.0


class Link:
    """One loop in one thread.

    Args:
        name: Of the thread.
    """

    def __init__(self, name: str) -> None:
        self._loop = asyncio.new_event_loop()
        self._thread = threading.Thread(target=self._loop.run_forever, name=name, daemon=True)
        self._thread.start()

    async def run(self, work: Coroutine[Any, Any, T]) -> T:
        """Have something done there and wait for it without blocking; cancelling this cancels it."""
        return await asyncio.wrap_future(asyncio.run_coroutine_threadsafe(work, self._loop))

    def post(self, job: Callable[[], object]) -> None:
        """Have something done there soon; from any thread."""
        if not self._loop.is_closed():
            self._loop.call_soon_threadsafe(job)

    def end(self, work: Coroutine[Any, Any, object], within_s: float) -> None:
        """Have a last thing done, wait for it no longer than allowed, and end the thread; blocks so long."""

        async def finish() -> None:
            with suppress(TimeoutError):
                async with asyncio.timeout(within_s):
                    await work
            left = asyncio.all_tasks() - {asyncio.current_task()}
            for task in left:
                task.cancel()
            await asyncio.gather(*left, return_exceptions=True)
            self._loop.stop()

        self.post(lambda: asyncio.ensure_future(finish()))
        self._thread.join(within_s + _SLACK_S)
        if not self._thread.is_alive():
            self._loop.close()
