"""The display interface: pictures of any kind come in, JPEGs for the screen go out (thesis 4.3.9)."""

from __future__ import annotations

import asyncio
from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar, TypeVar

from parley.agents.base import Node
from parley.agents.display.images import to_jpeg
from parley.clock import Clock
from parley.config import FeedSettings
from parley.errors import InvalidMessageError
from parley.messages import topics
from parley.messages.display import DisplayFeed
from parley.messages.ros import CompressedImage, Header, Time
from parley.messages.topics import Topic, display_topic
from parley.transport.base import Transport

__all__ = ["DisplayInterface"]

N = TypeVar("N", int, float)

MAX_FEEDS = 256
"""More feeds than any screen has room for are somebody's mistake."""


@dataclass(slots=True)
class _Feed:
    """One feed that is being shown: its newest picture that still waits, if any."""

    topic: Topic[CompressedImage]
    settings: FeedSettings
    waiting: DisplayFeed | None = None


class DisplayInterface(Node):
    """Turns `display_feed` into one topic of JPEGs per feed.

    The newest picture wins: those that come while one is at work or too soon replace each other, and the last
    one is always shown. Feeds do not wait for each other.

    Args:
        transport: Where everybody is.
        clock: For time stamps; the pace is wall time.
        quality: JPEG quality where encoding is needed.
        min_interval_s: Least wall time between two pictures of a feed.
        feeds: What differs for single feeds, by `robot/feed` or `feed`.
    """

    name: ClassVar[str] = "display_interface"
    apart = True

    def __init__(
        self,
        transport: Transport,
        clock: Clock,
        *,
        quality: int = 85,
        min_interval_s: float = 0.1,
        feeds: Mapping[str, FeedSettings] | None = None,
    ) -> None:
        super().__init__(transport)
        self._clock, self._quality, self._min_interval_s = clock, quality, min_interval_s
        self._feeds = dict(feeds or {})
        self._known: set[str] = set()
        self._busy: dict[str, _Feed] = {}

    async def open(self) -> None:
        """See `Node.open`."""
        # Many feeds share this topic, and a burst of one must not push out the last picture of another. What
        # is lost only the log tells: the next picture takes its place, and what a look tells has its own.
        await self.subscribe(topics.DISPLAY_FEED, DisplayFeed, self._on_picture, depth=MAX_FEEDS)

    def _on_picture(self, picture: DisplayFeed) -> None:
        topic = display_topic(picture.target, picture.name)
        if topic.name not in self._known and len(self._known) >= MAX_FEEDS:
            problem = f"more than {MAX_FEEDS} feeds; use fewer names"
            self.refuse(
                topics.DISPLAY_FEED.name,
                InvalidMessageError("DisplayFeed", "name", problem),
                target=picture.target,
            )
            return
        self._known.add(topic.name)
        feed = self._busy.get(topic.name)
        if feed is not None:
            feed.waiting = picture
            return
        self._busy[topic.name] = feed = _Feed(topic, self._settings(picture.target, picture.name), picture)
        self.spawn(self._show(feed), name=topic.name)

    async def _show(self, feed: _Feed) -> None:
        """Show what waits, at the allowed pace, until nothing does."""
        loop = asyncio.get_running_loop()
        try:
            while (picture := feed.waiting) is not None:
                feed.waiting = None
                # Counted from the beginning, or a film at just this pace would fall behind more and more.
                next_s = loop.time() + _either(feed.settings.interval_s, self._min_interval_s)
                await self._show_one(feed, picture)
                await asyncio.sleep(max(0.0, next_s - loop.time()))
        finally:
            del self._busy[feed.topic.name]

    async def _show_one(self, feed: _Feed, picture: DisplayFeed) -> None:
        unix_ms = self._clock.unix_ms()
        quality = _either(feed.settings.quality, self._quality)
        try:
            jpeg = await asyncio.to_thread(
                to_jpeg, picture.image, quality=quality, max_width_px=feed.settings.max_width_px
            )
        except InvalidMessageError as error:
            self.refuse(topics.DISPLAY_FEED.name, error, target=picture.target)
            return
        stamp = Time(unix_ms // 1000, unix_ms % 1000 * 1_000_000)
        self.send(feed.topic, CompressedImage(Header(stamp, frame_id=picture.name), "jpeg", jpeg))

    def _settings(self, robot: str, feed: str) -> FeedSettings:
        return self._feeds.get(f"{robot}/{feed}") or self._feeds.get(feed) or FeedSettings()


def _either(special: N | None, general: N) -> N:
    return general if special is None else special
