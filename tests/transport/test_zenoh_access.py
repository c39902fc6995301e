"""Rules of access: a robot's own names are its own, orders come from whom they may, the rest is told."""

from __future__ import annotations

import asyncio
import os
import sys
from collections.abc import AsyncIterator, Callable
from contextlib import AsyncExitStack, asynccontextmanager
from pathlib import Path
from typing import Any, Literal

import pytest
import yaml
import zenoh
from typer.testing import CliRunner

from parley.cli import command_line
from parley.cli.robot import EMPTY_FLOOR
from parley.clock import WallClock
from parley.config import NetworkSettings, SystemConfig, UserSettings
from parley.demos.observer import Observer
from parley.errors import ConfigError, FileFormatError, UnavailableError
from parley.messages import topics
from parley.messages.chat import ChatInput
from parley.messages.principal import person
from parley.messages.ros import String, UmrfGraphStop
from parley.messages.ros_robot import Bool
from parley.messages.status import StopCommand
from parley.messages.topics import QoS, Topic
from parley.messages.wire import to_string
from parley.sim.world_file import WorldFile
from parley.system import System
from parley.transport.zenoh import ZenohTransport
from parley.transport.zenoh.access import AccessFile, access_control
from parley.transport.zenoh.denials import Denial, Reader
from parley.transport.zenoh.session import config
from tests.transport.backends import free_port, until
from tests.transport.test_zenoh_tls import files, signed

NAMES = ("router", "ward-pc", "other-pc", "planner", "desk", "door")
ACCESS = """
robots: {ward-pc: [Ada], other-pc: [Kim]}
agents: [planner]
pages: [desk]
programs: {door: {says: [door_state, doors/**]}}
"""
Knows = Literal["users", "certificates"]


class Guarded:
    """A network behind a router that knows who is who."""

    def __init__(self, folder: Path, knows: Knows) -> None:
        self._folder, self._tls, self._users = folder, {}, None
        scheme = "tcp" if knows == "users" else "tls"
        self._at = f"{scheme}/127.0.0.1:{free_port()}"
        if knows == "users":
            self._users = folder / "users.txt"
            self._users.write_text("".join(f"{name}:of {name}\n" for name in NAMES), encoding="utf-8")
        else:
            authority = signed("authority")
            self._tls = {name: files(folder, name, signed(name, authority), authority) for name in NAMES}
        (folder / "access.yaml").write_text(ACCESS, encoding="utf-8")
        self.log = b""

    def network(self, name: str, password: str = "") -> NetworkSettings:
        """As a client, of that name."""
        user = None
        if self._users is not None:
            file = self._folder / f"{name}.password"
            file.write_text(f"{password or f'of {name}'}\n", encoding="utf-8")
            user = UserSettings(name=name, password_file=file)
        return NetworkSettings(
            role="client", connect=(self._at,), interface="", user=user, tls=self._tls.get(name)
        )

    def client(self, name: str) -> ZenohTransport:
        return ZenohTransport(self.network(name), node=name.replace("-", "_"))

    def denied(self, who: str, does: str, what: str) -> bool:
        """Whether the log of the router tells that."""
        lines = self.log.decode().splitlines()
        return any(
            all(part in line for part in ("denied", f"who={who}", f"may_not={does}", f"name={what}"))
            for line in lines
        )

    @asynccontextmanager
    async def router(self) -> AsyncIterator[None]:
        network = self.network("router").model_copy(update={"users": self._users})
        told = network.model_dump(mode="json", exclude_none=True)
        file = self._folder / "parley.yaml"
        file.write_text(yaml.safe_dump({"network": told}), encoding="utf-8")
        process = await asyncio.create_subprocess_exec(
            sys.executable, "-m", "parley", "node", "router", "--config", str(file),
            "--access", str(self._folder / "access.yaml"), env=os.environ | {"NO_COLOR": "1"},
            stdout=asyncio.subprocess.PIPE, stderr=asyncio.subprocess.PIPE,
        )  # fmt: skip
        assert process.stdout is not None
        assert process.stderr is not None
        reading = asyncio.create_task(self._read(process.stderr))
        try:
            assert b"access.yaml does not allow" in await process.stdout.readline()
            yield
        finally:
            process.terminate()
            await process.wait()
            await reading

    async def _read(self, stream: asyncio.StreamReader) -> None:
        while chunk := await stream.read(4096):
            self.log += chunk


async def knocks(network: NetworkSettings) -> None:
    async with ZenohTransport(network):
        pass


def velocities(robot: str) -> Topic[Bool]:
    return Topic(f"{robot}/lock", Bool, "std_msgs/msg/Bool", QoS())


