"""The ROS messages with which robots move, say where they are and what they see.

Sources: geometry_msgs, nav_msgs, sensor_msgs, tf2_msgs, vision_msgs and nav2_msgs of ROS 2, the last of
several releases.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Final, Literal

from parley.messages.actions import Action
from parley.messages.ros import Duration, Header, Time
from parley.messages.topics import Service

__all__ = [
    "ACTIVE",
    "LOCALISER",
    "NAVIGATOR",
    "Bool",
    "BoundingBox2D",
    "Detection2D",
    "Detection2DArray",
    "Empty",
    "GetStateRequest",
    "GetStateResponse",
    "Image",
    "LaserScan",
    "LifecycleState",
    "MapMetaData",
    "NavigateGoal",
    "NavigateResult",
    "ObjectHypothesis",
    "ObjectHypothesisWithPose",
    "OccupancyGrid",
    "Odometry",
    "Point",
    "Point2D",
    "Pose",
    "PoseStamped",
    "PoseWithCovariance",
    "PoseWithCovarianceStamped",
    "Quaternion",
    "Release",
    "TFMessage",
    "Transform",
    "TransformStamped",
    "Twist",
    "TwistStamped",
    "TwistWithCovariance",
    "Vector3",
    "VisionPose2D",
    "get_state",
    "navigate_to_pose",
]  # fmt: skip

Release = Literal["humble", "jazzy", "lyrical"]
"""Of Nav2, by the words of its messages: `jazzy` is for Kilted too, `lyrical` for Rolling."""

_UNKNOWN: Final = (0.0,) * 36


@dataclass(frozen=True, slots=True)
class Bool:
    """std_msgs/msg/Bool."""

    data: bool = False


@dataclass(frozen=True, slots=True)
class Empty:
    """std_msgs/msg/Empty."""


@dataclass(frozen=True, slots=True)
class GetStateRequest:
    """lifecycle_msgs/srv/GetState_Request."""


@dataclass(frozen=True, slots=True)
class LifecycleState:
    """lifecycle_msgs/msg/State."""

    id: int = 0
    label: str = ""


@dataclass(frozen=True, slots=True)
class GetStateResponse:
    """lifecycle_msgs/srv/GetState_Response."""

    current_state: LifecycleState = LifecycleState()


NAVIGATOR: Final = "bt_navigator"
LOCALISER: Final = "amcl"
"""The node of Nav2 that knows where the robot is."""
"""The node of Nav2 that takes goals."""
ACTIVE: Final = LifecycleState(3, "active")
"""Of a node that does its work."""


def get_state(node: str) -> Service[GetStateRequest, GetStateResponse]:
    """What a node that is started in steps answers to how far it is; `node` with its namespace."""
    return Service(f"{node}/get_state", GetStateRequest, GetStateResponse, "lifecycle_msgs/srv/GetState")


@dataclass(frozen=True, slots=True)
class Vector3:
    """geometry_msgs/msg/Vector3."""

    x: float = 0.0
    y: float = 0.0
    z: float = 0.0


@dataclass(frozen=True, slots=True)
class Point:
    """geometry_msgs/msg/Point."""

    x: float = 0.0
    y: float = 0.0
    z: float = 0.0


@dataclass(frozen=True, slots=True)
class Quaternion:
    """geometry_msgs/msg/Quaternion."""

    x: float = 0.0
    y: float = 0.0
    z: float = 0.0
    w: float = 1.0


@dataclass(frozen=True, slots=True)
class Pose:
    """geometry_msgs/msg/Pose."""

    position: Point = field(default_factory=Point)
    orientation: Quaternion = field(default_factory=Quaternion)


@dataclass(frozen=True, slots=True)
class PoseStamped:
    """geometry_msgs/msg/PoseStamped."""

    header: Header = field(default_factory=Header)
    pose: Pose = field(default_factory=Pose)


@dataclass(frozen=True, slots=True)
class PoseWithCovariance:
    """geometry_msgs/msg/PoseWithCovariance."""

    pose: Pose = field(default_factory=Pose)
    covariance: tuple[float, ...] = _UNKNOWN


@dataclass(frozen=True, slots=True)
class PoseWithCovarianceStamped:
    """geometry_msgs/msg/PoseWithCovarianceStamped."""

    header: Header = field(default_factory=Header)
    pose: PoseWithCovariance = field(default_factory=PoseWithCovariance)


@dataclass(frozen=True, slots=True)
class Twist:
    """geometry_msgs/msg/Twist."""

    linear: Vector3 = field(default_factory=Vector3)
    angular: Vector3 = field(default_factory=Vector3)


@dataclass(frozen=True, slots=True)
class TwistStamped:
    """geometry_msgs/msg/TwistStamped."""

    header: Header = field(default_factory=Header)
    twist: Twist = field(default_factory=Twist)


@dataclass(frozen=True, slots=True)
class TwistWithCovariance:
    """geometry_msgs/msg/TwistWithCovariance."""

    twist: Twist = field(default_factory=Twist)
    covariance: tuple[float, ...] = _UNKNOWN


@dataclass(frozen=True, slots=True)
class Odometry:
    """nav_msgs/msg/Odometry."""

    header: Header = field(default_factory=Header)
    child_frame_id: str = ""
    pose: PoseWithCovariance = field(default_factory=PoseWithCovariance)
    twist: TwistWithCovariance = field(default_factory=TwistWithCovariance)


@dataclass(frozen=True, slots=True)
class Transform:
    """geometry_msgs/msg/Transform."""

    translation: Vector3 = field(default_factory=Vector3)
    rotation: Quaternion = field(default_factory=Quaternion)


@dataclass(frozen=True, slots=True)
class TransformStamped:
    """geometry_msgs/msg/TransformStamped."""

    header: Header = field(default_factory=Header)
    child_frame_id: str = ""
    transform: Transform = field(default_factory=Transform)


@dataclass(frozen=True, slots=True)
class TFMessage:
    """tf2_msgs/msg/TFMessage."""

    transforms: tuple[TransformStamped, ...] = ()


@dataclass(frozen=True, slots=True)
class MapMetaData:
    """nav_msgs/msg/MapMetaData."""

    map_load_time: Time = field(default_factory=Time)
    resolution: float = 0.0
    width: int = 0
    height: int = 0
    origin: Pose = field(default_factory=Pose)


@dataclass(frozen=True, slots=True)
class OccupancyGrid:
    """nav_msgs/msg/OccupancyGrid."""

    header: Header = field(default_factory=Header)
    info: MapMetaData = field(default_factory=MapMetaData)
    data: tuple[int, ...] = ()


@dataclass(frozen=True, slots=True)
class LaserScan:
    """sensor_msgs/msg/LaserScan."""

    header: Header = field(default_factory=Header)
    angle_min: float = 0.0
    angle_max: float = 0.0
    angle_increment: float = 0.0
    time_increment: float = 0.0
    scan_time: float = 0.0
    range_min: float = 0.0
    range_max: float = 0.0
    ranges: tuple[float, ...] = ()
    intensities: tuple[float, ...] = ()


@dataclass(frozen=True, slots=True)
class Image:
    """sensor_msgs/msg/Image."""

    header: Header = field(default_factory=Header)
    height: int = 0
    width: int = 0
    encoding: str = "rgb8"
    is_bigendian: int = 0
    step: int = 0
    data: bytes = b""


@dataclass(frozen=True, slots=True)
class Point2D:
    """vision_msgs/msg/Point2D."""

    x: float = 0.0
    y: float = 0.0


@dataclass(frozen=True, slots=True)
class VisionPose2D:
    """vision_msgs/msg/Pose2D."""

    position: Point2D = field(default_factory=Point2D)
    theta: float = 0.0


@dataclass(frozen=True, slots=True)
class BoundingBox2D:
    """vision_msgs/msg/BoundingBox2D, in pixels."""

    center: VisionPose2D = field(default_factory=VisionPose2D)
    size_x: float = 0.0
    size_y: float = 0.0


@dataclass(frozen=True, slots=True)
class ObjectHypothesis:
    """vision_msgs/msg/ObjectHypothesis."""

    class_id: str = ""
    score: float = 0.0


@dataclass(frozen=True, slots=True)
class ObjectHypothesisWithPose:
    """vision_msgs/msg/ObjectHypothesisWithPose."""

    hypothesis: ObjectHypothesis = field(default_factory=ObjectHypothesis)
    pose: PoseWithCovariance = field(default_factory=PoseWithCovariance)


@dataclass(frozen=True, slots=True)
class Detection2D:
    """vision_msgs/msg/Detection2D."""

    header: Header = field(default_factory=Header)
    results: tuple[ObjectHypothesisWithPose, ...] = ()
    bbox: BoundingBox2D = field(default_factory=BoundingBox2D)
    id: str = ""


@dataclass(frozen=True, slots=True)
class Detection2DArray:
    """vision_msgs/msg/Detection2DArray."""

    header: Header = field(default_factory=Header)
    detections: tuple[Detection2D, ...] = ()


@dataclass(frozen=True, slots=True)
class NavigateGoal:
    """nav2_msgs/action/NavigateToPose, goal."""

    pose: PoseStamped = field(default_factory=PoseStamped)
    behavior_tree: str = ""


@dataclass(frozen=True, slots=True)
class HumbleResult:
    """nav2_msgs/action/NavigateToPose, result: Humble says nothing."""

    result: Empty = field(default_factory=Empty)


@dataclass(frozen=True, slots=True)
class NavigateResult:
    """nav2_msgs/action/NavigateToPose, result since Jazzy."""

    error_code: int = 0
    error_msg: str = ""


@dataclass(frozen=True, slots=True)
class NavigateFeedback:
    """nav2_msgs/action/NavigateToPose, feedback."""

    current_pose: PoseStamped = field(default_factory=PoseStamped)
    navigation_time: Duration = field(default_factory=Duration)
    estimated_time_remaining: Duration = field(default_factory=Duration)
    number_of_recoveries: int = 0
    distance_remaining: float = 0.0


@dataclass(frozen=True, slots=True)
class LyricalFeedback:
    """nav2_msgs/action/NavigateToPose, feedback since Lyrical."""

    current_pose: PoseStamped = field(default_factory=PoseStamped)
    navigation_time: Duration = field(default_factory=Duration)
    estimated_time_remaining: Duration = field(default_factory=Duration)
    number_of_recoveries: int = 0
    distance_remaining: float = 0.0
    position_tracking_error: float = 0.0
    heading_tracking_error: float = 0.0


_WORDS: Final[dict[Release, tuple[type[Any], type[Any]]]] = {
    "humble": (HumbleResult, NavigateFeedback),
    "jazzy": (NavigateResult, NavigateFeedback),
    "lyrical": (NavigateResult, LyricalFeedback),
}


def navigate_to_pose(name: str, release: Release) -> Action[NavigateGoal, Any, Any]:
    """The action by which Nav2 drives to a place, as a release has it."""
    result, feedback = _WORDS[release]
    return Action(name, NavigateGoal, result, feedback, "nav2_msgs/action/NavigateToPose")
