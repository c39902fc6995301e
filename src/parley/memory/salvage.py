"""What can still be read of a damaged SQLite file, row by row, into a new one.

Nothing is guessed: only rows that SQLite itself finds from the root of their table are taken, so what was
forgotten does not come back from pages that are free. What is derived (indexes, the full text) is made anew.
"""

from __future__ import annotations

import contextlib
import shutil
import sqlite3
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

__all__ = ["Salvaged", "salvage"]

_HEADER_BYTES: Final = 100
_STEPS: Final = 5000
"""So many row numbers behind an unreadable row are tried one by one; then the steps double."""
_LAST_ROW: Final = 2**63 - 1


@dataclass(frozen=True, slots=True)
class Salvaged:
    """What came of it."""

    kept: int = 0
    """Rows that stand in the new file."""
    gaps: int = 0
    """Places at which something could not be read; how much stood there nobody knows."""


def salvage(damaged: Path, fresh: sqlite3.Connection) -> Salvaged:
    """Copy into `fresh` whatever of `damaged` can be read; `damaged` stays as it is. Blocks.

    Args:
        damaged: The file, with what SQLite keeps beside it.
        fresh: A new file in the form that is wanted, in autocommit mode.
    """
    with tempfile.TemporaryDirectory(dir=damaged.parent, prefix=".salvage-") as folder:
        copy = Path(folder, "damaged.db")
        for suffix in ("", "-wal"):
            beside = damaged.with_name(damaged.name + suffix)
            if beside.exists():
                shutil.copyfile(beside, copy.with_name(copy.name + suffix))
        try:
            old = _readable(copy, fresh)
        except (sqlite3.Error, OSError):
            return Salvaged(gaps=1)
        try:
            return _copy_all(old, fresh)
        finally:
            old.close()


def _readable(copy: Path, fresh: sqlite3.Connection) -> sqlite3.Connection:
    """A connection to `copy`, with the header of another file if its own is spoilt."""
    try:
        return _opened(copy)
    except sqlite3.Error:
        _lend_header(copy, fresh)
        return _opened(copy)


def _opened(path: Path) -> sqlite3.Connection:
    connection = sqlite3.connect(path, isolation_level=None)
    try:
        connection.execute("SELECT count(*) FROM sqlite_master").fetchone()
    except BaseException:
        connection.close()
        raise
    return connection


def _lend_header(copy: Path, fresh: sqlite3.Connection) -> None:
    """Write the first bytes of a sound file over those of `copy`; which pages are free is then unknown."""
    raw = bytearray(fresh.serialize()[:_HEADER_BYTES])
    page_bytes = int.from_bytes(raw[16:18], "big") or 1
    page_bytes = 65536 if page_bytes == 1 else page_bytes
    raw[28:32] = (copy.stat().st_size // page_bytes).to_bytes(4, "big")
    raw[32:40] = bytes(8)
    raw[92:96] = raw[24:28]  # the number of pages counts
    with copy.open("r+b") as file:
        file.write(raw)


def _copy_all(old: sqlite3.Connection, fresh: sqlite3.Connection) -> Salvaged:
    kept = gaps = 0
    there = dict(_tables(old))
    for table, has_rowid in _tables(fresh):
        if table not in there:
            gaps += 1
            continue
        columns = [name for name in _columns(fresh, table) if name in _columns(old, table)]
        reader = _by_rowid(old, table, columns) if has_rowid else _from_both_ends(old, table, columns)
        fresh.execute("BEGIN")
        for row in reader:
            written = row is not None and _write(fresh, table, columns, row)
            kept, gaps = kept + written, gaps + (not written)
        fresh.execute("COMMIT")
    _go_on_counting(old, fresh)
    return Salvaged(kept, gaps)


def _go_on_counting(old: sqlite3.Connection, fresh: sqlite3.Connection) -> None:
    """The number of a row that was lost is given to no other."""
    with contextlib.suppress(sqlite3.Error):  # a file without such a list, or the list is lost
        for name, last in old.execute("SELECT name, seq FROM sqlite_sequence").fetchall():
            fresh.execute("DELETE FROM sqlite_sequence WHERE name = ? AND seq < ?", (name, last))
            fresh.execute(
                "INSERT INTO sqlite_sequence SELECT ?1, ?2"
                " WHERE NOT EXISTS (SELECT * FROM sqlite_sequence WHERE name = ?1)",
                (name, last),
            )


def _tables(db: sqlite3.Connection) -> list[tuple[str, bool]]:
    """Every table with rows of its own, and whether they have numbers."""
    rows = db.execute(
        "SELECT name, wr FROM pragma_table_list WHERE schema = 'main' AND type = 'table'"
        " AND name NOT LIKE 'sqlite!_%' ESCAPE '!' AND name <> 'migration' ORDER BY name"
    )
    return [(name, not without) for name, without in rows]


def _columns(db: sqlite3.Connection, table: str) -> list[str]:
    return [name for (name,) in db.execute("SELECT name FROM pragma_table_info(?)", (table,))]


def _write(fresh: sqlite3.Connection, table: str, columns: list[str], row: tuple[Any, ...]) -> bool:
    marks = ", ".join("?" * len(columns))
    try:
        fresh.execute(f"INSERT OR REPLACE INTO {table} ({', '.join(columns)}) VALUES ({marks})", row)
    except (sqlite3.IntegrityError, sqlite3.DataError):
        return False  # what is read is not what was written
    return True


def _by_rowid(db: sqlite3.Connection, table: str, columns: list[str]) -> Iterator[tuple[Any, ...] | None]:
    """Every row that can be read, and None for each place at which some cannot."""
    wanted = f"SELECT rowid, {', '.join(columns)} FROM {table} NOT INDEXED WHERE rowid >= ? ORDER BY rowid"
    row_id = -_LAST_ROW
    while True:
        try:
            for found in db.execute(wanted, (row_id,)):
                if found[0] < row_id:
                    break
                yield found[1:]
                row_id = found[0] + 1
            else:
                return
        except sqlite3.Error:
            pass  # not necessarily at `row_id`: the driver reads ahead
        skipped, found = _next_row(db, f"{wanted} LIMIT 1", row_id)
        if skipped:
            yield None
        if found is None:
            return
        yield found[1:]
        row_id = found[0] + 1


def _next_row(db: sqlite3.Connection, wanted: str, row_id: int) -> tuple[bool, tuple[Any, ...] | None]:
    """Whether something could not be read, and the next row that can be, if there is one."""
    for number in range(_STEPS + 63):
        try:
            found = db.execute(wanted, (row_id,)).fetchone()
            if found is None or found[0] >= row_id:
                return number > 0, found
        except sqlite3.Error:
            row_id = max(row_id, 0)  # rows are numbered from 1
        row_id += 1 if number < _STEPS else 2 ** (number - _STEPS)
        if row_id > _LAST_ROW:
            break
    return True, None


def _from_both_ends(
    db: sqlite3.Connection, table: str, columns: list[str]
) -> Iterator[tuple[Any, ...] | None]:
    """The same for a table whose rows have no numbers: up to a place that cannot be read, from either end."""
    key = ", ".join(
        name for (name,) in db.execute("SELECT name FROM pragma_table_info(?) WHERE pk ORDER BY pk", (table,))
    )
    for order in ("ASC", "DESC"):
        by = ", ".join(f"{name} {order}" for name in key.split(", "))
        try:
            yield from db.execute(f"SELECT {', '.join(columns)} FROM {table} ORDER BY {by}")
            return
        except sqlite3.Error:
            yield None
