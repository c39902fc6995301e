"""The memory store: what is remembered, replaced, forgotten, found, and kept through every mishap."""

from __future__ import annotations

import asyncio
import os
import re
import signal
import sqlite3
import subprocess
import sys
from collections.abc import AsyncIterator
from contextlib import closing
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from parley.clock import SimClock
from parley.errors import StoreError
from parley.memory.store import MemoryStore
from parley.messages.memory import MemoryEntry


class SteppingClock(SimClock):
    """A clock that a test sets."""

    unix = 1_000

    def unix_ms(self) -> int:
        return self.unix


@pytest.fixture
async def store() -> AsyncIterator[MemoryStore]:
    async with await MemoryStore.open(":memory:") as opened:
        yield opened


async def fill(store: MemoryStore, **texts: str) -> None:
    for name, data in texts.items():
        await store.add(MemoryEntry(name=name, data=data))


def names(entries: list[MemoryEntry]) -> list[str]:
    return [entry.name for entry in entries]


# Adding, replacing, forgetting


async def test_a_memory_comes_back_whole_with_its_times() -> None:
    clock = SteppingClock()
    async with await MemoryStore.open(":memory:", clock) as store:
        entry = MemoryEntry(
            name="box", type="image", data="aGk=", info="the box", scope="A", source="operator"
        )
        stored = await store.add(entry)
        assert stored == entry.model_copy(update={"created_unix_ms": 1_000, "updated_unix_ms": 1_000})
        assert await store.get("box", scope="A") == stored
        assert await store.get("box") is None
        assert await store.all() == [stored]


async def test_a_memory_of_the_same_name_is_replaced_and_the_older_one_kept_as_history() -> None:
    clock = SteppingClock()
    async with await MemoryStore.open(":memory:", clock) as store:
        old = await store.add(MemoryEntry(name="box", data="by the door"))
        clock.unix = 2_000
        new = await store.add(MemoryEntry(name="box", data="on the chair"))
        assert (new.created_unix_ms, new.updated_unix_ms) == (1_000, 2_000)
        assert await store.all() == [new]
        assert await store.history("box") == [old.model_copy(update={"ended_unix_ms": 2_000})]
        assert names(await store.search("door")) == []
        assert names(await store.search("chair")) == ["box"]


async def test_memories_of_one_name_in_different_scopes_stand_side_by_side(store: MemoryStore) -> None:
    for scope in ("", "A", "B"):
        await store.add(MemoryEntry(name="dock", data=f"dock of {scope}", scope=scope))
    assert [entry.scope for entry in await store.all()] == ["", "A", "B"]
    assert [entry.scope for entry in await store.all(scope="A")] == ["", "A"]
    assert [entry.scope for entry in await store.all(scope="")] == [""]
    assert {entry.scope for entry in await store.search("dock", scope="B")} == {"", "B"}


async def test_forgetting_takes_a_memory_out_of_everything_but_the_history(store: MemoryStore) -> None:
    await fill(store, box="by the door")
    assert await store.remove("box") is True
    assert await store.remove("box") is False
    assert await store.get("box") is None
    assert await store.all() == []
    assert await store.search("box door") == []
    assert [entry.data for entry in await store.history("box")] == ["by the door"]


async def test_forgetting_concerns_one_scope_unless_all_are_meant(store: MemoryStore) -> None:
    for scope in ("", "A", "B"):
        await store.add(MemoryEntry(name="dock", data="x", scope=scope))
    assert await store.remove("dock", scope="A")
    assert [entry.scope for entry in await store.all()] == ["", "B"]
    assert await store.remove("dock", scope=None)
    assert await store.all() == []


async def test_what_is_said_again_after_it_was_forgotten_is_new() -> None:
    clock = SteppingClock()
    async with await MemoryStore.open(":memory:", clock) as store:
        await fill(store, box="here")
        await store.remove("box")
        clock.unix = 5_000
        assert (await store.add(MemoryEntry(name="box", data="there"))).created_unix_ms == 5_000


