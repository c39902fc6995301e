"""What a ROS robot tells of itself: where it is, how fast, what its laser and camera see, whether it is held.

Everything here runs on the robot's link; the newest word of each is read from anywhere.
"""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from contextlib import AbstractAsyncContextManager
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

import structlog

from parley.errors import ActionFailure, FailureCode, TypeMismatchError
from parley.messages import ros, ros_robot
from parley.messages.topics import QoS, Topic
from parley.robots.base import CameraImage, LaserScan, Velocity
from parley.robots.ros_values import Frames, detections_of, map_of, picture_of, planar, scan_of
from parley.sentences import sentence
from parley.transport.base import Endpoint, Subscription, Transport, absolute
from parley.world.geometry import Pose2D

if TYPE_CHECKING:
    from parley.world.occupancy import OccupancyMap

__all__ = ["SILENT", "RosTopics", "Senses", "velocities_heard", "velocities_taken"]

PICTURE_S: Final = 5.0
"""Within this a camera gives a picture."""
DETECTOR_S: Final = 10.0
"""So much longer its detector has for what is in it: on a busy computer, or without a GPU, it is late."""
KEPT_BYTES: Final = 32_000_000
"""So much of pictures waits for what the robot's detector says of one of them."""
WATCHED_S: Final = 5.0
"""For so long after a picture was asked for the camera is listened to: pictures are what fills a network."""

ATTENDS_S: Final = 0.1
GONE_S: Final = 1.0
"""Who hears nothing for longer may have to be found by others again."""
SILENT: Final = sentence("My base does not answer.")

_TYPES: Final[dict[type[Any], str]] = {
    ros.CompressedImage: "sensor_msgs/msg/CompressedImage",
    ros_robot.Bool: "std_msgs/msg/Bool",
    ros_robot.Detection2DArray: "vision_msgs/msg/Detection2DArray",
    ros_robot.Image: "sensor_msgs/msg/Image",
    ros_robot.LaserScan: "sensor_msgs/msg/LaserScan",
    ros_robot.OccupancyGrid: "nav_msgs/msg/OccupancyGrid",
    ros_robot.Odometry: "nav_msgs/msg/Odometry",
    ros_robot.PoseWithCovarianceStamped: "geometry_msgs/msg/PoseWithCovarianceStamped",
    ros_robot.TFMessage: "tf2_msgs/msg/TFMessage",
    ros_robot.Twist: "geometry_msgs/msg/Twist",
    ros_robot.TwistStamped: "geometry_msgs/msg/TwistStamped",
}
_USUAL: Final = QoS()
_STREAM: Final = QoS(reliable=False, depth=5)
PICTURES: Final = QoS(reliable=False, depth=1)
_STATE: Final = QoS(latched=True, depth=1)

log = structlog.get_logger(__name__)


