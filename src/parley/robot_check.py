"""What `parley doctor --robot` finds at a robot with ROS: whether it tells and takes what Parley needs."""

from __future__ import annotations

import asyncio
import subprocess
from collections.abc import Callable, Iterable, Iterator
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import Any, Final

from parley.clock import WallClock
from parley.config import NetworkSettings, SystemConfig
from parley.errors import MissingExtraError, TransportError, UnavailableError
from parley.extras import needs
from parley.findings import Finding
from parley.messages import ros_robot
from parley.messages.ros import Time
from parley.network import transport_of
from parley.network_check import START_BRIDGE
from parley.robots.ros_file import RosRobotFile
from parley.robots.ros_senses import RosTopics, velocities_heard
from parley.robots.ros_values import Frames
from parley.transport.base import Endpoint, Transport, absolute

__all__ = ["examine_robot", "examine_time"]

LISTENS_S: Final = 4.0
"""A bridge is asked every 2 s who is there."""
ASKS_S: Final = 2.0
STALE_S: Final = 1.0
APART_S: Final = 1.0
"""Clocks that differ by less do no harm."""
_LONG_AGO_S: Final = 1e9
"""No clock of the wall shows so few seconds since 1970: it is a simulated one."""
_NETWORK: Final = "Look at `network` of the settings (--config): what is said of it above has to be ok first."
_AT_ONCE: Final = "call_services_in_new_thread", "send_action_goals_in_new_thread"
_SILENT: Final = (
    "Somebody would tell it there, and nothing comes: look whether it does (ros2 topic hz), and into the log "
    "of rosbridge, which needs the packages with the robot's messages."
)
_LOCK: Final = "Give twist_mux the lock of examples/twist_mux.yaml."
_NTP: Final = "Let both set their clocks by the network, e.g. with chrony (`chronyc makestep`)."


def examine_robot(file: RosRobotFile, name: str, network: NetworkSettings | None) -> Iterable[Finding]:
    """Listen to a robot for some seconds; nothing is sent to it.

    Args:
        file: What it is like.
        name: How people call it.
        network: Where it is, if it has no address of its own.

    Returns:
        What it tells and takes; what is wrong or missing of the whole hinders: it could not be driven so.
    """
    for finding in _examined(file, name, network):
        hinders = finding.state == "wrong" or finding.subject == "robot"
        yield replace(finding, needed=hinders)


def _examined(file: RosRobotFile, name: str, network: NetworkSettings | None) -> Iterable[Finding]:
    try:
        transport = _transport(file, network)
        yield from asyncio.run(_Look(file, name).through(transport))
    except MissingExtraError as missing:
        yield Finding("robot", "missing", f"{missing.what} is not installed.", missing.remedy)
    except (TransportError, OSError) as error:
        yield Finding(
            "robot", "wrong", f"{name} is out of reach: {error}", START_BRIDGE if file.address else _NETWORK
        )


def _transport(file: RosRobotFile, network: NetworkSettings | None) -> Transport:
    if file.address:
        with needs("rosbridge"):
            from parley.transport.rosbridge import RosbridgeTransport
        return RosbridgeTransport(file.address, ros=1 if file.kind == "ros1" else 2)
    if network is None:
        raise UnavailableError("it has no address, and the settings name no network on which it could be")
    return transport_of(SystemConfig(network=network), node="parley_doctor", release=file.release)


