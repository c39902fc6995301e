"""What ROS robots send, in our own terms: poses, ways between frames, maps, sweeps and pictures; and back."""

from __future__ import annotations

import io
import math
from typing import TYPE_CHECKING, Final

from parley.errors import ActionFailure, FailureCode, TypeMismatchError
from parley.messages import ros, ros_robot
from parley.sentences import sentence
from parley.world.geometry import Pose2D, wrap_angle

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from parley.robots.base import Detection, LaserScan
    from parley.world.occupancy import OccupancyMap

__all__ = [
    "Frames",
    "detected",
    "detections_of",
    "grid_of",
    "map_of",
    "picture_of",
    "planar",
    "pose_of",
    "scan_of",
    "stamped",
    "transform",
]

_CHANNELS: Final = {"rgb8": "RGB", "bgr8": "BGR", "rgba8": "RGBA", "bgra8": "BGRA", "mono8": "L"}
_OCCUPIED_FROM: Final = 65
_FREE_TO: Final = 25
_LONGEST_CHAIN: Final = 20


def pose_of(pose: Pose2D) -> ros_robot.Pose:
    """A planar pose as ROS has it."""
    half = pose.yaw_rad / 2
    turned = ros_robot.Quaternion(z=math.sin(half), w=math.cos(half))
    return ros_robot.Pose(ros_robot.Point(pose.x_m, pose.y_m), turned)


def stamped(pose: Pose2D, frame: str, unix_ms: int) -> ros_robot.PoseStamped:
    """The same with frame and time."""
    return ros_robot.PoseStamped(header(frame, unix_ms), pose_of(pose))


def header(frame: str, unix_ms: int) -> ros.Header:
    """Of a message of now."""
    return ros.Header(ros.Time(unix_ms // 1000, unix_ms % 1000 * 1_000_000), frame)


def planar(at: ros_robot.Point | ros_robot.Vector3, turned: ros_robot.Quaternion) -> Pose2D:
    """Place and heading on the floor."""
    q = turned
    yaw = math.atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y * q.y + q.z * q.z))
    return Pose2D(at.x, at.y, yaw)


def transform(parent: str, child: str, at: Pose2D, unix_ms: int) -> ros_robot.TransformStamped:
    """Where a frame stands in another."""
    pose = pose_of(at)
    place = ros_robot.Vector3(at.x_m, at.y_m)
    return ros_robot.TransformStamped(
        header(parent, unix_ms), child, ros_robot.Transform(place, pose.orientation)
    )


class Frames:
    """Where frames stand in each other, the newest word of each; flat, as floors are."""

    def __init__(self) -> None:
        self._in: dict[str, tuple[str, Pose2D]] = {}

    def learn(self, message: ros_robot.TFMessage) -> None:
        """Somebody told of some."""
        for told in message.transforms:
            child, parent = told.child_frame_id.lstrip("/"), told.header.frame_id.lstrip("/")
            self._in[child] = parent, planar(told.transform.translation, told.transform.rotation)

    @property
    def names(self) -> frozenset[str]:
        """All that were told of."""
        return frozenset({*self._in, *(parent for parent, _ in self._in.values())})

    def chain(self, frame: str) -> list[str]:
        """A frame, what it stands in, what that stands in, as far as it was told."""
        found = [frame]
        while (inner := self._in.get(found[-1])) is not None and len(found) < _LONGEST_CHAIN:
            found.append(inner[0])
        return found

    def find(self, frame: str, within: str) -> Pose2D | None:
        """Where a frame stands in another; None: nobody told."""
        at = Pose2D(0.0, 0.0)
        for _ in range(_LONGEST_CHAIN):
            if frame == within:
                return at
            if frame not in self._in:
                return None
            frame, parent_at = self._in[frame]
            at = _joined(parent_at, at)
        return None


def _joined(outer: Pose2D, inner: Pose2D) -> Pose2D:
    cos, sin = math.cos(outer.yaw_rad), math.sin(outer.yaw_rad)
    return Pose2D(
        outer.x_m + cos * inner.x_m - sin * inner.y_m,
        outer.y_m + sin * inner.x_m + cos * inner.y_m,
        wrap_angle(outer.yaw_rad + inner.yaw_rad),
    )


def map_of(grid: ros_robot.OccupancyGrid, name: str) -> OccupancyMap:
    """A robot's map.

    Raises:
        TypeMismatchError: Its size and its cells do not fit together, or it is turned.
    """
    import numpy as np

    from parley.world.occupancy import FREE, OCCUPIED, UNKNOWN, OccupancyMap

    rows, columns = grid.info.height, grid.info.width
    origin = planar(grid.info.origin.position, grid.info.origin.orientation)
    if len(grid.data) != rows * columns or not grid.info.resolution > 0:
        raise TypeMismatchError(f"a map of {columns} x {rows} came with {len(grid.data)} cells")
    if abs(origin.yaw_rad) > 1e-3:
        raise TypeMismatchError(f"a map that is turned by {origin.yaw_rad:.2f} rad cannot be used")
    told = np.array(grid.data, np.int8).reshape(rows, columns)
    cells = np.full(told.shape, UNKNOWN, np.int8)
    cells[(told >= 0) & (told <= _FREE_TO)] = FREE
    cells[told >= _OCCUPIED_FROM] = OCCUPIED
    return OccupancyMap(cells, grid.info.resolution, origin.x_m, origin.y_m, name)