@dataclass(frozen=True, slots=True)
class RosTopics:
    """What a robot's topics and frames are called; an empty name: it has none of that."""

    __pydantic_config__ = {"extra": "forbid"}  # noqa: RUF012 - for files

    namespace: str = ""
    """Before all names."""
    odom: str = "odom"
    amcl_pose: str = "amcl_pose"
    tf: str = "tf"
    tf_static: str = "tf_static"
    map: str = "map"
    scan: str = "scan"
    camera: str = "camera/image_raw/compressed"
    """Of type CompressedImage if it ends so, else Image."""
    detections: str = ""
    """A vision_msgs/Detection2DArray of what its own detector recognises, stamped as the picture it is of;
    places count in `map_frame` and `base_frame`."""
    emergency: str = ""
    """A std_msgs/Bool that is true while a button on the robot holds it."""
    cmd_vel: str = "cmd_vel"
    stamped: bool | None = None
    """Whether velocities are TwistStamped, as with many bases since Jazzy; None: as whoever listens there."""
    hold: str = "parley/hold"
    """Says ten times a second whether it must stand: a lock of twist_mux, so that silence holds it too."""
    map_frame: str = "map"
    base_frame: str = "base_link"

    @property
    def capabilities(self) -> frozenset[str]:
        """What it can sense."""
        return frozenset(({"camera"} if self.camera else set()) | ({"lidar"} if self.scan else set()))

    def topic(self, name: str, kind: type[Any], qos: QoS = _USUAL) -> Topic[Any]:
        """One of its topics."""
        return Topic(self.name(name), kind, _TYPES[kind], qos)

    def name(self, name: str) -> str:
        """A name with the namespace before it."""
        return f"{self.namespace}/{name}" if self.namespace and not name.startswith("/") else name

    def told(self) -> Iterator[tuple[str, type[Any], QoS]]:
        """What it tells on which topic, of all that it has."""
        every = (
            (self.tf_static, ros_robot.TFMessage, QoS(latched=True, depth=100)),
            (self.tf, ros_robot.TFMessage, QoS(depth=100)),
            (self.amcl_pose, ros_robot.PoseWithCovarianceStamped, _STATE),
            (self.odom, ros_robot.Odometry, _STREAM),
            (self.map, ros_robot.OccupancyGrid, _STATE),
            (self.scan, ros_robot.LaserScan, _STREAM),
            (self.camera, self.camera_type, PICTURES),
            (self.detections, ros_robot.Detection2DArray, PICTURES),
            (self.emergency, ros_robot.Bool, _STATE),
        )
        return ((name, kind, qos) for name, kind, qos in every if name)

    def heard(self, name: str, kind: type[Any], qos: QoS) -> Iterator[Topic[Any]]:
        """As what it is listened to: in ROS 2 only who latches is heard by who asks for it; buttons vary."""
        yield self.topic(name, kind, qos)
        if name == self.emergency:
            yield self.topic(name, kind)

    @property
    def camera_type(self) -> type[Any]:
        """Of its pictures."""
        return ros.CompressedImage if self.camera.endswith("compressed") else ros_robot.Image


def velocities_taken(topics: RosTopics, ends: Iterable[Endpoint]) -> type[Any]:
    """Of which type velocities must be so that whoever drives the base takes them."""
    stamped = topics.stamped
    if stamped is None:
        kinds = velocities_heard(topics, ends)
        stamped = _TYPES[ros_robot.TwistStamped] in kinds and _TYPES[ros_robot.Twist] not in kinds
    return ros_robot.TwistStamped if stamped else ros_robot.Twist


def velocities_heard(topics: RosTopics, ends: Iterable[Endpoint]) -> set[str]:
    """For which types of velocities somebody listens; no topic carries two."""
    there = absolute(topics.name(topics.cmd_vel))
    return {end.ros_type for end in ends if end.role == "subscription" and end.name == there}


