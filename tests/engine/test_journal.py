"""What ran is written down as it happens, and a kill -9 leaves it readable."""

from __future__ import annotations

import asyncio
import contextlib
import json
import sqlite3
import subprocess
import sys
from pathlib import Path
from typing import Any

from parley.clock import WallClock
from parley.engine import journal_file as room
from parley.engine.journal import Interrupted, Journal
from parley.messages import topics
from parley.messages.status import PlanUpdate
from parley.messages.wire import to_string
from parley.transport.local import LocalTransport
from parley.umrf.executor import GraphRun
from parley.umrf.io import read_graph
from parley.umrf.model import GraphState, NodeState
from tests.umrf.spec_actions import CATALOGUE, chain, node, planner_chain

from .rig import engine_of, rigged

ROOT = Path(__file__).parent.parent.parent

VICTIM = """
import asyncio, json, sys
from parley.clock import WallClock
from parley.engine.engine import ActionEngine
from parley.engine.journal import Journal
from parley.messages import topics
from parley.messages.ros import UmrfGraphStart
from parley.transport.local import LocalTransport
from tests.umrf.spec_actions import CATALOGUE, planner_chain, node

async def main():
    async with LocalTransport() as transport, await Journal.open(sys.argv[1], WallClock()) as journal:
        async with ActionEngine("A", transport=transport, catalogue=CATALOGUE, clock=WallClock(),
                                make_context=lambda run: run, journal=journal):
            graph = planner_chain("errand", [
                node("JoinText", 0, left="a", right="b"), node("WaitFor", 1, seconds=60.0),
                node("InThread", 2, text="c"),
            ])
            transport.publisher(topics.GRAPH_START).publish(UmrfGraphStart("", json.dumps(graph), ("A",)))
            await asyncio.sleep(0.3)
            await journal.flush()
            print("ready", flush=True)
            await asyncio.sleep(60)

asyncio.run(main())
"""


async def found(path: Path) -> tuple[Interrupted, ...]:
    async with await Journal.open(path, WallClock()) as journal:
        return journal.interrupted


def killed(path: Path) -> None:
    """An engine that is killed in the middle of its second step."""
    command = [sys.executable, "-c", VICTIM, str(path)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, cwd=ROOT) as victim:
        assert victim.stdout is not None
        assert victim.stdout.readline() == "ready\n"
        victim.kill()


def rows(path: Path, sql: str) -> list[Any]:
    with sqlite3.connect(path) as connection:
        found = connection.execute(sql).fetchall()
    connection.close()
    return found


async def test_after_a_kill_it_is_known_what_was_interrupted_where(tmp_path: Path) -> None:
    file = tmp_path / "journal.db"
    killed(file)
    async with await Journal.open(file, WallClock()) as journal:
        (was,) = journal.interrupted
    assert (was.actor, was.graph.name, was.graph.state) == ("A", "errand", GraphState.RUNNING)
    assert [item.full_name for item in was.going_on] == ["WaitFor_1"]
    assert [item.full_name for item in was.remaining] == ["WaitFor_1", "InThread_2"]
    assert was.outputs == {"JoinText_0": {"text": "a-b"}}
    assert was.is_linear


async def test_a_proper_end_forgets_nothing_that_nobody_went_on_with(tmp_path: Path) -> None:
    file = tmp_path / "journal.db"
    killed(file)
    assert await found(file) == await found(file) != ()


async def test_what_is_stopped_because_the_process_ends_is_left_as_it_was(tmp_path: Path) -> None:
    file = tmp_path / "journal.db"
    async with await Journal.open(file, WallClock()) as journal, rigged(journal=journal) as rig:
        rig.start(planner_chain("errand", [node("WaitFor", 0, seconds=60.0)]))
        await rig.until(lambda: rig.node_states("errand", "WaitFor_0")[-1:] == ["RUNNING"])
        await journal.end()
    (was,) = await found(file)
    assert [item.full_name for item in was.going_on] == ["WaitFor_0"]


async def test_a_second_kill_still_knows_until_something_new_begins(tmp_path: Path) -> None:
    file = tmp_path / "journal.db"
    killed(file)
    killed(file)
    assert [was.graph.name for was in await found(file)] == ["errand"]
    assert [state for (state,) in rows(file, "SELECT settled FROM run")] == [1, 0]


async def test_a_plan_that_is_given_up_just_before_the_end_is_not_offered_again(tmp_path: Path) -> None:
    file = tmp_path / "journal.db"
    killed(file)
    async with LocalTransport() as transport, await Journal.open(file, WallClock()) as journal:
        heard = await journal.heed_plans(transport)
        plans = transport.publisher(topics.PLAN)
        plans.publish(to_string(PlanUpdate(target="A", state="held", steps=())))
        plans.publish(to_string(PlanUpdate(target="A", state="idle", steps=())))
        await asyncio.sleep(0)  # heard, and not written yet
        await heard.close()
    assert await found(file) == ()


