"""An emergency stop outlives the process: only a person ends it."""

from __future__ import annotations

from pathlib import Path

from parley.clock import WallClock
from parley.engine.journal import Journal

from .rig import DummyRobot, Rig, rigged


def said(rig: Rig, state: str) -> bool:
    return any(report.state == state for report in rig.reports)


async def test_a_stop_that_nobody_reset_holds_after_a_restart(tmp_path: Path) -> None:
    file = tmp_path / "journal.db"
    async with await Journal.open(file, WallClock()) as journal, rigged(DummyRobot(), journal=journal) as rig:
        rig.emergency("stop")
        await rig.until(lambda: said(rig, "at_rest"))
        await journal.flush()

    robot = DummyRobot()
    async with await Journal.open(file, WallClock()) as journal, rigged(robot, journal=journal) as again:
        assert journal.latched == {"A"}
        await again.until(lambda: said(again, "at_rest"))
        assert robot.told == ["stop"]
        assert again.statuses[-1].state == "stopped"
        again.emergency("reset")
        await again.until(lambda: said(again, "reset"))
        await journal.flush()

    async with await Journal.open(file, WallClock()) as journal:
        assert journal.latched == frozenset()