class Senses:
    """The newest of everything.

    Args:
        topics: Where it is told.
        now_s: The robot's time.
        wall_s: Wall time.
        timeout: What bounds waiting for a picture, in seconds.
    """

    def __init__(
        self,
        topics: RosTopics,
        now_s: Callable[[], float],
        wall_s: Callable[[], float],
        timeout: Callable[[float], AbstractAsyncContextManager[Any]] = asyncio.timeout,
    ) -> None:
        self._topics, self._now_s, self._wall_s, self._timeout = topics, now_s, wall_s, timeout
        self._frames = Frames()
        self._amcl: Pose2D | None = None
        self._odom: ros_robot.Odometry | None = None
        self._heard_s = 0.0
        self._attended_s: float | None = None
        """When somebody here could hear last; None: always."""
        self._back_s: float | None = None
        """When somebody here could hear again, after others may have taken this process for gone."""
        self._sweep: tuple[ros_robot.LaserScan, float] | None = None
        self._camera: list[Subscription] = []
        self._taken: deque[_Picture] = deque()
        self._seen: ros_robot.Detection2DArray | None = None
        self._judged: tuple[_Picture, ros_robot.Detection2DArray] | None = None
        """The newest picture of which the detector spoke, and what it said."""
        self._count = 0
        self._pictures = asyncio.Condition()
        self._wanted = 0
        """So many wait for a picture."""
        self._watched_s = 0.0
        self.occupancy: OccupancyMap | None = None
        self.emergency = False
        self.ready = asyncio.Event()
        """It is known where the robot is and how fast."""
        self.mapped = asyncio.Event()

    async def listen(self, transport: Transport) -> None:
        """Hear of everything but pictures, which are heard while somebody wants them."""
        handlers: dict[str, Callable[[Any], None]] = {
            self._topics.tf_static: self._on_frames,
            self._topics.tf: self._on_frames,
            self._topics.amcl_pose: self._on_amcl,
            self._topics.odom: self._on_odom,
            self._topics.map: self._on_map,
            self._topics.scan: self._on_scan,
            self._topics.emergency: self._on_emergency,
        }
        for name, kind, qos in self._topics.told():
            if name in handlers:
                for topic in self._topics.heard(name, kind, qos):
                    await transport.subscribe(topic, handlers[name])

    # -- read from anywhere ------------------------------------------------------------------------------

    def fresh(self, within_s: float) -> bool:
        """Whether the base was heard lately, of the time in which somebody here could hear it."""
        now_s = self._wall_s()
        if self._attended_s is not None:
            now_s = min(now_s, self._attended_s + 2 * ATTENDS_S)
        return now_s - self._heard_s <= within_s

    async def attend(self) -> None:
        """Notice that this process, or the thread in which messages come in, was kept from hearing any."""
        while True:
            self._attended_s = self._wall_s()
            await asyncio.sleep(ATTENDS_S)
            now_s = self._wall_s()
            late_s = now_s - self._attended_s - 2 * ATTENDS_S
            self._heard_s = min(now_s, self._heard_s + max(0.0, late_s))
            if late_s > GONE_S:
                self._back_s = now_s

    def returned(self, within_s: float) -> bool:
        """Whether this process was away until lately: if the base is not heard, that may be why."""
        return self._back_s is not None and self._wall_s() - self._back_s <= within_s

    def missing(self) -> str:
        """What is not heard, for engineers."""
        names = self._topics
        found = {
            f"{names.name(names.odom)} (odometry)": self._odom,
            f"{names.name(names.tf)} from {names.base_frame} to {names.map_frame}, or "
            f"{names.name(names.amcl_pose)} (pose)": self._pose(),
        }
        return "nothing on " + " and ".join(what for what, told in found.items() if told is None)

    def pose(self, within_s: float) -> Pose2D:
        """Where the robot is.

        Raises:
            ActionFailure: `hardware`: it is not known, or not heard for longer than allowed.
        """
        pose = self._pose()
        if pose is None or not self.fresh(within_s):
            raise ActionFailure(FailureCode.HARDWARE, SILENT)
        return pose

    def velocity(self, within_s: float) -> Velocity:
        """How fast it moves.

        Raises:
            ActionFailure: See `pose`.
        """
        if self._odom is None or not self.fresh(within_s):
            raise ActionFailure(FailureCode.HARDWARE, SILENT)
        twist = self._odom.twist.twist
        return Velocity(twist.linear.x, twist.angular.z)

    def scan(self) -> LaserScan:
        """The newest sweep.

        Raises:
            ActionFailure: `hardware`: there is none.
        """
        if self._sweep is None:
            raise ActionFailure(FailureCode.HARDWARE, sentence("My laser tells nothing."))
        return scan_of(*self._sweep)

    def _pose(self) -> Pose2D | None:
        """By the frames; where nobody tells them, by the localisation alone."""
        return self._frames.find(self._topics.base_frame, self._topics.map_frame) or self._amcl

    # -- on the link -------------------------------------------------------------------------------------

    async def picture(self, transport: Transport) -> CameraImage:
        """The next picture.

        Raises:
            ActionFailure: `not_capable` without a camera, `hardware` if none comes.
        """
        if not self._topics.camera:
            raise ActionFailure(FailureCode.NOT_CAPABLE, sentence("I have no camera."))
        self._wanted += 1
        try:
            picture, seen = await self._next_picture(transport)
        finally:
            self._wanted -= 1
            self._watched_s = self._wall_s()
        pixels = picture_of(picture.told)
        height, width, _ = pixels.shape
        found = None if seen is None else detections_of(seen, self._place_of(seen.header.frame_id))
        return CameraImage(width, height, "rgb8", pixels, picture.stamp_s, found)

    async def _next_picture(self, transport: Transport) -> tuple[_Picture, ros_robot.Detection2DArray | None]:
        """Taken from now on; with a detector, one of which it speaks, if it speaks at all."""
        async with self._pictures:
            if not self._camera:
                await self._watch(transport)
            before = self._count
        try:
            async with self._timeout(PICTURE_S), self._pictures:
                await self._pictures.wait_for(lambda: self._count > before)
                picture = self._taken[-1]
        except TimeoutError:
            raise ActionFailure(FailureCode.HARDWARE, sentence("My camera gives no picture.")) from None
        if not self._topics.detections:
            return picture, None
        try:
            async with self._timeout(DETECTOR_S), self._pictures:
                await self._pictures.wait_for(lambda: self._judged and self._judged[0].number > before)
                return self._judged or (picture, None)
        except TimeoutError:
            log.warning("the robot's detector says nothing", topic=self._topics.detections)
            return self._taken[-1], None

    async def _watch(self, transport: Transport) -> None:
        names = self._topics
        pictures = names.topic(names.camera, names.camera_type, PICTURES)
        self._camera.append(await transport.subscribe(pictures, self._on_picture))
        if names.detections:
            found = names.topic(names.detections, ros_robot.Detection2DArray, PICTURES)
            self._camera.append(await transport.subscribe(found, self._on_detections))

    def _place_of(self, frame: str) -> Pose2D | None:
        """Where a frame stands on the map, as far as it lies flat: cameras do not."""
        names = self._topics
        if frame not in (names.map_frame, names.base_frame):
            return None
        return Pose2D(0.0, 0.0) if frame == names.map_frame else self._pose()

    async def rest(self) -> None:
        """Listen to the camera no more if nobody wanted a picture for a while."""
        if self._camera and not self._wanted and self._wall_s() - self._watched_s > WATCHED_S:
            camera, self._camera = self._camera, []
            self._taken.clear()
            for end in camera:
                await end.close()

    def _on_frames(self, told: ros_robot.TFMessage) -> None:
        self._frames.learn(told)
        self._look()

    def _on_amcl(self, told: ros_robot.PoseWithCovarianceStamped) -> None:
        self._amcl = planar(told.pose.pose.position, told.pose.pose.orientation)
        self._look()

    def _on_odom(self, told: ros_robot.Odometry) -> None:
        self._odom, self._heard_s = told, self._wall_s()
        self._look()

    def _look(self) -> None:
        if not self.ready.is_set() and self._odom is not None and self._pose() is not None:
            self.ready.set()

    def _on_scan(self, told: ros_robot.LaserScan) -> None:
        self._sweep = told, self._now_s()

    def _on_map(self, told: ros_robot.OccupancyGrid) -> None:
        try:
            self.occupancy = map_of(told, self._topics.map)
            self.mapped.set()
        except TypeMismatchError as error:
            log.warning("the robot's map cannot be used", why=str(error))

    def _on_emergency(self, told: ros_robot.Bool) -> None:
        self.emergency = told.data

    async def _on_picture(self, told: Any) -> None:
        async with self._pictures:
            self._count += 1
            self._taken.append(_Picture(self._count, told, self._now_s()))
            while sum(len(one.told.data) for one in self._taken) > KEPT_BYTES and len(self._taken) > 1:
                self._taken.popleft()
            self._judge()

    async def _on_detections(self, told: ros_robot.Detection2DArray) -> None:
        async with self._pictures:
            self._seen = told
            self._judge()

    def _judge(self) -> None:
        """Find the picture of which the detector spoke last."""
        if (seen := self._seen) is not None:
            of = (one for one in self._taken if one.told.header.stamp == seen.header.stamp)
            self._judged = next(((one, seen) for one in of), self._judged)
        self._pictures.notify_all()


@dataclass(frozen=True, slots=True)
class _Picture:
    """As it was heard."""

    number: int
    told: Any
    stamp_s: float
