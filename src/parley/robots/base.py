"""What an action can ask of a robot, whatever stands behind it (design section 7).

Frames follow REP 103 and 105: x forward, y left, metres and radians; poses are in the `map` frame.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final, Literal, Protocol

from parley.messages.status import Trouble
from parley.world.geometry import Pose2D, Velocity

if TYPE_CHECKING:  # who only writes a robot class need not load it
    import numpy as np
    from numpy.typing import NDArray

__all__ = [
    "COMMAND_LIFETIME_S",
    "Arm",
    "CameraImage",
    "Detection",
    "DriveLimits",
    "LaserScan",
    "NavigationControl",
    "Robot",
    "SeenPerson",
    "Sight",
    "Velocity",
]

COMMAND_LIFETIME_S: Final = 0.3
"""For so long a velocity command counts; a robot that gets no further one comes to rest by itself."""


@dataclass(frozen=True, slots=True)
class DriveLimits:
    """What the drive can do, and what the robot keeps from obstacles."""

    __pydantic_config__ = {"extra": "forbid"}  # noqa: RUF012 - for files

    max_speed_mps: float
    max_turn_radps: float
    max_acceleration_mps2: float = 0.5
    max_turn_acceleration_radps2: float = 3.0
    max_lateral_mps: float = 0.0
    """Sideways; 0: a base that must turn to go there."""
    keep_out_m: float = 0.0
    """Distance that the robot's centre keeps from everything the lidar sees."""


@dataclass(frozen=True, slots=True)
class LaserScan:
    """One sweep of the lidar; invalid or out-of-range beams are `inf`."""

    angle_min_rad: float
    angle_increment_rad: float
    ranges_m: NDArray[np.float32]
    range_max_m: float
    stamp_s: float


@dataclass(frozen=True, slots=True)
class Detection:
    """Something that the robot's detector recognised in a picture."""

    label: str
    """What it is, in words, e.g. the description in the world."""
    pixels: int
    """How much of the picture it covers."""
    box: tuple[int, int, int, int]
    """left, top, right, bottom in pixels (right and bottom exclusive)."""
    distance_m: float | None = None
    """Median distance, where the camera knows depth."""
    x_m: float | None = None
    y_m: float | None = None
    """The middle of what is seen of it, in the map frame, where the camera knows depth."""
    span_m: tuple[float, float] = (0.0, 0.0)
    """How far that reaches along the map's x and y."""
    confidence: float | None = None
    """How sure the detector is, 0 to 1; None: it does not say."""


@dataclass(frozen=True, slots=True)
class CameraImage:
    """One picture, with what the robot's own detector saw in it (None: it has no detector)."""

    width: int
    height: int
    encoding: Literal["rgb8"]
    data: NDArray[np.uint8]
    """Shape (height, width, 3)."""
    stamp_s: float
    detections: tuple[Detection, ...] | None = None


@dataclass(frozen=True, slots=True)
class Sight:
    """How much of what is around a robot its camera takes in."""

    fov_rad: float
    """Horizontal opening angle of one picture."""
    aside_rad: float = 0.0
    """How far to either side pictures can be taken without driving: a head that turns, or more cameras."""


@dataclass(frozen=True, slots=True)
class SeenPerson:
    """Somebody whom a robot sees."""

    name: str
    """Who it is, as far as the robot can tell; else any words for a person."""
    x_m: float
    y_m: float
    """Where, in the map frame."""


@dataclass(frozen=True, slots=True)
class NavigationControl:
    """How the caller watches and holds a drive."""

    on_progress: Callable[[float], None]
    """Gets the remaining distance in metres, a few times a second."""
    paused: Callable[[], bool]
    """While true the robot stands still and waits."""
    waits: Callable[[str], None] = lambda _: None
    """Gets for what it stands and waits, as people read it, whenever that changes; empty: it goes on."""