class _Look:
    """One look at one robot."""

    def __init__(self, file: RosRobotFile, name: str) -> None:
        self._file, self._name, self._clock = file, name, WallClock()
        space = file.topics.namespace.replace("{name}", name)
        self._topics: RosTopics = replace(file.topics, namespace=space)
        self._frames = Frames()
        self._heard: dict[str, Any] = {}
        """Topic -> the newest word there."""
        self._heard_s: dict[str, float] = {}
        self._apart_s: float | None = None
        self._ends: list[Endpoint] = []
        self._news = asyncio.Event()
        """Something was heard, or somebody came or went."""

    async def through(self, transport: Transport) -> list[Finding]:
        """All that is found over this transport."""
        topics = self._topics
        listened = {topics.tf, topics.tf_static, topics.odom, topics.amcl_pose, topics.map, topics.emergency}
        async with transport:
            for name, kind, qos in topics.told():
                if name in listened:
                    for topic in topics.heard(name, kind, qos):
                        await transport.subscribe(topic, self._hears(name))
            stop = transport.on_endpoints_changed(lambda: self._look(transport))
            self._look(transport)
            with suppress(TimeoutError):
                async with asyncio.timeout(LISTENS_S):
                    while not self._is_whole():
                        self._news.clear()
                        await self._news.wait()
            stop()
            seen = self._discovery()
            listeners = [] if seen.state == "missing" else [
                *await self._bridge(transport), *await self._navigation(transport),
                self._velocities(), self._lock(),
            ]  # fmt: skip
        if seen.state == "missing" and not self._heard:
            return [seen]
        return [
            seen, self._odometry(), self._place(), *self._clocks(), *self._map(), *self._senses(),
            *listeners, *self._button(),
        ]  # fmt: skip

    def _look(self, transport: Transport) -> None:
        self._ends = [end for end in transport.endpoints() if end.elsewhere]
        self._news.set()

    def _is_whole(self) -> bool:
        """Whether nothing more is waited for."""
        topics = self._topics
        told = {topics.odom, topics.map} - {""} <= self._heard.keys()
        return (
            told
            and self._place().state == "ok"
            and self._takes_goals()
            and all(self._listeners(name) for name in (topics.cmd_vel, topics.hold))
        )

    def _hears(self, name: str) -> Callable[[Any], None]:
        def hear(message: Any) -> None:
            self._heard[name], self._heard_s[name] = message, self._clock.wall_s()
            if isinstance(message, ros_robot.TFMessage):
                self._frames.learn(message)
            elif name == self._topics.odom:
                self._apart_s = _seconds(message.header.stamp) - self._clock.unix_ms() / 1000
            self._news.set()

        return hear

    def _at(self, name: str) -> str:
        return absolute(self._topics.name(name))

    def _told_elsewhere(self, ros_type: str, setting: str, at: str) -> str:
        """Where else somebody tells that, as a remedy."""
        there = sorted(
            {end.name for end in self._ends if end.role == "publisher" and end.ros_type == ros_type}
        )
        if at in there:
            return _SILENT
        if not there:
            return "Start the robot's driver, or look at its namespace and domain."
        return (
            f"It is told on {', '.join(there)}: write that under topics, as `{setting}`, or set `namespace`."
        )

    # -- one thing each ------------------------------------------------------------------------------------

    def _discovery(self) -> Finding:
        if self._ends:
            names = len({end.name for end in self._ends})
            return Finding(
                "discovery", "ok", f"{names} topics and services of {self._name} and others are seen"
            )
        if self._file.address:
            text = (
                "the bridge answers, and does not tell who is there, nor who takes goals and velocities: its "
                "rosapi does not run"
            )
            return Finding(
                "discovery", "missing", text, "Start the launch file of rosbridge, which starts both."
            )
        mend = "All need one domain (ROS_DOMAIN_ID), RMW and network; multicast must pass, or name `connect`."
        return Finding("discovery", "missing", "nobody is seen on the network", mend)

    def _odometry(self) -> Finding:
        at = self._at(self._topics.odom)
        if self._topics.odom in self._heard:
            return Finding("odometry", "ok", f"told on {at}")
        text = f"nothing on {at} in {LISTENS_S:g} s, so that the robot counts as gone"
        return Finding("odometry", "wrong", text, self._told_elsewhere("nav_msgs/msg/Odometry", "odom", at))

    def _place(self) -> Finding:
        """Where it is on the map, by frames or by its localisation."""
        base, wanted, topics = self._topics.base_frame, self._topics.map_frame, self._topics
        if self._frames.find(base, wanted) is not None:
            old_s = self._clock.wall_s() - self._heard_s.get(topics.tf, float("-inf"))
            if old_s <= STALE_S or topics.tf not in self._heard:
                return Finding("TF", "ok", f"{wanted} to {base} is known")
            text = f"{wanted} to {base} was told {old_s:.1f} s ago, and no more since"
            return Finding("TF", "wrong", text, "Look whether localisation and driver still run.")
        if topics.amcl_pose in self._heard:
            return Finding("TF", "ok", f"not known; the place is told on {self._at(topics.amcl_pose)}")
        chain = self._frames.chain(base)
        if len(chain) > 1:
            text = f"{base} is known in {chain[-1]}, and nobody tells where {chain[-1]} is in {wanted}"
            return Finding(
                "TF", "wrong", text, "Start localisation (AMCL), and tell it where the robot stands."
            )
        known = ", ".join(sorted(self._frames.names)) or "none"
        text = f"nobody tells where {base} is; frames that are told: {known}"
        mend = "Write `base_frame` and `map_frame` as the robot calls them, or start its localisation."
        return Finding("TF", "wrong", text, mend)

    def _clocks(self) -> Iterator[Finding]:
        apart_s = self._apart_s
        if apart_s is None:
            return
        if _seconds(self._heard[self._topics.odom].header.stamp) < _LONG_AGO_S:
            text = "the robot tells simulated time, or none: how its clock stands to this one is not known"
            yield Finding("clocks", "unused", text)
        elif abs(apart_s) > APART_S:
            yield Finding("clocks", "wrong", f"the robot's clock is {apart_s:+.1f} s from this one", _NTP)
        else:
            yield Finding("clocks", "ok", f"the robot's clock is {apart_s:+.2f} s from this one")

    def _map(self) -> Iterator[Finding]:
        if self._topics.map:
            at = self._at(self._topics.map)
            if self._topics.map in self._heard:
                yield Finding("map", "ok", f"told on {at}")
            else:
                text = f"none on {at}: one has to come with the place (--world)"
                yield Finding(
                    "map", "unused", text, self._told_elsewhere("nav_msgs/msg/OccupancyGrid", "map", at)
                )

    def _senses(self) -> Iterator[Finding]:
        """Whether somebody would tell what is listened to only when it is wanted."""
        topics = self._topics
        kinds = {name: topics.topic(name, kind, qos).ros_type for name, kind, qos in topics.told()}
        for setting, name in (
            ("scan", topics.scan), ("camera", topics.camera), ("detections", topics.detections),
        ):  # fmt: skip
            if not name or not self._ends:
                continue
            at = self._at(name)
            if any(end.role == "publisher" and end.name == at for end in self._ends):
                yield Finding(setting, "ok", f"told on {at}")
                continue
            mend = self._told_elsewhere(kinds[name], setting, at)
            mend = f'{mend} If it has none: {setting}: ""'
            yield Finding(setting, "missing", f"nobody tells it on {at}", mend)

    async def _bridge(self, transport: Transport) -> list[Finding]:
        """Whether a bridge does several things at once; only a robot's own, and only one of ROS 2 says so."""
        if not self._file.address:
            return []
        from parley.transport.rosbridge.census import BRIDGE
        from parley.transport.rosbridge.rosapi import GET_PARAM, GetParamRequest

        if not any(end.name == f"{BRIDGE}/get_parameters" and end.role == "server" for end in self._ends):
            return []

        off: list[str] = []
        for option in _AT_ONCE:
            with suppress(TransportError):
                asked = GetParamRequest(f"{BRIDGE}:{option}")
                if (await transport.call(GET_PARAM, asked, timeout_s=ASKS_S)).value == "false":
                    off.append(option)
        text = f"without {' and '.join(off)} a call or drive keeps all else back, and the lock shuts"
        return [Finding("bridge", "wrong", text, START_BRIDGE)] if off else []

    @property
    def _action(self) -> str:
        return self._file.action or ("move_base" if self._file.kind == "ros1" else "navigate_to_pose")

    def _takes_goals(self) -> bool:
        at = self._at(self._action)
        role, name = (
            ("subscription", "goal") if self._file.kind == "ros1" else ("server", "_action/send_goal")
        )
        return any(end.role == role and end.name == f"{at}/{name}" for end in self._ends)

    async def _navigation(self, transport: Transport) -> list[Finding]:
        """Whether something takes goals, and is ready to."""
        ros1 = self._file.kind == "ros1"
        what, at = ("move_base" if ros1 else "Nav2"), self._at(self._action)
        there = self._takes_goals()
        if not there:
            others = sorted(
                end.name.removesuffix("/_action/send_goal")
                for end in self._ends
                if end.role == "server" and end.name.endswith("/_action/send_goal")
            )
            mend = f"Actions that are there: {', '.join(others)}; write one as `action`." if others else (
                f"Start {what} on the robot, or look at its namespace."
            )  # fmt: skip
            return [Finding(what, "wrong", f"nobody takes goals on {at}", mend)]
        if ros1:
            return [Finding(what, "ok", f"takes goals on {at}")]
        node = self._topics.name(ros_robot.NAVIGATOR)
        try:
            answer = await transport.call(
                ros_robot.get_state(node), ros_robot.GetStateRequest(), timeout_s=ASKS_S
            )
        except TransportError:
            return [Finding(what, "ok", f"takes goals on {at}; {node} does not say how far it is")]
        state = answer.current_state
        if state.id == ros_robot.ACTIVE.id:
            return [Finding(what, "ok", f"takes goals on {at}, and is active")]
        text = f"{node} is {state.label or state.id}, not active: it refuses goals"
        mend = f"See on the robot: ros2 lifecycle get {absolute(node)}; its manager logs what failed."
        return [Finding(what, "wrong", text, mend)]

    def _listeners(self, name: str) -> list[Endpoint]:
        at = self._at(name)
        return [end for end in self._ends if end.role == "subscription" and end.name == at]

    def _velocities(self) -> Finding:
        at = self._at(self._topics.cmd_vel)
        if not self._listeners(self._topics.cmd_vel):
            mend = "Let the base, or twist_mux before it, listen there; or write its topic as `cmd_vel`."
            return Finding("velocities", "wrong", f"nobody listens on {at}", mend)
        if len(velocities_heard(self._topics, self._ends)) > 1:
            text = f"on {at} some listen for Twist and some for TwistStamped, so that it gets none"
            mend = "Let all there take the same (twist_mux: `use_stamped`), or give the others another topic."
            return Finding("velocities", "wrong", text, mend)
        return Finding("velocities", "ok", f"the base listens on {at}")

    def _lock(self) -> Finding:
        at = self._at(self._topics.hold)
        if self._listeners(self._topics.hold):
            return Finding("lock", "ok", f"somebody listens on {at}")
        text = f"nobody listens on {at}: {self._name} would drive on when this program or the network dies"
        return Finding("lock", "wrong", text, _LOCK)

    def _button(self) -> Iterator[Finding]:
        name = self._topics.emergency
        if not name:
            yield Finding("button", "unused", "no topic is named for a stop button on it (`emergency`)")
        elif name not in self._heard:
            text = f"nothing on {self._at(name)} yet; many tell it only when it is pressed"
            yield Finding("button", "unused", text)
        else:
            pressed = self._heard[name].data
            yield Finding("button", "wrong" if pressed else "ok", "pressed" if pressed else "not pressed",
                          "Pull it out when it is safe." if pressed else "")  # fmt: skip


