"""Where the messages of a subscription wait for their handler, whatever backend and thread they come from."""

from __future__ import annotations

import asyncio
import contextlib
import inspect
import threading
from collections import deque
from collections.abc import Callable, Sequence
from typing import Any, Final, Generic, TypeVar

import structlog

from parley.messages.topics import Topic
from parley.transport.base import Handler, Subscription

__all__ = ["Inbox", "Turn", "being_cancelled"]

M = TypeVar("M")

log = structlog.get_logger(__name__)

TURN_S: Final = 0.01


class Turn:
    """Lets whoever has many pieces of work, of which none may ever wait, keep the loop for `TURN_S`."""

    def __init__(self) -> None:
        self._loop = asyncio.get_running_loop()
        self._until_s = self._loop.time() + TURN_S

    async def pause(self) -> None:
        """To be called between two pieces: others are let in when the turn is over."""
        if self._loop.time() > self._until_s:
            await asyncio.sleep(0)
            self._until_s = self._loop.time() + TURN_S


class _Line:
    """Inboxes whose messages are handled as they came, one after the other, and the task for it."""

    def __init__(self, name: str) -> None:
        self.turns: deque[Inbox[Any]] = deque()
        self.lock = threading.Lock()
        """Held for the moment in which a message comes or is taken; it may come from another thread."""
        self.users = 0
        self._name = name
        self._loop = asyncio.get_running_loop()
        self._thread = threading.get_ident()
        self._arrived = asyncio.Event()
        self._handling: Inbox[Any] | None = None
        self._work()

    def _work(self) -> None:
        self._task = asyncio.create_task(self._run(), name=f"sub {self._name}")

    def wake(self) -> None:
        """A message is in the line that was empty."""
        if threading.get_ident() == self._thread:
            self._arrived.set()
        else:
            with contextlib.suppress(RuntimeError):  # the loop has ended, and nobody waits for messages
                self._loop.call_soon_threadsafe(self._arrived.set)

    async def _run(self) -> None:
        while True:
            turn = Turn()
            while self.turns:
                with self.lock:
                    inbox = self._handling = self.turns.popleft()
                    waiting = inbox.pop()
                for message in waiting:
                    await inbox.handle(message)
                self._handling = None
                await turn.pause()
            self._arrived.clear()
            if not self.turns:
                await self._arrived.wait()

    async def leave(self, inbox: Inbox[Any]) -> None:
        """An inbox is closed: its handler is cancelled if it runs, the others go on."""
        self.users -= 1
        if self.users and self._handling is not inbox:
            return
        task = self._task
        task.cancel()
        if task is not asyncio.current_task():
            await asyncio.gather(task, return_exceptions=True)
        if self.users:
            self._work()


class Inbox(Generic[M]):
    """A bounded queue, and the line in which its messages wait for the handler.

    Args:
        topic: What is heard.
        handler: Gets each message, on the loop.
        depth: How many may wait; of more the oldest are dropped. None: as many as the topic says.
        along: Another inbox, whose messages and these are handled in the order in which they came.
        on_failure: Called when the handler raised.
    """

    def __init__(
        self,
        topic: Topic[M],
        handler: Handler[M],
        *,
        depth: int | None,
        along: Subscription | None,
        on_failure: Callable[[], None],
    ) -> None:
        self._topic, self._handler, self._on_failure = topic, handler, on_failure
        self._queue: deque[M] = deque(maxlen=None if topic.qos.keep_all else depth or topic.qos.depth)
        self._dropped = 0
        self._open = True
        self._line: _Line = along._line if isinstance(along, Inbox) else _Line(topic.name)
        self._line.users += 1

    @property
    def dropped(self) -> int:
        """See `Subscription.dropped`."""
        return self._dropped

    def put(self, message: M) -> None:
        """A message came; from any thread."""
        line = self._line
        with line.lock:
            if not self._open:
                return
            full = len(self._queue) == self._queue.maxlen
            if full:
                line.turns.remove(self)
            was_empty = not line.turns
            self._queue.append(message)
            line.turns.append(self)
        if was_empty:
            line.wake()
        if full:
            self.lose(1)

    def lose(self, count: int) -> None:
        """Messages were dropped, here or on their way; from any thread."""
        with self._line.lock:
            before, self._dropped = self._dropped, self._dropped + count
        if (
            before.bit_length() != self._dropped.bit_length()
        ):  # 1, 2, 4, 8, ...: a flood does not flood the log
            log.warning(
                "messages dropped: more came at once than a subscriber takes, or the connection was away",
                topic=self._topic.name,
                dropped=self._dropped,
                depth=self._queue.maxlen,
            )

    def pop(self) -> Sequence[M]:
        """The message that waits longest; after a closing there is none."""
        return (self._queue.popleft(),) if self._queue else ()

    async def handle(self, message: M) -> None:
        """Hand a message over; what the handler does ends here."""
        try:
            answer = self._handler(message)
            if answer is not None and inspect.isawaitable(answer):
                await answer
        except asyncio.CancelledError:
            if being_cancelled():
                raise
            # The handler waited for something that was cancelled; the topic must not fall silent for that.
            log.info("handler was cancelled", topic=self._topic.name)
        except Exception:
            # The border of every node: a defect in one handler must not silence the topic, but must be seen.
            self._on_failure()
            log.exception("handler failed", topic=self._topic.name)

    async def close(self) -> None:
        """See `Subscription.close`."""
        if self._open:
            with self._line.lock:
                self._open = False
                self._queue.clear()
            await self._line.leave(self)


def being_cancelled() -> bool:
    """Whether a CancelledError is meant for the current task, not for something it waited for."""
    task = asyncio.current_task()
    return task is not None and task.cancelling() > 0
