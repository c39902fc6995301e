"""What the doctor finds at a robot with ROS, over real networks; the simulated one stands in for it."""

from __future__ import annotations

import asyncio
import sys
from collections.abc import AsyncIterator
from contextlib import AsyncExitStack, asynccontextmanager
from dataclasses import replace
from pathlib import Path

import pytest
import zenoh

from parley.clock import SimClock, WallClock
from parley.config import NetworkSettings
from parley.findings import Finding
from parley.messages import ros_robot
from parley.messages.topics import QoS, Service
from parley.robot_check import examine_robot, examine_time
from parley.robots.nav2 import Nav2Robot, Nav2Setup
from parley.robots.nav2_simulated import SimulatedNav2
from parley.robots.ros_file import RosRobotFile
from parley.robots.ros_senses import RosTopics
from parley.sim.simulator import Simulator
from parley.transport.base import Endpoint, Transport
from parley.transport.rosbridge import RosbridgeServer, RosbridgeTransport, rosapi
from parley.transport.rosbridge.rosapi import GET_PARAM, GetParamRequest, GetParamResponse
from parley.transport.zenoh import ZenohTransport
from parley.transport.zenoh.keys import Node
from parley.transport.zenoh.session import config
from tests.sim.worlds import two_rooms
from tests.transport.backends import free_port, until

TOPICS = RosTopics(namespace="A", emergency="e_stop")


class Ahead(WallClock):
    """Of a machine that nobody set."""

    def unix_ms(self) -> int:
        return super().unix_ms() + 3_600_000


@asynccontextmanager
async def robot(
    kind: str,
) -> AsyncIterator[tuple[SimulatedNav2, Transport, RosRobotFile, NetworkSettings | None]]:
    async with AsyncExitStack() as stack:
        file, network = RosRobotFile(topics=TOPICS), None
        far: Transport
        if kind == "rosbridge":
            bridge = await stack.enter_async_context(RosbridgeServer())
            far = await stack.enter_async_context(RosbridgeTransport(bridge.address))
            file = file.model_copy(update={"address": bridge.address})
        else:
            at = (f"tcp/127.0.0.1:{free_port()}",)
            far = await stack.enter_async_context(
                ZenohTransport(NetworkSettings(role="router", listen=at, interface=""))
            )
            network = NetworkSettings(role="client", connect=at, interface="")
        simulator = await stack.enter_async_context(Simulator(two_rooms(), clock=SimClock()))
        nav2 = await stack.enter_async_context(SimulatedNav2(simulator, "A", far, topics=TOPICS))
        yield nav2, far, file, network


