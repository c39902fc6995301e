"""An emergency stop outlives the process: only a person ends it."""

from __future__ import annotations

from pathlib import Path

from parley.gate.stop_line import StopLine

from .rig import DummyRobot, Rig, rigged


def said(rig: Rig, state: str) -> bool:
    return any(report.state == state for report in rig.reports)


async def test_a_stop_that_nobody_reset_holds_after_a_restart(tmp_path: Path) -> None:
    file = tmp_path / "stops.json"
    line = StopLine(file)
    async with rigged(DummyRobot(), line=line) as rig:
        line.pull(["A"], by=None)
        await rig.until(lambda: said(rig, "received"))

    again_line = StopLine(file)  # the other was never closed
    robot = DummyRobot()
    async with rigged(robot, line=again_line) as again:
        await again.until(lambda: said(again, "at_rest"))
        assert robot.told == ["halt"]
        assert again.statuses[-1].state == "stopped"