async def test_memories_come_oldest_first_and_a_changed_one_counts_as_new(store: MemoryStore) -> None:
    await fill(store, a="1", b="2", c="3")
    await fill(store, a="4")
    assert names(await store.all()) == ["b", "c", "a"]
    assert names(await store.newest(2)) == ["a", "c"]


@pytest.mark.spec("P17")
async def test_time_stamps_keep_their_order_when_the_clock_goes_back() -> None:
    clock = SteppingClock()
    async with await MemoryStore.open(":memory:", clock) as store:
        stamps = []
        for unix in (5_000, 5_000, 0, 9_000):
            clock.unix = unix
            stamps.append((await store.add(MemoryEntry(name=f"at {unix}", data="x"))).updated_unix_ms)
    assert stamps == [5_000, 5_001, 5_002, 9_000]


async def test_the_history_of_something_that_changes_all_the_time_is_bounded(store: MemoryStore) -> None:
    await fill(store, other="1")
    await fill(store, other="2")
    for number in range(80):
        await fill(store, position=str(number))
    assert [entry.data for entry in await store.history("position")] == [str(n) for n in range(29, 79)]
    assert [entry.data for entry in await store.history("other")] == ["1"]


async def test_changes_made_at_the_same_time_are_all_there(store: MemoryStore) -> None:
    await asyncio.gather(*(store.add(MemoryEntry(name=f"m{n % 25}", data=str(n))) for n in range(100)))
    assert len(await store.all()) == 25
    assert sum([len(await store.history(f"m{n}")) for n in range(25)]) == 75


async def test_a_cancelled_change_leaves_the_store_usable(store: MemoryStore) -> None:
    task = asyncio.create_task(fill(store, box="x"))
    await asyncio.sleep(0)
    task.cancel()
    with pytest.raises(asyncio.CancelledError):
        await task
    await fill(store, chair="y")
    assert "chair" in names(await store.all())


async def test_what_was_forgotten_can_be_remembered_again(store: MemoryStore) -> None:
    await store.add(MemoryEntry(name="box", data="by the door", info="the box", source="Kim"))
    assert await store.restore("box") is None, "it was not forgotten"
    await store.remove("box")
    again = await store.restore("box")
    assert again is not None
    assert (again.data, again.info, again.source, again.ended_unix_ms) == ("by the door", "the box", "Kim", 0)
    assert await store.get("box") == again
    assert await store.restore("chair") is None


async def test_restoring_concerns_one_scope(store: MemoryStore) -> None:
    await store.add(MemoryEntry(name="dock", data="own", scope="A"))
    await store.remove("dock", "A")
    assert await store.restore("dock") is None
    assert (again := await store.restore("dock", "A")) is not None
    assert again.scope == "A"


async def test_use_is_counted_with_its_time_and_changes_neither_order_nor_text() -> None:
    clock = SteppingClock()
    async with await MemoryStore.open(":memory:", clock) as store:
        await fill(store, a="1", b="2")
        clock.unix = 5_000
        await store.mark_used(["a", "unheard of"])
        await store.mark_used(["a"])
        used, unused = await store.all()
        assert (used.name, used.used_count, used.used_unix_ms, used.updated_unix_ms) == ("a", 2, 5_000, 1_000)
        assert (unused.used_count, unused.used_unix_ms) == (0, 0)
        await fill(store, a="3")
        assert [entry.used_count for entry in await store.all()] == [0, 0], "the new fact was never used"
        assert [entry.used_count for entry in await store.history("a")] == [2]


async def test_of_one_name_the_robots_own_memory_is_the_one_that_was_used(store: MemoryStore) -> None:
    for scope in ("", "A"):
        await store.add(MemoryEntry(name="dock", data="x", scope=scope))
    await store.mark_used(["dock"], ["A"])
    await store.mark_used(["dock"], ["A", "B"])
    assert [(entry.scope, entry.used_count) for entry in await store.all()] == [("", 1), ("A", 2)]


async def test_texts_and_pictures_are_listed_apart(store: MemoryStore) -> None:
    await store.add(MemoryEntry(name="photo", type="image", data="aGk="))
    await fill(store, box="x")
    assert names(await store.all(kind="image")) == ["photo"]
    assert names(await store.all(kind="text")) == ["box"]