@pytest.fixture(autouse=True)
def impatient(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("parley.robot_check.LISTENS_S", 1.5)


async def found(file: RosRobotFile, network: NetworkSettings | None) -> dict[str, Finding]:
    told = await asyncio.to_thread(lambda: list(examine_robot(file, "A", network)))
    return {finding.subject: finding for finding in told}


@pytest.mark.parametrize("kind", ["rosbridge", "zenoh"])
async def test_a_robot_that_has_everything_is_found_well(kind: str) -> None:
    async with robot(kind) as (_, _, file, network):
        seen = await found(file, network)
    states = {subject: finding.state for subject, finding in seen.items()}
    assert states == dict.fromkeys(
        ("discovery", "odometry", "TF", "clocks", "map", "scan", "camera", "Nav2", "velocities", "lock"), "ok"
    ) | {"button": "unused"}
    assert "is active" in seen["Nav2"].text
    assert not any(finding.hinders for finding in seen.values())


async def test_each_thing_that_is_wrong_is_said_with_how_to_mend_it() -> None:
    async with robot("zenoh") as (nav2, far, file, network):
        nav2.lifecycle = ros_robot.LifecycleState(2, "inactive")
        nav2._clock = Ahead()
        nav2.press(True)
        stamped = far.subscribe(TOPICS.topic("other", ros_robot.TwistStamped), lambda _: None)
        await stamped
        wrong = replace(TOPICS, base_frame="base_footprint", hold="lock", cmd_vel="other", amcl_pose="")
        seen = await found(file.model_copy(update={"topics": wrong}), network)
    assert {"odometry": "ok", "velocities": "ok"}.items() <= {s: f.state for s, f in seen.items()}.items()
    for subject, text, mend in (
        (
            "TF",
            "nobody tells where base_footprint is; frames that are told: base_link, map",
            "base_frame",
        ),
        ("clocks", "+3600.", "NTP|chrony"),
        ("Nav2", "bt_navigator is inactive, not active", "ros2 lifecycle get /A/bt_navigator"),
        ("lock", "nobody listens on /A/lock", "twist_mux"),
        ("button", "pressed", "Pull it out"),
    ):
        assert seen[subject].state == "wrong", subject
        assert seen[subject].hinders, subject
        assert text in seen[subject].text
        assert any(word in seen[subject].remedy for word in mend.split("|")), seen[subject]


async def test_names_that_differ_are_found_and_named() -> None:
    async with robot("zenoh") as (_, _, file, network):
        wrong = replace(TOPICS, odom="odometry", cmd_vel="cmd_vel_nav", map_frame="world", amcl_pose="")
        wrong = replace(wrong, scan="laser", camera="eye/compressed")
        seen = await found(file.model_copy(update={"topics": wrong, "action": "drive"}), network)
    assert "told on /A/odom: write that under topics, as `odom`" in seen["odometry"].remedy
    assert "base_link is known in map, and nobody tells where map is in world" in seen["TF"].text
    assert seen["velocities"].text == "nobody listens on /A/cmd_vel_nav"
    assert (seen["scan"].text, seen["scan"].state) == ("nobody tells it on /A/laser", "missing")
    assert "told on /A/scan: write that under topics, as `scan`" in seen["scan"].remedy
    assert "told on /A/camera/image_raw/compressed" in seen["camera"].remedy
    assert seen["Nav2"].remedy == "Actions that are there: /A/navigate_to_pose; write one as `action`."


async def test_what_is_there_and_silent_is_not_sent_to_where_it_is() -> None:
    async with robot("zenoh") as (_, far, file, network):
        silent = replace(TOPICS, odom="mute")
        far.publisher(TOPICS.topic("mute", ros_robot.Odometry))
        seen = await found(file.model_copy(update={"topics": silent}), network)
    assert (seen["odometry"].state, "nothing on /A/mute" in seen["odometry"].text) == ("wrong", True)
    assert "nothing comes" in seen["odometry"].remedy


async def test_a_base_of_which_nobody_knows_what_it_takes_is_told() -> None:
    async with robot("zenoh") as (_, _, file, network):
        assert network is not None
        ours = Nav2Robot("A", lambda: ZenohTransport(network), Nav2Setup(topics=TOPICS))
        await ours.open()
        assert ours.trouble() == ""
        with zenoh.open(config(network)) as other:
            end = Endpoint("/A/cmd_vel", "geometry_msgs/msg/TwistStamped", "subscription")
            token = Node(0, str(other.zid()), "other").end_token(1, end, "RIHS01_x", QoS())
            with other.liveliness().declare_token(token):
                await until(lambda: ours.trouble() == "misset")
                seen = await found(file, network)
        await until(lambda: ours.trouble() == "")
        ours.close()
    assert seen["velocities"].state == "wrong"
    assert "some listen for Twist and some for TwistStamped" in seen["velocities"].text
    assert "use_stamped" in seen["velocities"].remedy


@pytest.mark.parametrize("at_once", [False, True])
async def test_a_bridge_that_does_one_thing_after_the_other_is_told(*, at_once: bool) -> None:
    async def values(request: GetParamRequest) -> GetParamResponse:
        goals = request.name == "/rosbridge_websocket:send_action_goals_in_new_thread"
        return GetParamResponse("true" if at_once or not goals else "false")

    async with robot("rosbridge") as (_, far, file, network):
        own = Service("/rosbridge_websocket/get_parameters", GetParamRequest, GetParamResponse, "a/srv/B")
        await far.serve(own, values)
        await far.serve(GET_PARAM, values)
        seen = await found(file, network)
    if at_once:
        assert "bridge" not in seen
    else:
        assert seen["bridge"].state == "wrong"
        assert "send_action_goals_in_new_thread:=true" in seen["bridge"].remedy


async def test_of_a_bridge_that_does_not_tell_who_is_there_nothing_is_said_of_who_listens(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    async with robot("rosbridge") as (_, _, file, network):
        monkeypatch.setattr("parley.transport.rosbridge.census.TOPICS", replace(rosapi.TOPICS, name="/none"))
        seen = await found(file, network)
    assert (seen["discovery"].state, seen["odometry"].state) == ("missing", "ok")
    assert not {"Nav2", "velocities", "lock"} & set(seen)


async def test_a_robot_out_of_reach_is_told_with_how_to_reach_it() -> None:
    away = RosRobotFile(address=f"ws://127.0.0.1:{free_port()}")
    seen = await found(away, None)
    assert seen["robot"].state == "wrong"
    assert "rosbridge_websocket_launch.xml" in seen["robot"].remedy
    seen = await found(RosRobotFile(), NetworkSettings(interface=""))
    assert (seen["discovery"].state, "ROS_DOMAIN_ID" in seen["discovery"].remedy) == ("missing", True)


@pytest.mark.parametrize(
    ("says", "state"),
    [("A,1,1,Normal", "ok"), ("A,0,0,Not synchronised", "wrong"), (None, "unused")],
)
def test_whether_this_clock_is_set_by_others(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, says: str | None, state: str
) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    if says is not None:
        program = tmp_path / "chronyc"
        program.write_text(f"#!{sys.executable}\nprint({says!r})\n", encoding="utf-8")
        program.chmod(0o755)
    assert examine_time(tmp_path / "synchronized").state == state
    (tmp_path / "synchronized").touch()
    assert examine_time(tmp_path / "synchronized").state == "ok"
