"""A process that is killed again and again at any moment comes to its end, and does nothing twice.

What was not yet written down at a kill is done again: that much is lost by design (`docs/engine.md`).
"""

from __future__ import annotations

import json
import random
import shutil
import subprocess
import sys
from collections import Counter
from pathlib import Path

import pytest

from parley.clock import WallClock
from parley.engine.journal import Journal
from parley.umrf.model import NodeState

from .marks import MARKS_FILE, ladder

ROOT = Path(__file__).parent.parent.parent
RUNGS = 25

VICTIM = """
import asyncio, json, sys
from parley.clock import WallClock
from parley.engine.engine import ActionEngine
from parley.engine.journal import Journal
from parley.transport.local import LocalTransport
from parley.umrf.io import read_graph
from tests.engine.marks import CATALOGUE

async def main():
    file, graph = sys.argv[1:]
    async with LocalTransport() as transport, await Journal.open(file, WallClock()) as journal:
        async with ActionEngine("A", transport=transport, catalogue=CATALOGUE, clock=WallClock(),
                                make_context=lambda run: run, journal=journal) as engine:
            if journal.interrupted:
                engine.restore(journal.interrupted[0])
                engine.runs.resume("g")
            else:
                engine.start(read_graph(graph))
            print("going", flush=True)
            await engine.runs.get("g").wait()
            await journal.flush()
            print(engine.runs.get("g").state, flush=True)

asyncio.run(main())
"""


def lives_for(file: Path, graph: str, seconds: float | None) -> str:
    """Go on for so long (None: to the end) and be killed; how the graph ended, if it did."""
    command = [sys.executable, "-c", VICTIM, str(file), graph]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, cwd=ROOT) as victim:
        assert victim.stdout is not None
        try:
            assert victim.stdout.readline() == "going\n"
            try:
                victim.wait(seconds)
            except subprocess.TimeoutExpired:
                victim.kill()
            return victim.stdout.read().strip()
        finally:
            victim.kill()


def copied(file: Path, folder: Path) -> Path:
    """The journal as it is, so that looking at it changes nothing."""
    folder.mkdir()
    for part in file.parent.glob(f"{file.name}*"):
        shutil.copy(part, folder)
    return folder / file.name


async def done(file: Path) -> set[str]:
    """Which nodes had come to their end as far as it was written down."""
    async with await Journal.open(file, WallClock()) as journal:
        nodes = [node for left in journal.interrupted for node in left.graph.nodes]
        return {str(n.input_parameters["text"].value) for n in nodes if n.state is NodeState.FINISHED}


@pytest.mark.spec("10.4")
@pytest.mark.parametrize("seed", [1, *(pytest.param(seed, marks=pytest.mark.soak) for seed in range(2, 8))])
async def test_kills_at_any_moment_repeat_nothing_that_was_done(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, seed: int
) -> None:
    marks, file, chance = tmp_path / "marks.txt", tmp_path / "journal.db", random.Random(seed)
    marks.touch()
    monkeypatch.setenv(MARKS_FILE, str(marks))

    def began() -> Counter[str]:
        return Counter(marks.read_text(encoding="utf-8").split())

    graph, kills, state = json.dumps(ladder(RUNGS)), 0, ""
    finished: dict[str, int] = {}
    while not state:
        state = lives_for(file, graph, chance.uniform(0.0, 0.15) if kills < 4 else None)
        now = began()
        assert {text: now[text] for text in finished} == finished, "what was done is not done again"
        if not state:
            finished |= {text: now[text] for text in await done(copied(file, tmp_path / f"copy{kills}"))}
            kills += 1
    assert state == "FINISHED"
    assert kills >= 1
    assert began().keys() == {f"n{index}" for index in range(3 * RUNGS + 1)}
    assert max(began().values()) <= kills + 1
