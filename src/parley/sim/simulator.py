"""The embedded simulator: it steps the physics, moves robot time on, and answers what robots can sense.

Everything but drawing happens on the event loop: a batch of steps costs about a tenth of a millisecond, less
than handing it to a thread and back would. Pictures cost 200 times that and are drawn in one thread of their
own, from a copy. While something blocks the loop the world does not stand still with it: a thread steps it on
at its pace (`keeper`), so that a robot that nobody commands comes to rest. Robot time follows afterwards.
"""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Callable, Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import Any, Self

import mujoco
import numpy as np
import structlog
from numpy.typing import NDArray

from parley.clock import SimClock
from parley.errors import FileFormatError
from parley.sim.build import STEP_S, build_spec, robot_body, thing_body
from parley.sim.camera import Frame, RayCaster, Sighting, sightings
from parley.sim.entries import RobotEntry
from parley.sim.events import Events, WorldEvent
from parley.sim.floor_plan import bounds_m, survey
from parley.sim.keeper import Keeper
from parley.sim.lidar import Sweep, sweep
from parley.sim.people import people_in_sight
from parley.sim.power import Battery, charges
from parley.sim.robot_model import RobotModel
from parley.sim.slipping import slipped
from parley.sim.walks import Walkers
from parley.sim.world_file import WorldChanges, WorldFile
from parley.world.geometry import Pose2D, Velocity, wrap_angle
from parley.world.occupancy import OccupancyMap

__all__ = ["BATCH_S", "Guard", "Photograph", "Simulator"]

log = structlog.get_logger(__name__)

BATCH_S = 0.05
"""Robot time moves on in steps of this length."""
COMMAND_LIFETIME_S = 0.3
"""A robot whose velocity command is not repeated for this long (robot time) stops, as a real base does."""
BRAKING = 5.0
"""A drive that is halted or not commanded brakes with so many times the force that it accelerates with."""

_STEPS = round(BATCH_S / STEP_S)
# After robot time moved on, those who waited for it get this many rounds of the loop before it moves again.
_ROUNDS = 10
# So far behind its pace it makes up for lost time (a held clock, a busy machine); what is more is let go.
_MAX_LAG_S = 0.5
_REST_MPS = 1e-3


STILL = Velocity()

Guard = Callable[[Pose2D, Velocity, Velocity], Velocity]
"""What may become of a command: gets the pose, the measured and the commanded velocity."""


@dataclass(frozen=True, slots=True, eq=False)
class Photograph:
    """What a robot's camera took, and when."""

    frame: Frame
    sightings: tuple[Sighting, ...]
    stamp_s: float


@dataclass(slots=True, eq=False)
class _Base:
    """One robot's drive and senses."""

    entry: RobotEntry
    index: int
    """Joints and actuators of robot i are numbers 3i to 3i + 2."""
    body_id: int
    rng: np.random.Generator
    battery: Battery
    command: Velocity = STILL
    commanded_at_s: float = 0.0
    stopped: bool = False
    guard: Guard | None = None
    last_sweep: Sweep | None = None

    @property
    def lidar_noise_m(self) -> float:
        """Of a range, as it is now."""
        more = self.entry.lidar_noise_m
        return self.entry.model.lidar.noise_m if more is None else more

    @property
    def slots(self) -> slice:
        return slice(3 * self.index, 3 * self.index + 3)