# Searching


async def test_a_memory_called_what_is_asked_for_comes_first(store: MemoryStore) -> None:
    await fill(store, chair_place="The chair is red.", notes="chair place, chair place", x="chair")
    assert names(await store.search("Chair place"))[0] == "chair_place"
    assert names(await store.search("chairPlace"))[0] == "chair_place"
    await fill(store, spare_chair_place="short")
    assert names(await store.search("chair place"))[0] == "chair_place"


async def test_a_name_of_words_that_tell_nothing_is_found_by_that_name(store: MemoryStore) -> None:
    await fill(store, where_it_is="somewhere", other="box")
    assert names(await store.search("where it is")) == ["where_it_is"]


@pytest.mark.parametrize(
    "query", ["Where are the boxes?", "is there a BOX", "Böx", "boxe", "the box’s colour", "go & fetch: box!"]
)
async def test_words_are_found_whatever_their_case_ending_and_surroundings(
    store: MemoryStore, query: str
) -> None:
    await fill(store, a="The box stands by the door.", b="The chair stands by the wall.")
    assert names(await store.search(query)) == ["a"]


async def test_memories_that_share_rarer_words_come_first(store: MemoryStore) -> None:
    for number in range(30):
        await fill(store, **{f"chair{number}": f"chair number {number} stands in the hall"})
    await fill(store, lamp="the lamp stands in the hall")
    await fill(store, **{"last chair": "a chair stands in the hall"})
    assert names(await store.search("the lamp in the hall"))[0] == "lamp"


async def test_letters_and_numbers_tell_things_of_a_kind_apart(store: MemoryStore) -> None:
    for letter in "ABCDEF":
        await store.add(MemoryEntry(name=f"area_{letter}", data=f"Area {letter} has a pallet."))
    await fill(
        store, gate3="Gate 3 is shut.", gate4="Gate 4 is open.", note="a letter in an area: be careful"
    )
    assert names(await store.search("is something in area D?"))[0] == "area_D"
    assert names(await store.search("go to area a"))[0] == "area_A"
    assert names(await store.search("what about gate 3"))[0] == "gate3"


async def test_the_beginning_of_a_word_finds_it_where_nobody_used_it_whole(store: MemoryStore) -> None:
    await fill(store, a="The workbench is full.", b="Work begins at eight.")
    assert names(await store.search("workben")) == ["a"]
    assert names(await store.search("work")) == ["b"]


async def test_pictures_are_found_by_name_and_info_and_never_by_their_bytes(store: MemoryStore) -> None:
    await store.add(MemoryEntry(name="photo", type="image", data="box", info="the door from outside"))
    assert names(await store.search("door")) == ["photo"]
    assert await store.search("box") == []
    await store.remove("photo")
    assert await store.search("door") == []


@pytest.mark.parametrize(
    "query",
    [
        "",
        "   ",
        "?",
        "where is it",
        '"',
        '" OR "',
        "box OR",
        "NEAR(",
        "name:",
        "*",
        "(",
        "-box",
        "a'b",
        "\x00",
        "🤖",
    ],
)
async def test_no_query_is_too_strange(store: MemoryStore, query: str) -> None:
    await fill(store, a="The chair stands by the door.")
    assert await store.search(query) == []


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], max_examples=60, deadline=None)
@given(query=st.text())
async def test_any_query_gets_an_answer(store: MemoryStore, query: str) -> None:
    await store.search(query)


async def test_not_more_are_returned_than_asked_for(store: MemoryStore) -> None:
    for number in range(30):
        await fill(store, **{f"box{number}": "a box"})
    assert len(await store.search("box")) == 20
    assert len(await store.search("box", limit=3)) == 3


async def test_an_old_memory_with_two_common_words_is_found_among_many_with_one(store: MemoryStore) -> None:
    await fill(store, wanted="The red box is in the attic.")
    for number in range(400):
        await fill(store, **{f"n{number}": ["a red chair", "a blue box", "a red lamp", "a box"][number % 4]})
    assert names(await store.search("the red box"))[0] == "wanted"


