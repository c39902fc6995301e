"""Actions in a process of their own: whatever they do, the engine lives."""

from __future__ import annotations

import asyncio
import ctypes
import multiprocessing
import os
import sys
import time
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest

from parley.clock import WallClock
from parley.errors import ActionFailure, FailureCode
from parley.messages.failure import FailureReport
from parley.umrf import isolated as room
from parley.umrf.action import Outcome, RunHandle, action
from parley.umrf.catalogue import Catalogue
from parley.umrf.discovery import ActionFolder
from parley.umrf.executor import GraphRun
from parley.umrf.io import read_graph
from parley.umrf.model import Result
from parley.umrf.transition import Transition

pytestmark = pytest.mark.spec("D23", "D36")


@dataclass(frozen=True)
class Place:
    x: float
    y: float


@dataclass(frozen=True)
class Told:
    text: str
    process: float


@action(isolated=True)
async def tell(ctx: RunHandle, place: Place, times: int = 2) -> Told:
    """Say where."""
    ctx.log("in there")
    ctx.progress(0.5, "half")
    await asyncio.sleep(0)
    return Told(f"{ctx.actor} {ctx.node} {place.x} " * times, os.getpid())


class MuteError(Exception):
    def __str__(self) -> str:
        raise RuntimeError("no words")


@action(isolated=True)
def find_out(ctx: RunHandle) -> Outcome:
    """Tell something that cannot leave, and which process this one comes from."""
    return Outcome(facts={"seen": "a box", "parent": float(os.getppid()), "thing": lambda: None})


@action(isolated=True, outputs={"what": "thing"})
def misbehave(ctx: RunHandle, how: str) -> Outcome:
    """End badly."""
    match how:
        case "segfault":
            ctypes.string_at(0)
        case "os._exit":
            os._exit(7)
        case "sys.exit":
            sys.exit(3)
        case "raise":
            raise KeyError("shelf")
        case "badstr":
            raise MuteError()
        case "opaque":
            return Outcome(outputs={"what": lambda: None})
        case "fail":
            raise ActionFailure(FailureCode.BLOCKED, "A box is in the way.", {"by": "a box"})
    return Outcome(False)


@action(isolated=True)
def ignore_everything(ctx: RunHandle) -> None:
    """Never look up."""
    while True:
        time.sleep(0.05)


@action(isolated=True)
def work_until_stopped(ctx: RunHandle) -> None:
    """Look whether to stop."""
    ctx.progress(None, "begun")
    while not ctx.stop_requested:
        time.sleep(0.005)


@action(isolated=True)
class Polite:
    async def run(self, ctx: RunHandle) -> None:
        ctx.progress(None, "begun")
        await asyncio.sleep(60)


ACTIONS: tuple[Any, ...] = (tell, find_out, misbehave, ignore_everything, work_until_stopped, Polite)


CATALOGUE = Catalogue(item.spec for item in ACTIONS)


def started(
    name: str, values: Mapping[str, Any], catalogue: Catalogue = CATALOGUE
) -> tuple[GraphRun, list[Transition]]:
    spec = catalogue.get(name)
    assert spec is not None
    inputs: dict[str, Any] = {}
    for flat, item in spec.inputs.items():
        *levels, last = flat.split("::")
        at = inputs
        for level in levels:
            at = at.setdefault(level, {})
        at[last] = {"pvf_type": item.type} | ({"pvf_value": values[flat]} if flat in values else {})
    outputs = {flat: {"pvf_type": item.type} for flat, item in spec.outputs.items()}
    node = {"name": name, "type": "sync", "input_parameters": inputs, "output_parameters": outputs}
    told: list[Transition] = []
    run = GraphRun(
        read_graph({"graph_name": "g", "actions": [node]}),
        catalogue,
        actor="A",
        clock=WallClock(),
        make_context=lambda handle: handle,
        observer=told.append,
    )
    run.start()
    return run, told


def report(run: GraphRun, node: str) -> FailureReport:
    found = run.snapshot().node(node)
    assert found is not None
    return FailureReport.parse(found.messages[-1].message)


