"""The measurement of the simulator measures what it says."""

from __future__ import annotations

import pytest

from parley.bench.simulator import measure_simulator
from parley.demos.catalogue import load_demo


async def test_all_robots_drive_and_take_five_pictures_a_second() -> None:
    without, with_cameras = [run async for run in measure_simulator(load_demo("fleet").world, 0.4)]
    assert (without.robots, without.pictures) == (3, 0)
    assert with_cameras.robots == 3
    assert 2 * 3 <= with_cameras.pictures <= 3 * 3
    for run in (without, with_cameras):
        assert run.robot_s == pytest.approx(0.4, abs=0.21)
    assert without.per_core > 0