async def test_an_old_memory_with_a_rare_and_a_common_word_beats_those_with_one(store: MemoryStore) -> None:
    await fill(store, wanted="The red teapot.", other="The tin teapot.")
    for number in range(900):
        await fill(store, **{f"n{number}": ["a red chair", "a lamp", "a shelf"][number % 3]})
    await fill(store, **{"one more": "a red chair"})
    assert names(await store.search("red teapot"))[:2] == ["wanted", "other"]


async def test_an_old_memory_with_three_common_words_is_found_among_many_with_two(store: MemoryStore) -> None:
    await fill(store, wanted="A red box, open.")
    texts = ["a red box", "a box, open", "something red, open", "a lamp", "a shelf", "a cart"]
    await asyncio.gather(
        *(store.add(MemoryEntry(name=f"n{n}", data=texts[n % 6])) for n in range(310 * len(texts)))
    )
    assert names(await store.search("the red open box"))[0] == "wanted"


# All of it together

some_names = st.sampled_from(["box", "chair", "chairPlace", "chair_place"])
some_scopes = st.sampled_from(["", "A", "B"])
changes = st.lists(st.tuples(st.booleans(), some_names, some_scopes | st.none()), max_size=25)


@settings(max_examples=40, deadline=None)
@given(changes)
def test_after_any_changes_the_store_says_and_finds_what_a_plain_list_would(
    steps: list[tuple[bool, str, str | None]],
) -> None:
    async def run() -> None:
        expected: dict[tuple[str, str], str] = {}
        ended = 0
        async with await MemoryStore.open(":memory:") as store:
            for number, (is_addition, name, scope) in enumerate(steps):
                concerned = [key for key in expected if key[0] == name and scope in (None, key[1])]
                if is_addition:
                    concerned = [(name, scope or "")]
                    ended += concerned[0] in expected
                    await store.add(MemoryEntry(name=name, scope=scope or "", data=f"word{number}x"))
                else:
                    ended += len(concerned)
                    assert await store.remove(name, scope) == bool(concerned)
                for key in concerned:
                    expected.pop(key, None)
                if is_addition:
                    expected[concerned[0]] = f"word{number}x"
            everything = await store.all()
            assert [((entry.name, entry.scope), entry.data) for entry in everything] == list(expected.items())
            for number in range(len(steps)):
                found = [entry.data for entry in await store.search(f"word{number}x")]
                assert found == [data for data in expected.values() if data == f"word{number}x"]
            assert sum([len(await store.history(name)) for name in {name for _, name, _ in steps}]) == ended

    asyncio.run(run())


# The file


async def test_what_was_remembered_is_there_after_a_restart(tmp_path: Path) -> None:
    path = tmp_path / "deep" / "down" / "memory.db"
    async with await MemoryStore.open(path) as store:
        await fill(store, box="by the door")
        await fill(store, box="on the chair")
    async with await MemoryStore.open(str(path)) as store:
        assert [entry.data for entry in await store.all()] == ["on the chair"]
        assert [entry.data for entry in await store.history("box")] == ["by the door"]
        assert names(await store.search("chair")) == ["box"]
        assert store.notice == ""


async def test_two_processes_may_use_one_file(tmp_path: Path) -> None:
    path = tmp_path / "memory.db"
    async with await MemoryStore.open(path) as one, await MemoryStore.open(path) as other:
        await asyncio.gather(*(fill(store, **{f"m{n}": "x"}) for n in range(20) for store in (one, other)))
        assert len(await one.all()) == len(await other.all()) == 20


WRITER = """
import asyncio, sys
from parley.memory.store import MemoryStore
from parley.messages.memory import MemoryEntry

async def main():
    async with await MemoryStore.open(sys.argv[1]) as store:
        print("open", flush=True)
        sys.stdin.readline()
        for number in range(40):
            await store.add(MemoryEntry(name=f"{sys.argv[2]}{number}", data="x"))
            await store.add(MemoryEntry(name="shared", data=f"{sys.argv[2]}{number}"))

asyncio.run(main())
"""