class Simulator:
    """A world in motion while it is open (``async with``); its state can be read before that, too."""

    def __init__(
        self, world: WorldFile, *, clock: SimClock, speed: float | None = 1.0, seed: int = 0
    ) -> None:
        """Set up the world.

        Args:
            world: What there is.
            clock: Robot time, moved on by this simulator alone.
            speed: Robot time per wall time; None: as fast as the machine can.
            seed: For the noise of sensors, slipping wheels and times of events.
        """
        if speed is not None and speed <= 0:
            raise ValueError("speed must be positive, or None for as fast as possible")
        self._clock, self._speed = clock, speed
        self._task: asyncio.Task[None] | None = None
        self._lock = threading.RLock()
        """Held while the model or its data are used: loop and keeper share them."""
        self._ahead_s = 0.0
        """How much further than robot time the keeper has stepped the world."""
        self._keeper: Keeper | None = None
        self._drawing: ThreadPoolExecutor | None = None
        self._artist: RayCaster | None = None
        self._world = world
        self._events = Events(world.events, seed)
        self.on_event: Callable[[WorldEvent], None] = lambda _: None
        """Told of everything that happens in the world by itself."""
        self._walkers = Walkers(seed)
        self._load(world)
        self._bases = {
            entry.name: _Base(
                entry,
                index,
                self._body_id(robot_body(entry.name)),
                np.random.default_rng([seed, index]),
                Battery(entry.model, entry.battery),
            )
            for index, entry in enumerate(world.robots)
        }
        for base in self._bases.values():
            self._data.qpos[base.slots] = base.entry.pose

    @property
    def clock(self) -> SimClock:
        """Robot time."""
        return self._clock

    @property
    def world(self) -> WorldFile:
        """The world as it is now, except where its robots are."""
        return self._world

    async def __aenter__(self) -> Self:
        self._drawing = ThreadPoolExecutor(max_workers=1, thread_name_prefix="sim-camera")
        self._task = asyncio.create_task(self._run(), name="simulator")
        if self._speed is not None:  # at its own pace nobody can say when it is late
            pace = BATCH_S / self._speed
            self._keeper = Keeper(self._clock, pace, self._moving, self._step_alone)
            self._keeper.open()
        return self

    async def __aexit__(self, *exc: object) -> None:
        assert self._task is not None and self._drawing is not None
        if self._keeper is not None:
            await self._keeper.close()
        task, self._task = self._task, None
        task.cancel()
        try:
            await task
        except asyncio.CancelledError:
            if not task.cancelled():
                raise
        finally:
            drawing, self._drawing = self._drawing, None
            await asyncio.to_thread(drawing.shutdown, cancel_futures=True)

    # -- robots ---------------------------------------------------------------------------------------

    def model(self, robot: str) -> RobotModel:
        """What the robot is made of."""
        return self._bases[robot].entry.model

    def pose(self, robot: str) -> Pose2D:
        """Where the robot is."""
        with self._lock:
            x, y, yaw = self._data.qpos[self._bases[robot].slots]
        return Pose2D(float(x), float(y), wrap_angle(float(yaw)))

    def velocity(self, robot: str) -> Velocity:
        """As it is measured."""
        slots = self._bases[robot].slots
        with self._lock:
            east, north, turn = self._data.qvel[slots]
            yaw = self._data.qpos[slots][2]
        cos, sin = np.cos(yaw), np.sin(yaw)
        return Velocity(float(cos * east + sin * north), float(turn), float(cos * north - sin * east))

    def command(self, robot: str, velocity: Velocity) -> None:
        """Drive at this velocity, limited to what the robot can, for at most `COMMAND_LIFETIME_S`."""
        base = self._bases[robot]
        limits = base.entry.model
        base.command = Velocity(
            float(np.clip(velocity.linear_mps, -limits.max_speed_mps, limits.max_speed_mps)),
            float(np.clip(velocity.angular_radps, -limits.max_turn_radps, limits.max_turn_radps)),
            float(np.clip(velocity.lateral_mps, -limits.max_lateral_mps, limits.max_lateral_mps)),
        )
        base.commanded_at_s = self._clock.now_s() + self._ahead_s
        self._wake()

    def commanded(self, robot: str) -> Velocity:
        """How the robot's drive is told to move now."""
        base = self._bases[robot]
        return STILL if base.stopped else base.command

    def set_stopped(self, robot: str, stopped: bool) -> None:
        """Hold the robot's drive at zero, whatever is commanded, until it is let go again."""
        base = self._bases[robot]
        base.stopped = stopped
        base.command = STILL
        if not stopped:
            self._wake()

    def set_guard(self, robot: str, guard: Guard) -> None:
        """Let `guard` have the last word on every command, at each step of the world, whoever commands."""
        self._bases[robot].guard = guard

    def stopped(self, robot: str) -> bool:
        """Whether the robot's drive is held."""
        return self._bases[robot].stopped

    def scan(self, robot: str) -> Sweep:
        """The lidar's newest sweep; one per moment of robot time."""
        base, now_s = self._bases[robot], self._clock.now_s()
        if base.last_sweep is None or base.last_sweep.stamp_s != now_s:
            with self._lock:
                mujoco.mj_kinematics(self._model, self._data)
                base.last_sweep = sweep(
                    self._model,
                    self._data,
                    base.body_id,
                    self.pose(robot),
                    base.entry.model.lidar,
                    base.lidar_noise_m,
                    base.rng,
                    now_s,
                )
        return base.last_sweep

    def camera_works(self, robot: str) -> bool:
        """Whether the robot's camera gives pictures."""
        return self._bases[robot].entry.camera == "working"

    def knows_where(self, robot: str) -> bool:
        """Whether the robot can tell where it is."""
        return self._bases[robot].entry.localisation == "working"

    def battery(self, robot: str) -> Battery:
        """The robot's battery."""
        return self._bases[robot].battery

    def people(self, robot: str) -> tuple[tuple[str, float, float], ...]:
        """Which people the robot's camera sees and where, nearest first; none where it gives no pictures."""
        base = self._bases[robot]
        camera = base.entry.model.camera
        if camera is None or not self.camera_works(robot):
            return ()
        with self._lock:
            mujoco.mj_kinematics(self._model, self._data)
            return people_in_sight(
                self._world, self._model, self._data, self._names, base.body_id, self.pose(robot), camera
            )

    async def photograph(self, robot: str, aside_rad: float = 0.0) -> Photograph:
        """Take a picture of this moment with a robot's camera, turned aside as far as it can be.

        Raises:
            RuntimeError: The simulator is not open, or the camera is missing or broken.
        """
        base = self._bases[robot]
        camera = base.entry.model.camera
        if camera is None or not self.camera_works(robot):
            raise RuntimeError(f"{robot} has no working camera")
        aside = max(-camera.aside_rad, min(camera.aside_rad, aside_rad))
        # Taken now, with the model: the world may change before the picture is drawn.
        stamp_s, names, body_id = self._clock.now_s(), self._names, base.body_id
        frame = await self._draw(
            lambda artist, qpos: artist.photograph(qpos, body_id, _turned(qpos[base.slots], aside), camera)
        )
        return Photograph(frame, sightings(frame, names), stamp_s)

    # -- the world ------------------------------------------------------------------------------------

    def change(self, changes: WorldChanges | Mapping[str, Any]) -> None:
        """Change the world now: remove, add and move things, put robots elsewhere, let faults come or go.

        Raises:
            FileFormatError: A change is malformed or names something that is not there.
        """
        if not isinstance(changes, WorldChanges):
            changes = WorldChanges.parse(changes)
        with self._lock:
            self.become(self._world.with_changes(changes))
            for base in self._bases.values():
                told = changes.robots.get(base.entry.name)
                if told is not None and told.battery is not None:
                    base.battery.charge = told.battery
                if base.entry.name in changes.move:
                    self._data.qpos[base.slots] = changes.move[base.entry.name]
                    self._data.qvel[base.slots] = 0.0

    def become(self, world: WorldFile) -> None:
        """Take over another state of this world, with the same robots, which stay where they are."""
        with self._lock:
            qpos, qvel, ctrl = self._data.qpos.copy(), self._data.qvel.copy(), self._data.ctrl.copy()
            self._load(world)
            self._world = world
            self._data.qpos[:], self._data.qvel[:], self._data.ctrl[:] = qpos, qvel, ctrl
            for base in self._bases.values():
                base.body_id = self._body_id(robot_body(base.entry.name))
                base.last_sweep = None
                base.entry = world.robot(base.entry.name)

    def occupancy(self, robot: str, resolution_m: float = 0.05) -> OccupancyMap:
        """The map that a perfect survey of the world as it is now would give this robot."""
        return survey(self._world, self.model(robot).height_m, resolution_m)

    async def top_down(self, width_px: int = 900) -> NDArray[np.uint8]:
        """The whole world from above, north up; shape (height, width, 3).

        Raises:
            RuntimeError: The simulator is not open.
        """
        bounds = bounds_m(self._world)
        return (await self._draw(lambda artist, qpos: artist.map_view(qpos, bounds, width_px))).rgb

    # -- inside ---------------------------------------------------------------------------------------

    def _load(self, world: WorldFile) -> None:
        self._model = build_spec(world).compile()
        self._data = mujoco.MjData(self._model)
        self._forces = self._model.actuator_forcerange.copy()
        self._walkers.enter(world, self._model, self._data)
        self._names = {
            self._body_id(thing_body(thing.name)): (thing.name, thing.label or thing.words)
            for thing in world.standing()
        } | {
            self._body_id(robot_body(robot.name)): (robot.name, f"robot {robot.name}")
            for robot in world.robots
        }

    def _body_id(self, name: str) -> int:
        return int(self._model.body(name).id)

    async def _draw(self, work: Callable[[RayCaster, NDArray[np.float64]], Frame]) -> Frame:
        if self._drawing is None:
            raise RuntimeError("the simulator is not open")
        with self._lock:
            model, qpos, people = self._model, self._data.qpos.copy(), self._walkers.poses_of(self._data)

        def draw() -> Frame:
            if self._artist is None or self._artist.model is not model:
                self._artist = RayCaster(model)
            self._artist.people = people
            return work(self._artist, qpos)

        return await asyncio.get_running_loop().run_in_executor(self._drawing, draw)

    async def _run(self) -> None:
        """Step the world for as long as it is open."""
        due_s = self._clock.wall_s()
        try:
            while True:
                if self._catch_up():
                    due_s = self._clock.wall_s()
                if not self._wanted():
                    idle = not self._clock.held
                    self._clock.wanted.clear()
                    await self._clock.wanted.wait()
                    if idle:
                        due_s = self._clock.wall_s()
                    continue
                self._step()
                for _ in range(_ROUNDS):
                    await asyncio.sleep(0)
                if self._speed is not None:
                    now_s = self._clock.wall_s()
                    due_s = max(due_s + BATCH_S / self._speed, now_s - _MAX_LAG_S)
                    if due_s > now_s:
                        await asyncio.sleep(due_s - now_s)
        except mujoco.FatalError as error:
            log.error("simulator_died", error=str(error))
            raise

    def _wanted(self) -> bool:
        """Whether robot time should move: not while it is held.

        At a pace of its own it moves on even if nothing else does, as people's time does; as fast as the
        machine can, only while something moves, somebody waits, or something is to happen at its time.
        """
        if self._clock.held:
            return False
        idle = self._speed is None and not self._events.timed
        return not idle or self._busy()

    def _busy(self) -> bool:
        """Whether anybody waits or anything moves."""
        return self._clock.has_sleepers or self._moving()

    def _moving(self) -> bool:
        if any(base.command != STILL and not base.stopped for base in self._bases.values()):
            return True
        with self._lock:
            return bool(np.abs(self._data.qvel).max() > _REST_MPS)

    def _step(self) -> None:
        self._use_batteries(self._busy())
        robots = [(self.pose(name), base.entry.model.radius_m) for name, base in self._bases.items()]
        with self._lock:
            self._world = self._walkers.pass_time(BATCH_S, robots, self._world, self._data)
        self._step_world(self._clock.now_s())
        self._clock.advance(BATCH_S)
        self._happen()

    def _use_batteries(self, works: bool) -> None:
        for name, base in self._bases.items():
            rests = self.commanded(name) == STILL
            charged = rests and charges(self._world, base.entry.model, self.pose(name))
            base.battery.pass_time(BATCH_S, works=works, charged=charged)

    def _happen(self) -> None:
        """Let happen what is due."""
        poses = {name: self.pose(name) for name in self._bases} if self._events.events else {}
        for event in self._events.due(self._clock.now_s(), poses, self._place_of):
            try:
                self.change(event.change)
            except FileFormatError as error:  # a person took away before what it is about
                log.warning("world_event_impossible", name=event.name, error=str(error))
                continue
            log.info("world_event", name=event.name)
            self.on_event(event)

    def _place_of(self, thing: str) -> Pose2D | None:
        there = (one for one in self._world.standing() if one.name == thing)
        return next((self._world.base_of(one) for one in there), None)

    def _step_world(self, now_s: float) -> None:
        with self._lock:
            for base in self._bases.values():
                # A thread may command or halt meanwhile, so each is looked at once.
                expired = now_s - base.commanded_at_s >= COMMAND_LIFETIME_S - 1e-9
                if expired:
                    base.command = STILL
                brakes = expired or base.stopped
                told = STILL if brakes else slipped(self._guarded(base), base.entry, base.rng)
                self._data.ctrl[base.slots] = told.linear_mps, told.lateral_mps, told.angular_radps
                self._model.actuator_forcerange[base.slots] = self._forces[base.slots] * (
                    BRAKING if brakes else 1.0
                )
            mujoco.mj_step(self._model, self._data, _STEPS)

    def _step_alone(self) -> None:
        """Step while the loop is blocked; in the keeper's thread."""
        with self._lock:
            self._step_world(self._clock.now_s() + self._ahead_s)
            self._ahead_s += BATCH_S
        self._wake()

    def _catch_up(self) -> bool:
        """Let robot time follow what was stepped while the loop was blocked; whether there was anything."""
        with self._lock:
            ahead_s, self._ahead_s = self._ahead_s, 0.0
            if ahead_s:
                self._clock.advance(ahead_s)
        return ahead_s > 0

    def _wake(self) -> None:
        """Look whether the world has to move; from any thread."""
        task = self._task
        if task is None or task.done():
            return
        loop = task.get_loop()
        try:
            asyncio.get_running_loop()
        except RuntimeError:  # not the loop's thread
            loop.call_soon_threadsafe(self._clock.wanted.set)
        else:
            self._clock.wanted.set()

    def _guarded(self, base: _Base) -> Velocity:
        if base.guard is None or base.command == STILL:
            return base.command
        name = base.entry.name
        return base.guard(self.pose(name), self.velocity(name), base.command)


def _turned(joints: NDArray[np.float64], aside_rad: float) -> Pose2D:
    return Pose2D(float(joints[0]), float(joints[1]), wrap_angle(float(joints[2]) + aside_rad))
