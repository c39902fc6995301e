"""One file says which part of a system runs where."""

from __future__ import annotations

import asyncio
import os
import signal
import sys
from contextlib import AsyncExitStack
from pathlib import Path

import pytest
from typer.testing import CliRunner

from parley.cli import command_line, up
from parley.cli.on_loop import PULSE, on_loop
from parley.config import NetworkSettings, SystemConfig
from parley.deployment import Deployment
from parley.errors import ConfigError, FileFormatError
from parley.network import transport_of
from tests.test_examples import EXAMPLES, invoke
from tests.transport.backends import free_port, until
from tests.transport.peer import TALK

FILES = sorted((EXAMPLES / "deployments").glob("*.yaml"))
SEVERAL = """
data: kept
machines:
  yard: {listen: ["tcp/0.0.0.0:7447"], interface: ""}
  desk: {connect: ["tcp/192.168.1.5:7447"], interface: ""}
settings: {approval: ask_first, rules_file: rules.yaml}
robots:
  - {name: A, machine: yard, world: boxes}
  - {name: B, machine: yard, world: boxes}
  - {name: Kim, machine: yard, class: "cart.py:Cart"}
agents: {machine: desk}
web: {machine: desk, port: 8401}
"""


def load(folder: Path, text: str) -> Deployment:
    (folder / "up.yaml").write_text(text, encoding="utf-8")
    return Deployment.load(folder / "up.yaml")


@pytest.mark.parametrize("file", FILES, ids=lambda file: str(file.stem))
def test_every_part_of_an_example_runs_somewhere_and_can_be_begun(file: Path) -> None:
    deployment = Deployment.load(file)
    parts = [part for machine in deployment.machines or ["here"] for part in deployment.parts(machine)]
    assert sorted(part.name for part in parts) == ["agents", "page", "robot David"]
    for part in parts:  # its words are those of a command that there is
        invoke(*part.arguments[: 2 if part.arguments[0] == "node" else 1], "--help")


def test_each_machine_gets_its_parts_and_its_network(tmp_path: Path) -> None:
    (tmp_path / "cart.py").write_text("", encoding="utf-8")
    deployment = load(tmp_path, SEVERAL)
    assert [part.arguments for part in deployment.parts("yard")] == [
        ("engine", "--world", "boxes", "--robot", "A", "--robot", "B"),
        ("engine", "--robot", "Kim", "--class", f"{tmp_path / 'cart.py'}:Cart"),
    ]
    assert [part.name for part in deployment.parts("desk")] == ["agents", "page"]
    (tmp_path / "elsewhere").mkdir()
    read = tmp_path / "elsewhere" / "parley.yaml"
    read.write_text(deployment.settings_text("desk"), encoding="utf-8")
    settings = SystemConfig.load(read)
    assert settings.network == NetworkSettings(connect=("tcp/192.168.1.5:7447",), interface="")
    assert deployment.settings_of("desk", first=False) == settings
    assert (settings.approval, settings.rules_path) == ("ask_first", tmp_path / "rules.yaml")


async def test_the_parts_of_a_machine_and_who_looks_after_them_share_one_port(tmp_path: Path) -> None:
    text = SEVERAL.replace("7447", str(free_port()))
    deployment = load(tmp_path, text.replace("192.168.1.5", "127.0.0.1"))
    async with AsyncExitStack() as ends:
        away = await ends.enter_async_context(transport_of(deployment.settings_of("desk")))
        for first in (True, False, False):
            transport = transport_of(deployment.settings_of("yard", first=first))
            await ends.enter_async_context(transport)
            transport.publisher(TALK)

        def seen() -> int:
            return sum(end.elsewhere and end.name == f"/{TALK.name}" for end in away.endpoints())

        await until(lambda: seen() == 3)


def test_this_machine_is_the_only_one_or_the_one_that_is_named(tmp_path: Path) -> None:
    assert load(tmp_path, "data: kept").machine() == "here"
    several = load(tmp_path, SEVERAL)
    assert several.machine("desk") == "desk"
    for wished in ("", "attic"):
        with pytest.raises(ConfigError, match="--machine yard or desk"):
            several.machine(wished)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (SEVERAL.replace("machine: desk, port", "machine: attic, port"), "no machine 'attic'"),
        (SEVERAL.replace("name: B", "name: A"), "two robots have the name 'A'"),
        (SEVERAL.replace("port: 8401", "prot: 8401"), "line 12"),
        (SEVERAL.replace("approval", "aproval"), "line 6"),
    ],
)
def test_what_cannot_be_is_refused_with_its_place(tmp_path: Path, text: str, said: str) -> None:
    with pytest.raises(FileFormatError, match=said):
        load(tmp_path, text)