@pytest.mark.skipif(sys.platform == "win32", reason="rights are given otherwise there")
async def test_only_its_owner_can_read_the_file(tmp_path: Path) -> None:
    def rights() -> set[int]:
        return {file.stat().st_mode & 0o777 for file in tmp_path.iterdir()}

    async with await MemoryStore.open(tmp_path / "memory.db") as store:
        await fill(store, box="by the door")
        assert rights() == {0o600}


OPENER = """
import asyncio, sys
from parley.memory.store import MemoryStore
from parley.messages.memory import MemoryEntry

async def main():
    for number in range(24):
        print(number, flush=True)
        sys.stdin.readline()
        async with await MemoryStore.open(f"{sys.argv[1]}/{number}.db") as store:
            await store.add(MemoryEntry(name=sys.argv[2], data="x"))

asyncio.run(main())
"""


def open_at_once(folder: Path) -> None:
    """Two processes open the same 24 files, each at the same time, and remember something in it."""
    children = [
        subprocess.Popen(
            [sys.executable, "-c", OPENER, str(folder), who],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True,
        )
        for who in "ab"
    ]  # fmt: skip
    for number in range(24):
        for child in children:
            assert child.stdout is not None
            while (line := child.stdout.readline()) and line.strip() != str(number):
                pass
        for child in children:
            assert child.stdin is not None
            child.stdin.write("go\n")
            child.stdin.flush()
    for child in children:
        child.communicate(timeout=60)
    assert [child.returncode for child in children] == [0, 0]


async def test_two_processes_that_open_a_new_or_a_damaged_file_at_once_both_keep_what_they_remember(
    tmp_path: Path,
) -> None:
    for number in range(0, 24, 2):
        (tmp_path / f"{number}.db").write_bytes(b"this is no database\n" * 500)
    await asyncio.to_thread(open_at_once, tmp_path)
    for number in range(24):
        async with await MemoryStore.open(tmp_path / f"{number}.db") as store:
            assert set(names(await store.all())) == {"a", "b"}
        aside = [
            file for file in _files(tmp_path) if re.fullmatch(rf"{number}\.db\.corrupt-[\d-]+", file.name)
        ]
        assert len(aside) == (number % 2 == 0)


def test_two_processes_that_write_at_once_lose_nothing(tmp_path: Path) -> None:
    path = tmp_path / "memory.db"
    children = [
        subprocess.Popen(
            [sys.executable, "-c", WRITER, str(path), who],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
        )
        for who in "ab"
    ]  # fmt: skip
    for child in children:
        assert child.stdout is not None
        while "open" not in child.stdout.readline():
            assert child.poll() is None
    errors = [child.communicate("go\n", timeout=100)[1] for child in children]
    assert [child.returncode for child in children] == [0, 0], errors

    async def kept() -> tuple[set[str], int]:
        async with await MemoryStore.open(path) as store:
            return set(names(await store.all())), len(await store.history("shared"))

    found, versions = asyncio.run(kept())
    assert found == {"shared"} | {f"{who}{number}" for who in "ab" for number in range(40)}
    assert versions == 50


FILLER = """
import asyncio, resource, signal, sys
from parley.errors import StoreError
from parley.memory.store import MemoryStore
from parley.messages.memory import MemoryEntry

async def main():
    async with await MemoryStore.open(sys.argv[1]) as store:
        await store.add(MemoryEntry(name="first", data="x"))
        # Beyond this size every write of a file fails, as on a disk that is full.
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (300_000, resource.RLIM_INFINITY))
        kept = []
        try:
            for number in range(100):
                await store.add(MemoryEntry(name=f"m{number}", data="word " * 2_000))
                kept.append(f"m{number}")
        except StoreError as error:
            print("refused", error)
        resource.setrlimit(resource.RLIMIT_FSIZE, (resource.RLIM_INFINITY, resource.RLIM_INFINITY))
        await store.add(MemoryEntry(name="last", data="y"))
        print("kept", *kept)

asyncio.run(main())
"""


