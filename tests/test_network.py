"""A system whose parts are in several processes: robots in one, the operator in another."""

from __future__ import annotations

import asyncio
import json
import signal
import sys
from collections.abc import Callable
from contextlib import AsyncExitStack
from pathlib import Path

import pytest
from typer.testing import CliRunner

from parley.cli import command_line
from parley.cli.node import run_system
from parley.cli.robot import EMPTY_FLOOR
from parley.clock import WallClock
from parley.config import NetworkSettings, SystemConfig, UserSettings
from parley.demos.observer import Observer
from parley.errors import ConfigError, FileFormatError, UnavailableError
from parley.messages import topics
from parley.messages.principal import person
from parley.messages.ros import ChatRequest, ChatResponse, UmrfGraphStart
from parley.messages.status import ActorStatus, StopCommand
from parley.messages.wire import to_string
from parley.network import transport_of
from parley.network_check import examine_network
from parley.robots.base import Velocity
from parley.robots.own import RobotBase
from parley.sim.world_file import WorldFile
from parley.system import System
from parley.transport.local import LocalTransport
from parley.web.backend import Backend
from parley.web.config import WebConfig
from parley.world.geometry import Pose2D
from tests.transport.backends import free_port, until
from tests.umrf.spec_actions import planner_chain


def test_without_a_network_everything_is_in_one_process() -> None:
    assert isinstance(transport_of(SystemConfig()), LocalTransport)


def test_a_part_of_its_own_needs_a_network(tmp_path: Path) -> None:
    (tmp_path / "parley.yaml").write_text("language: builtin\n", encoding="utf-8")
    for part in ("terminal", "web"):
        result = CliRunner().invoke(command_line(), ["node", part, "--config", str(tmp_path / "parley.yaml")])
        assert isinstance(result.exception, ConfigError)
        assert "names no network" in str(result.exception)


async def test_robots_of_another_process_are_talked_to_and_stopped(tmp_path: Path) -> None:
    at = f"tcp/127.0.0.1:{free_port()}"
    settings = tmp_path / "parley.yaml"
    settings.write_text(f"network: {{listen: [{at}], interface: ''}}\n", encoding="utf-8")
    robots = await asyncio.create_subprocess_exec(
        sys.executable, "-m", "parley", "demo", "nursing-home", "--robots", "David", "--no-open",
        "--port", "0", "--config", str(settings), "--data", str(tmp_path / "data"),
        stdout=asyncio.subprocess.DEVNULL,
    )  # fmt: skip
    network = NetworkSettings(listen=(), connect=(at,), interface="")
    try:
        async with (
            transport_of(SystemConfig(network=network)) as transport,
            Observer(transport, WallClock()) as operator,
        ):
            await operator.until(lambda: bool(operator.robots))
            (robot,) = operator.robots
            operator.say("go to the kitchen", robot)
            await operator.until(lambda: operator.state(robot) == "running")
            stop = StopCommand(id="now", by=person())
            transport.publisher(topics.STOP).publish(to_string(stop))

            def told() -> list[str]:
                return [report.state for report in operator.stop_reports if report.id == "now"]

            await operator.until(lambda: "at_rest" in told())
            assert told()[0] == "received"
            await operator.until(lambda: operator.state(robot) == "paused")

            robots.kill()
            await until(lambda: all("umrf_graph_start" not in end.name for end in transport.endpoints()))
    finally:
        if robots.returncode is None:
            robots.send_signal(signal.SIGKILL)
        await robots.wait()


async def test_a_release_that_is_pressed_while_the_robot_is_out_of_reach_arrives(tmp_path: Path) -> None:
    at = f"tcp/127.0.0.1:{free_port()}"
    between = NetworkSettings(role="router", listen=(at,), interface="")
    settings = SystemConfig(network=NetworkSettings(role="client", connect=(at,), interface="", silence_s=1))

    async with AsyncExitStack() as stack:
        router = transport_of(SystemConfig(network=between))
        await router.__aenter__()
        floor = WorldFile.parse(EMPTY_FLOOR)
        robots = await stack.enter_async_context(System(floor, settings, part="robots"))
        page = await stack.enter_async_context(transport_of(settings))
        backend = await stack.enter_async_context(Backend(page, WebConfig(data_dir=tmp_path)))
        views = backend.state.robots.views
        await until(lambda: "Kim" in views and views["Kim"].connection == "here")
        backend.stopper.stop((), by=person(), id="stop")
        await until(lambda: views["Kim"].stop.state == "at_rest")
        await router.__aexit__(None, None, None)
        await until(lambda: not any(end.elsewhere for end in page.endpoints()))
        await until(lambda: views["Kim"].connection != "here")  # what was under way has come, or is lost
        assert backend.stopper.reset(("Kim",), by=person(), id="release") == ""
        await until(lambda: views["Kim"].stop.release == "sent")
        assert robots.stop_line.latched("Kim")
        await stack.enter_async_context(transport_of(SystemConfig(network=between)))
        await until(lambda: not robots.stop_line.latched("Kim"), within_s=20)
        await until(lambda: views["Kim"].stop.state == "none")


