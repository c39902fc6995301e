"""A damaged page loses what stood on it and nothing else; the damage is real bytes in a real file."""

from __future__ import annotations

import asyncio
import sqlite3
from collections.abc import Callable
from contextlib import closing
from pathlib import Path

import pytest

from parley.clock import SimClock
from parley.memory.incidents import IncidentStore
from parley.memory.store import MemoryStore
from parley.messages.memory import MemoryEntry
from tests.memory.test_incidents import incident

PAGE = 4096
COUNT = 300
GARBAGE = bytes(range(7, 256)) * 17


async def filled(path: Path) -> None:
    """A file with all kinds of pages, a forgotten memory and one with a history."""
    async with await MemoryStore.open(path) as store:
        for number in range(COUNT):
            await store.add(MemoryEntry(name=f"m{number}", data=f"fact {number} " * 20))
        await store.add(MemoryEntry(name="long", data="long story " * 2000))
        await store.add(MemoryEntry(name="m1", data="another fact"))
        await store.remove("m2")


def root(path: Path, name: str) -> int:
    with closing(sqlite3.connect(path)) as db:
        (number,) = db.execute("SELECT rootpage FROM sqlite_master WHERE name = ?", (name,)).fetchone()
    return int(number) - 1


def pages(path: Path) -> list[bytes]:
    content = path.read_bytes()
    return [content[at : at + PAGE] for at in range(0, len(content), PAGE)]


def leaf_with(text: bytes) -> Callable[[Path], int]:
    return lambda path: next(
        number for number, page in enumerate(pages(path)) if number and page[0] == 0x0D and text in page
    )


def index_leaf(path: Path) -> int:
    return next(
        number for number, page in enumerate(pages(path)) if number and page[0] == 0x0A and b"m77" in page
    )


def overflow(path: Path) -> int:
    return next(
        number for number, page in enumerate(pages(path)) if page[0] == 0 and page.count(b"long story") > 300
    )


def damaged(path: Path, page: int, *, until: int = PAGE) -> None:
    content = bytearray(path.read_bytes())
    content[page * PAGE : page * PAGE + until] = GARBAGE[:until]
    path.write_bytes(content)


@pytest.mark.parametrize(
    ("find", "until", "lost_at_most"),
    [
        (leaf_with(b"fact 150 "), PAGE, 20),
        (leaf_with(b"fact 3 "), PAGE, 20),
        (index_leaf, PAGE, 0),
        (lambda path: root(path, "memory_current"), PAGE, 0),
        (lambda path: root(path, "memory_search_data"), PAGE, 0),
        (lambda path: root(path, "memory_search_docsize"), PAGE, 0),
        (lambda path: root(path, "memory_vector"), PAGE, 0),
        (overflow, PAGE, 1),
        (lambda path: 0, 100, 0),
    ],
    ids=[
        "leaf",
        "first leaf",
        "index",
        "root of index",
        "text index",
        "text sizes",
        "vectors",
        "overflow",
        "header",
    ],
)
async def test_a_damaged_page_loses_what_stood_on_it(
    tmp_path: Path, find: Callable[[Path], int], until: int, lost_at_most: int
) -> None:
    path = tmp_path / "memory.db"
    await filled(path)
    async with await MemoryStore.open(path) as store:
        before = {entry.name: entry for entry in await store.all()}
        assert store.notice == ""
    damaged(path, find(path), until=until)
    broken = path.read_bytes()

    async with await MemoryStore.open(path, SimClock()) as store:
        after = {entry.name: entry for entry in await store.all()}
        assert len(before) - lost_at_most <= len(after) <= len(before)
        assert all(before[name] == entry for name, entry in after.items())
        assert "m2" not in after, "what was forgotten stays forgotten"
        assert "was kept" in store.notice
        assert "memory.db.corrupt-" in store.notice
        assert [entry.name for entry in await store.search("fact 299")][:1] == ["m299"]
        added = await store.add(MemoryEntry(name="new", data="a new box"))
        assert [entry.name for entry in await store.search("new box")] == [added.name]
    (aside,) = await asyncio.to_thread(lambda: [*tmp_path.glob("*.corrupt-*")])
    assert aside.read_bytes() == broken
    async with await MemoryStore.open(path) as store:
        assert store.notice == ""
        assert len(await store.all()) == len(after) + 1


async def test_two_damaged_pages_lose_what_stood_on_both(tmp_path: Path) -> None:
    path = tmp_path / "memory.db"
    await filled(path)
    for text in (b"fact 50 ", b"fact 200 "):
        damaged(path, leaf_with(text)(path))
    async with await MemoryStore.open(path) as store:
        kept = {entry.name for entry in await store.all()}
        assert len(kept) > COUNT - 40
        assert {"m10", "m100", "m298", "long"} <= kept
        assert not {"m50", "m200"} & kept


async def test_other_files_lose_no_more_either(tmp_path: Path) -> None:
    path = tmp_path / "incidents.db"
    async with await IncidentStore.open(path, SimClock()) as store:
        for number in range(100):
            await store.save(incident(number))
    damaged(path, leaf_with(b'"i50"')(path))
    async with await IncidentStore.open(path, SimClock()) as store:
        kept = {found.id for found in await store.newest()}
        assert "kept" in store.notice
    assert 80 < len(kept) < 100
