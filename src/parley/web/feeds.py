"""Subscribes to pictures while somebody looks at them, so that cameras nobody watches can rest."""

from __future__ import annotations

import asyncio
import contextlib
from collections import Counter
from collections.abc import Callable
from typing import Final, Self

import structlog

from parley.errors import TransportError
from parley.messages.ros import CompressedImage
from parley.messages.topics import display_topic
from parley.transport.base import Subscription, Transport
from parley.web.feed_state import FeedBook, Picture

__all__ = ["CONTINUOUS", "Feeds"]

log = structlog.get_logger(__name__)

CONTINUOUS: Final = frozenset({"camera", "map"})
"""Names of feeds that are films; nobody need watch for their topics to be there."""
_PREFIX: Final = display_topic("r", "f").name.removesuffix("r/f")

Key = tuple[str, str]


class Feeds:
    """Finds feeds by their topics. Use as ``async with``.

    Args:
        transport: Where the topics are.
        book: Gets what is found, and the pictures.
        robots: The names of the robots.
        on_picture: Told of each picture.
    """

    def __init__(
        self,
        transport: Transport,
        book: FeedBook,
        robots: Callable[[], list[str]],
        on_picture: Callable[[Key, Picture], None],
    ) -> None:
        self._transport, self._book, self._robots, self._on_picture = transport, book, robots, on_picture
        self._watched: Counter[Key] = Counter()
        self._open: dict[Key, Subscription] = {}
        self._look = asyncio.Event()
        self._waits: dict[Key, list[asyncio.Future[Picture]]] = {}
        self._stack = contextlib.AsyncExitStack()

    async def __aenter__(self) -> Self:
        self._stack.push_async_callback(self._close_all)
        self._stack.callback(self._transport.on_endpoints_changed(self._look.set))
        task = asyncio.create_task(self._run(), name="web feeds")
        self._stack.push_async_callback(_cancel, task)
        self._look.set()
        return self

    async def __aexit__(self, *exc: object) -> None:
        await self._stack.aclose()

    def watch(self, key: Key) -> None:
        """Somebody looks at a feed; each call is ended by one of `unwatch`."""
        self._watched[key] += 1
        self._look.set()

    def unwatch(self, key: Key) -> None:
        """Somebody looks away."""
        self._watched[key] -= 1
        if self._watched[key] <= 0:
            del self._watched[key]
        self._look.set()

    async def newest(self, key: Key, *, within_s: float) -> Picture | None:
        """The newest picture of a feed.

        Args:
            key: Robot and name.
            within_s: Wall time to wait for a picture of a feed that nobody watches.
        """
        info = self._book.infos.get(key)
        if key in self._open and key in self._book.pictures:
            return self._book.pictures[key]
        if info is None:
            return None
        wait: asyncio.Future[Picture] = asyncio.get_running_loop().create_future()
        self._waits.setdefault(key, []).append(wait)
        self.watch(key)
        try:
            async with asyncio.timeout(within_s):
                return await wait
        except TimeoutError:
            return self._book.pictures.get(key)
        finally:
            self.unwatch(key)
            waits = self._waits[key]
            waits.remove(wait)
            if not waits:
                del self._waits[key]

    async def _run(self) -> None:
        while True:
            await self._look.wait()
            self._look.clear()
            self._find()
            wanted = set(self._watched) | {
                key for key, info in self._book.infos.items() if not info.continuous
            }
            for key in wanted - set(self._open):
                await self._subscribe(key)
            for key in set(self._open) - wanted:
                await self._open.pop(key).close()

    def _find(self) -> None:
        names = {display_topic(robot, "").name.rpartition("/")[0]: robot for robot in self._robots()}
        for end in self._transport.endpoints():
            if end.role == "publisher" and end.name.startswith(_PREFIX):
                folder, _, feed = end.name.rpartition("/")
                robot = names.get(folder, folder.removeprefix(_PREFIX))
                self._book.announce(robot, feed, continuous=feed in CONTINUOUS)

    async def _subscribe(self, key: Key) -> None:
        def receive(message: CompressedImage) -> None:
            was_continuous = key in self._book.infos and self._book.infos[key].continuous
            picture = self._book.on_picture(*key, message)
            for wait in self._waits.get(key, ()):
                if not wait.done():
                    wait.set_result(picture)
            if self._book.infos[key].continuous != was_continuous:
                self._look.set()
            self._on_picture(key, picture)

        try:
            self._open[key] = await self._transport.subscribe(display_topic(*key), receive, depth=2)
        except TransportError as error:
            log.warning("feed cannot be read", robot=key[0], feed=key[1], problem=str(error))

    async def _close_all(self) -> None:
        for subscription in self._open.values():
            await subscription.close()
        self._open.clear()


async def _cancel(task: asyncio.Task[None]) -> None:
    task.cancel()
    await asyncio.gather(task, return_exceptions=True)
