"""A system whose parts are processes of their own on one network of this machine, for tests."""

from __future__ import annotations

import asyncio
import contextlib
import signal
import sys
from collections.abc import AsyncIterator
from contextlib import AsyncExitStack, asynccontextmanager
from dataclasses import dataclass, field
from pathlib import Path

from parley.clock import WallClock
from parley.config import NetworkSettings, SystemConfig
from parley.demos.observer import Observer
from parley.errors import TransportError
from parley.messages import topics
from parley.messages.map import GetMap
from parley.messages.ros import ChatRequest, String
from parley.messages.status import ActorStatus
from parley.messages.wire import decode, encode
from parley.network import transport_of
from parley.transport.base import Transport
from tests.transport.backends import free_port

ROBOT = "David"
DOMAIN = 77
ROBOT_FILE = """
radius_m: 0.22
limits: {max_speed_mps: 0.26, max_turn_radps: 1.8}
topics: {detections: detections, emergency: e_stop}
"""
DRIVER_FILE = '''
"""A driver of somebody's own: it sends velocities to its base, which is another process."""

import asyncio, time

from parley.api import ActionFailure, DriveLimits, FailureCode, Pose2D, RobotBase, Velocity
from parley.config import NetworkSettings, SystemConfig
from parley.messages.ros_robot import Odometry, Twist, Vector3
from parley.messages.topics import QoS
from parley.network import transport_of
from parley.robots.ros_senses import RosTopics
from parley.robots.ros_values import planar


class Driver(RobotBase):
    radius_m, limits = 0.22, DriveLimits(max_speed_mps=0.26, max_turn_radps=1.8)

    async def open(self):
        self._loop, self._heard = asyncio.get_running_loop(), asyncio.Event()
        network = NetworkSettings(domain=DOMAIN, role="client", connect=("BASE",), interface="")
        base = await transport_of(SystemConfig(network=network)).__aenter__()
        names = RosTopics()
        self._out = base.publisher(names.topic(names.cmd_vel, Twist))
        odom = names.topic(names.odom, Odometry, QoS(reliable=False, depth=5))
        await base.subscribe(odom, self._on_odom)
        await self._heard.wait()

    def _on_odom(self, told):
        self._odom, self._heard_s = told, time.monotonic()
        self._heard.set()

    def trouble(self):
        return "" if time.monotonic() - self._heard_s < 1.0 else "silent"

    def _told(self):
        if self.trouble():
            raise ActionFailure(FailureCode.HARDWARE, "My base does not answer.")
        return self._odom

    def pose(self):
        pose = self._told().pose.pose
        return planar(pose.position, pose.orientation)

    def velocity(self):
        twist = self._told().twist.twist
        return Velocity(twist.linear.x, twist.angular.z)

    def send(self, velocity):
        twist = Twist(Vector3(velocity.linear_mps), Vector3(z=velocity.angular_radps))
        self._loop.call_soon_threadsafe(self._out.publish, twist)
'''


@dataclass
class Parts:
    """The processes, and an operator who listens."""

    folder: Path
    settings: Path
    port: int
    """Of the page."""
    robot: str = ""
    """What the robot is like that is another process; empty: it is simulated in the engine's."""
    door: Path = Path()
    """Settings of a simulator that can be seen without the router, by `eye`."""
    eye: NetworkSettings = field(default_factory=NetworkSettings)
    speed: str = "1"
    """Of the simulator that stands behind Nav2, where it is a part."""
    beside: Path | None = None
    """Settings of an engine that reaches its robot without the router; None: through it."""
    processes: dict[str, asyncio.subprocess.Process] = field(default_factory=dict)
    statuses: dict[str, ActorStatus] = field(default_factory=dict)
    """The newest heartbeat of each robot."""
    beat: asyncio.Event = field(default_factory=asyncio.Event)
    """Set with each."""
    transport: Transport = field(init=False)
    operator: Observer = field(init=False)

    def on_status(self, message: String) -> None:
        """A heartbeat."""
        status = decode(ActorStatus, message.data)
        self.statuses[status.actor] = status
        self.beat.set()

    async def end(self) -> None:
        """No process is left."""
        for process in self.processes.values():
            if process.returncode is None:
                process.kill()
                await process.wait()

    async def start(self, part: str, *options: str) -> None:
        """Start a part anew; `engine`, the engine of one robot of the team (`engine Leo`), or a node."""
        name, _, one = part.partition(" ")
        driven = [] if not self.robot else ["--robot", ROBOT, "--class", self.robot]
        words = {
            "router": ["node", "router"],
            "simulator": ["robot", "simulate", "--world", "nursing-home", "--speed", self.speed],
            "engine": ["engine", "--world", "nursing-home", *driven, "--data", str(self.folder / "engine")],
            "agents": ["node", "agents", "--data", str(self.folder / "agents")],
            "web": ["node", "web", "--no-open", "--port", str(self.port), "--data", str(self.folder / "web")],
        }[name]
        if one:
            words = ["engine", "--world", "fleet", "--robot", one, "--data", str(self.folder / part)]
        settings = self.door if part == "simulator" else self.settings
        if part == "engine" and self.beside is not None:
            settings = self.beside
        self.processes[part] = await asyncio.create_subprocess_exec(
            sys.executable, "-m", "parley", *words, "--config", str(settings), *options,
            stdout=asyncio.subprocess.DEVNULL,
        )  # fmt: skip

    async def kill(self, part: str) -> None:
        """Without a goodbye."""
        self.processes[part].kill()
        await self.processes[part].wait()

    def freeze(self, part: str) -> None:
        """It hangs from now on."""
        self.processes[part].send_signal(signal.SIGSTOP)

    def thaw(self, part: str) -> None:
        """It goes on."""
        self.processes[part].send_signal(signal.SIGCONT)

    async def until_met(self, robot: str = ROBOT) -> None:
        """Wait until those who plan know the robot."""
        known = "{}"
        async with asyncio.timeout(60.0):
            while known == "{}":
                await asyncio.sleep(0.1)
                with contextlib.suppress(TransportError):
                    asked = ChatRequest(encode(GetMap(robot=robot)))
                    known = (await self.transport.call(topics.GET_MAP, asked, timeout_s=5.0)).response
            await self.settled()

    async def settled(self) -> None:
        """Wait until everybody has heard how the robot fares now: it says so every second."""
        for _ in range(2):
            self.beat.clear()
            async with asyncio.timeout(10.0):
                await self.beat.wait()

    def begun(self, action: str) -> int:
        """How often an action began."""
        return sum(
            event.kind == "node"
            and event.state == "RUNNING"
            and event.cause not in ("resume", "restore")
            and event.node.startswith(action)
            for event in self.operator.events
        )

    def heard(self, text: str) -> bool:
        """Whether a robot said something of this kind."""
        return any(text in said.message for said in self.operator.said)


