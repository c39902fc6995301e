"""Records of failures: kept, found again, bounded."""

from __future__ import annotations

import asyncio
from pathlib import Path

import pytest

from parley.clock import WallClock
from parley.errors import StoreError
from parley.memory import incidents
from parley.memory.incidents import IncidentStore
from parley.messages.chat import ActionCall
from parley.messages.incident import Incident, IncidentAttempt


def incident(number: int, robot: str = "A", **changes: object) -> Incident:
    base = Incident(id=f"i{number}", robot=robot, step=ActionCall(name="Look"), message="A box.")
    return base.model_copy(update=changes)


async def test_record_survives_closing_with_all_that_it_says(tmp_path: Path) -> None:
    attempts = (IncidentAttempt(kind="asked", asked="Why?", answered="Because.", tried="That.", unix_ms=5),)
    kept = incident(1, attempts=attempts, ending="solved", closed_unix_ms=9, note="Well.")
    async with await IncidentStore.open(tmp_path / "incidents.db", WallClock()) as store:
        await store.save(kept)
    async with await IncidentStore.open(tmp_path / "incidents.db", WallClock()) as store:
        assert await store.newest() == (kept,)


async def test_newest_failures_come_first_and_a_change_does_not_move_them(tmp_path: Path) -> None:
    async with await IncidentStore.open(":memory:", WallClock()) as store:
        for number in (1, 2, 3):
            await store.save(incident(number))
        await store.save(incident(1, ending="held"))
        assert [(item.id, item.ending) for item in await store.newest(limit=2)] == [
            ("i3", "open"),
            ("i2", "open"),
        ]
        assert [item.id for item in await store.still_open()] == ["i2", "i3"]


async def test_one_robots_records_are_found_whatever_the_capitals() -> None:
    async with await IncidentStore.open(":memory:", WallClock()) as store:
        await store.save(incident(1, "Ada"))
        await store.save(incident(2, "Bob"))
        assert [item.id for item in await store.newest("ADA")] == ["i1"]


async def test_only_so_many_are_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(incidents, "KEPT", 3)
    async with await IncidentStore.open(":memory:", WallClock()) as store:
        for number in range(8):
            await store.save(incident(number))
        assert [item.id for item in await store.newest()] == ["i7", "i6", "i5"]


async def test_damaged_file_is_put_aside(tmp_path: Path) -> None:
    (tmp_path / "incidents.db").write_bytes(b"no database at all" * 100)
    async with await IncidentStore.open(tmp_path / "incidents.db", WallClock()) as store:
        await store.save(incident(1))
    assert await asyncio.to_thread(lambda: list(tmp_path.glob("incidents.db.corrupt-*")))


async def test_closed_store_says_so() -> None:
    store = await IncidentStore.open(":memory:", WallClock())
    await store.close()
    with pytest.raises(StoreError, match="closed"):
        await store.save(incident(1))
