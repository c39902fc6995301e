"""Robots of other people: a class with three methods becomes a robot that plans ways, obeys rules and stops.

::

    class Cart(RobotBase):
        def pose(self) -> Pose2D: ...
        def velocity(self) -> Velocity: ...
        def send(self, velocity: Velocity) -> None: ...
"""

from __future__ import annotations

import asyncio
import threading
from abc import ABC, abstractmethod
from typing import TYPE_CHECKING, Final

from parley.clock import Clock, WallClock
from parley.errors import ActionFailure, FailureCode
from parley.messages.status import Trouble
from parley.robots.base import (
    COMMAND_LIFETIME_S,
    Arm,
    CameraImage,
    DriveLimits,
    LaserScan,
    NavigationControl,
    SeenPerson,
    Sight,
    Velocity,
)
from parley.sentences import sentence
from parley.world.geometry import Pose2D

if TYPE_CHECKING:  # planning is loaded with the first drive
    from parley.gate.fence import Fence
    from parley.robots.navigator import Navigator
    from parley.world.occupancy import OccupancyMap

__all__ = ["RobotBase"]

_LOOK_S: Final = 0.05
"""Wall time between two looks at whether a command has expired, or whether a rule is broken."""
_SLACK_MPS: Final = 0.05
STILL: Final = Velocity()
KEPT_OUT: Final = sentence("A rule does not let me drive on there.")