def test_writes_that_the_disk_refuses_lose_nothing_acknowledged_and_room_heals(tmp_path: Path) -> None:
    path = tmp_path / "memory.db"
    done = subprocess.run(
        [sys.executable, "-c", FILLER, str(path)], capture_output=True, text=True, timeout=100, check=False
    )
    assert done.returncode == 0, done.stderr
    assert "refused" in done.stdout
    kept = done.stdout.rpartition("kept ")[2].split()
    assert kept

    async def remembered() -> set[str]:
        async with await MemoryStore.open(path) as store:
            assert store.notice == ""
            return set(names(await store.all()))

    assert asyncio.run(remembered()) == {"first", "last", *kept}


READER = """
import asyncio, os, sys
from parley.errors import StoreError
from parley.memory.store import MemoryStore
from parley.messages.memory import MemoryEntry
if os.geteuid() == 0:
    os.setgid(65534)
    os.setuid(65534)

async def main():
    try:
        async with await MemoryStore.open(sys.argv[1]) as store:
            await store.add(MemoryEntry(name="box", data="x"))
            print("stored")
    except StoreError as error:
        print("refused", error)

asyncio.run(main())
"""


@pytest.mark.parametrize("what", ["file", "folder"])
def test_file_or_folder_that_may_only_be_read_is_refused_and_left_as_it_was(
    tmp_path: Path, what: str
) -> None:
    folder = tmp_path / "data"
    path = folder / "memory.db"

    async def make() -> None:
        async with await MemoryStore.open(path) as store:
            await fill(store, chair="y")

    if what == "file":
        asyncio.run(make())
        path.chmod(0o444)
    else:
        folder.mkdir()
    before = path.read_bytes() if path.exists() else b""
    for parent in (tmp_path, *tmp_path.parents[:2]):
        parent.chmod(0o755)
    folder.chmod(0o555)
    try:
        done = subprocess.run(
            [sys.executable, "-c", READER, str(path)],
            capture_output=True,
            text=True,
            timeout=100,
            check=False,
        )
    finally:
        folder.chmod(0o755)
    assert done.returncode == 0, done.stderr
    assert "refused" in done.stdout
    assert str(path) in done.stdout
    assert (path.read_bytes() if path.exists() else b"") == before
    assert not list(folder.glob("*.corrupt-*"))


@pytest.mark.spec("P17")
def test_what_was_acknowledged_survives_kill_9(tmp_path: Path) -> None:
    path = tmp_path / "memory.db"
    program = """
import asyncio, sys
from parley.memory.store import MemoryStore
from parley.messages.memory import MemoryEntry

async def main():
    store = await MemoryStore.open(sys.argv[1])
    for number in range(100_000):
        await store.add(MemoryEntry(name=f"m{number}", data="x"))
        sys.stdout.write(f"remembered m{number}\\n")
        sys.stdout.flush()

asyncio.run(main())
"""
    child = subprocess.Popen(
        [sys.executable, "-c", program, str(path)],
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        text=True,
    )
    assert child.stdout is not None
    lines = [line for line, _ in zip(child.stdout, range(50), strict=False)]
    os.kill(child.pid, signal.SIGKILL)
    lines += child.stdout
    child.stdout.close()
    child.wait()

    async def remembered() -> set[str]:
        async with await MemoryStore.open(path) as store:
            assert store.notice == ""
            return {entry.name for entry in await store.all()}

    acknowledged = set(re.findall(r"^remembered (m\d+)\n", "".join(lines), re.MULTILINE))
    assert len(acknowledged) >= 40
    assert acknowledged <= asyncio.run(remembered())


