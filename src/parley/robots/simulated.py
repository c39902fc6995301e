"""A robot of the embedded simulator."""

from __future__ import annotations

from types import TracebackType
from typing import Self

from parley.clock import SimClock
from parley.errors import ActionFailure, FailureCode
from parley.gate.book import RuleBook
from parley.gate.fence import Fence
from parley.gate.judge import RobotFacts
from parley.messages.status import Trouble
from parley.robots.base import (
    Arm,
    CameraImage,
    Detection,
    DriveLimits,
    LaserScan,
    NavigationControl,
    SeenPerson,
    Sight,
    Velocity,
)
from parley.robots.navigator import Navigator
from parley.robots.simulated_arm import SimulatedArm
from parley.sentences import sentence
from parley.sim.simulator import Simulator
from parley.sim.starts import started
from parley.sim.world_file import WorldFile
from parley.world.geometry import Pose2D
from parley.world.occupancy import OccupancyMap

__all__ = ["SimulatedFleet", "SimulatedRobot"]


class SimulatedRobot:
    """Drives one robot of a `Simulator`; implements `parley.robots.base.Robot`."""

    def __init__(
        self, simulator: Simulator, name: str, occupancy: OccupancyMap, fence: Fence | None = None
    ) -> None:
        """Take hold of a robot.

        Args:
            simulator: The world it is in.
            name: Its name in the world file.
            occupancy: The map it plans on.
            fence: Where it must not go and how fast it may be, whoever commands it.
        """
        self.name = name
        self._simulator, self._map = simulator, occupancy
        self._model = simulator.model(name)
        self._navigator: Navigator | None = None
        self._fence = fence
        self._arm = SimulatedArm(simulator, name) if self._model.arm_reach_m else None
        if fence is not None:
            simulator.set_guard(name, fence.limit)

    @property
    def capabilities(self) -> frozenset[str]:
        """See `Robot.capabilities`."""
        has = {"drive", "lidar"} | ({"camera", "sees_people"} if self._model.camera else set())
        has |= {"arm"} if self._arm is not None else set()
        docks = any(thing.charges for thing in self._simulator.world.things)
        return frozenset(has | ({"charges"} if docks and self.battery() is not None else set()))

    @property
    def radius_m(self) -> float:
        """See `Robot.radius_m`."""
        return self._model.radius_m

    @property
    def stopped(self) -> bool:
        """Whether it is held by `halt`."""
        return self._simulator.stopped(self.name)

    def pose(self) -> Pose2D:
        """See `Robot.pose`.

        Raises:
            ActionFailure: `hardware`: it does not know.
        """
        if not self._simulator.knows_where(self.name):
            raise ActionFailure(FailureCode.HARDWARE, sentence("I do not know where I am."))
        return self._simulator.pose(self.name)

    def velocity(self) -> Velocity:
        """See `Robot.velocity`."""
        return self._simulator.velocity(self.name)

    def scan(self) -> LaserScan:
        """See `Robot.scan`."""
        sweep = self._simulator.scan(self.name)
        return LaserScan(0.0, sweep.increment_rad, sweep.ranges_m, sweep.range_max_m, sweep.stamp_s)

    def planned_path(self) -> tuple[tuple[float, float], ...]:
        """See `Robot.planned_path`."""
        return self._navigator.way_ahead() if self._navigator is not None else ()

    def battery(self) -> float | None:
        """See `Robot.battery`."""
        return self._simulator.battery(self.name).told

    def trouble(self) -> Trouble:
        """See `Robot.trouble`."""
        return ""

    def drive(self, velocity: Velocity) -> None:
        """See `Robot.drive`; does nothing while halted.

        Raises:
            ActionFailure: `hardware`: the battery is empty.
        """
        if velocity != Velocity() and self._simulator.battery(self.name).is_empty:
            raise ActionFailure(FailureCode.HARDWARE, sentence("My battery is empty, so I cannot drive."))
        self._simulator.command(self.name, velocity)

    @property
    def sight(self) -> Sight | None:
        """See `Robot.sight`."""
        camera = self._model.camera
        return Sight(camera.fov_rad, camera.aside_rad) if camera is not None else None

    async def image(self) -> CameraImage:
        """See `Robot.image`."""
        return await self.look(0.0)

    async def look(self, aside_rad: float) -> CameraImage:
        """See `Robot.look`."""
        if self._model.camera is None:
            raise ActionFailure(FailureCode.NOT_CAPABLE, f"{self.name} has no camera.")
        if not self._simulator.camera_works(self.name):
            raise ActionFailure(FailureCode.HARDWARE, "My camera gives no picture.")
        with self._simulator.clock.hold():
            photograph = await self._simulator.photograph(self.name, aside_rad)
        height, width, _ = photograph.frame.rgb.shape
        return CameraImage(
            width,
            height,
            "rgb8",
            photograph.frame.rgb,
            photograph.stamp_s,
            tuple(
                Detection(s.label, s.pixels, s.box, s.distance_m, s.x_m, s.y_m, s.span_m, s.confidence)
                for s in photograph.sightings
            ),
        )

    def people(self) -> tuple[SeenPerson, ...]:
        """See `Robot.people`."""
        return tuple(SeenPerson(name, x, y) for name, x, y in self._simulator.people(self.name))

    @property
    def arm(self) -> Arm | None:
        """See `Robot.arm`."""
        return self._arm

    async def speak(self, text: str) -> None:
        """See `Robot.speak`: it has no loudspeaker."""

    async def navigate(self, goal: Pose2D, control: NavigationControl, *, timeout_s: float) -> Pose2D:
        """See `Robot.navigate`; time while it is paused or stopped does not count against `timeout_s`."""
        if self._navigator is not None:
            raise ActionFailure(FailureCode.INTERNAL, f"{self.name} is driving somewhere else already.")
        model = self._model
        limits = DriveLimits(
            model.max_speed_mps,
            model.max_turn_radps,
            model.max_acceleration_mps2,
            model.max_turn_acceleration_radps2,
            model.max_lateral_mps,
            Navigator.keep_out_m(model.radius_m),
        )
        self._navigator = Navigator(
            self, limits, self._map, self._simulator.clock, control, timeout_s, self._fence
        )
        try:
            return await self._navigator.drive_to(goal)
        finally:
            self._navigator = None

    def halt(self) -> None:
        """See `Robot.halt`."""
        self._simulator.set_stopped(self.name, True)

    def release(self) -> None:
        """See `Robot.release`."""
        self._simulator.set_stopped(self.name, False)