WRONG = """
data: kept
settings: {aproval: ask_first, network: {domian: 3}}
machines: {yard: {}}
robots:
  - {name: A, machine: attic}
  - {name: A, machine: yard, wrld: boxes}
  - {machine: yard, machine: yard}
web: {machine: yard, port: 100000}
"""
ALL_THAT_IS_WRONG = """
line 3: settings.aproval: there is no such setting
line 3: settings.network.domian: there is no such setting
line 6: robots[0].machine: there is no machine 'attic'; there are: yard
line 7: robots[1].name: two robots have the name 'A'
line 7: robots[1].wrld: there is no such setting
line 8: machine: is said twice
line 8: robots[2].name: Field required
line 9: web.port: Input should be less than or equal to 65535
"""


def test_all_that_is_wrong_is_told_at_once_in_the_order_of_the_file(tmp_path: Path) -> None:
    with pytest.raises(FileFormatError) as refused:
        load(tmp_path, WRONG)
    told = str(refused.value).replace("up.yaml, ", "").splitlines()
    agents = "line 2: agents.machine: there is no machine 'here'; there are: yard"
    assert told == [agents, *ALL_THAT_IS_WRONG.split("\n")[1:-1]]


def test_all_that_is_not_there_is_told_before_anything_is_started(tmp_path: Path) -> None:
    file = tmp_path / "up.yaml"
    robots = "[{name: A, world: nohome}, {name: B, class: 'none.py:Cart'}, {name: C, class: no.yaml}]"
    file.write_text(f"data: kept\nrobots: {robots}\nweb: {{password_file: none}}\n", encoding="utf-8")
    for options in ((), ("--check",)):
        result = CliRunner().invoke(command_line(), ["up", str(file), *options])
        assert isinstance(result.exception, ConfigError)
        told = [line.split(": ")[1] for line in str(result.exception).splitlines()]
        assert told == ["web.password_file", "robots[0].world", "robots[1].class", "robots[2].class"]
        assert ("parley engine" in result.output) == bool(options)


@pytest.mark.parametrize(
    ("script", "ended"), [("import time; time.sleep(60)", None), ("raise SystemExit(3)", 3)]
)
async def test_a_part_that_hangs_is_ended_as_one_that_ends(
    script: str, ended: int | None, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    (tmp_path / "parley").mkdir()
    (tmp_path / "parley" / "__init__.py").touch()
    working = "import asyncio\nfrom os import environ, write\nwrite(int(environ['PARLEY_PULSE']), b'.')\n"
    (tmp_path / "parley" / "__main__.py").write_text(working + script, encoding="utf-8")
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    monkeypatch.setattr(up, "HANGS_AFTER_S", 0.2)
    async with asyncio.timeout(30):
        assert await up._until_it_ends([]) == ended


LOOKS_AFTER = """
import asyncio, sys
from parley.cli import up
sys.executable, up.HANGS_AFTER_S, up.BEAT_S = sys.argv[1], 0.6, 0.2
print(asyncio.run(up._until_it_ends([])))
"""
BEATS = """#!{}
import os, time
for _ in range(40):
    os.write(int(os.environ['PARLEY_PULSE']), b'.')
    time.sleep(0.1)
"""


async def test_a_part_is_not_ended_for_a_time_in_which_we_hung_ourselves(tmp_path: Path) -> None:
    part = tmp_path / "part"
    part.write_text(BEATS.format(sys.executable), encoding="utf-8")
    part.chmod(0o755)
    command = [sys.executable, "-c", LOOKS_AFTER, str(part)]
    looking = await asyncio.create_subprocess_exec(*command, stdout=asyncio.subprocess.PIPE)
    await asyncio.sleep(2.0)
    looking.send_signal(signal.SIGSTOP)
    await asyncio.sleep(1.0)
    looking.send_signal(signal.SIGCONT)
    assert (await looking.communicate())[0] == b"0\n"


def test_a_part_ends_in_order_when_nobody_looks_after_it_any_more(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    ours, its = os.pipe()
    os.close(ours)
    monkeypatch.setenv(PULSE, str(its))
    closed: list[str] = []

    async def work() -> None:
        try:
            await asyncio.sleep(30)
        finally:
            closed.append("in order")

    with pytest.raises(SystemExit, match="143"):
        on_loop(work())
    os.close(its)
    assert closed == ["in order"]


def test_a_command_gives_signs_of_life_to_whoever_started_it(monkeypatch: pytest.MonkeyPatch) -> None:
    ours, its = os.pipe()
    monkeypatch.setenv(PULSE, str(its))
    assert on_loop(asyncio.sleep(0, "done")) == "done"
    assert os.read(ours, 10) == b"."
    os.close(ours)
    os.close(its)
