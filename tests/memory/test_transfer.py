"""Memories on their way between files: nothing is lost, and what is wrong changes nothing."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from parley.clock import SimClock
from parley.errors import FileFormatError, StoreError
from parley.memory.store import MemoryStore
from parley.memory.transfer import ExportFile, MergeCounts, read_export
from parley.messages.memory import MemoryEntry
from tests.memory.photos import photo


class Late(SimClock):
    unix = 10_000

    def unix_ms(self) -> int:
        return self.unix


def entry(name: str = "box", data: str = "x", at: int = 1_000, **rest: Any) -> MemoryEntry:
    return MemoryEntry(name=name, data=data, updated_unix_ms=at, created_unix_ms=at, **rest)


async def opened() -> MemoryStore:
    return await MemoryStore.open(":memory:", Late())


async def opened_later() -> MemoryStore:
    clock = Late()
    clock.unix = 20_000
    return await MemoryStore.open(":memory:", clock)


def write(folder: Path, value: Any) -> Path:
    path = folder / "export.json"
    path.write_text(value if isinstance(value, str) else json.dumps(value), encoding="utf-8")
    return path


async def test_what_is_exported_comes_back_whole_pictures_times_and_history_too(tmp_path: Path) -> None:
    async with await opened() as store:
        await store.add(entry("box", "old", source="Kim"))
        await store.add(entry("box", "new", scope="A", info="the box"))
        await store.add(entry("box", "newer"))
        await store.add(entry("photo", photo(), type="image"))
        await store.mark_used(["box"])
        memories, history = await store.all(), await store.history()
        file = ExportFile(memories=tuple(memories), history=tuple(history))
    found = read_export(write(tmp_path, file.model_dump_json()))
    async with await opened_later() as other:
        assert await other.merge(found.memories, found.history) == MergeCounts(added=3)
        assert await other.all() == memories
        assert await other.history() == history
        assert [e.name for e in await other.search("the box")] == ["box", "box"]
        assert await other.merge(found.memories, found.history) == MergeCounts(unchanged=3)
        assert await other.history() == history


async def test_of_one_name_the_later_fact_wins_and_the_other_goes_to_the_history() -> None:
    async with await opened() as store:
        await store.merge([entry("a", "ours", 5_000), entry("b", "ours", 5_000)])
        counts = await store.merge([entry("a", "theirs", 4_000), entry("b", "theirs", 6_000), entry("c")])
        assert counts == MergeCounts(added=1, replaced=1, kept=1)
        assert {e.name: e.data for e in await store.all()} == {"a": "ours", "b": "theirs", "c": "x"}
        assert [e.data for e in await store.history("a")] == ["theirs"]
        assert [e.data for e in await store.history("b")] == ["ours"]
        assert await store.search("theirs") == [e for e in await store.all() if e.name == "b"]


async def test_scopes_are_told_apart() -> None:
    async with await opened() as store:
        await store.merge([entry("dock", "all"), entry("dock", "own", scope="A")])
        assert await store.merge([entry("dock", "newer", 2_000, scope="A")]) == MergeCounts(replaced=1)
        assert [(e.scope, e.data) for e in await store.all()] == [("", "all"), ("A", "newer")]


async def test_memories_stay_in_the_order_of_their_times() -> None:
    async with await opened() as store:
        await store.merge([entry("b", at=3_000), entry("d", at=7_000)])
        await store.merge([entry("a", at=2_000), entry("c", at=5_000)])
        await store.add(entry("e"))
        assert [e.name for e in await store.all()] == list("abcde")
        assert [e.name for e in await store.newest(2)] == ["e", "d"]


async def test_times_in_the_future_are_taken_for_now() -> None:
    async with await opened() as store:
        await store.merge([entry(at=99_999_999)])
        assert (await store.all())[0].updated_unix_ms == 10_000
        assert (await store.add(entry("next"))).updated_unix_ms == 10_001


async def test_history_that_comes_in_is_bounded_like_our_own() -> None:
    async with await opened() as store:
        older = [entry("box", str(n), n, ended_unix_ms=n + 1) for n in range(1, 81)]
        await store.merge([entry("box", "now", 9_000)], older)
        assert [e.data for e in await store.history("box")] == [str(n) for n in range(31, 81)]
        assert [e.data for e in await store.all()] == ["now"]


async def test_merge_that_fails_halfway_changes_nothing() -> None:
    async with await opened() as store:
        await store.add(entry("box", "ours"))
        broken = entry("chair").model_copy(update={"data": "\ud800"})
        with pytest.raises(StoreError):
            await store.merge([entry("box", "theirs", 9_999), broken])
        assert [(e.name, e.data) for e in await store.all()] == [("box", "ours")]
        await store.add(entry("still", "usable"))


BOX = {"name": "box", "data": "x"}
GOOD: dict[str, Any] = {"format": "parley-memory", "version": 1, "memories": [BOX]}


@pytest.mark.parametrize(
    ("value", "where"),
    [
        ("{", "not valid JSON"),
        ([], "format"),
        ({"format": "other", "version": 1}, "format"),
        ({**GOOD, "version": 2}, "version"),
        ({**GOOD, "memories": [{"name": "box"}]}, r"memories\[0\]\.data"),
        ({**GOOD, "memories": [{"name": "", "data": "x"}]}, r"memories\[0\]\.name"),
        ({**GOOD, "memories": [BOX, BOX]}, r"memories\[1\]\.name"),
        ({**GOOD, "memories": [{"name": "p", "type": "image", "data": "aGk="}]}, r"memories\[0\]\.data"),
        ({**GOOD, "history": [{"name": "p", "data": "\ud800"}]}, r"history\[0\]"),
        ({**GOOD, "surprise": 1}, "surprise"),
    ],
)
def test_what_does_not_fit_is_refused_with_its_place(tmp_path: Path, value: Any, where: str) -> None:
    with pytest.raises(FileFormatError, match=where):
        read_export(write(tmp_path, value))


def test_file_that_is_not_there_is_named(tmp_path: Path) -> None:
    with pytest.raises(FileFormatError, match=r"gone\.json: cannot be read"):
        read_export(tmp_path / "gone.json")