class Cart(RobotBase):
    """One that knows whether anybody has opened it."""

    opened = False

    async def open(self) -> None:
        self.opened = True

    def pose(self) -> Pose2D:
        return Pose2D(1.0, 1.0)

    def velocity(self) -> Velocity:
        return Velocity()

    def send(self, velocity: Velocity) -> None: ...


async def test_a_robot_that_another_engine_drives_is_not_touched() -> None:
    first, second = Cart("Kim"), Cart("Kim")
    async with LocalTransport() as transport:
        one, other = (
            System(None, SystemConfig(), robots=[cart], part="robots", transport=transport)
            for cart in (first, second)
        )
        async with one:
            with pytest.raises(UnavailableError, match="already"):
                await other.__aenter__()
            assert (first.opened, second.opened) == (True, False)


@pytest.mark.parametrize(
    ("foreign", "rules", "ends"),
    [
        (False, "", "what the rules are"),
        (True, "", "FINISHED"),
        (True, "rules: [{id: still, kind: action, actions: [MoveBy], verdict: forbid}]", "must not do"),
    ],
)
async def test_an_engine_moves_under_a_planner_that_tells_no_rules_where_its_settings_say_so(
    tmp_path: Path, foreign: bool, rules: str, ends: str
) -> None:
    settings = SystemConfig(foreign_planner=foreign, rules_file=tmp_path / "rules.yaml")
    (tmp_path / "rules.yaml").write_text(rules or "rules: []", encoding="utf-8")
    told: list[str] = []
    async with LocalTransport() as transport:
        floor = WorldFile.parse(EMPTY_FLOOR)
        async with System(floor, settings, part="robots", transport=transport):
            await transport.subscribe(topics.GRAPH_FEEDBACK, lambda heard: told.extend(heard.history))
            step = {
                "name": "MoveBy",
                "instance_id": 0,
                "type": "sync",
                "input_parameters": {
                    "direction": {"pvf_type": "string", "pvf_value": "forward"},
                    "distance": {"pvf_type": "number", "pvf_value": 0.1},
                },
            }
            graph = json.dumps(planner_chain("foreign", [step]))
            transport.publisher(topics.GRAPH_START).publish(UmrfGraphStart("", graph, ("Kim",)))
            await until(lambda: any(ends in text for text in told), within_s=20)


async def test_the_doctor_says_who_is_there_which_address_is_silent_and_whose_clock_is_wrong() -> None:
    at, silent = (f"tcp/127.0.0.1:{free_port()}" for _ in range(2))
    here = NetworkSettings(listen=(at,), interface="")
    async with transport_of(SystemConfig(network=here)) as transport:
        await transport.serve(topics.RULES, _nothing)
        heartbeat = transport.publisher(topics.ACTOR_STATUS)

        def beat() -> None:
            status = ActorStatus(actor="A", unix_ms=WallClock().unix_ms() - 3_600_000)
            heartbeat.publish(to_string(status))

        beats = asyncio.create_task(_every(0.2, beat))
        network = NetworkSettings(listen=(), connect=(at, silent), interface="")
        found = await asyncio.to_thread(lambda: list(examine_network(network)))
        beats.cancel()
    assert [(item.subject, item.state) for item in found] == [
        ("network", "ok"), ("network", "wrong"), ("network", "ok"), ("clocks", "wrong"),
    ]  # fmt: skip
    assert silent in found[1].text
    assert "robots: A; who plans: there" in found[2].text
    assert "-3600 s" in found[3].text, found[3].text


async def test_the_doctor_says_who_is_not_let_in_and_so_does_a_client_that_begins(tmp_path: Path) -> None:
    at = f"tcp/127.0.0.1:{free_port()}"
    for file, text in {"users": "desk:right\n", "right": "right", "wrong": "wrong"}.items():
        (tmp_path / file).write_text(text, encoding="utf-8")
    door = NetworkSettings(listen=(at,), interface="", users=tmp_path / "users")
    async with transport_of(SystemConfig(network=door)):
        for password, state in (("right", "ok"), ("wrong", "wrong"), ("", "wrong")):
            user = UserSettings(name="desk", password_file=tmp_path / password) if password else None
            inside = NetworkSettings(connect=(at,), interface="", user=user)
            found = await asyncio.to_thread(list, examine_network(inside))
            assert (found[0].state, at in found[0].text) == (state, True), password
            assert ("`users`" in found[0].remedy) == (state == "wrong")
        client = inside.model_copy(update={"role": "client"})
        with pytest.raises(UnavailableError, match=f"nobody at {at} answers and lets this in; parley doctor"):
            async with transport_of(SystemConfig(network=client)):
                pass


