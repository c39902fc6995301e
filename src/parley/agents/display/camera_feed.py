"""A robot's camera as a continuous display feed, while somebody watches it."""

from __future__ import annotations

import asyncio
from typing import ClassVar, Final

from parley.agents.base import Node
from parley.agents.display.watching import Watched
from parley.engine.services import ContextServices
from parley.errors import ActionFailure
from parley.messages.topics import display_topic
from parley.robots.base import Robot
from parley.transport.base import Transport

__all__ = ["FEED", "CameraFeed"]

FEED: Final = "camera"
"""Name of the display feed."""
RETRY_S: Final = 2.0
"""Wall time after which a camera that failed is tried again."""


class CameraFeed(Node):
    """Takes pictures only while `/webapp/display_feed/<robot>/camera` has a subscriber.

    The topic is advertised from the start, so that people find the feed.

    Args:
        transport: Where the topics are.
        robot: Whose camera.
        rate_hz: Pictures per second of wall time.
    """

    name: ClassVar[str] = "camera_feed"

    def __init__(self, transport: Transport, robot: Robot, rate_hz: float = 5.0) -> None:
        super().__init__(transport)
        self._robot, self._interval_s = robot, 1.0 / rate_hz
        self._services = ContextServices(robot.name, transport)

    async def open(self) -> None:
        """See `Node.open`."""
        topic = display_topic(self._robot.name, FEED)
        await self.opened.enter_async_context(self._services)
        self.opened.callback(self.transport.publisher(topic).close)
        watched = self.opened.enter_context(Watched(self.transport, [topic.name]))
        self.spawn(self._run(watched), name=self._robot.name)

    async def _run(self, watched: Watched) -> None:
        while True:
            await watched.wait()
            try:
                self._services.show(FEED, await self._robot.image())
                await asyncio.sleep(self._interval_s)
            except ActionFailure as failure:
                self.log.warning("no picture", robot=self._robot.name, reason=failure.message)
                await asyncio.sleep(RETRY_S)
