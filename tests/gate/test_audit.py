"""The chain of the audit log and its file: whatever is changed in it is found."""

from __future__ import annotations

import os
import signal
import sqlite3
import subprocess
import sys
from contextlib import closing
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from parley.clock import WallClock
from parley.errors import StoreError
from parley.gate.audit import Head, Row, Verifier, sealed
from parley.gate.audit_store import AuditStore, check_file, head_file, read_file
from parley.messages.audit import AuditChain, AuditEvent, GetAudit
from parley.messages.principal import person

KIM = person("Kim", device="phone")


def said(words: str, at: int = 1) -> AuditEvent:
    return AuditEvent(effect="speak", by=KIM, robot="Ada", words=words, unix_ms=at)


def chain(count: int) -> list[Row]:
    rows: list[Row] = []
    for number in range(count):
        rows.append(sealed(said(f"go to box {number}"), rows[-1].head if rows else Head()))
    return rows


def checked(rows: list[Row], head: Head) -> AuditChain:
    verifier = Verifier(head)
    for row in rows:
        verifier.take(row)
    return verifier.result()


def test_what_was_written_is_whole() -> None:
    rows = chain(5)
    found = checked(rows, rows[-1].head)
    assert (found.entries, found.problem, found.last) == (5, "", str(rows[-1].head))


@settings(max_examples=60, deadline=None)
@given(st.data())
def test_a_changed_removed_swapped_or_added_entry_is_found_where_it_is(data: st.DataObject) -> None:
    rows = chain(data.draw(st.integers(2, 8)))
    head, at = rows[-1].head, data.draw(st.integers(0, len(rows) - 1))
    deed = data.draw(st.sampled_from(["words", "sealed anew", "hash", "remove", "swap", "add", "exchange"]))
    other = data.draw(st.integers(0, len(rows) - 1).filter(lambda index: index != at))
    forged = sealed(
        said("go to the door"), Head(rows[at].number - 1, rows[at - 1].hash if at else Head().hash)
    )
    first = rows[at].number
    match deed:
        case "words":
            rows[at] = Row(rows[at].number, rows[at].record.replace("box", "door"), rows[at].hash)
        case "sealed anew":
            rows[at] = forged
            first = min(first + 1, head.number)
        case "hash":
            rows[at] = Row(rows[at].number, rows[at].record, forged.hash)
        case "remove":
            del rows[at]
            first = first if first == head.number else first + 1
        case "swap":
            rows[at], rows[other] = (
                Row(rows[at].number, rows[other].record, rows[other].hash),
                Row(rows[other].number, rows[at].record, rows[at].hash),
            )
            first = min(at, other) + 1
        case "add":
            rows.insert(at, Row(rows[at].number, forged.record, forged.hash))
        case "exchange":
            rows = [*rows[:at], forged]
            for _ in range(at + 1, head.number):
                rows.append(sealed(said("nothing"), rows[-1].head))
            first = head.number
    found = checked(rows, head)
    assert found.problem
    assert found.first_broken == first


def test_a_whole_log_that_was_written_anew_is_found_by_a_mark_that_was_kept_elsewhere() -> None:
    real, forged = chain(5), [sealed(said("nothing"), Head())]
    verifier = Verifier(forged[-1].head, marks=(real[2].head,))
    verifier.take(forged[0])
    assert verifier.result().first_broken == 2


async def written(path: Path, count: int) -> None:
    async with await AuditStore.open(path, WallClock()) as store:
        await store.append([said(f"box {number}", at=number + 1) for number in range(count)])


async def test_the_file_itself_refuses_to_change_or_remove_an_entry(tmp_path: Path) -> None:
    await written(tmp_path / "audit.db", 2)
    with closing(sqlite3.connect(tmp_path / "audit.db")) as db:
        for statement in ("UPDATE entry SET hash = 'x'", "DELETE FROM entry"):
            with pytest.raises(sqlite3.IntegrityError, match="only grows"):
                db.execute(statement)


@pytest.mark.parametrize("left", [0, 3])
async def test_what_was_cut_off_at_the_end_stays_known_when_the_log_goes_on(
    tmp_path: Path, left: int
) -> None:
    path = tmp_path / "audit.db"
    await written(path, 5)
    with closing(sqlite3.connect(path)) as db, db:
        db.execute("DROP TRIGGER entry_stays")
        db.execute("DELETE FROM entry WHERE number > ?", (left,))
    assert "cut off" in check_file(path).problem
    await written(path, 1)
    found = check_file(path)
    assert "missing" in found.problem
    assert found.first_broken == 6


