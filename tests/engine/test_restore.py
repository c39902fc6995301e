"""Any graph that a kill -9 interrupted can be gone on with: nothing that was done is done again."""

from __future__ import annotations

import json
import subprocess
import sys
from collections import Counter
from collections.abc import AsyncIterator, Iterator
from contextlib import asynccontextmanager, contextmanager
from pathlib import Path
from typing import Any

import pytest

from parley.clock import WallClock
from parley.engine.engine import ActionEngine
from parley.engine.interrupted import Interrupted
from parley.engine.journal import Journal
from parley.errors import GraphRefusedError
from parley.transport.local import LocalTransport
from parley.umrf.model import GraphState

from .marks import CATALOGUE, MARKS_FILE, branching, looping, nested, opaque, spontaneous
from .rig import Rig, engine_of

ROOT = Path(__file__).parent.parent.parent

VICTIM = """
import asyncio, json, os, sys
from parley.clock import WallClock
from parley.engine.engine import ActionEngine
from parley.engine.journal import Journal
from parley.messages import topics
from parley.messages.ros import UmrfGraphPause, UmrfGraphStart
from parley.transport.local import LocalTransport
from tests.engine.marks import CATALOGUE

async def main():
    journal_file, wanted, graph, pause = sys.argv[1:]
    async with LocalTransport() as transport, await Journal.open(journal_file, WallClock()) as journal:
        async with ActionEngine("A", transport=transport, catalogue=CATALOGUE, clock=WallClock(),
                                make_context=lambda run: run, journal=journal):
            transport.publisher(topics.GRAPH_START).publish(UmrfGraphStart("", graph, ("A",)))
            async with asyncio.timeout(20):
                marks = os.environ["PARLEY_TEST_MARKS"]
                while sorted(json.loads(wanted)) != sorted(open(marks).read().split()):
                    await asyncio.sleep(0.005)
            if pause:
                transport.publisher(topics.GRAPH_PAUSE).publish(UmrfGraphPause(pause, ("A",)))
            await asyncio.sleep(0.05)
            await journal.flush()
            print("ready", flush=True)
            await asyncio.sleep(60)

asyncio.run(main())
"""


class Marks:
    """Each action writes a line when it begins."""

    def __init__(self, folder: Path) -> None:
        self.folder, self.file = folder, folder / "marks.txt"
        self.file.touch()

    def count(self) -> Counter[str]:
        return Counter(self.file.read_text(encoding="utf-8").split())

    def open_gate(self) -> None:
        """From now on actions that wait for the gate end."""
        (self.folder / "gate").touch()


@pytest.fixture
def marks(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Marks:
    found = Marks(tmp_path)
    monkeypatch.setenv(MARKS_FILE, str(found.file))
    return found


def kill(marks: Marks, graph: dict[str, Any], wanted: list[str], *, pause: str = "") -> Path:
    """Run `graph` until exactly the `wanted` marks were made, then kill the process; its journal."""
    file = marks.folder / "journal.db"
    command = [sys.executable, "-c", VICTIM, str(file), json.dumps(wanted), json.dumps(graph), pause]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, cwd=ROOT) as victim:
        assert victim.stdout is not None
        with victim_ends(victim):
            assert victim.stdout.readline() == "ready\n"
    return file


@contextmanager
def victim_ends(victim: subprocess.Popen[str]) -> Iterator[None]:
    try:
        yield
    finally:
        victim.kill()


@asynccontextmanager
async def an_engine(journal: Journal | None = None) -> AsyncIterator[tuple[Rig, ActionEngine]]:
    """The engine of the new process, and what it tells."""
    async with LocalTransport() as transport:
        rig = Rig(transport, None)
        await rig.listen()
        async with engine_of("A", rig, catalogue=CATALOGUE, journal=journal) as engine:
            yield rig, engine
        assert transport.handler_failures == 0


async def resumed(file: Path, marks: Marks, end: str) -> tuple[Rig, Counter[str]]:
    """Everything that began after the graph was taken up and resumed, and what was told."""
    async with await Journal.open(file, WallClock()) as journal:
        (left,) = journal.interrupted
        async with an_engine(journal) as (rig, engine):
            before = marks.count()
            engine.restore(left)
            await rig.until_graph(left.graph.name, "PAUSED")
            assert marks.count() == before, "nothing goes on by itself"
            marks.open_gate()
            engine.runs.resume(left.graph.name)
            await rig.until_graph(left.graph.name, end)
            return rig, marks.count() - before


async def test_branches_and_their_join_go_on_where_they_were(marks: Marks) -> None:
    file = kill(marks, branching(), ["first", "quick", "slow", "otherwise"])
    _, again = await resumed(file, marks, "FINISHED")
    assert again == Counter(slow=1, join=1, last=1)