class SimulatedFleet:
    """The robots of a simulated world; implements `parley.robots.fleet.Fleet`.

    Args:
        world: What there is.
        speed: Robot time per wall time; None: as fast as the machine can.
        seed: For the noise of sensors and times of events; not 0: for where robots begin, too.
        occupancy: The map they drive by; None: surveyed from the world as it is.
    """

    def __init__(
        self,
        world: WorldFile,
        *,
        speed: float | None = 1.0,
        seed: int = 0,
        occupancy: OccupancyMap | None = None,
    ) -> None:
        self.clock = SimClock()
        self.simulator = Simulator(started(world, seed), clock=self.clock, speed=speed, seed=seed)
        self._given = occupancy
        self._surveyed: dict[str, OccupancyMap] = {}

    async def __aenter__(self) -> Self:
        await self.simulator.__aenter__()
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        await self.simulator.__aexit__(kind, error, trace)

    @property
    def names(self) -> tuple[str, ...]:
        """See `Fleet.names`."""
        return tuple(robot.name for robot in self.simulator.world.robots)

    def occupancy(self, robot: str) -> OccupancyMap:
        """See `Fleet.occupancy`."""
        if self._given is not None:
            return self._given
        if robot not in self._surveyed:
            self._surveyed[robot] = self.simulator.occupancy(robot)
        return self._surveyed[robot]

    def facts(self, robot: str) -> RobotFacts:
        """See `Fleet.facts`."""
        model = self.simulator.model(robot)
        return RobotFacts(self.occupancy(robot).name, model.radius_m, model.max_speed_mps)

    def robot(self, name: str, rules: RuleBook) -> SimulatedRobot:
        """See `Fleet.robot`."""
        fence = Fence(rules, name, braking_mps2=self.simulator.model(name).max_acceleration_mps2)
        return SimulatedRobot(self.simulator, name, self.occupancy(name), fence)
