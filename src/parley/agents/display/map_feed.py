"""Where a robot is and where it goes, for maps on screens: as data, and as a picture (thesis, figure 17)."""

from __future__ import annotations

import asyncio
import base64
import io
import math
import zlib
from collections.abc import Callable, Sequence
from functools import lru_cache
from typing import ClassVar, Final

from PIL import Image

from parley.agents.base import Node
from parley.agents.display.map_drawing import MapPicture
from parley.agents.display.watching import Watched
from parley.clock import Clock
from parley.errors import ActionFailure
from parley.messages import topics
from parley.messages.display import DisplayFeed
from parley.messages.map import MapView
from parley.messages.status import PoseInfo
from parley.messages.topics import display_topic
from parley.robots.base import Robot
from parley.transport.base import Transport
from parley.world.object_map import MapObject, ObjectMap
from parley.world.occupancy import OccupancyMap

__all__ = ["FEED", "MapFeed", "MapViews"]

FEED: Final = "map"
"""Name of the display feed."""
MOVING_INTERVAL_S: Final = 0.2
"""Wall time between two views of a robot that moves."""
RESTING_INTERVAL_S: Final = 2.0
"""Wall time after which a view that did not change is sent again, for who came meanwhile."""
PICTURE_INTERVAL_S: Final = 0.5
_MAX_POINTS: Final = 200
"""Of a way or a sweep; more cannot be told apart on a screen."""

Point = tuple[float, float]


class MapViews(Node):
    """Sends `/parley/map_view` of one robot while somebody subscribes to it.

    Args:
        transport: Where the topics are.
        robot: Whose view.
        map_name: Of the map it drives by.
        clock: For time stamps; the pace is wall time.
        known: What is on that map now.
    """

    name: ClassVar[str] = "map_views"

    def __init__(
        self,
        transport: Transport,
        robot: Robot,
        map_name: str,
        clock: Clock,
        known: Callable[[], ObjectMap] = ObjectMap,
    ) -> None:
        super().__init__(transport)
        self._robot, self._map_name, self._clock, self._known = robot, map_name, clock, known

    async def open(self) -> None:
        """See `Node.open`."""
        watched = self.opened.enter_context(Watched(self.transport, [topics.MAP_VIEW.name]))
        self.spawn(self._run(watched), name=self._robot.name)

    async def _run(self, watched: Watched) -> None:
        told, quiet_s = None, 0.0
        while True:
            await watched.wait()
            known = self._known()
            view = _seen(self._robot, self._map_name, self._clock.unix_ms(), known)
            where = (view.pose, view.path, view.holds, view.places) if view is not None else told
            if view is not None and (where != told or quiet_s >= RESTING_INTERVAL_S):
                told, quiet_s = where, 0.0
                self.publish(topics.MAP_VIEW, view)
            # A pose is measured, not announced: it has to be looked up.
            await asyncio.sleep(MOVING_INTERVAL_S)
            quiet_s += MOVING_INTERVAL_S


class MapFeed(Node):
    """Draws the map with the robot, its way and its lidar as the display feed `map`, while somebody watches.

    Args:
        transport: Where the topics are.
        robot: Who is drawn.
        occupancy: The map it drives by.
        objects: What stands where now.
        clock: For time stamps; the pace is wall time.
    """

    name: ClassVar[str] = "map_feed"

    def __init__(
        self,
        transport: Transport,
        robot: Robot,
        occupancy: OccupancyMap,
        objects: Callable[[], Sequence[MapObject]],
        clock: Clock,
    ) -> None:
        super().__init__(transport)
        self._robot, self._map, self._objects, self._clock = robot, occupancy, objects, clock

    async def open(self) -> None:
        """See `Node.open`."""
        topic = display_topic(self._robot.name, FEED)
        self.opened.callback(self.transport.publisher(topic).close)
        watched = self.opened.enter_context(Watched(self.transport, [topic.name]))
        self.spawn(self._run(watched), name=self._robot.name)

    async def _run(self, watched: Watched) -> None:
        drawn, picture = None, None
        while True:
            await watched.wait()
            if (objects := self._objects()) != drawn or picture is None:
                drawn, picture = (
                    objects,
                    await asyncio.to_thread(
                        MapPicture, self._map, objects, robot_radius_m=self._robot.radius_m
                    ),
                )
            view = _seen(self._robot, self._map.name, self._clock.unix_ms())
            if view is not None:
                image = await asyncio.to_thread(_png, picture, view)
                feed = DisplayFeed(target=self._robot.name, name=FEED, image=image)
                self.publish(topics.DISPLAY_FEED, feed)
            await asyncio.sleep(PICTURE_INTERVAL_S)


_NOTHING: Final = ObjectMap()


def _seen(robot: Robot, map_name: str, unix_ms: int, known: ObjectMap = _NOTHING) -> MapView | None:
    """The same, or None while the robot does not know where it is."""
    try:
        return view_of(robot, map_name, unix_ms, known)
    except ActionFailure:
        return None


def view_of(robot: Robot, map_name: str, unix_ms: int, known: ObjectMap = _NOTHING) -> MapView:
    """What a map on a screen shows of a robot now; without lidar there is no sweep."""
    pose, way = robot.pose(), robot.planned_path()
    here = PoseInfo(x=round(pose.x_m, 3), y=round(pose.y_m, 3), yaw=round(pose.yaw_rad, 3))
    goal = PoseInfo(x=way[-1][0], y=way[-1][1]) if way else None
    room = next((area.name for area in known.areas if area.holds(here.x, here.y)), "")
    holds = robot.arm.holds if robot.arm is not None else ""
    return MapView(
        actor=robot.name, map_name=map_name, pose=here, places=_mark(known), room=room, holds=holds,
        path=_thinned(way), goal=goal, scan=_scan(robot), unix_ms=unix_ms,
    )  # fmt: skip


@lru_cache(maxsize=8)
def _mark(known: ObjectMap) -> str:
    """Short, and another one for other rooms and things."""
    return f"{zlib.crc32(repr(known).encode()):08x}"


def _scan(robot: Robot) -> tuple[Point, ...]:
    try:
        scan = robot.scan()
    except ActionFailure:
        return ()
    pose = robot.pose()
    angle_rad = pose.yaw_rad + scan.angle_min_rad
    hits = [
        (
            round(pose.x_m + distance * math.cos(angle_rad + index * scan.angle_increment_rad), 3),
            round(pose.y_m + distance * math.sin(angle_rad + index * scan.angle_increment_rad), 3),
        )
        for index, distance in enumerate(scan.ranges_m.tolist())
        if math.isfinite(distance) and distance < scan.range_max_m
    ]
    return _thinned(tuple(hits))


def _thinned(points: tuple[Point, ...]) -> tuple[Point, ...]:
    """At most `_MAX_POINTS` of them, evenly chosen, the last one among them."""
    step = -(-len(points) // _MAX_POINTS) or 1
    return points[::-1][::step][::-1]


def _png(picture: MapPicture, view: MapView) -> str:
    return _base64_png(picture.draw(view))


def _base64_png(image: Image.Image) -> str:
    buffer = io.BytesIO()
    image.save(buffer, "PNG", compress_level=1)
    return base64.b64encode(buffer.getvalue()).decode("ascii")
