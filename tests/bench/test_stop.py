"""`parley bench stop`: a press reaches the drive within its budget, and the robot comes to rest."""

from __future__ import annotations

from parley.bench.stop import WAYS, measure_stop

BUDGET_MS = 50.0


async def test_a_driving_robot_is_stopped_in_every_way() -> None:
    figures = {item.way: item async for item in measure_stop(1, ["database_locked"])}
    assert tuple(figures) == WAYS
    for way in ("press", "topic"):
        assert max(figures[way].drive_ms) < BUDGET_MS, way
    assert all(item.drive_ms[0] <= item.rest_ms[0] < 1000 for item in figures.values())