async def test_how_everything_that_ran_stands_is_written_down(tmp_path: Path) -> None:
    file = tmp_path / "journal.db"
    async with await Journal.open(file, WallClock()) as journal, rigged(journal=journal) as rig:
        rig.start(
            planner_chain("g", [node("JoinText", 0, left="a", right="b"), node("Fail", 1, reason="door")])
        )
        await rig.until_graph("g", "HALTED")
        await journal.flush()
        ((failed,),) = rows(file, "SELECT saved FROM node WHERE node = 'Fail_1' AND state = 'ERROR'")
        assert "door" in json.loads(failed)["log"][-1][1]
        rig.modify(planner_chain("g", [node("JoinText", 0, left="a", right="b"), node("NoOp", 2)]), "NoOp_2")
        await rig.until(lambda: rig.graph_states("g")[-1:] == ["HALTED"] and len(rig.graph_states("g")) > 3)
        await journal.flush()
    ((started, now),) = rows(file, "SELECT graph_started, graph_now FROM run")
    assert [item.full_name for item in read_graph(started).nodes] == ["JoinText_0", "Fail_1"]
    assert [item.full_name for item in read_graph(now).nodes] == ["JoinText_0", "NoOp_2"]
    ((outputs,),) = rows(file, "SELECT saved FROM node WHERE node = 'JoinText_0'")
    assert json.loads(outputs)["outputs"] == {"text": "a-b"}


async def run_to_its_end(journal: Journal, name: str, length: int) -> None:
    await run_to_its_rest(journal, chain(name, [node("NoOp", index) for index in range(length)]))


async def run_to_its_rest(journal: Journal, graph: dict[str, Any]) -> None:
    run = GraphRun(
        read_graph(graph),
        CATALOGUE,
        actor="A",
        clock=WallClock(),
        make_context=lambda handle: handle,
        observer=lambda transition: journal.record(run, transition),
    )
    run.start()
    await run.wait()


async def test_old_runs_are_cut(tmp_path: Path, monkeypatch: Any) -> None:
    monkeypatch.setattr(room, "KEPT_RUNS", 20)
    file = tmp_path / "journal.db"
    async with await Journal.open(file, WallClock()) as journal:
        for index in range(201):
            await run_to_its_end(journal, f"g{index}", 1)
        await run_to_its_end(journal, "long", 50)
    ((runs,),) = rows(file, "SELECT count(*) FROM run")
    assert runs <= 20 + room.TIDY_EVERY
    ((orphans,),) = rows(file, "SELECT count(*) FROM node WHERE run NOT IN (SELECT id FROM run)")
    assert orphans == 0


async def test_a_journal_that_cannot_be_written_stops_nobody(tmp_path: Path) -> None:
    file = tmp_path / "journal.db"
    async with await Journal.open(file, WallClock()) as journal:
        with sqlite3.connect(file) as connection:
            connection.execute("DROP TABLE node")
        connection.close()
        await run_to_its_end(journal, "g", 3)
        await journal.flush()


async def test_a_graph_that_waits_for_repair_was_interrupted_and_one_that_ran_dry_was_not(
    tmp_path: Path,
) -> None:
    file = tmp_path / "journal.db"
    journal = await Journal.open(file, WallClock())
    await run_to_its_rest(journal, planner_chain("repair", [node("NoOp", 0), node("Fail", 1, reason="door")]))
    await run_to_its_rest(journal, planner_chain("dry", [node("NoOp", 0), node("NoOp", 1)]))
    await journal.flush()
    second = await Journal.open(file, WallClock())  # the first is still open, as after a kill
    assert [was.graph.name for was in second.interrupted] == ["repair"]
    assert second.interrupted[0].remaining[0].state is NodeState.ERROR
    await second.close()
    await journal.close()
    await asyncio.sleep(0)


async def test_a_graph_that_is_only_named_like_an_inner_one_is_offered(tmp_path: Path) -> None:
    names, path = ["job", "job__east__1"], tmp_path / "journal.db"
    async with (
        rigged() as rig,
        await Journal.open(path, WallClock()) as journal,
        engine_of("B", rig, journal=journal),
    ):
        for name in names:
            rig.start(chain(name, [node("WaitFor", 0, seconds=60.0)]), ["B"])
            await rig.until_graph(name, "RUNNING")
        await journal.flush()
        with contextlib.closing(sqlite3.connect(path)) as file:
            left, _ = room.read_left(file)
        assert [item.graph.name for item in left] == names


async def test_people_are_told_when_it_cannot_be_written_and_when_it_can_again(tmp_path: Path) -> None:
    told: asyncio.Queue[str] = asyncio.Queue()
    file = tmp_path / "journal.db"
    async with (
        await Journal.open(file, WallClock(), tell=told.put_nowait) as journal,
        rigged(journal=journal) as rig,
    ):
        await journal._database.run(lambda db: db.execute("PRAGMA query_only = 1").fetchall())
        rig.start(planner_chain("errand", [node("WaitFor", 0, seconds=60.0)]))
        assert "cannot be written down" in await told.get()
        await journal._database.run(lambda db: db.execute("PRAGMA query_only = 0").fetchall())
        await rig.until_node("errand", "WaitFor_0", ["RUNNING"])
        rig.stop("errand")
        assert "written down again" in await told.get()
        await rig.until_graph("errand", "STOPPED")
        await journal.flush()
        assert told.empty()