async def test_a_log_without_the_file_that_holds_its_end_is_not_whole(tmp_path: Path) -> None:
    await written(tmp_path / "audit.db", 2)
    head_file(tmp_path / "audit.db").unlink()
    assert "is missing" in check_file(tmp_path / "audit.db").problem


async def test_old_entries_are_removed_and_the_chain_goes_on(tmp_path: Path) -> None:
    path = tmp_path / "audit.db"
    async with await AuditStore.open(path, WallClock()) as store:
        await store.append([said(f"box {number}", at=number + 1) for number in range(6)])
        assert await store.prune(4, AuditEvent(effect="prune", unix_ms=9)) == 3
        await store.append([said("door", at=10)])
        assert (await store.check()).problem == ""
    assert [entry.number for entry in read_file(path, GetAudit())] == [8, 7, 6, 5, 4]
    assert check_file(path).problem == ""
    with closing(sqlite3.connect(path)) as db, db:
        db.execute("DROP TRIGGER entry_stays")
        db.execute("DELETE FROM entry WHERE number = 4")
    assert check_file(path).first_broken == 5


async def test_the_log_is_narrowed_by_robot_person_effect_time_and_text(tmp_path: Path) -> None:
    async with await AuditStore.open(":memory:", WallClock()) as store:
        await store.append([
            said("go to the box", at=10),
            AuditEvent(effect="stop", by=person("Lee", device="terminal"), robot="Bo", unix_ms=20),
            AuditEvent(effect="start", robot="Ada", detail={"labels": ["Drive to the Õunapuu"]}, unix_ms=30),
        ])  # fmt: skip

        async def numbers(**wanted: object) -> list[int]:
            return [entry.number for entry in await store.entries(GetAudit.model_validate(wanted))]

        assert await numbers() == [3, 2, 1]
        assert await numbers(limit=1) == [3]
        assert await numbers(before=3) == [2, 1]
        assert await numbers(robot="ada") == [3, 1]
        assert await numbers(by="lee") == await numbers(by="TERMINAL") == [2]
        assert await numbers(by="program") == [3]
        assert await numbers(effect="start") == await numbers(text="õunapuu") == [3]
        assert await numbers(since_unix_ms=20, until_unix_ms=30) == [2]


async def test_a_full_disk_fails_and_loses_nothing_that_was_acknowledged(tmp_path: Path) -> None:
    path = tmp_path / "audit.db"
    async with await AuditStore.open(path, WallClock()) as store:
        await store.append([said("first")])
        await store._database.run(lambda db: db.execute("PRAGMA max_page_count = 12").fetchall())
        with pytest.raises(StoreError, match="full"):
            await store.append([said("x" * 3000) for _ in range(40)])
        await store._database.run(lambda db: db.execute("PRAGMA max_page_count = 100000").fetchall())
        await store.append([said("last")])
    assert [entry.words for entry in read_file(path, GetAudit())] == ["last", "first"]
    assert check_file(path).problem == ""


WRITER = """
import asyncio, sys
from pathlib import Path
from parley.clock import WallClock
from parley.gate.audit_store import AuditStore
from parley.messages.audit import AuditEvent

async def main():
    async with await AuditStore.open(Path(sys.argv[1]), WallClock()) as store:
        number = 0
        while True:
            await store.append([AuditEvent(effect="speak", words=str(number))])
            print(number, flush=True)
            number += 1

asyncio.run(main())
"""


@pytest.mark.skipif(os.name == "nt", reason="there is no SIGKILL")
@pytest.mark.parametrize("after", [1, 8])
def test_a_killed_writer_loses_nothing_acknowledged(tmp_path: Path, after: int) -> None:
    path = tmp_path / "audit.db"
    with subprocess.Popen([sys.executable, "-c", WRITER, path], stdout=subprocess.PIPE, text=True) as writer:
        assert writer.stdout is not None
        for _ in range(after):
            writer.stdout.readline()
        writer.send_signal(signal.SIGKILL)
        left = writer.stdout.read().split()
    acknowledged = after + len(left)
    assert len(read_file(path, GetAudit(limit=1000))) >= acknowledged
    assert check_file(path).problem == ""
