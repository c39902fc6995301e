"""The steps that bring a memory file to its present form."""

from __future__ import annotations

import sqlite3
from collections.abc import Iterator
from contextlib import closing

import pytest

from parley.errors import StoreError
from parley.memory import migrations
from parley.memory.migrations import MIGRATIONS, migrate

NAMES = [step.__name__ for step in MIGRATIONS]


@pytest.fixture
def db() -> Iterator[sqlite3.Connection]:
    with closing(sqlite3.connect(":memory:", isolation_level=None)) as connection:
        yield connection


def recorded(db: sqlite3.Connection) -> list[tuple[str, int]]:
    return db.execute("SELECT name, unix_ms FROM migration ORDER BY rowid").fetchall()


def test_every_step_runs_once_and_is_recorded(db: sqlite3.Connection) -> None:
    migrate(db, unix_ms=7)
    migrate(db, unix_ms=8)
    assert recorded(db) == [(name, 7) for name in NAMES]


def test_a_file_of_an_older_version_is_brought_up_to_date(
    db: sqlite3.Connection, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(migrations, "MIGRATIONS", MIGRATIONS[:1])
    migrate(db, unix_ms=7)
    monkeypatch.undo()
    migrate(db, unix_ms=8)
    assert recorded(db) == [(NAMES[0], 7), *((name, 8) for name in NAMES[1:])]


def test_a_step_that_fails_undoes_those_before_it(
    db: sqlite3.Connection, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(_: sqlite3.Connection) -> None:
        raise ValueError("a defect of the step")

    monkeypatch.setattr(migrations, "MIGRATIONS", (*MIGRATIONS, fail))
    with pytest.raises(ValueError, match="defect"):
        migrate(db, unix_ms=7)
    assert db.execute("SELECT name FROM sqlite_master").fetchall() == []
    monkeypatch.undo()
    migrate(db, unix_ms=8)
    assert recorded(db) == [(name, 8) for name in NAMES]


def test_an_unknown_step_means_a_newer_program_wrote_the_file(db: sqlite3.Connection) -> None:
    migrate(db, unix_ms=7)
    db.execute("INSERT INTO migration VALUES ('later', 9)")
    with pytest.raises(StoreError, match="later"):
        migrate(db, unix_ms=8)
    assert not db.in_transaction


def test_names_of_steps_never_change() -> None:
    assert NAMES[:5] == ["create_memory", "bound_history", "record_use", "order_by_time", "keep_vectors"]


def test_what_an_older_version_remembered_is_kept_searched_and_bounded(
    db: sqlite3.Connection, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(migrations, "MIGRATIONS", MIGRATIONS[:2])
    migrate(db, unix_ms=7)
    monkeypatch.undo()
    insert = (
        "INSERT INTO memory"
        " (name, scope, type, data, info, source, name_key, created_unix_ms, updated_unix_ms)"
        " VALUES ('box', '', 'text', ?, '', '', 'box', 1, ?)"
    )
    for number in range(3):
        db.execute(insert, (f"word{number}", number))
    migrate(db, unix_ms=8)
    for number in range(3, 60):
        db.execute(insert, (f"word{number}", number))
    assert db.execute("SELECT data, used_count FROM memory WHERE ended_unix_ms IS NULL").fetchall() == [
        ("word59", 0)
    ]
    assert db.execute("SELECT count(*), min(updated_unix_ms) FROM memory").fetchone() == (51, 9)
    found = "SELECT rowid FROM memory_search WHERE memory_search MATCH ?"
    assert len(db.execute(found, ("word59",)).fetchall()) == 1
    assert db.execute(found, ("word2",)).fetchall() == []
