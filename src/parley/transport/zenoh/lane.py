"""Where the loop leaves what may have to wait for the network."""

from __future__ import annotations

import asyncio
import threading
from collections import deque
from collections.abc import Callable
from concurrent.futures import Future
from queue import SimpleQueue
from typing import Final, TypeVar

import structlog

__all__ = ["Lane", "Outbox"]

T = TypeVar("T")

log = structlog.get_logger(__name__)

BYTES_AHEAD: Final = 1_000_000
"""As much may wait to be sent of a topic whose depth is less."""


class Lane:
    """A thread that does one thing after the other; one that hangs holds up neither other lanes nor the loop.

    Args:
        name: For the log and for whoever looks at threads.
    """

    def __init__(self, name: str) -> None:
        self._name = name
        self._jobs: SimpleQueue[Callable[[], object] | None] = SimpleQueue()
        # A daemon: a network that hangs does not keep the process from ending.
        threading.Thread(target=self._run, name=f"zenoh {name}", daemon=True).start()

    def do(self, job: Callable[[], object]) -> None:
        """Have `job` done after those before it; returns at once."""
        self._jobs.put(job)

    async def ask(self, job: Callable[[], T]) -> T:
        """Have `job` done, and wait for what it returns or raises."""
        answer: Future[T] = Future()

        def work() -> None:
            if answer.set_running_or_notify_cancel():
                try:
                    answer.set_result(job())
                except Exception as error:  # noqa: BLE001 - handed on to who waits
                    answer.set_exception(error)

        self._jobs.put(work)
        return await asyncio.wrap_future(answer)

    def close(self) -> None:
        """End when all is done that was asked for."""
        self._jobs.put(None)

    def _run(self) -> None:
        while (job := self._jobs.get()) is not None:
            try:
                job()
            except Exception:
                # The border of the thread: what fails here was left by somebody who does not wait for it.
                log.exception("the network did not take something", lane=self._name)


class Outbox:
    """What a publisher has still to send: as much as its depth, and more if that is little; else the newest.

    Args:
        depth: How many at least are kept; None: all.
    """

    def __init__(self, depth: int | None) -> None:
        self._depth = depth
        self._waiting: deque[tuple[bytes | bytearray, bytes]] = deque()
        self._bytes = 0
        self._lock = threading.Lock()
        self.dropped = 0

    def put(self, data: bytes | bytearray, attachment: bytes) -> bool:
        """Something is to be sent; whether older things had to go for it."""
        before = self.dropped
        with self._lock:
            self._waiting.append((data, attachment))
            self._bytes += len(data)
            while self._depth is not None and len(self._waiting) > self._depth and self._bytes > BYTES_AHEAD:
                self._bytes -= len(self._waiting.popleft()[0])
                self.dropped += 1
        return self.dropped > before

    def take(self) -> tuple[bytes | bytearray, bytes] | None:
        """What is to be sent next."""
        with self._lock:
            if not self._waiting:
                return None
            taken = self._waiting.popleft()
            self._bytes -= len(taken[0])
            return taken
