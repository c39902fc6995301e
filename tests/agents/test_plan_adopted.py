"""Plans with conditions and concurrency after a kill: the engine takes the graph up, the planner the plan."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from parley.agents.planner.restore import adopted_steps, interruption_text, restored_steps
from parley.clock import WallClock
from parley.engine.interrupted import Interrupted
from parley.engine.journal import Journal
from parley.messages.chat import ActionCall
from parley.umrf.model import GraphState
from tests.agents.crew import Crew, ask, crew, drive, look
from tests.agents.test_plan_flow import beside, check, when


async def interrupted(folder: Path, there: set[str], running: list[str], *order: ActionCall) -> Interrupted:
    """What the journal held at the moment when the steps were in these states."""
    async with crew() as party, await Journal.open(folder / "journal.db", WallClock()) as journal:
        await party.engine("A", journal=journal)
        party.body.there = there
        party.body.far.add(1)
        party.body.gate("lid")
        party.order(*order)
        await party.until(lambda: party.steps() == running)
        await journal.flush()
        shutil.copytree(folder, folder / "copy")
        party.body.far.clear()
        party.body.gate("lid").set()
        party.body.gate("ready").set()
        await party.state("idle")
    async with await Journal.open(folder / "copy" / "journal.db", WallClock()) as copy:
        (was,) = copy.interrupted
        return was


async def taken_up(party: Crew, was: Interrupted) -> None:
    """The robot comes back, and its engine and the planner take up what was left."""
    engine = await party.engine("A")
    engine.restore(was)
    steps = adopted_steps(was)
    assert restored_steps(was) == []
    assert "carry on" in interruption_text(was, True)
    party.planner.adopt("A", was.graph.name, steps, dry=was.graph.state is GraphState.HALTED)
    await party.state("paused")


async def test_branch_goes_on_where_it_was_and_the_other_stays_left_out(tmp_path: Path) -> None:
    order = [check("box"), when(drive(1), 0), when(look("floor"), 0, False), look("door")]
    was = await interrupted(tmp_path, {"box"}, ["finished", "running", "skipped", "queued"], *order)
    async with crew() as party:
        await taken_up(party, was)
        assert party.body.did == []
        party.command("start")
        await party.state("idle")
        assert party.body.did == ["drive 1", "look door"]
        assert party.steps() == ["finished", "finished", "skipped", "finished"]


async def test_condition_that_was_not_decided_yet_is_decided_then(tmp_path: Path) -> None:
    order = [ask("ready"), check("box"), when(look("floor"), 1), when(look("roof"), 1, False), look("door")]
    was = await interrupted(tmp_path, set(), ["waiting", *["queued"] * 4], *order)
    async with crew() as party:
        await taken_up(party, was)
        party.command("start")
        await party.until(lambda: party.body.did == ["ask ready"])
        party.body.gate("ready").set()
        await party.state("idle")
        assert party.body.did == ["ask ready", "check box", "look roof", "look door"]


async def test_steps_that_ran_at_the_same_time_are_both_run_again_and_what_follows_once(
    tmp_path: Path,
) -> None:
    order = [drive(1), beside(look("lid"), 0), look("door")]
    was = await interrupted(tmp_path, set(), ["running", "running", "queued"], *order)
    async with crew() as party:
        await taken_up(party, was)
        party.command("start")
        await party.state("idle")
        assert sorted(party.body.did[:2]) == ["drive 1", "look lid"]
        assert party.body.did[2:] == ["look door"]


@pytest.mark.parametrize("word", ["clear", "skip"])
async def test_what_is_taken_up_can_be_dropped(tmp_path: Path, word: str) -> None:
    order = [check("box"), when(drive(1), 0), look("door")]
    was = await interrupted(tmp_path, {"box"}, ["finished", "running", "queued"], *order)
    async with crew() as party:
        await taken_up(party, was)
        party.command(word)
        if word == "skip":
            party.command("start")
        await party.state("idle")
        await party.settled()
        assert party.body.did == ([] if word == "clear" else ["look door"])