def grid_of(occupancy: OccupancyMap, frame: str, unix_ms: int) -> ros_robot.OccupancyGrid:
    """A map of ours as ROS has it."""
    rows, columns = occupancy.cells.shape
    origin = pose_of(Pose2D(occupancy.origin_x_m, occupancy.origin_y_m))
    top = header(frame, unix_ms)
    info = ros_robot.MapMetaData(top.stamp, occupancy.resolution_m, columns, rows, origin)
    return ros_robot.OccupancyGrid(top, info, tuple(occupancy.cells.ravel().tolist()))


def scan_of(told: ros_robot.LaserScan, stamp_s: float) -> LaserScan:
    """A sweep; beams that hit nothing, or cannot be, are `inf`."""
    import numpy as np

    from parley.robots.base import LaserScan

    ranges = np.array(told.ranges, np.float32)
    with np.errstate(invalid="ignore"):
        ranges[~((ranges >= told.range_min) & (ranges <= told.range_max))] = np.inf
    return LaserScan(told.angle_min, told.angle_increment, ranges, told.range_max, stamp_s)


def detections_of(told: ros_robot.Detection2DArray, at: Pose2D | None) -> tuple[Detection, ...]:
    """What a detector recognised, the largest first.

    Args:
        told: Its words; of several for one thing the most certain counts.
        at: Where the frame of its places stands on the map; None: that is not known, so no places are.
    """
    from parley.robots.base import Detection

    found = []
    for one in (one for one in told.detections if one.results):
        best = max(one.results, key=lambda result: result.hypothesis.score)
        where = best.pose.pose.position
        place = None if at is None or where == ros_robot.Point() else _joined(at, Pose2D(where.x, where.y))
        middle, width, height = one.bbox.center.position, one.bbox.size_x, one.bbox.size_y
        left, top = round(middle.x - width / 2), round(middle.y - height / 2)
        found.append(
            Detection(
                best.hypothesis.class_id,
                round(width * height),
                (left, top, left + round(width), top + round(height)),
                None,
                None if place is None else place.x_m,
                None if place is None else place.y_m,
                confidence=best.hypothesis.score,
            )
        )
    return tuple(sorted(found, key=lambda one: -one.pixels))


def detected(seen: tuple[Detection, ...], top: ros.Header) -> ros_robot.Detection2DArray:
    """The same as ROS has it, with places in the frame of the header."""

    def told(one: Detection) -> ros_robot.Detection2D:
        left, upper, right, lower = one.box
        middle = ros_robot.VisionPose2D(ros_robot.Point2D((left + right) / 2, (upper + lower) / 2))
        where = ros_robot.Pose(ros_robot.Point(one.x_m or 0.0, one.y_m or 0.0))
        score = 1.0 if one.confidence is None else one.confidence
        result = ros_robot.ObjectHypothesisWithPose(
            ros_robot.ObjectHypothesis(one.label, score), ros_robot.PoseWithCovariance(where)
        )
        return ros_robot.Detection2D(
            top, (result,), ros_robot.BoundingBox2D(middle, right - left, lower - upper)
        )

    return ros_robot.Detection2DArray(top, tuple(map(told, seen)))


def picture_of(told: ros.CompressedImage | ros_robot.Image) -> NDArray[np.uint8]:
    """The pixels of a picture, red, green and blue.

    Raises:
        ActionFailure: `hardware`: it cannot be read.
    """
    import numpy as np
    from PIL import Image, UnidentifiedImageError

    try:
        if isinstance(told, ros.CompressedImage):
            with Image.open(io.BytesIO(told.data), formats=("JPEG", "PNG")) as picture:
                return np.asarray(picture.convert("RGB"))
        raw = np.frombuffer(told.data, np.uint8).reshape(told.height, told.step)
        channels = _CHANNELS[told.encoding]
        pixels = raw[:, : told.width * len(channels)].reshape(told.height, told.width, len(channels))
    except (UnidentifiedImageError, OSError, ValueError, KeyError) as error:
        what = told.format if isinstance(told, ros.CompressedImage) else told.encoding
        raise ActionFailure(
            FailureCode.HARDWARE,
            sentence("I cannot read what my camera sends."),
            {"why": str(error), "form": what},
        ) from error
    order = [channels.index(colour) if channels != "L" else 0 for colour in "RGB"]
    return np.ascontiguousarray(pixels[:, :, order])
