"""Graph files without a transport."""

from __future__ import annotations

import asyncio
import json
from pathlib import Path

import pytest

from parley.clock import WallClock
from parley.engine.run_file import check_file, read_graph_file, run_graph
from parley.errors import FileFormatError
from parley.umrf.io import read_graph
from parley.umrf.model import Result
from parley.umrf.transition import Transition
from tests.umrf.spec_actions import CATALOGUE, chain, node, planner_chain


def write(path: Path, raw: object) -> Path:
    path.write_text(json.dumps(raw), encoding="utf-8")
    return path


def test_checking_a_file_gives_every_problem(tmp_path: Path) -> None:
    good = write(tmp_path / "good.json", chain("g", [node("NoOp")]))
    assert check_file(good, CATALOGUE) == []
    unknown = write(
        tmp_path / "unknown.json", {"graph_name": "g", "actions": [{"name": "X", "type": "sync"}]}
    )
    assert [problem.code for problem in check_file(unknown, CATALOGUE)] == ["unknown_action"]
    broken = write(tmp_path / "broken.json", {"actions": [{}]})
    assert len(check_file(broken, CATALOGUE)) > 2


def test_a_file_that_cannot_be_read_is_named(tmp_path: Path) -> None:
    with pytest.raises(FileFormatError, match=r"nowhere\.json: cannot be read"):
        read_graph_file(tmp_path / "nowhere.json")
    (tmp_path / "latin.json").write_bytes(b"\xff")
    with pytest.raises(FileFormatError, match=r"latin\.json: is not UTF-8"):
        check_file(tmp_path / "latin.json", CATALOGUE)


async def run(raw: dict[str, object], told: list[Transition]) -> Result:
    return await run_graph(
        read_graph(raw),
        CATALOGUE,
        actor="A",
        clock=WallClock(),
        make_context=lambda handle: handle,
        observer=told.append,
    )


async def test_a_graph_runs_to_its_end() -> None:
    told: list[Transition] = []
    assert await run(chain("g", [node("NoOp")]), told) is Result.ON_TRUE
    assert told[-1].state == "FINISHED"


async def test_a_graph_that_halts_has_ended_too() -> None:
    told: list[Transition] = []
    assert await run(planner_chain("g", [node("NoOp")]), told) is Result.ON_HALTED
    assert told[-1].state == "HALTED"


async def test_cancelling_stops_what_runs() -> None:
    told: list[Transition] = []
    task = asyncio.create_task(run(chain("g", [node("WaitFor", 0, seconds=60)]), told))
    await asyncio.sleep(0.01)
    task.cancel()
    with pytest.raises(asyncio.CancelledError):
        await task
    assert told[-1].state == "STOPPED"