@asynccontextmanager
async def parts(
    folder: Path,
    *names: str,
    speed: str = "1",
    beside: bool = False,
    driver: bool = False,
    settings_text: str = "",
) -> AsyncIterator[Parts]:
    """These parts, up and running; where a router is among them, all meet there and nowhere else.

    Args:
        folder: Where they keep things.
        names: Which.
        speed: Of a simulator that is a part.
        beside: Whether engine and simulator hear each other without the router, and each other only.
        driver: Whether the robot is not behind Nav2: a driver in the engine's process sends it velocities.
        settings_text: What all have in their settings besides.
    """
    at = f"tcp/127.0.0.1:{free_port()}"
    # The operator is the one whom all others connect to, as it is the one who stays.
    role, settings = "client" if "router" in names else "peer", folder / "parley.yaml"
    network = NetworkSettings(domain=DOMAIN, role=role, connect=(at,), interface="")
    settings.write_text(
        f"network: {{domain: {DOMAIN}, role: {role}, connect: [{at}], interface: ''}}\n{settings_text}",
        encoding="utf-8",
    )
    seen = f"tcp/127.0.0.1:{free_port()}"
    robot = _robot(folder, seen, "" if beside else at, driver=driver) if "simulator" in names else ""
    eye = NetworkSettings(domain=DOMAIN, role="client", connect=(seen,), interface="")
    made = Parts(folder, settings, free_port(), robot, folder / "door.yaml", eye, speed)
    if beside:
        made.beside = folder / "beside.yaml"
        made.beside.write_text(
            f"network: {{domain: {DOMAIN}, connect: [{at}, {seen}], interface: ''}}\n{settings_text}",
            encoding="utf-8",
        )
    async with AsyncExitStack() as stack:
        stack.push_async_callback(made.end)
        for name in (name for name in names if name in ("router", "simulator")):
            await made.start(name)
            await until_open(at if name == "router" else seen)
        if "router" not in names:
            network = NetworkSettings(domain=DOMAIN, listen=(at,), interface="")
        made.transport = await stack.enter_async_context(transport_of(SystemConfig(network=network)))
        made.operator = await stack.enter_async_context(Observer(made.transport, WallClock(), print))
        await made.transport.subscribe(topics.ACTOR_STATUS, made.on_status)
        for name in names:
            if name not in made.processes:
                await made.start(name)
        robots = [ROBOT] if "engine" in names else [name[7:] for name in names if name[:7] == "engine "]
        for robot_name in robots:
            await made.operator.until(lambda name=robot_name: name in made.operator.robots)  # type: ignore[misc]
        if "agents" in names:
            for robot_name in robots or [ROBOT]:
                await made.until_met(robot_name)
        yield made


def _robot(folder: Path, seen: str, at: str, *, driver: bool) -> str:
    """Write what a robot is like that is another process, and its door; where that is."""
    (folder / "door.yaml").write_text(
        f"network: {{domain: {DOMAIN}, listen: [{seen}], interface: '', connect: [{at}]}}\n", encoding="utf-8"
    )
    (folder / "robot.yaml").write_text(ROBOT_FILE, encoding="utf-8")
    text = DRIVER_FILE.replace("DOMAIN", str(DOMAIN)).replace("BASE", seen)
    (folder / "driver.py").write_text(text, encoding="utf-8")
    return f"{folder / 'driver.py'}:Driver" if driver else str(folder / "robot.yaml")


async def until_open(address: str) -> None:
    """Wait until somebody listens there."""
    host, _, port = address.partition("/")[2].rpartition(":")
    async with asyncio.timeout(60):
        while True:
            with contextlib.suppress(OSError):
                _, writer = await asyncio.open_connection(host, int(port))
                writer.close()
                return
            await asyncio.sleep(0.05)