class RobotBase(ABC):
    """A robot that you tell how to move; implements `parley.robots.base.Robot`.

    You write `pose`, `velocity` and `send`. What it has besides you say by overriding `scan` (lidar), `image`
    (camera), `battery`, `people` and `speak`, and `go` where the robot finds its way by itself. Commands
    expire here after `COMMAND_LIFETIME_S` also while the main loop is blocked. They do not when the process
    dies: the base must come to rest by itself when nobody sends any more.

    Args:
        name: How people call it.
    """

    capabilities: frozenset[str] = frozenset({"drive"})
    """What it has: `drive`, `camera`, `lidar`, `sees_people`, `loudspeaker`, `charges`, `arm`, and words of
    your own that your actions ask for."""
    radius_m: float = 0.25
    """Radius of its footprint."""
    limits: DriveLimits = DriveLimits(max_speed_mps=0.4, max_turn_radps=1.5)
    """How fast it may be driven."""

    def __init__(self, name: str) -> None:
        self.name = name
        self._clock: Clock = WallClock()
        self._map: OccupancyMap | None = None
        self._fence: Fence | None = None
        self._navigator: Navigator | None = None
        self._lock = threading.RLock()
        self._halted = self._driven = False
        self._expires_s = 0.0
        self._watch: threading.Thread | None = None
        self._closed = threading.Event()

    # -- what you write ----------------------------------------------------------------------------------

    @abstractmethod
    def pose(self) -> Pose2D:
        """Where it is, in metres and radians on the map.

        Raises:
            ActionFailure: `hardware`: it does not know.
        """

    @abstractmethod
    def velocity(self) -> Velocity:
        """How fast it moves, measured.

        Raises:
            ActionFailure: `hardware`: it cannot tell.
        """

    @abstractmethod
    def send(self, velocity: Velocity) -> None:
        """Hand a velocity to the base. Any thread may call it; it returns at once.

        Raises:
            ActionFailure: `hardware`: the base cannot be told.
        """

    # -- what you may override ---------------------------------------------------------------------------

    async def go(self, goal: Pose2D, control: NavigationControl, *, timeout_s: float) -> Pose2D:
        """Drive to a place and return where it ended. Override it where the robot finds its way by itself.

        Cancelling it must stop the robot. So must `halt`, `control.paused()` must hold it.

        Raises:
            ActionFailure: `unreachable`, `blocked`, `timed_out`, `hardware`.
        """
        from parley.robots.navigator import Navigator

        if self._map is None:
            raise ActionFailure(FailureCode.UNREACHABLE, sentence("I have no map to find a way on."))
        navigator = Navigator(self, self.limits, self._map, self._clock, control, timeout_s, self._fence)
        self._navigator = navigator
        try:
            return await navigator.drive_to(goal)
        finally:
            self._navigator = None

    def scan(self) -> LaserScan:
        """The newest lidar sweep; here one without beams."""
        import numpy as np

        return LaserScan(0.0, 0.0, np.empty(0, np.float32), 0.0, self._clock.now_s())

    async def image(self) -> CameraImage:
        """Take a picture now; here there is no camera.

        Raises:
            ActionFailure: `not_capable`.
        """
        raise ActionFailure(FailureCode.NOT_CAPABLE, f"{self.name} has no camera.")

    def battery(self) -> float | None:
        """How full it is, 0 to 1; here it cannot tell."""
        return None

    def trouble(self) -> Trouble:
        """What keeps it from moving, which operators are told; here nothing."""
        return ""

    @property
    def sight(self) -> Sight | None:
        """How much its camera takes in. Override it with `look` where it can look aside."""
        return None

    async def look(self, aside_rad: float) -> CameraImage:
        """Take a picture in a direction, counter-clockwise from straight ahead."""
        return await self.image()

    def people(self) -> tuple[SeenPerson, ...]:
        """Whom it sees now and where, the nearest first; here nobody. It goes with `sees_people`."""
        return ()

    @property
    def arm(self) -> Arm | None:
        """What it takes things with; here it has none. It goes with the capability `arm`."""
        return None

    async def speak(self, text: str) -> None:  # noqa: B027 - most robots have none
        """Say something aloud; here there is no loudspeaker. It goes with `loudspeaker`."""

    async def open(self) -> None:  # noqa: B027 - most robots have nothing to wait for
        """Connect to what needs a moment; called once, on the program's loop, before the robot is used.

        Raises:
            UnavailableError: It does not answer.
        """

    @property
    def own_map(self) -> OccupancyMap | None:
        """The map it finds its way by itself with, known once it is open; here none."""
        return None

    # -- what is done for you ----------------------------------------------------------------------------

    def settle(self, occupancy: OccupancyMap | None, clock: Clock, fence: Fence | None) -> None:
        """Learn the map, the time and the rules it drives by; called before it is used.

        Raises:
            MissingExtraError: It finds ways on the map, and what that needs is not installed.
        """
        if occupancy is not None and type(self).go is RobotBase.go:
            from parley.world import grids

            grids.require()
        self._map, self._clock, self._fence = occupancy, clock, fence

    def close(self) -> None:
        """Stand still and command nothing more; the robot can be used again."""
        with self._lock:
            if self._driven:
                self.send(STILL)
            self._driven = False
            watch, self._watch = self._watch, None
        self._closed.set()
        if watch is not None:
            watch.join()
        self._closed.clear()

    @property
    def stopped(self) -> bool:
        """Whether it is held by `halt`."""
        return self._halted

    def planned_path(self) -> tuple[tuple[float, float], ...]:
        """See `Robot.planned_path`."""
        return self._navigator.way_ahead() if self._navigator is not None else ()

    def drive(self, velocity: Velocity) -> None:
        """See `Robot.drive`; what the rules do not let it do is made slower."""
        if self._fence is not None and velocity != STILL:
            velocity = self._fence.limit(self.pose(), self.velocity(), velocity)
        with self._lock:
            if self._halted:
                return
            self._driven = velocity != STILL
            self._expires_s = self._clock.wall_s() + COMMAND_LIFETIME_S
            self.send(velocity)
            if self._driven and self._watch is None:
                self._watch = threading.Thread(target=self._expire, name=f"drive {self.name}", daemon=True)
                self._watch.start()

    def halt(self) -> None:
        """See `Robot.halt`."""
        with self._lock:
            self._halted, self._driven = True, False
            self.send(STILL)

    def release(self) -> None:
        """See `Robot.release`."""
        with self._lock:
            self._halted = False

    async def navigate(self, goal: Pose2D, control: NavigationControl, *, timeout_s: float) -> Pose2D:
        """See `Robot.navigate`: `go`, watched so that no rule is broken on the way."""
        fence = self._fence
        if fence is None or type(self).go is RobotBase.go:  # whose commands all pass the fence
            return await self.go(goal, control, timeout_s=timeout_s)
        if closed := fence.why_closed(goal):
            raise ActionFailure(FailureCode.FORBIDDEN, closed.sentence, {"rule": closed.rule})
        drive = asyncio.ensure_future(self.go(goal, control, timeout_s=timeout_s))
        try:
            while not drive.done():
                await asyncio.wait([drive], timeout=_LOOK_S)
                if not drive.done() and self._breaks(fence):
                    raise ActionFailure(FailureCode.FORBIDDEN, KEPT_OUT)
            return drive.result()
        finally:
            if not drive.done():
                drive.cancel()
                await asyncio.gather(drive, return_exceptions=True)
                self.drive(STILL)

    def _breaks(self, fence: Fence) -> bool:
        """Whether the robot moves in a way that the rules do not allow."""
        now = self.velocity()
        return now.speed_mps - fence.limit(self.pose(), now, now).speed_mps > _SLACK_MPS

    def _expire(self) -> None:
        """Runs in a thread of its own: a blocked loop must not leave the robot driving."""
        while not self._closed.wait(_LOOK_S):
            with self._lock:
                if self._driven and self._clock.wall_s() > self._expires_s:
                    self._driven = False
                    self.send(STILL)