@pytest.mark.parametrize("damage", ["nonsense", "middle"])
async def test_a_damaged_file_is_put_aside_and_people_are_told(tmp_path: Path, damage: str) -> None:
    path = tmp_path / "memory.db"
    async with await MemoryStore.open(path) as store:
        for number in range(200):
            await fill(store, **{f"m{number}": "word " * 50})
    content = path.read_bytes()
    broken = b"this is no database\n" * 500 if damage == "nonsense" else _overwrite_pages(content)
    path.write_bytes(broken)

    clock = SteppingClock()
    clock.unix = 123
    async with await MemoryStore.open(path, clock) as store:
        assert await store.all() == []
        assert "memory.db.corrupt-123" in store.notice
        await fill(store, box="remembered again")
    assert (tmp_path / "memory.db.corrupt-123").read_bytes() == broken
    async with await MemoryStore.open(path) as store:
        assert names(await store.all()) == ["box"]
        assert store.notice == ""


async def test_a_damaged_file_takes_the_place_of_none_that_was_put_aside_before(tmp_path: Path) -> None:
    for content in (b"no database " * 500, b"none either " * 500):
        (tmp_path / "memory.db").write_bytes(content)
        async with await MemoryStore.open(tmp_path / "memory.db", SteppingClock()) as store:
            assert store.notice
    assert (tmp_path / "memory.db.corrupt-1000").read_bytes() == b"no database " * 500
    assert (tmp_path / "memory.db.corrupt-1000-1").read_bytes() == b"none either " * 500


async def test_what_stands_beside_a_damaged_file_goes_aside_with_it(tmp_path: Path) -> None:
    path = tmp_path / "memory.db"
    async with await MemoryStore.open(path) as store:
        await fill(store, box="x")
    with closing(sqlite3.connect(path)) as another_process:
        another_process.execute("SELECT count(*) FROM memory").fetchall()
        path.write_bytes(b"this is no database\n" * 500)
        async with await MemoryStore.open(path, SteppingClock()) as store:
            await fill(store, chair="y")
    aside = {"memory.db.corrupt-1000", "memory.db.corrupt-1000-wal", "memory.db.corrupt-1000-shm"}
    assert aside <= {file.name for file in _files(tmp_path)}
    async with await MemoryStore.open(path) as store:
        assert names(await store.all()) == ["chair"]


def _files(folder: Path) -> list[Path]:
    return list(folder.iterdir())


def _overwrite_pages(content: bytes) -> bytes:
    """Spoil the pages behind the schema, leaving a file that opens."""
    return content[: 4096 * 12] + b"\x05" * (len(content) - 4096 * 12)


@pytest.mark.parametrize("kind", ["folder", "under a file"])
async def test_a_file_that_cannot_be_used_is_refused_in_plain_words(tmp_path: Path, kind: str) -> None:
    (tmp_path / "file").write_text("x")
    path = tmp_path if kind == "folder" else tmp_path / "file" / "memory.db"
    with pytest.raises(StoreError, match=str(path)):
        await MemoryStore.open(path)
    assert (tmp_path / "file").read_text() == "x"


async def test_a_file_of_a_newer_parley_is_left_alone(tmp_path: Path) -> None:
    path = tmp_path / "memory.db"
    async with await MemoryStore.open(path) as store:
        await fill(store, box="x")
    with sqlite3.connect(path) as db:
        db.execute("INSERT INTO migration VALUES ('add_feelings', 0)")
    db.close()
    with pytest.raises(StoreError, match=r"newer version of Parley \(add_feelings\)"):
        await MemoryStore.open(path)
    assert path.exists(), "it was not put aside"


async def test_a_full_disk_is_told_and_what_was_there_stays(tmp_path: Path) -> None:
    async with await MemoryStore.open(tmp_path / "memory.db") as store:
        await fill(store, box="x")
        await store._database.run(lambda db: db.execute("PRAGMA max_page_count = 1"))
        with pytest.raises(StoreError, match="full"):
            for number in range(100):
                await fill(store, **{f"big{number}": "word " * 10_000})
        await store._database.run(lambda db: db.execute("PRAGMA max_page_count = 1000000"))
        await fill(store, chair="y")
        assert {"box", "chair"} <= set(names(await store.all()))


async def test_a_closed_store_says_so() -> None:
    async with await MemoryStore.open(":memory:") as store:
        pass
    await store.close()
    with pytest.raises(StoreError, match="closed"):
        await store.all()
