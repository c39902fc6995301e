"""A simulated robot behind the interface of Nav2: whatever drives a Nav2 robot can drive it.

It serves NavigateToPose, takes velocities, and tells its map, frames, odometry, sweeps and pictures. As on a
robot with twist_mux the hold topic locks its drive, and so does silence there once it was heard.
"""

from __future__ import annotations

import asyncio
import io
from collections.abc import AsyncIterator
from contextlib import AbstractAsyncContextManager, AsyncExitStack, asynccontextmanager
from typing import Any, Final, Self

import structlog

from parley.clock import WallClock
from parley.errors import ActionFailure, UnsupportedError
from parley.messages import ros, ros_robot
from parley.messages.actions import GoalState
from parley.messages.ros_robot import Release, navigate_to_pose
from parley.robots.base import NavigationControl, Velocity
from parley.robots.nav2_errors import code_of
from parley.robots.ros_senses import RosTopics
from parley.robots.ros_values import detected, grid_of, header, planar, pose_of, stamped, transform
from parley.robots.simulated import SimulatedRobot
from parley.sim.simulator import Simulator
from parley.transport.actions import ActionServer, RunningGoal
from parley.transport.base import Outcome, Transport, absolute
from parley.world.geometry import Pose2D

__all__ = ["LOCK_S", "SimulatedNav2"]

LOCK_S: Final = 0.3
"""A lock whose last word is older than this is shut."""
TELL_S: Final = 0.05
SCAN_EVERY: Final = 4
PICTURE_EVERY: Final = 10
LATCH_EVERY: Final = 10
DRIVE_S: Final = 600.0

log = structlog.get_logger(__name__)