async def test_a_join_gets_what_a_branch_gave_before_the_kill(marks: Marks) -> None:
    file = kill(marks, branching(), ["first", "quick", "slow", "otherwise"])
    rig, _ = await resumed(file, marks, "FINISHED")
    (given,) = [item.outputs["gave"].value for item in rig.events if item.node == "Mark_3" and item.outputs]
    assert given == "join:quick"


async def test_a_graph_that_was_paused_goes_on_with_what_was_held_back(marks: Marks) -> None:
    graph = branching()
    file = kill(marks, graph, ["first", "quick", "slow", "otherwise"], pause="g")
    _, again = await resumed(file, marks, "FINISHED")
    assert again == Counter(slow=1, join=1, last=1)


async def test_a_cycle_goes_on_in_its_round(marks: Marks) -> None:
    file = kill(marks, looping(), ["work", "check", "work", "check", "work"])
    _, again = await resumed(file, marks, "FINISHED")
    assert again == Counter(work=1, check=1)


async def test_a_graph_inside_goes_on_where_it_was(marks: Marks) -> None:
    file = kill(marks, nested(), ["before", "inner_first", "inner_slow"])
    rig, again = await resumed(file, marks, "FINISHED")
    assert again == Counter(inner_slow=1, inner_last=1, after=1)
    assert rig.graph_states("g__Inner__0")[0] == "PAUSED", "the inner graph was taken up, not begun"


async def test_a_spontaneous_action_goes_on_with_its_rounds(marks: Marks) -> None:
    file = kill(marks, spontaneous(), ["tick", "check", "tick", "check", "tick"])
    _, again = await resumed(file, marks, "FINISHED")
    assert again["check"] == 1
    assert again["tick"] in (1, 2), "the end of the graph may find the next round begun"


async def test_a_second_kill_before_anybody_said_go_on_loses_nothing(marks: Marks) -> None:
    file = kill(marks, branching(), ["first", "quick", "slow", "otherwise"])
    journal = await Journal.open(file, WallClock())
    (left,) = journal.interrupted
    async with an_engine(journal) as (_, engine):
        engine.restore(left)
        await journal.flush()
        copy = file.with_name("copy.db")  # what a kill would leave now
        with_wal(file, copy)
    await journal.close()
    _, again = await resumed(copy, marks, "FINISHED")
    assert again == Counter(slow=1, join=1, last=1)


def with_wal(file: Path, copy: Path) -> None:
    for suffix in ("", "-wal"):
        source = file.with_name(file.name + suffix)
        if source.exists():
            copy.with_name(copy.name + suffix).write_bytes(source.read_bytes())


async def test_it_can_be_dropped_and_a_step_of_it_skipped(marks: Marks) -> None:
    file = kill(marks, branching(), ["first", "quick", "slow", "otherwise"])
    async with await Journal.open(file, WallClock()) as journal:
        (left,) = journal.interrupted
        async with an_engine() as (rig, engine):
            engine.restore(left)
            engine.runs.end_node("g", "Mark_2")
            engine.runs.resume("g")
            await rig.until_graph("g", "HALTED")
        async with an_engine() as (rig, engine):
            engine.restore(left)
            engine.runs.stop("g")
            await rig.until_graph("g", "STOPPED")
    assert marks.count() == Counter(first=1, quick=1, slow=1, otherwise=1)


async def test_what_was_being_stopped_is_not_offered(marks: Marks) -> None:
    file = kill(marks, branching(), ["first", "quick", "slow", "otherwise"])
    async with await Journal.open(file, WallClock()) as journal:
        (left,) = journal.interrupted
    assert left.saved is not None
    frame = {**left.saved.frame, "state": "STOPPING"}
    saved = type(left.saved)(left.saved.graph, frame, left.saved.nodes)
    assert not Interrupted.of("A", saved, 0, shared=False).is_open


async def test_a_graph_of_several_actors_is_told_but_not_gone_on_with(marks: Marks) -> None:
    file = kill(marks, branching(), ["first", "quick", "slow", "otherwise"])
    async with await Journal.open(file, WallClock()) as journal:
        (left,) = journal.interrupted
        assert left.saved is not None
        shared = Interrupted.of("A", left.saved, 0, shared=True)
        async with an_engine() as (_, engine):
            with pytest.raises(GraphRefusedError, match="others took part"):
                engine.restore(shared)
            assert engine.runs.all == ()


async def test_a_value_that_could_not_be_kept_is_missed_before_anything_runs(marks: Marks) -> None:
    file = kill(marks, opaque(), ["slow"])
    async with await Journal.open(file, WallClock()) as journal:
        (left,) = journal.interrupted
        async with an_engine() as (_, engine):
            with pytest.raises(GraphRefusedError, match="thing of Take_0"):
                engine.restore(left)
            assert engine.runs.all == ()
    assert left.graph.state is GraphState.RUNNING