class Arm(Protocol):
    """What a robot takes things with."""

    @property
    def holds(self) -> str:
        """What is in the hand, in words; empty: nothing."""
        ...

    async def pick_up(self, thing: Detection) -> None:
        """Take something that was just seen.

        Raises:
            ActionFailure: `unreachable`, `not_capable` (too large, the hand is full), `hardware`.
        """
        ...

    async def put_down(self, x_m: float, y_m: float) -> None:
        """Put what is in the hand onto what stands there, in the map frame; on the floor if nothing does.

        Raises:
            ActionFailure: `unreachable`, `not_capable` (the hand is empty), `hardware`.
        """
        ...


class Robot(Protocol):
    """One robot."""

    name: str

    @property
    def capabilities(self) -> frozenset[str]:
        """What it has: `drive`, `camera`, `lidar`, `sees_people`, `loudspeaker`, `charges`, `arm`, ..."""
        ...

    @property
    def radius_m(self) -> float:
        """Radius of its footprint."""
        ...

    def pose(self) -> Pose2D:
        """Where it believes it is, in the map frame.

        Raises:
            ActionFailure: `hardware`: it does not know.
        """
        ...

    def velocity(self) -> Velocity:
        """Measured, not commanded."""
        ...

    def scan(self) -> LaserScan:
        """The newest lidar sweep."""
        ...

    def planned_path(self) -> tuple[tuple[float, float], ...]:
        """What is left of the way of a running `navigate`, map-frame x and y; else empty."""
        ...

    def battery(self) -> float | None:
        """How full it is, 0 to 1; None if the robot cannot tell."""
        ...

    def trouble(self) -> Trouble:
        """What keeps it from moving, as far as it can tell."""
        ...

    async def image(self) -> CameraImage:
        """Take a picture now.

        Raises:
            ActionFailure: `hardware` if the camera gives none, `not_capable` if there is no camera.
        """
        ...

    @property
    def sight(self) -> Sight | None:
        """How much its camera takes in; None: it does not say, or has none."""
        ...

    async def look(self, aside_rad: float) -> CameraImage:
        """Take a picture in a direction, counter-clockwise from straight ahead, as far as `sight` reaches.

        Raises:
            ActionFailure: See `image`.
        """
        ...

    def people(self) -> tuple[SeenPerson, ...]:
        """Whom it sees now, the nearest first; nobody without `sees_people`."""
        ...

    @property
    def arm(self) -> Arm | None:
        """What it takes things with; None without `arm`."""
        ...

    async def speak(self, text: str) -> None:
        """Say something aloud and return when it is said; without `loudspeaker` nothing is heard.

        Raises:
            ActionFailure: `hardware`.
        """
        ...

    async def navigate(self, goal: Pose2D, control: NavigationControl, *, timeout_s: float) -> Pose2D:
        """Drive to `goal` and return where it ended; cancelling stops the robot.

        Raises:
            ActionFailure: `unreachable` (no way on the map), `blocked` (something unexpected in the way),
                `timed_out` (robot time), `hardware`.
        """
        ...

    def drive(self, velocity: Velocity) -> None:
        """Command a velocity; thread-safe, returns at once.

        It is a duty of the robot itself, below whatever commands it, that a command expires after
        `COMMAND_LIFETIME_S`: a blocked loop or a dead process must not leave a robot driving. Where the base
        does not do that of its own accord, a watchdog beside it does.
        """
        ...

    def halt(self) -> None:
        """Come to rest now and refuse every command until `release`; thread-safe, returns at once.

        To a running `navigate` it is no more than standing still: after `release` it goes on, unless it was
        cancelled meanwhile. Halting a robot that is halted is allowed.

        Raises:
            ActionFailure: `hardware` if the drive cannot be told.
        """
        ...

    def release(self) -> None:
        """Take commands again after `halt`; moves nothing. Thread-safe, returns at once.

        Raises:
            ActionFailure: `hardware` if the drive cannot be told.
        """
        ...