class SimulatedNav2:
    """``async with SimulatedNav2(simulator, "A", transport):``.

    Args:
        simulator: The world, at real speed.
        robot: Its name there.
        transport: Where it is seen.
        release: Whose messages it has.
        topics: Its names.
        action: The name of the action.
    """

    def __init__(
        self,
        simulator: Simulator,
        robot: str,
        transport: Transport,
        *,
        release: Release = "jazzy",
        topics: RosTopics | None = None,
        action: str = "navigate_to_pose",
    ) -> None:
        self._transport, self._names, self._simulator = transport, topics or RosTopics(), simulator
        self._map = simulator.occupancy(robot)
        self.robot = SimulatedRobot(simulator, robot, self._map)
        self._clock = WallClock()
        self._action = navigate_to_pose(self._names.name(action), release)
        self._held: bool | None = None
        self._held_s = self._deaf_s = 0.0
        self._beat_s = self._clock.wall_s()
        self._pressed = False
        self.lifecycle = ros_robot.ACTIVE
        """How far its navigator says it is."""

    async def __aenter__(self) -> Self:
        names, transport, stack = self._names, self._transport, AsyncExitStack()
        takes = ros_robot.TwistStamped if names.stamped else ros_robot.Twist
        self._stack = await stack.__aenter__()
        self._out = {}
        for name, kind, qos in names.told():
            try:
                self._out[name] = transport.publisher(names.topic(name, kind, qos))
            except UnsupportedError as error:  # the messages of a detector are not part of every ROS
                if name != names.detections:
                    raise
                log.warning("it does not tell what its detector sees", robot=self.robot.name, why=str(error))
        self._out[names.map].publish(grid_of(self._map, names.map_frame, self._clock.unix_ms()))
        for topic, handler in (
            (names.topic(names.cmd_vel, takes), self._on_velocity),
            (names.topic(names.hold, ros_robot.Bool), self._on_hold),
        ):
            heard = await transport.subscribe(topic, handler)
            stack.push_async_callback(heard.close)
        await stack.enter_async_context(self._serving())
        for work in (self._tell(), self._watch()):
            stack.push_async_callback(_ended, asyncio.create_task(work, name=f"nav2 of {self.robot.name}"))
        return self

    async def __aexit__(self, *exc: Any) -> None:
        await self._stack.__aexit__(None, None, None)
        for publisher in self._out.values():
            publisher.close()

    def press(self, pressed: bool) -> None:
        """Press the button for emergencies on the robot, or pull it out."""
        self._pressed = pressed
        self._lock()
        self._out[self._names.emergency].publish(ros_robot.Bool(pressed))

    def _serving(self) -> AbstractAsyncContextManager[Any]:
        """What takes goals."""
        return self._bt_navigator()

    @asynccontextmanager
    async def _bt_navigator(self) -> AsyncIterator[None]:
        async def state(_: ros_robot.GetStateRequest) -> ros_robot.GetStateResponse:
            return ros_robot.GetStateResponse(self.lifecycle)

        async with ActionServer(self._transport, self._action, self._carry_out, self._clock):
            nodes = ros_robot.NAVIGATOR, ros_robot.LOCALISER
            told = [
                await self._transport.serve(ros_robot.get_state(self._names.name(node)), state)
                for node in nodes
            ]
            try:
                yield
            finally:
                for end in told:
                    await end.close()

    # -- the drive ---------------------------------------------------------------------------------------

    async def _watch(self) -> None:
        """Shut the lock in time, whatever else takes its time."""
        while True:
            self._is_deaf()
            self._beat_s = self._clock.wall_s()
            self._lock()
            await asyncio.sleep(TELL_S)

    def _is_deaf(self) -> bool:
        """Whether this hung until a moment ago: what it may read now is old, and moves nothing any more."""
        now_s = self._clock.wall_s()
        if now_s - self._beat_s > LOCK_S:
            self._deaf_s = now_s + LOCK_S
        return now_s < self._deaf_s

    def _on_velocity(self, told: ros_robot.Twist | ros_robot.TwistStamped) -> None:
        twist = told.twist if isinstance(told, ros_robot.TwistStamped) else told
        velocity = Velocity(twist.linear.x, twist.angular.z)
        if velocity != Velocity():
            if not self._is_deaf():
                self.robot.drive(velocity)
        elif not self.robot.stopped:  # no command any more, so that it brakes, and not one to roll out
            self.robot.halt()
            self.robot.release()

    def _on_hold(self, told: ros_robot.Bool) -> None:
        if told.data or not self._is_deaf():
            self._held, self._held_s = told.data, self._clock.wall_s()
        self._lock()

    def _lock(self) -> None:
        silent = self._held is not None and self._clock.wall_s() - self._held_s > LOCK_S
        locked = bool(self._held) or silent or self._pressed
        if locked and not self.robot.stopped:
            self.robot.halt()
        elif not locked and self.robot.stopped:
            self.robot.release()

    async def _carry_out(self, running: RunningGoal[Any, Any]) -> Outcome[Any]:
        target = running.goal.pose.pose
        goal = planar(target.position, target.orientation)
        feedback, recoveries = self._action.feedback, 0

        def on_progress(remaining_m: float) -> None:
            here = stamped(self.robot.pose(), self._names.map_frame, self._clock.unix_ms())
            running.feedback(feedback(here, number_of_recoveries=recoveries, distance_remaining=remaining_m))

        control = NavigationControl(on_progress, lambda: False)
        try:
            await self.robot.navigate(goal, control, timeout_s=DRIVE_S)
        except ActionFailure as failure:
            return Outcome(GoalState.ABORTED, self._result(code_of(failure), failure.message))
        return Outcome(GoalState.SUCCEEDED, self._result(0, ""))

    def _result(self, code: int, says: str) -> Any:
        made = self._action.result
        return made(code, says) if made is ros_robot.NavigateResult else made()

    # -- what it tells -----------------------------------------------------------------------------------

    async def _tell(self) -> None:
        beat = 0
        while True:
            self._tell_place(latched=beat % LATCH_EVERY == 0)
            if beat % SCAN_EVERY == 0:
                self._tell_scan()
            if beat % PICTURE_EVERY == 0:
                await self._tell_picture()
            beat += 1
            await asyncio.sleep(TELL_S)

    def _tell_place(self, *, latched: bool) -> None:
        names, pose, now_ms = self._names, self.robot.pose(), self._clock.unix_ms()
        moves = self.robot.velocity()
        twist = ros_robot.Twist(ros_robot.Vector3(moves.linear_mps), ros_robot.Vector3(z=moves.angular_radps))
        frames = (
            transform(names.map_frame, "odom", Pose2D(0.0, 0.0), now_ms),
            transform("odom", names.base_frame, pose, now_ms),
        )
        self._out[names.tf].publish(ros_robot.TFMessage(frames))
        place = ros_robot.PoseWithCovariance(pose_of(pose))
        odometry = ros_robot.Odometry(
            header("odom", now_ms), names.base_frame, place, ros_robot.TwistWithCovariance(twist)
        )
        self._out[names.odom].publish(odometry)
        if latched:
            told = ros_robot.PoseWithCovarianceStamped(header(names.map_frame, now_ms), place)
            self._out[names.amcl_pose].publish(told)

    def _tell_scan(self) -> None:
        sweep = self.robot.scan()
        count = len(sweep.ranges_m)
        told = ros_robot.LaserScan(
            header(self._names.base_frame, self._clock.unix_ms()),
            angle_min=sweep.angle_min_rad,
            angle_max=sweep.angle_min_rad + sweep.angle_increment_rad * (count - 1),
            angle_increment=sweep.angle_increment_rad,
            range_max=sweep.range_max_m,
            ranges=tuple(sweep.ranges_m.tolist()),
        )
        self._out[self._names.scan].publish(told)

    async def _tell_picture(self) -> None:
        names = self._names
        wanted = absolute(names.name(names.camera))
        ends = self._transport.endpoints()
        if not any(end.name == wanted and end.role == "subscription" for end in ends):
            return
        picture = await self.robot.image()
        top = header("camera", self._clock.unix_ms())
        if names.camera_type is ros_robot.Image:
            data, step = picture.data.tobytes(), 3 * picture.width
            told: Any = ros_robot.Image(top, picture.height, picture.width, "rgb8", 0, step, data)
        else:
            told = ros.CompressedImage(top, "jpeg", await asyncio.to_thread(_jpeg, picture.data))
        self._out[names.camera].publish(told)
        if names.detections in self._out:
            place = ros.Header(top.stamp, names.map_frame)
            self._out[names.detections].publish(detected(picture.detections or (), place))


async def _ended(task: asyncio.Task[None]) -> None:
    task.cancel()
    await asyncio.gather(task, return_exceptions=True)


def _jpeg(pixels: Any) -> bytes:
    from PIL import Image

    out = io.BytesIO()
    Image.fromarray(pixels).save(out, "JPEG", quality=85)
    return out.getvalue()
