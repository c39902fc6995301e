"""A robot that finds its way by itself, asked over a transport: what Nav2 and move_base have in common.

Goals that nobody watches any more are called off, and it stands until that is certain.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Coroutine
from contextlib import suppress
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Final, Literal, Protocol, TypeVar

import structlog

from parley.errors import (
    ActionFailure,
    FailureCode,
    GoalRefusedError,
    TransportError,
    TransportTimeoutError,
    TypeMismatchError,
    UnavailableError,
)
from parley.extras import needs
from parley.gate.fence import Fence
from parley.messages.actions import GoalState
from parley.messages.ros_robot import Bool, PoseStamped, Twist, TwistStamped, Vector3
from parley.messages.status import Trouble
from parley.robots.base import CameraImage, DriveLimits, LaserScan, NavigationControl, Velocity
from parley.robots.link import Link
from parley.robots.own import RobotBase
from parley.robots.ros_senses import SILENT, RosTopics, Senses, velocities_heard, velocities_taken
from parley.robots.ros_values import header, stamped
from parley.sentences import sentence
from parley.transport.base import Outcome, Publisher, SentGoal, Transport, absolute
from parley.world.geometry import Pose2D

if TYPE_CHECKING:
    from parley.world.occupancy import OccupancyMap

__all__ = ["Connect", "Goals", "RosRobot", "RosSetup"]

HOLD_S: Final = 0.1
"""Between two words to the robot on whether it must stand."""
LOST_S: Final = 1.0
"""A base that is not heard for so long does not answer."""
LOOP_S: Final = 0.5
"""A program whose loop stands for so long does not watch its robot."""
ASKING_S: Final = 2.0
READY_S: Final = 10.0
BACK_S: Final = 30.0
"""So long it may take until all hear each other again, once this program or a link was away: who looks for
others does so every 8 s at last, and 15 s were seen. The robot stands meanwhile."""
SEEN_S: Final = 1.0
"""After this it is seen whether somebody tells a map."""
MAP_S: Final = 3.0
"""A map that somebody tells is waited for so long; without it a robot drives by that of its place."""
_ENDING_S: Final = 3.0
_LOOK_S: Final = 0.02
_LONG_S: Final = 3600.0
MISSET: Final = "all that listen there must take the same, Twist or TwistStamped; see parley doctor --robot"

PRESSED: Final = sentence("The emergency stop on me is pressed.")
UNLIKE: Final = sentence("My base is set up wrongly.")
LATE: Final = sentence("I did not get there in time.")
NO_WAY: Final = sentence("I know no way to there.")

T = TypeVar("T")

log = structlog.get_logger(__name__)


class Goals(Protocol):
    """How a robot is asked to drive to places. Used on its link."""

    async def open(self, transport: Transport) -> None:
        """Begin to hear of goals."""

    async def send(
        self, target: PoseStamped, on_remaining: Callable[[float], None], *, timeout_s: float
    ) -> SentGoal[Any]:
        """Ask for a place; see `ActionClient.send`. `on_remaining` gets metres."""
        ...

    async def call_off(self, *, timeout_s: float) -> bool:
        """Call off all goals, whosever; whether none was left.

        Raises:
            UnavailableError: Nobody drives to goals there, or is not seen yet.
            TransportError: It is not known.
        """
        ...

    def failure(self, outcome: Outcome[Any], *, moved: bool) -> ActionFailure:
        """Why a drive ended without arriving.

        Args:
            outcome: What was told.
            moved: Whether the robot came away from where it began.
        """
        ...


SLOW_DRIVE: Final = DriveLimits(max_speed_mps=0.4, max_turn_radps=1.5)

Connect = str | Callable[[], Transport]
"""The address of a rosbridge, `ws://...`; or what makes another transport, opened in a thread of its own."""


@dataclass(frozen=True, slots=True)
class RosSetup:
    """What a robot is like; the names are the usual ones."""

    action: str
    """By which it drives to a place."""
    topics: RosTopics = field(default_factory=RosTopics)
    radius_m: float = 0.25
    limits: DriveLimits = SLOW_DRIVE

    @property
    def goals(self) -> str:
        """The name of the action, where the robot has it."""
        return self.topics.name(self.action)


class RosRobot(RobotBase):
    """See the module.

    Args:
        name: How people call it.
        connect: Where it is.
        goals: How it is asked to drive.
        setup: What it is like.
        ros: The version of ROS behind a rosbridge.
    """

    def __init__(
        self, name: str, connect: Connect, goals: Goals, setup: RosSetup, *, ros: Literal[1, 2] = 2
    ) -> None:
        super().__init__(name)
        topics = setup.topics
        self._connect = connect if callable(connect) else lambda: _bridge(connect, ros)
        self._goals, self._names = goals, topics
        self.radius_m, self.limits = setup.radius_m, setup.limits
        self.capabilities = frozenset({"drive"} | topics.capabilities)
        self._senses = Senses(topics, lambda: self._clock.now_s(), lambda: self._clock.wall_s())
        self._link: Link | None = None
        self._transport: Transport | None = None
        self._keeping: asyncio.Future[Any] | None = None
        self._beating: asyncio.Task[None] | None = None
        self._cmd_vel: tuple[type[Any], Publisher[Any]] | None = None
        self._refused = ""
        """Why its base gets no velocities, for engineers."""
        self._beat_s = 0.0
        self._paused = False
        self._sending: asyncio.Future[Any] | None = None
        """A goal that the robot was asked for, until it said whether it takes it."""
        self._unwatched = True
        """Whether it may be driving to a goal that nobody watches."""

    # -- what robots have --------------------------------------------------------------------------------

    @property
    def own_map(self) -> OccupancyMap | None:
        """See `RobotBase.own_map`: the one it drives by."""
        return self._senses.occupancy

    def trouble(self) -> Trouble:
        """See `Robot.trouble`."""
        if not self._senses.fresh(LOST_S):
            return "silent"
        if self._senses.emergency:
            return "pressed"
        return "misset" if self._refused else ""

    def pose(self) -> Pose2D:
        """See `Robot.pose`."""
        return self._senses.pose(LOST_S)

    def velocity(self) -> Velocity:
        """See `Robot.velocity`."""
        return self._senses.velocity(LOST_S)

    def scan(self) -> LaserScan:
        """See `Robot.scan`."""
        return self._senses.scan()

    async def image(self) -> CameraImage:
        """See `Robot.image`."""
        if self._transport is None:
            raise ActionFailure(FailureCode.HARDWARE, SILENT)
        return await self._there(self._senses.picture(self._transport))

    def send(self, velocity: Velocity) -> None:
        """See `RobotBase.send`."""
        if self._link is not None and self._transport is not None:
            self._link.post(lambda: self._drive_at(velocity))

    def _drive_at(self, velocity: Velocity) -> None:
        """On the link: hand a velocity to the base, of the type that it takes."""
        if self._transport is None:
            return
        self._open_velocities(self._transport)
        if self._cmd_vel is None:
            return
        twist = Twist(Vector3(velocity.linear_mps), Vector3(z=velocity.angular_radps))
        stamped = self._cmd_vel[0] is TwistStamped
        top = header(self._names.base_frame, self._clock.unix_ms())
        self._cmd_vel[1].publish(TwistStamped(top, twist) if stamped else twist)

    def _open_velocities(self, transport: Transport) -> None:
        kind = velocities_taken(self._names, transport.endpoints())
        if self._cmd_vel is None or self._cmd_vel[0] is not kind:
            if self._cmd_vel is not None:
                self._cmd_vel[1].close()
            self._cmd_vel = None
            try:
                topic = self._names.topic(self._names.cmd_vel, kind)
                self._cmd_vel = kind, transport.publisher(topic)
            except TypeMismatchError as error:
                self._refuse(str(error))
                return
            self._refused = ""

    def _look(self) -> None:
        """On the link: whether who listens for velocities agrees on their type."""
        if self._transport is not None and self._velocities_heard(self._transport) > 1:
            self._refuse(f"both kinds are listened for on {self._names.name(self._names.cmd_vel)}")
        else:
            self._refused = ""

    def _velocities_heard(self, transport: Transport) -> int:
        """For how many kinds of velocities somebody listens."""
        return len(velocities_heard(self._names, transport.endpoints()))

    def _refuse(self, why: str) -> None:
        """Say once why the base gets no velocities."""
        if why != self._refused:
            log.error("the base gets no velocities", robot=self.name, why=why, remedy=MISSET)
        self._refused = why

    def halt(self) -> None:
        """See `Robot.halt`: besides, it is told to stand, and `go` calls its goal off."""
        super().halt()
        self._tell()

    def release(self) -> None:
        """See `Robot.release`."""
        super().release()
        self._tell()

    # -- coming and going --------------------------------------------------------------------------------

    async def open(self) -> None:
        """See `RobotBase.open`: connects, and waits until it is known where the robot is.

        Raises:
            UnavailableError: Nobody answers there, or nobody says where the robot is.
        """
        self._link = Link(f"link of {self.name}")
        self._beating = asyncio.create_task(self._beat(), name=f"beat of {self.name}")
        try:
            await self._there(self._begin())
        except BaseException:
            self.close()
            raise

    def close(self) -> None:
        """See `RobotBase.close`: goals are called off, and the connection ends."""
        super().close()
        link, self._link = self._link, None
        if self._beating is not None:
            self._beating.cancel()
        if link is not None:
            link.end(self._end(), _ENDING_S)

    async def _begin(self) -> None:
        transport = self._connect()
        await transport.__aenter__()
        names = self._names
        self._hold = transport.publisher(names.topic(names.hold, Bool))
        self._transport = transport
        transport.on_endpoints_changed(self._look)
        await self._senses.listen(transport)
        await self._goals.open(transport)
        self._opened_s = self._clock.wall_s()
        self._keeping = asyncio.gather(self._keep(transport), self._senses.attend())
        try:
            async with asyncio.timeout(READY_S):
                await self._senses.ready.wait()
        except TimeoutError as error:
            raise UnavailableError(
                f"{self.name} does not say where it is: {self._senses.missing()}"
            ) from error
        await self._hear_map(transport)

    async def _hear_map(self, transport: Transport) -> None:
        """Wait for the map, if there is one: it is large, and DDS hands out late what was said before."""
        wanted = absolute(self._names.name(self._names.map))
        for wait_s in (SEEN_S, MAP_S):
            with suppress(TimeoutError):
                async with asyncio.timeout(wait_s):
                    await self._senses.mapped.wait()
                return
            if not any(end.name == wanted and end.role == "publisher" for end in transport.endpoints()):
                return

    async def _end(self) -> None:
        transport, self._transport, self._cmd_vel = self._transport, None, None
        if self._keeping is not None:
            self._keeping.cancel()
            await asyncio.gather(self._keeping, return_exceptions=True)
        if transport is not None and self._senses.fresh(LOST_S):
            with suppress(TransportError):  # it stands as it hears no more of us
                await self._call_all_off()
        if transport is not None:
            await transport.__aexit__(None, None, None)

    # -- that it stands when it must ---------------------------------------------------------------------

    async def _beat(self) -> None:
        """On the program's loop: it is alive."""
        while True:
            self._beat_s = self._clock.wall_s()
            await asyncio.sleep(HOLD_S)

    def _tell(self) -> None:
        """Say at once whether it must stand; from any thread."""
        if self._link is not None and self._transport is not None:
            self._link.post(self._tell_hold)

    def _tell_hold(self) -> None:
        silent = self._clock.wall_s() - self._beat_s > LOOP_S
        self._hold.publish(Bool(self._halted or self._paused or self._unwatched or silent))

    async def _keep(self, transport: Transport) -> None:
        """On the link: say again and again whether it must stand, and call off what nobody watches."""
        while True:
            self._tell_hold()
            if self._cmd_vel is None and self._velocities_heard(transport) == 1:
                self._open_velocities(transport)  # so that the first one, a stop's, is heard at once
            if self._unwatched:
                asked = self._sending is None or self._sending.done()
                with suppress(TransportError):  # it stands meanwhile, and this is tried again
                    self._unwatched = not await self._call_all_off() or not asked
            await self._senses.rest()
            await asyncio.sleep(HOLD_S)

    async def _call_all_off(self) -> bool:
        """Whether no goal was left."""
        try:
            return await self._goals.call_off(timeout_s=ASKING_S)
        except UnavailableError:
            waited_s = self._clock.wall_s() - self._opened_s
            return self._sending is None and waited_s > ASKING_S and self._senses.fresh(LOST_S)

    # -- driving -----------------------------------------------------------------------------------------

    async def go(self, goal: Pose2D, control: NavigationControl, *, timeout_s: float) -> Pose2D:
        """See `RobotBase.go`: the robot finds the way. Time in which the robot is held does not count."""
        left_s, began = timeout_s, self.pose()
        try:
            while True:
                while self._is_held(control) or self._is_away():  # noqa: ASYNC110 - said by functions
                    await asyncio.sleep(_LOOK_S)
                started_s = self._clock.now_s()
                if await self._attempt(goal, control, left_s, began):
                    return self.pose()
                left_s -= self._clock.now_s() - started_s
        finally:
            self._paused = False

    def _is_held(self, control: NavigationControl) -> bool:
        self._paused = control.paused()
        return self._paused or self._halted

    async def _attempt(self, goal: Pose2D, control: NavigationControl, left_s: float, began: Pose2D) -> bool:
        """Drive to the end of one goal; False: it was held meanwhile, or out of reach."""
        loop, until_s = asyncio.get_running_loop(), self._clock.now_s() + left_s

        def on_progress(remaining_m: float) -> None:
            loop.call_soon_threadsafe(control.on_progress, remaining_m)

        drive = asyncio.ensure_future(self._there(self._drive(goal, on_progress)))
        try:
            while not drive.done():
                await asyncio.wait([drive], timeout=_LOOK_S)
                self._check()
                if self._is_away() or self._is_held(control):
                    return False
                if self._clock.now_s() > until_s:
                    raise ActionFailure(FailureCode.TIMED_OUT, LATE)
            outcome = drive.result()
            if outcome is None:
                return False
        finally:
            if not drive.done():
                self.drive(Velocity())
                drive.cancel()
                self._unwatched = True
                self._tell()
            await asyncio.gather(drive, return_exceptions=True)
        if outcome.state is GoalState.SUCCEEDED:
            return True
        raise self._goals.failure(outcome, moved=self.pose().distance_to(began) > self.radius_m)

    def _is_away(self) -> bool:
        """Whether its base is out of reach as this program was away, and both look for each other."""
        return not self._senses.fresh(LOST_S) and self._senses.returned(BACK_S)

    def _breaks(self, fence: Fence) -> bool:
        return not self._is_away() and super()._breaks(fence)  # it stands until it is heard

    def _check(self) -> None:
        """Raises `ActionFailure` if it cannot drive."""
        if self._senses.emergency:
            raise ActionFailure(FailureCode.HARDWARE, PRESSED)
        if not (self._senses.fresh(LOST_S) or self._is_away()):
            raise ActionFailure(FailureCode.HARDWARE, SILENT)

    async def _drive(self, goal: Pose2D, on_progress: Callable[[float], None]) -> Outcome[Any] | None:
        """On the link: one goal to its end; None: who had taken it was out of reach."""
        with suppress(TimeoutError):
            async with asyncio.timeout(BACK_S):
                while self._unwatched:  # noqa: ASYNC110 - set from other threads
                    await asyncio.sleep(_LOOK_S)
        if self._unwatched:
            raise ActionFailure(FailureCode.HARDWARE, SILENT)
        self._tell_hold()
        target = stamped(goal, self._names.map_frame, self._clock.unix_ms())
        try:
            self._sending = asyncio.ensure_future(self._goals.send(target, on_progress, timeout_s=ASKING_S))
            sent = await asyncio.shield(self._sending)
            with suppress(UnavailableError):
                return await self._ended(sent)
            self._unwatched = True
            self._tell_hold()
            return None
        except GoalRefusedError as error:
            raise ActionFailure(FailureCode.UNREACHABLE, NO_WAY) from error
        except TransportError as error:
            self._unwatched = True
            says = UNLIKE if isinstance(error, TypeMismatchError) else SILENT
            raise ActionFailure(FailureCode.HARDWARE, says, {"why": str(error)}) from error

    async def _ended(self, sent: SentGoal[Any]) -> Outcome[Any]:
        while True:
            with suppress(TransportTimeoutError):
                return await sent.outcome(timeout_s=_LONG_S)

    async def _there(self, work: Coroutine[Any, Any, T]) -> T:
        if self._link is None:
            work.close()
            raise ActionFailure(FailureCode.HARDWARE, SILENT)
        return await self._link.run(work)


def _bridge(address: str, ros: Literal[1, 2]) -> Transport:
    with needs("rosbridge"):
        from parley.transport.rosbridge import RosbridgeTransport
    return RosbridgeTransport(address, ros=ros)
