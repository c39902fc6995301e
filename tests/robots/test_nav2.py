"""A robot behind the interface of Nav2, driven over every kind of network; the simulator stands in for it."""

from __future__ import annotations

import asyncio
import gc
import itertools
import subprocess
import sys
from collections.abc import AsyncIterator, Callable
from contextlib import AsyncExitStack, asynccontextmanager, suppress
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Self, TypeVar

import numpy as np
import pytest
import structlog
from typer.testing import CliRunner

from parley.cli import command_line
from parley.clock import SimClock, WallClock
from parley.config import NetworkSettings
from parley.errors import ActionFailure, FailureCode, UnavailableError, UnsupportedError
from parley.messages.actions import ActionWire, GoalState
from parley.messages.ros import CompressedImage
from parley.messages.ros_robot import (
    ACTIVE,
    Bool,
    GetStateRequest,
    Release,
    Twist,
    Vector3,
    get_state,
    navigate_to_pose,
)
from parley.messages.topics import Topic
from parley.robots.base import NavigationControl, Velocity
from parley.robots.check import blocked
from parley.robots.link import Link
from parley.robots.nav2 import Nav2Robot, Nav2Setup
from parley.robots.nav2_errors import failure_of
from parley.robots.nav2_simulated import SimulatedNav2
from parley.robots.ros_robot import LOST_S, Goals, RosRobot, RosSetup
from parley.robots.ros_senses import RosTopics
from parley.sim.simulator import Simulator
from parley.transport.base import Endpoint, Publisher, Transport
from parley.transport.local import LocalTransport
from parley.transport.rosbridge import RosbridgeServer, RosbridgeTransport
from parley.transport.zenoh import ZenohTransport
from parley.transport.zenoh.definitions import of_release
from parley.world.geometry import Pose2D
from tests.sim.worlds import two_rooms
from tests.transport.backends import NEEDS_ROS, free_port, ros2_node, until

M = TypeVar("M")
ROOT = Path(__file__).parent.parent.parent
TOPICS = RosTopics(emergency="e_stop", namespace="A")
NOT_PAUSED = NavigationControl(lambda _: None, lambda: False)
QUICK = 5.0
"""Times real speed, where nothing is commanded from outside."""


class Peer:
    """The simulated robot, with what it needs."""

    topics = TOPICS

    def __init__(self, release: Release, speed: float) -> None:
        self._release, self._speed, self._stack = release, speed, AsyncExitStack()
        self.nav2: SimulatedNav2

    async def begin(self, transport: Transport) -> None:
        simulator = Simulator(two_rooms(), clock=SimClock(), speed=self._speed)
        await self._stack.enter_async_context(simulator)
        nav2 = SimulatedNav2(simulator, "A", transport, release=self._release, topics=self.topics)
        self.nav2 = await self._stack.enter_async_context(nav2)

    async def end(self) -> None:
        await self._stack.aclose()


class Hosted(LocalTransport):
    """One process: the simulated robot is on the same loop."""

    def __init__(self, peer: Peer) -> None:
        super().__init__()
        self._peer = peer

    async def __aenter__(self) -> Self:
        await self._peer.begin(self)
        return self

    async def __aexit__(self, *exc: Any) -> None:
        await self._peer.end()
        await super().__aexit__(*exc)


