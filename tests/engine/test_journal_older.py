"""What another release wrote down is not lost when this one opens the journal."""

from __future__ import annotations

import contextlib
import sqlite3
from pathlib import Path

import pytest
import structlog

from parley.clock import WallClock
from parley.engine.journal import Journal
from parley.engine.journal_file import VERSION
from parley.engine.journal_older import put_aside_other_form


def written(path: Path, form: int, text: str) -> None:
    with contextlib.closing(sqlite3.connect(path)) as connection:
        connection.execute("CREATE TABLE run (id INTEGER PRIMARY KEY, graph_name TEXT)")
        connection.execute("INSERT INTO run (graph_name) VALUES (?)", (text,))
        connection.execute(f"PRAGMA user_version = {form}")
        connection.commit()


def names(path: Path) -> list[str]:
    with contextlib.closing(sqlite3.connect(path)) as connection:
        return [name for (name,) in connection.execute("SELECT graph_name FROM run")]


@pytest.mark.parametrize("form", [1, VERSION - 1, VERSION + 1])
async def test_a_journal_of_another_form_is_kept_beside_the_new_one_and_that_is_logged(
    tmp_path: Path, form: int
) -> None:
    path = tmp_path / "journal.db"
    written(path, form, "errand")
    with structlog.testing.capture_logs() as logs:
        async with await Journal.open(path, WallClock()) as journal:
            assert journal.interrupted == ()
    kept = tmp_path / f"journal.form-{form}.db"
    assert names(kept) == ["errand"]
    assert names(path) == []
    (entry,) = [item for item in logs if item["log_level"] == "warning"]
    assert entry["now"] == str(kept)


def test_a_second_one_does_not_take_the_place_of_the_first(tmp_path: Path) -> None:
    path = tmp_path / "journal.db"
    for text in ("first", "second"):
        written(path, 1, text)
        put_aside_other_form(path, VERSION)
    assert names(tmp_path / "journal.form-1.db") == ["first"]
    assert names(tmp_path / "journal.form-1-2.db") == ["second"]


def test_what_was_not_yet_written_back_at_a_kill_goes_along(tmp_path: Path) -> None:
    path, left = tmp_path / "journal.db", tmp_path / "left"
    left.mkdir()
    with contextlib.closing(sqlite3.connect(path)) as connection:
        connection.execute("PRAGMA journal_mode = WAL")
        connection.execute("CREATE TABLE run (id INTEGER PRIMARY KEY, graph_name TEXT)")
        connection.execute("INSERT INTO run (graph_name) VALUES ('errand')")
        connection.execute("PRAGMA user_version = 1")
        connection.commit()
        for file in tmp_path.glob("journal.db*"):
            (left / file.name).write_bytes(file.read_bytes())
    aside = put_aside_other_form(left / "journal.db", VERSION)
    assert aside is not None
    assert names(aside) == ["errand"]
    assert not list(left.glob("journal.db*"))


async def test_one_of_this_form_stays(tmp_path: Path) -> None:
    path = tmp_path / "journal.db"
    async with await Journal.open(path, WallClock()):
        pass
    assert put_aside_other_form(path, VERSION) is None


def test_none_at_all_an_empty_one_and_what_is_no_journal_are_left_to_who_opens_it(tmp_path: Path) -> None:
    path = tmp_path / "journal.db"
    assert put_aside_other_form(path, VERSION) is None
    path.touch()
    assert put_aside_other_form(path, VERSION) is None
    path.write_bytes(b"this is no database" * 100)
    assert put_aside_other_form(path, VERSION) is None
    assert [file.name for file in tmp_path.iterdir()] == ["journal.db"]