def _seconds(stamp: Time) -> float:
    return stamp.sec + stamp.nanosec / 1e9


def examine_time(synchronised: Path = Path("/run/systemd/timesync/synchronized")) -> Finding:
    """Whether this machine sets its clock by others.

    Args:
        synchronised: A file that is there once systemd has set the clock.
    """
    if synchronised.exists():
        return Finding("time sync", "ok", "systemd sets this clock by the network")
    for command, good in ((("chronyc", "-c", "tracking"), _chrony), (("ntpq", "-pn"), _ntpq)):
        with suppress(OSError, subprocess.SubprocessError):
            told = subprocess.run(command, capture_output=True, text=True, timeout=ASKS_S, check=True).stdout
            if good(told):
                return Finding("time sync", "ok", f"{command[0]} says that this clock is set by others")
            text = f"{command[0]} runs, and has nobody to set this clock by"
            return Finding("time sync", "wrong", text, "Look whether its servers are within reach.")
    text = "not known: neither systemd-timesyncd nor chrony nor ntpd answers here"
    return Finding(
        "time sync", "unused", text, "Robots and this machine need one time: sudo apt install chrony."
    )


def _chrony(told: str) -> bool:
    """Its columns end with how the leap second stands."""
    return bool(told.strip()) and not told.strip().endswith("Not synchronised")


def _ntpq(told: str) -> bool:
    """The server that is followed has a star."""
    return any(line.startswith("*") for line in told.splitlines())
