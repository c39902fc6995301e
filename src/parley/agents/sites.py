"""Where robots are, as their engines tell it: maps, things, rooms, and what each robot is like."""

from __future__ import annotations

import asyncio
import contextlib
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import ClassVar, Final

from parley.agents.base import Node
from parley.errors import FileFormatError, InvalidMessageError
from parley.messages import topics
from parley.messages.map import PlacesKept
from parley.messages.robot import RobotSite
from parley.messages.ros import String
from parley.messages.status import ActorStatus
from parley.messages.wire import decode
from parley.transport.base import Transport
from parley.world.object_map import MapArea, MapObject
from parley.world.placed import Placed
from parley.world.telling import Surroundings, surroundings_of

__all__ = ["Sites"]

NOWHERE: Final = Surroundings()
SOON_S: Final = 3.0
_NOTHING: Final = Placed()


class Sites(Node):
    """The newest that each robot told, with what people put on its map.

    Args:
        transport: Where the topics are.
        told: Called with a robot and its surroundings whenever they change.
    """

    name: ClassVar[str] = "sites"

    def __init__(self, transport: Transport, told: Callable[[str, Surroundings], None]) -> None:
        super().__init__(transport)
        self._told = told
        self._asked: set[str] = set()
        self._heard: dict[str, Surroundings] = {}
        self._placed: dict[str, Placed] = {}
        self._changed = asyncio.Event()
        self.by_robot: dict[str, Surroundings] = {}
        """What is known, by robot."""

    async def open(self) -> None:
        """See `Node.open`."""
        await self.subscribe(topics.ACTOR_STATUS, ActorStatus, self._on_status)
        await self.subscribe(topics.PLACES_KEPT, PlacesKept, self._on_places)

    def objects(self, robot: str) -> Sequence[MapObject]:
        """What people may name to a robot."""
        return self.by_robot.get(robot, NOWHERE).objects.objects

    def rooms(self, robot: str) -> Sequence[MapObject]:
        """The rooms a robot can be sent to."""
        return self.by_robot.get(robot, NOWHERE).objects.rooms

    def areas(self) -> Sequence[MapArea]:
        """The named parts of all maps."""
        return tuple(dict.fromkeys(area for known in self.by_robot.values() for area in known.objects.areas))

    async def of(self, robot: str) -> Surroundings:
        """A robot's surroundings, as soon as it has told them."""
        while robot not in self.by_robot:
            await self._changed.wait()
        return self.by_robot[robot]

    async def known(self, robot: str) -> Surroundings | None:
        """The same; None of a robot whose engine is not ours and tells nothing."""
        return await self.of(robot) if robot in self._asked else None

    async def soon(self, robot: str) -> None:
        """Wait a moment for a robot that has just come, and not for one that never tells."""
        if robot in self._asked and robot not in self.by_robot:
            with contextlib.suppress(TimeoutError):
                async with asyncio.timeout(SOON_S):
                    await self.of(robot)

    async def _on_status(self, status: ActorStatus) -> None:
        if status.actor not in self._asked and status.engine == "parley":
            self._asked.add(status.actor)
            await self.subscribe_raw(topics.actor_site(status.actor), self._on_site)

    def _on_site(self, message: String) -> None:
        try:
            site = decode(RobotSite, message.data)
            known = surroundings_of(site)
        except InvalidMessageError as error:
            self.refuse("parley_site", error)
            return
        self._heard[site.actor] = known
        self._know(site.actor)
        changed, self._changed = self._changed, asyncio.Event()
        changed.set()

    def _on_places(self, kept: PlacesKept) -> None:
        """An engine tells the same in a moment; who spoke is understood by it at once."""
        try:
            self._placed = {name: Placed.of_json(told) for name, told in kept.maps.items()}
        except FileFormatError as error:
            self.log.warning("unreadable places", error=str(error))
            return
        for robot in self._heard:
            self._know(robot)

    def _know(self, robot: str) -> None:
        heard = self._heard[robot]
        placed = self._placed.get(heard.occupancy.name, _NOTHING)
        self.by_robot[robot] = known = replace(heard, objects=placed.applied(heard.objects))
        self._told(robot, known)