class Cable:
    """Between an address and a server: what can be pulled out."""

    def __init__(self, port: int) -> None:
        self._port, self._ends = port, list[asyncio.StreamWriter]()
        self._tasks: set[asyncio.Task[None]] = set()

    async def __aenter__(self) -> Self:
        self.port = free_port()
        await self.plug()
        return self

    async def plug(self) -> None:
        self._server = await asyncio.start_server(self._join, "127.0.0.1", self.port)

    async def __aexit__(self, *_: object) -> None:
        self.pull()
        await asyncio.gather(*self._tasks, return_exceptions=True)

    def pull(self) -> None:
        """Nothing passes any more."""
        self._server.close()
        for end in self._ends:
            end.transport.abort()

    async def _join(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        further, onward = await asyncio.open_connection("127.0.0.1", self._port)
        self._ends += [writer, onward]
        for source, sink in ((reader, onward), (further, writer)):
            task = asyncio.create_task(self._carry(source, sink))
            self._tasks.add(task)

    @staticmethod
    async def _carry(source: asyncio.StreamReader, sink: asyncio.StreamWriter) -> None:
        with suppress(OSError):
            while data := await source.read(65536):
                sink.write(data)
                await sink.drain()


@dataclass
class Stage:
    robot: Nav2Robot
    nav2: SimulatedNav2
    cable: Cable
    at_cable: Link


@asynccontextmanager
async def stage(
    kind: str, release: Release = "jazzy", speed: float = 1.0, *, said: Release | None = None
) -> AsyncIterator[Stage]:
    """A robot of ours, and beyond a network what it drives, on a loop of its own."""
    peer, cable = Peer(release, speed), Cable(free_port())
    async with AsyncExitStack() as stack:
        link = Link("peer")
        stack.callback(link.end, asyncio.sleep(0), 5.0)
        if kind == "local":
            near: Callable[[], Transport] = lambda: Hosted(peer)  # noqa: E731
        else:
            near, far = await networks(kind, release, cable, link, stack)
            await link.run(far.__aenter__())
            stack.push_async_callback(lambda: link.run(far.__aexit__(None, None, None)))
            await link.run(peer.begin(far))
            stack.push_async_callback(lambda: link.run(peer.end()))
        robot = Nav2Robot("A", near, Nav2Setup(release=said or release, topics=TOPICS, radius_m=0.2))
        stack.callback(robot.close)
        await robot.open()
        robot.settle(robot.own_map, WallClock(), None)
        yield Stage(robot, peer.nav2, cable, link)


async def networks(
    kind: str, release: Release, cable: Cable, link: Link, stack: AsyncExitStack
) -> tuple[Callable[[], Transport], Transport]:
    """How ours comes to the network, and the end of the other."""
    port = cable._port
    if kind == "rosbridge":
        bridge = RosbridgeServer(port)
        await link.run(bridge.__aenter__())
        stack.push_async_callback(lambda: link.run(bridge.__aexit__(None, None, None)))
        await link.run(cable.__aenter__())
        stack.push_async_callback(lambda: link.run(cable.__aexit__()))
        return lambda: RosbridgeTransport(f"ws://127.0.0.1:{cable.port}"), RosbridgeTransport(
            f"ws://127.0.0.1:{port}", look_s=0.1
        )
    if kind == "ros2":
        return lambda: ros2_node("ours", look_s=0.1), ros2_node("theirs", look_s=0.1)
    await link.run(cable.__aenter__())
    stack.push_async_callback(lambda: link.run(cable.__aexit__()))
    definitions = (of_release(release),)
    far = ZenohTransport(
        NetworkSettings(listen=(f"tcp/127.0.0.1:{port}",), interface=""), definitions=definitions
    )
    near = NetworkSettings(listen=(), connect=(f"tcp/127.0.0.1:{cable.port}",), interface="")
    return lambda: ZenohTransport(near, definitions=definitions), far


def ahead(robot: Nav2Robot, metres: float) -> Pose2D:
    pose = robot.pose()
    return Pose2D(pose.x_m + metres, pose.y_m, 0.0)


@pytest.mark.parametrize(
    ("kind", "release"),
    [
        ("local", "jazzy"),
        ("zenoh", "humble"),
        ("rosbridge", "lyrical"),
        pytest.param("ros2", "jazzy", marks=NEEDS_ROS),
    ],
)
async def test_it_drives_to_a_place_and_tells_how_far_it_is(kind: str, release: Release) -> None:
    remaining: list[float] = []
    async with stage(kind, release, QUICK) as on:
        goal = ahead(on.robot, 0.8)
        control = NavigationControl(remaining.append, lambda: False)
        ended = await on.robot.navigate(goal, control, timeout_s=20)
        assert ended.distance_to(goal) < 0.1
        assert on.nav2.robot.pose().distance_to(goal) < 0.1
    assert remaining == sorted(remaining, reverse=True)
    assert 0 < remaining[-1] < remaining[0] < 1


@pytest.mark.parametrize("kind", ["zenoh", pytest.param("ros2", marks=NEEDS_ROS)])
async def test_it_knows_its_map_sees_with_its_laser_and_takes_pictures(kind: str) -> None:
    async with stage(kind) as on:
        own, true = on.robot.own_map, on.nav2.robot._map
        assert own is not None and np.array_equal(own.cells, true.cells)
        assert (own.origin_x_m, own.origin_y_m) == (true.origin_x_m, true.origin_y_m)
        await until(lambda: on.robot._senses._sweep)
        assert np.nanmin(on.robot.scan().ranges_m) == pytest.approx(1.0, abs=0.1)
        picture = await on.robot.image()
        assert picture.data.shape == (picture.height, picture.width, 3)
        assert picture.data.std() > 1


@pytest.mark.parametrize(
    ("kind", "release", "known"),
    [
        ("local", "jazzy", {"nav2_code": 208}),
        ("local", "humble", {"nav2_code": 0, "nav2_says": ""}),
        pytest.param("ros2", "jazzy", {"nav2_code": 208}, marks=NEEDS_ROS),
    ],
)
async def test_where_no_way_leads_it_says_so(kind: str, release: Release, known: dict[str, Any]) -> None:
    async with stage(kind, release, QUICK) as on:
        with pytest.raises(ActionFailure) as failed:
            await on.robot.navigate(Pose2D(40.0, 1.0), NOT_PAUSED, timeout_s=20)
    assert failed.value.code is FailureCode.UNREACHABLE
    assert known.items() <= failed.value.details.items()


@pytest.mark.parametrize("kind", ["zenoh", pytest.param("ros2", marks=NEEDS_ROS)])
async def test_a_button_pressed_on_the_robot_ends_the_drive_and_is_told(kind: str) -> None:
    async with stage(kind) as on:
        drive = asyncio.create_task(on.robot.navigate(ahead(on.robot, 2.0), NOT_PAUSED, timeout_s=20))
        await until(lambda: on.nav2.robot.velocity().linear_mps > 0.1)
        on.nav2.press(True)
        with pytest.raises(ActionFailure, match="emergency stop on me is pressed"):
            await drive
        assert on.robot.trouble() == "pressed"
        await until(lambda: on.nav2.robot.velocity().linear_mps < 0.02)
        on.nav2.press(False)
        await until(lambda: not on.robot.trouble() and not on.nav2.robot.stopped)
        assert on.nav2.robot.velocity().linear_mps < 0.02  # what was called off is not taken up again


async def test_a_stop_shuts_the_lock_zeroes_the_velocity_and_calls_the_goal_off_on_the_wire() -> None:
    locks, speeds, goals = list[bool](), list[float](), list[int]()
    action = ActionWire(navigate_to_pose(TOPICS.name("navigate_to_pose"), "jazzy"))
    async with stage("rosbridge") as on, RosbridgeTransport(f"ws://127.0.0.1:{on.cable.port}") as watch:
        await watch.subscribe(TOPICS.topic(TOPICS.hold, Bool), lambda told: locks.append(told.data))
        await watch.subscribe(TOPICS.topic(TOPICS.cmd_vel, Twist), lambda told: speeds.append(told.linear.x))
        await watch.subscribe(action.status, lambda told: goals.extend(g.status for g in told.status_list))
        drive = asyncio.create_task(on.robot.navigate(ahead(on.robot, 2.0), NOT_PAUSED, timeout_s=20))
        await until(lambda: on.nav2.robot.velocity().linear_mps > 0.1 and locks[-1:] == [False])
        ready = Endpoint("/A/cmd_vel", "geometry_msgs/msg/Twist", "publisher")
        await until(lambda: ready in watch.endpoints())
        assert not speeds, "the zero of a stop waits for no opening"
        on.robot.halt()
        await until(lambda: locks[-1] and speeds[-1:] == [0.0] and goals[-1:] == [GoalState.CANCELED])
        await until(lambda: on.nav2.robot.velocity().linear_mps < 0.02)
        assert not drive.done()  # a person may let it go on
        drive.cancel()
        await asyncio.gather(drive, return_exceptions=True)


class WithoutVision(Hosted):
    """A ROS to which the messages of a detector are not installed."""

    def publisher(self, topic: Topic[M]) -> Publisher[M]:
        if topic.ros_type.startswith("vision_msgs/"):
            raise UnsupportedError(f"ROS does not know {topic.ros_type}")
        return super().publisher(topic)


async def test_a_simulated_robot_needs_no_messages_of_a_detector_and_its_nodes_say_they_are_active() -> None:
    peer = Peer("jazzy", QUICK)
    peer.topics = replace(TOPICS, detections="detections")
    with structlog.testing.capture_logs() as logs:
        async with WithoutVision(peer) as transport:
            for node in ("A/bt_navigator", "A/amcl"):
                answer = await transport.call(get_state(node), GetStateRequest(), timeout_s=5.0)
                assert answer.current_state == ACTIVE
            pictures: list[CompressedImage] = []
            await transport.subscribe(peer.topics.topic(TOPICS.camera, CompressedImage), pictures.append)
            await until(lambda: pictures)
    assert [one["why"] for one in logs if "detector" in one["event"]] == [
        "ROS does not know vision_msgs/msg/Detection2DArray"
    ]


async def test_a_base_that_hung_does_nothing_of_what_it_was_told_meanwhile_and_then_obeys_again() -> None:
    async with Hosted(Peer("jazzy", 1.0)) as transport:
        base = transport._peer.nav2.robot
        drive = transport.publisher(TOPICS.topic(TOPICS.cmd_vel, Twist))
        permit = transport.publisher(TOPICS.topic(TOPICS.hold, Bool))

        def told() -> bool:
            drive.publish(Twist(Vector3(0.2)))
            permit.publish(Bool(False))
            return base.velocity().linear_mps > 0.1

        await until(told)
        drive.publish(Twist(Vector3(0.2)))
        permit.publish(Bool(False))
        assert blocked(base, 1.0) < 1.0
        before = base.pose()
        await asyncio.sleep(0.25)  # it reads what came
        assert base.pose().distance_to(before) < 0.005
        await until(told)


async def test_where_the_release_is_another_one_it_says_that_it_is_set_up_wrongly() -> None:
    async with stage("rosbridge", "humble", QUICK, said="jazzy") as on:
        with pytest.raises(ActionFailure, match="set up wrongly") as failed:
            await on.robot.navigate(ahead(on.robot, 0.8), NOT_PAUSED, timeout_s=20)
    assert "error_code" in failed.value.details["why"]


@pytest.mark.parametrize("kind", ["zenoh", "rosbridge"])
async def test_when_the_network_dies_it_stands_within_a_second_and_does_not_go_on_by_itself(
    kind: str,
) -> None:
    clock = WallClock()
    async with stage(kind) as on:
        drive = asyncio.create_task(on.robot.navigate(ahead(on.robot, 3.5), NOT_PAUSED, timeout_s=20))
        await until(lambda: on.nav2.robot.velocity().linear_mps > 0.2)
        on.at_cable.post(on.cable.pull)
        cut_s = clock.wall_s()
        await until(lambda: on.nav2.robot.velocity().linear_mps < 0.02)
        assert clock.wall_s() - cut_s < 1.0
        with pytest.raises(ActionFailure, match="does not answer") as failed:
            await drive
        assert on.nav2.robot.stopped and on.nav2.robot.planned_path()
        await on.at_cable.run(on.cable.plug())
        await until(lambda: not on.nav2.robot.stopped)
        assert on.nav2.robot.planned_path() == ()
    assert failed.value.code is FailureCode.HARDWARE


class AwayOnce:
    """Those who drive a robot, out of reach for us right after the first goal: its end is not heard."""

    def __init__(self, goals: Goals) -> None:
        self._goals, self.sent = goals, 0

    async def send(self, *given: Any, timeout_s: float) -> Any:
        sent = await self._goals.send(*given, timeout_s=timeout_s)
        self.sent += 1
        return sent if self.sent > 1 else Away()

    def __getattr__(self, name: str) -> Any:
        return getattr(self._goals, name)


async def test_a_drive_goes_on_when_who_drives_it_was_out_of_reach_for_a_moment() -> None:
    async with stage("local", speed=QUICK) as on:
        once = AwayOnce(on.robot._goals)
        on.robot._goals = once
        there = ahead(on.robot, 0.8)
        assert (await on.robot.navigate(there, NOT_PAUSED, timeout_s=30)).distance_to(there) < 0.3
        assert once.sent == 2


class Away:
    """Who takes a goal, and is out of reach from then on."""

    async def open(self, transport: Transport) -> None:
        pass

    async def send(self, target: Any, on_remaining: Any, *, timeout_s: float) -> Any:
        return self

    async def outcome(self, *, timeout_s: float) -> Any:
        raise UnavailableError("away")

    async def call_off(self, *, timeout_s: float) -> bool:
        raise UnavailableError("away")

    def failure(self, outcome: Any, *, moved: bool) -> ActionFailure:
        raise AssertionError(outcome)


@pytest.mark.parametrize("was_away", [True, False])
async def test_a_base_that_is_not_heard_right_after_this_program_was_away_is_waited_for(
    monkeypatch: pytest.MonkeyPatch, *, was_away: bool
) -> None:
    async with stage("local", speed=QUICK) as on:
        asked = itertools.count()
        monkeypatch.setattr(on.robot._senses, "fresh", lambda _: not 5 <= next(asked) < 15)
        monkeypatch.setattr(on.robot._senses, "returned", lambda _: was_away)
        there = ahead(on.robot, 0.8)
        if was_away:
            assert (await on.robot.navigate(there, NOT_PAUSED, timeout_s=30)).distance_to(there) < 0.3
            assert next(asked) > 15
        else:
            with pytest.raises(ActionFailure, match="does not answer"):
                await on.robot.navigate(there, NOT_PAUSED, timeout_s=30)


async def test_who_drives_it_and_stays_away_is_not_waited_for_for_ever(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("parley.robots.ros_robot.BACK_S", 0.5)
    peer = Peer("jazzy", 1.0)
    setup = RosSetup("navigate_to_pose", topics=TOPICS, radius_m=0.2)
    robot = RosRobot("A", lambda: Hosted(peer), Away(), setup)
    await robot.open()
    try:
        robot.settle(robot.own_map, WallClock(), None)
        there = Pose2D(robot.pose().x_m + 1.0, robot.pose().y_m, 0.0)
        with pytest.raises(ActionFailure, match="does not answer"):
            await robot.navigate(there, NOT_PAUSED, timeout_s=60)
        assert peer.nav2.robot.stopped
    finally:
        await asyncio.to_thread(robot.close)


@pytest.mark.parametrize("kind", ["local", "zenoh"])
async def test_a_base_that_takes_velocities_with_a_stamp_gets_them(
    kind: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    takes = replace(TOPICS, stamped=True)
    monkeypatch.setattr(Peer, "topics", takes)
    async with stage(kind) as on:  # ours is not told
        await until(lambda: not on.nav2.robot.stopped)

        def moves() -> bool:
            on.robot.drive(Velocity(0.2))
            return on.nav2.robot.velocity().linear_mps > 0.02

        await until(moves)
        on.robot.halt()
        await until(lambda: on.nav2.robot.velocity().linear_mps < 0.02)


async def test_while_the_program_hangs_it_stands() -> None:
    async with stage("zenoh") as on:
        drive = asyncio.create_task(on.robot.navigate(ahead(on.robot, 3.5), NOT_PAUSED, timeout_s=20))
        await until(lambda: on.nav2.robot.velocity().linear_mps > 0.2)
        assert blocked(on.nav2.robot, 1.2) < 1.0
        drive.cancel()


async def test_a_drive_that_failed_while_the_program_hung_is_told_once_and_not_by_the_loop_besides() -> None:
    told: list[dict[str, Any]] = []
    asyncio.get_running_loop().set_exception_handler(lambda _, context: told.append(context))
    async with stage("rosbridge") as on:
        drive = asyncio.create_task(on.robot.navigate(ahead(on.robot, 3.5), NOT_PAUSED, timeout_s=20))
        await until(lambda: on.nav2.robot.velocity().linear_mps > 0.2)
        (inner,) = (task for task in asyncio.all_tasks() if "_there" in repr(task))
        inner.add_done_callback(lambda _: blocked(on.nav2.robot, LOST_S + 0.5))
        on.at_cable.post(on.cable.pull)
        with pytest.raises(ActionFailure, match="does not answer"):
            await drive
    del inner, drive
    gc.collect()
    assert told == []


def test_the_page_can_be_followed_with_the_simulated_robot(tmp_path: Path) -> None:
    port, example = str(free_port()), tmp_path / "nav2_robot.py"
    example.write_text(
        (ROOT / "examples" / "nav2_robot.py").read_text("utf-8").replace("9090", port), "utf-8"
    )
    simulate = [sys.executable, "-m", "parley", "robot", "simulate", "--port", port]
    with subprocess.Popen(simulate, stdout=subprocess.PIPE, text=True) as stand_in:
        try:
            assert stand_in.stdout is not None and f":{port}, namespace none" in stand_in.stdout.readline()
            said = subprocess.run([sys.executable, str(example)], capture_output=True, text=True, check=True)
            words = ["robot", "check", f"{example}:robot", "--yes"]
            checked = CliRunner().invoke(command_line(), words)
        finally:
            stand_in.terminate()
    assert said.stdout.count("finished") == 2, said.stdout
    assert checked.exit_code == 0 and checked.output.count("kept ") == 5, checked.output


class LateMap(Hosted):
    """Hands the map out only a while after all else was heard."""

    async def subscribe(self, topic: Topic[M], handler: Any, **more: Any) -> Any:
        def late(message: Any) -> None:
            asyncio.get_running_loop().call_later(1.5, handler, message)

        return await super().subscribe(topic, late if topic.name.endswith("map") else handler, **more)


async def test_a_map_that_comes_late_is_waited_for() -> None:
    robot = Nav2Robot("A", lambda: LateMap(Peer("jazzy", QUICK)), Nav2Setup(topics=TOPICS))
    try:
        await robot.open()
        assert robot.own_map is not None
    finally:
        robot.close()


async def test_a_robot_that_says_nothing_of_itself_is_not_taken_for_ready(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("parley.robots.ros_robot.READY_S", 0.05)
    robot = Nav2Robot("A", LocalTransport)
    with pytest.raises(UnavailableError, match=r"odom \(odometry\).*tf from base_link to map.*amcl_pose"):
        await robot.open()


@pytest.mark.parametrize(
    ("number", "moved", "code"),
    [
        (0, True, FailureCode.BLOCKED),
        (0, False, FailureCode.UNREACHABLE),
        (105, True, FailureCode.BLOCKED),
        (208, True, FailureCode.UNREACHABLE),
        (9003, True, FailureCode.TIMED_OUT),
        (102, True, FailureCode.HARDWARE),
        (54321, True, FailureCode.HARDWARE),
    ],
)
def test_what_nav2_says_is_one_of_our_failures(number: int, moved: bool, code: FailureCode) -> None:
    assert failure_of(number, "", moved=moved).code is code