@pytest.mark.parametrize("let_in", [True, False])
async def test_a_peer_that_is_not_let_in_says_so_and_does_not_say_that_robots_hear_it(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], let_in: bool
) -> None:
    at, silent = (f"tcp/127.0.0.1:{free_port()}" for _ in range(2))
    for file, text in {"users": "desk:right\n", "password": "right" if let_in else "wrong"}.items():
        (tmp_path / file).write_text(text, encoding="utf-8")
    door = NetworkSettings(listen=(at,), interface="", users=tmp_path / "users")
    user = UserSettings(name="desk", password_file=tmp_path / "password")
    peer = NetworkSettings(connect=(at, silent), interface="", user=user)
    shown = ""
    async with transport_of(SystemConfig(network=door)):
        system = System(None, SystemConfig(network=peer, data_dir=tmp_path / "data"), part="agents")
        running = asyncio.create_task(run_system(system))
        while "Ctrl-C" not in shown:
            await asyncio.sleep(0.05)
            out, err = capsys.readouterr()
            shown += out + err
        running.cancel()
        await asyncio.gather(running, return_exceptions=True)
    assert ("Robots can be talked to.\n" in shown) == let_in
    assert (f"{at} answers, and does not let the user 'desk' in. It is tried on." in shown) == (not let_in)
    assert silent not in shown


def test_the_doctor_says_whether_others_can_be_looked_for(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("parley.network_check.LISTENS_S", 0.0)
    monkeypatch.setenv("ROS_DOMAIN_ID", "7")
    for interface, state in (
        ("127.0.0.1", "ok"),
        ("lo", "ok"),
        ("no-such-net", "wrong"),
        ("203.0.113.9", "wrong"),
    ):
        found = {
            item.subject: item for item in examine_network(NetworkSettings(interface=interface, listen=()))
        }
        assert found["discovery"].state == state, found["discovery"]
    assert found["domain"].text == "the settings say domain 0, and ROS_DOMAIN_ID is 7"
    assert "connect" in found["discovery"].remedy


@pytest.mark.parametrize(
    ("networks", "state"), [(["no-such-net", "lo"], "ok"), (["no-such-net"], "wrong"), ([], "wrong")]
)
def test_one_network_without_a_way_out_is_enough(
    monkeypatch: pytest.MonkeyPatch, networks: list[str], state: str
) -> None:
    monkeypatch.setattr("parley.network_check.LISTENS_S", 0.0)
    monkeypatch.setattr("parley.network_check.LOOPBACK", ())
    monkeypatch.setattr("socket.if_nameindex", lambda: list(enumerate(networks)))
    found = [*examine_network(NetworkSettings(interface="auto", listen=()))]
    assert next(item.state for item in found if item.subject == "discovery") == state


async def test_a_network_that_this_machine_is_not_on_is_told_at_once() -> None:
    for interface in ("no-such-net", "203.0.113.9"):
        network = NetworkSettings(interface=interface, listen=())
        with pytest.raises(UnavailableError, match=f"not on {interface} now; its networks: .*lo"):
            async with transport_of(SystemConfig(network=network)):
                pass


@pytest.mark.parametrize(
    ("network", "told"),
    [("{listen: tcp/127.0.0.1:7447}", "a list"), ("{connect: [tcp/robot]}", "a port"),
     ("{listen: ['tcp/0.0.0.0:99999']}", "a port")],
)  # fmt: skip
def test_an_address_that_is_none_is_told_in_the_words_of_the_file(network: str, told: str) -> None:
    with pytest.raises(FileFormatError, match=f"line 1: network.*{told}"):
        SystemConfig.parse(f"network: {network}")


async def _nothing(request: ChatRequest) -> ChatResponse:
    return ChatResponse()


async def _every(seconds: float, do: Callable[[], None]) -> None:
    while True:
        do()
        await asyncio.sleep(seconds)


def test_a_bridge_that_does_not_answer_is_told_with_how_to_start_it() -> None:
    (found,) = examine_network(NetworkSettings(rosbridge=f"ws://127.0.0.1:{free_port()}"))
    assert (found.state, "send_action_goals_in_new_thread:=true" in found.remedy) == ("wrong", True)
    assert "tls" not in found.remedy