async def begun(told: list[Transition]) -> None:
    async with asyncio.timeout(20):
        while not any(item.progress_text == "begun" for item in told):  # noqa: ASYNC110
            await asyncio.sleep(0.01)


def nobody_is_left() -> bool:
    return not [child for child in multiprocessing.active_children() if child.is_alive()]


async def test_inputs_outputs_log_and_progress_cross_over() -> None:
    run, told = started("Tell", {"place::x": 1.5, "place::y": 2.0})
    assert await run.wait() is Result.ON_TRUE
    outputs = run.outputs("Tell_0")
    assert outputs["text"] == "A Tell_0 1.5 " * 2
    assert outputs["process"] != os.getpid()
    assert "half" in [item.progress_text for item in told]
    node = run.snapshot().node("Tell_0")
    assert node is not None
    assert [item.message for item in node.messages] == ["in there"]
    assert nobody_is_left()


@pytest.mark.parametrize(
    ("how", "code", "words"),
    [
        ("segfault", FailureCode.INTERNAL, "SIGSEGV"),
        ("os._exit", FailureCode.INTERNAL, "exit code 7"),
        ("sys.exit", FailureCode.INTERNAL, "it called exit(3)"),
        ("raise", FailureCode.INTERNAL, "Misbehave failed: KeyError: 'shelf'."),
        ("badstr", FailureCode.INTERNAL, "MuteError: (RuntimeError while saying why)"),
        ("opaque", FailureCode.INTERNAL, "What Misbehave gave cannot leave its process"),
        ("fail", FailureCode.BLOCKED, "A box is in the way."),
    ],
)
async def test_a_bad_end_is_the_nodes_failure_alone(how: str, code: FailureCode, words: str) -> None:
    run, _ = started("Misbehave", {"how": how})
    assert await run.wait() is Result.ON_ERROR
    failure = report(run, "Misbehave_0")
    assert failure.code is code
    assert words in failure.message
    assert nobody_is_left()


async def test_a_fact_that_cannot_leave_is_named_and_processes_come_from_a_warm_one() -> None:
    parents = []
    for _ in range(2):
        run, told = started("FindOut", {})
        assert await run.wait() is Result.ON_TRUE
        (end,) = [item for item in told if item.state == "FINISHED" and item.node]
        assert set(end.outputs) == {"seen", "parent"}
        node = run.snapshot().node("FindOut_0")
        assert node is not None
        assert node.messages[-1].message.startswith("thing is not told, as it cannot leave its process")
        parents.append(end.outputs["parent"].value)
    assert parents[0] == parents[1] != os.getpid()


@pytest.mark.parametrize("name", ["WorkUntilStopped", "Polite"])
async def test_a_stop_reaches_the_action(name: str) -> None:
    run, told = started(name, {})
    await begun(told)
    run.stop()
    assert await run.wait() is Result.ON_STOPPED
    assert nobody_is_left()


async def test_a_stop_kills_what_does_not_end(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(room, "STOP_GRACE_S", 0.2)
    run, _ = started("IgnoreEverything", {})
    async with asyncio.timeout(20):
        while nobody_is_left():  # noqa: ASYNC110
            await asyncio.sleep(0.01)
    run.stop()
    assert await run.wait() is Result.ON_STOPPED
    assert nobody_is_left()


async def test_an_action_file_of_a_folder_can_be_isolated(tmp_path: Path) -> None:
    (tmp_path / "mine.py").write_text(
        "from parley.umrf.action import action\n@action(isolated=True)\n"
        "def mine(ctx, text: str) -> bool:\n    return text == 'box'\n",
        encoding="utf-8",
    )
    index = ActionFolder(tmp_path)
    index.scan()
    run, _ = started("Mine", {"text": "chair"}, Catalogue(index.found.specs))
    assert await run.wait() is Result.ON_FALSE


async def test_what_is_hidden_in_a_function_cannot_be_isolated_and_says_so() -> None:
    @action(isolated=True)
    def hidden(ctx: RunHandle) -> None:
        """Not at the top of its module."""

    run, _ = started("Hidden", {}, Catalogue([hidden.spec]))
    assert await run.wait() is Result.ON_ERROR
    assert "top of its module" in report(run, "Hidden_0").message