@pytest.mark.parametrize("knows", ["users", "certificates"])
async def test_a_robot_may_say_what_is_its_own_and_no_order(tmp_path: Path, knows: Knows) -> None:
    guarded = Guarded(tmp_path, knows)
    heard: list[str] = []

    def hears(what: str) -> Callable[[Any], None]:
        return lambda _: heard.append(what)

    async with AsyncExitStack() as stack:
        await stack.enter_async_context(guarded.router())
        enter = stack.enter_async_context
        ward, other, desk = [await enter(guarded.client(name)) for name in ("ward-pc", "other-pc", "desk")]
        await ward.subscribe(velocities("Ada"), hears("own"))
        await other.subscribe(velocities("Kim"), hears("another's"))
        await other.subscribe(topics.STOP, hears("stop"))
        await other.subscribe(topics.CHAT_INPUT, hears("order"))
        await desk.subscribe(topics.ACTOR_STATUS, hears("status"))
        await until(lambda: len([end for end in ward.endpoints() if end.elsewhere]) >= 4)
        said: tuple[tuple[Topic[Any], Any], ...] = (
            (velocities("Ada"), Bool(True)),
            (velocities("Kim"), Bool(True)),
            (topics.STOP, String("{}")),
            (topics.GRAPH_STOP, UmrfGraphStop("x", ("Kim",))),
            (topics.CHAT_INPUT, to_string(ChatInput(message="come here", targets=("Kim",), by=person()))),
            (topics.ACTOR_STATUS, String("{}")),
        )
        for topic, message in said:
            ward.publisher(topic).publish(message)
        await until(lambda: {"own", "status"} <= set(heard))
        await until(lambda: guarded.denied("ward-pc", "say", "/Kim/lock"))
        await until(lambda: guarded.denied("ward-pc", "say", "/parley/stop"))
        await until(lambda: guarded.denied("ward-pc", "say", "/umrf_graph_stop"))
        await until(lambda: guarded.denied("ward-pc", "say", "/chat_interface_input"))
        with zenoh.open(config(guarded.network("door"))) as raw:  # of whoever keeps to no agreement
            raw.put("0/parley/stop/std_msgs::msg::dds_::String_/x", b"{}")
            await until(lambda: guarded.denied("door", "say", "/parley/stop"))
        await desk.subscribe(velocities("Ada"), hears("overheard"))
        await until(lambda: guarded.denied("desk", "hear", "/Ada/lock"))
        desk.publisher(topics.STOP).publish(String("{}"))
        await until(lambda: "stop" in heard)
        assert sorted(heard) == ["own", "status", "stop"]
        assert not guarded.denied("ward-pc", "say", "/Ada/lock")
        assert not guarded.denied("desk", "say", "/parley/stop")
        if knows == "users":
            strangers = [guarded.network("door", "guessed"), guarded.network("nobody")]
            refused = await asyncio.gather(*map(knocks, strangers), return_exceptions=True)
            assert [type(error) for error in refused] == [UnavailableError] * 2


async def test_all_parts_do_their_work_and_nothing_of_it_is_denied(tmp_path: Path) -> None:
    guarded = Guarded(tmp_path, "users")

    def settings(name: str) -> SystemConfig:
        return SystemConfig(network=guarded.network(name), data_dir=tmp_path / name)

    async with AsyncExitStack() as stack:
        enter = stack.enter_async_context
        await enter(guarded.router())
        world = WorldFile.parse(EMPTY_FLOOR.replace("Kim", "Ada"))
        await enter(System(None, settings("planner"), part="agents"))
        await enter(System(world, settings("ward-pc"), part="robots"))
        desk = await enter(guarded.client("desk"))
        operator = await enter(Observer(desk, WallClock()))
        await operator.until(lambda: operator.robots == {"Ada"})
        operator.say("move forward 3 metres", "Ada")
        await operator.until(lambda: operator.state("Ada") == "running")
        stop = StopCommand(id="now", by=person())
        desk.publisher(topics.STOP).publish(to_string(stop))
        await operator.until(lambda: any(report.state == "at_rest" for report in operator.stop_reports))
        reset = StopCommand(command="reset", id="later", by=person())
        desk.publisher(topics.STOP).publish(to_string(reset))
        await operator.until(lambda: any(report.state == "reset" for report in operator.stop_reports))
        operator.say("what do you remember?", "Ada")
        await operator.until(lambda: len(operator.said) > 1)
    assert guarded.log.decode() == ""


def test_the_file_says_what_is_wrong_with_it() -> None:
    for text, wrong in (
        ("pages: [desk]\nprinters: [x]\n", "line 2.*printers.*no such setting"),
        ("robots: {pc: [Ada]}\npages: [pc]\n", "'pc' is in two lists"),
        ("robots: {one: [Ada], two: [Ada]}\n", "two have the robot 'Ada'"),
        ("", "names nobody"),
        ("programs: {door: {says: ['a b']}}\n", "programs.door.says"),
    ):
        with pytest.raises(FileFormatError, match=f"(?s){wrong}"):
            AccessFile.parse(text)


def test_nobody_can_be_told_apart_without_certificates_or_users() -> None:
    with pytest.raises(ConfigError, match="need tls or users"):
        access_control(NetworkSettings(), AccessFile.parse(ACCESS))


def test_the_rules_can_be_printed_for_another_router(tmp_path: Path) -> None:
    (tmp_path / "users.txt").write_text("desk:x\n", encoding="utf-8")
    (tmp_path / "access.yaml").write_text("pages: [desk]\n", encoding="utf-8")
    (tmp_path / "parley.yaml").write_text(
        "network: {connect: [tcp/127.0.0.1:7447], users: users.txt, access: access.yaml}\n", encoding="utf-8"
    )
    result = CliRunner().invoke(
        command_line(), ["node", "router", "--config", str(tmp_path / "parley.yaml"), "--show"]
    )
    rules = yaml.safe_load(result.output)["access_control"]
    assert rules["default_permission"] == "deny"
    assert rules["subjects"] == [{"id": "desk", "usernames": ["desk"]}]


def test_what_the_library_foretells_is_no_denial() -> None:
    reader = Reader()
    about = "TRACE rx-0 ThreadId(07) zenoh: "
    who = "abc on Interface(lo)+Username(ward-pc)+Transport(Tcp)+abc is unauthorized to Put"
    key = "0/Kim/lock/std_msgs::msg::dds_::Bool_/RIHS01_x"
    for line in (
        f"{about}ACL (ingress): caching permissions for `{key}` ...",
        f"{about}{who} (ingress) on {key}",
    ):
        assert reader.read(line.encode()) is None
    told = reader.read(f"{about}Using cached result: abc is unauthorized to Put (ingress) on {key}".encode())
    assert told == Denial("ward-pc", "say", "/Kim/lock")
