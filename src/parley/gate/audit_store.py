"""The audit log in one SQLite file, and the head of its chain in a small file beside it.

SQLite and not lines of text: commands read while the system writes, filters need not read everything, a write
is whole or not there, and the file itself refuses to change or remove an entry. Old months are removed in
one transaction that also writes down what was removed, so that the chain goes on.
"""

from __future__ import annotations

import contextlib
import os
import sqlite3
from collections.abc import Iterator, Sequence
from contextlib import closing
from pathlib import Path
from typing import Final, Self

import structlog

from parley.clock import Clock
from parley.errors import ConfigError, InvalidMessageError, StoreError
from parley.gate.audit import PRUNE, Head, Row, Verifier, entry_of, sealed
from parley.memory.on_file import RecordStore
from parley.messages.audit import AuditChain, AuditEntry, AuditEvent, GetAudit

__all__ = ["AuditStore", "check_file", "head_file", "read_file"]

log = structlog.get_logger(__name__)

_KEEP: Final = """
    CREATE TRIGGER IF NOT EXISTS entry_stays BEFORE DELETE ON entry
        BEGIN SELECT RAISE(ABORT, 'the audit log only grows'); END;
"""
_SCHEMA: Final = f"""
    CREATE TABLE IF NOT EXISTS entry (
        number INTEGER PRIMARY KEY, record TEXT NOT NULL, hash TEXT NOT NULL,
        unix_ms INTEGER GENERATED ALWAYS AS (json_extract(record, '$.unix_ms')) VIRTUAL,
        robot TEXT GENERATED ALWAYS AS (json_extract(record, '$.robot')) VIRTUAL,
        effect TEXT GENERATED ALWAYS AS (json_extract(record, '$.effect')) VIRTUAL
    );
    CREATE INDEX IF NOT EXISTS entry_robot ON entry (robot COLLATE NOCASE);
    CREATE INDEX IF NOT EXISTS entry_effect ON entry (effect);
    CREATE TRIGGER IF NOT EXISTS entry_as_it_is BEFORE UPDATE ON entry
        BEGIN SELECT RAISE(ABORT, 'the audit log only grows'); END;
    {_KEEP}
"""
_WHO: Final = (
    "folded("
    + " || ' ' || ".join(
        f"coalesce(json_extract(record, '$.by.{field}'), '{instead}')"
        for field, instead in (("name", ""), ("device", ""), ("kind", "program"), ("key", ""))
    )
    + ")"
)
_SAID: Final = (
    "folded(json_extract(record, '$.words') || ' ' || json_extract(record, '$.reason') || ' '"
    " || json_extract(record, '$.detail'))"
)
_CHUNK: Final = 5000
"""Entries that are checked at a stretch; writing goes on in between."""


class AuditStore(RecordStore):
    """Made by `open`. Only grows."""

    SCHEMA = _SCHEMA
    WHAT = "audit log"
    _head_file: Path | None = None
    _head: Head | None = None

    @classmethod
    async def open(cls, path: Path | str, clock: Clock) -> Self:
        """See `RecordStore.open`."""
        store = await super().open(path, clock)
        if str(path) != ":memory:":
            store._head_file = head_file(Path(path))
            with contextlib.suppress(InvalidMessageError):  # unreadable counts as missing: checking says so
                store._head = _read_head(store._head_file)
        if store._head is None:
            await store._database.run(store._begin_head)
        return store

    async def append(self, events: Sequence[AuditEvent]) -> None:
        """Add entries; when this returns, they are durable."""
        await self._database.run(lambda db: self._append(db, events))

    async def entries(self, wanted: GetAudit) -> tuple[AuditEntry, ...]:
        """What was asked for, newest first."""
        return await self._database.run(lambda db: _select(db, wanted))

    async def check(self) -> AuditChain:
        """Whether all is as it was written."""
        verifier, at = Verifier(self._head), 0
        while rows := await self._database.run(lambda db, after=at: _rows(db, after, _CHUNK)):  # type: ignore[misc]
            for row in rows:
                verifier.take(row)
            at = rows[-1].number
        return verifier.result()

    async def prune(self, before_unix_ms: int, event: AuditEvent) -> int:
        """Remove what is older and write down that it was; how many entries went."""
        return await self._database.run(lambda db: self._prune(db, before_unix_ms, event))

    # -- on the thread of the file ---------------------------------------------------------------------

    def _begin_head(self, db: sqlite3.Connection) -> None:
        if _last(db).number == 0:
            self._set_head(Head())

    def _append(self, db: sqlite3.Connection, events: Sequence[AuditEvent]) -> None:
        db.execute("BEGIN IMMEDIATE")
        try:
            head = self._grow(db, events)
            db.execute("COMMIT")
        except BaseException:
            db.execute("ROLLBACK") if db.in_transaction else None
            raise
        self._set_head(head)

    def _grow(self, db: sqlite3.Connection, events: Sequence[AuditEvent]) -> Head:
        """Where the file ends before the head says, the chain goes on from the head: the gap must show."""
        last = _last(db)
        head = self._head if self._head is not None and self._head.number >= last.number else last
        for event in events:
            row = sealed(event, head)
            db.execute(
                "INSERT INTO entry (number, record, hash) VALUES (?, ?, ?)",
                (row.number, row.record, row.hash),
            )
            head = row.head
        return head

    def _prune(self, db: sqlite3.Connection, before_unix_ms: int, event: AuditEvent) -> int:
        row = db.execute(
            "SELECT number, hash FROM entry WHERE number < (SELECT coalesce(min(number), 0) FROM entry"
            " WHERE unix_ms >= ?) ORDER BY number DESC LIMIT 1",
            (before_unix_ms,),
        ).fetchone()
        if row is None:
            return 0
        removed = Head(*row)
        told = event.model_copy(update={"effect": PRUNE, "detail": {"last": str(removed)}})
        db.execute("BEGIN IMMEDIATE")
        try:
            db.execute("DROP TRIGGER entry_stays")
            count = db.execute("DELETE FROM entry WHERE number <= ?", (removed.number,)).rowcount
            db.execute(_KEEP)
            head = self._grow(db, [told])
            db.execute("COMMIT")
        except BaseException:
            db.execute("ROLLBACK") if db.in_transaction else None
            raise
        self._set_head(head)
        return count

    def _set_head(self, head: Head) -> None:
        """Behind the entries, never before them: an end that lags is no fault, one that is ahead is."""
        self._head = head
        if self._head_file is None:
            return
        beside = self._head_file.with_name(f"{self._head_file.name}.new")
        try:
            with os.fdopen(os.open(beside, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o600), "w") as file:
                file.write(str(head))
                file.flush()
                os.fsync(file.fileno())
            beside.replace(self._head_file)
        except OSError as error:
            log.error("end of the audit log not written", problem=str(error))


def head_file(path: Path) -> Path:
    """The file that holds the end of the log at `path`."""
    return path.with_suffix(".head")


def read_file(path: Path, wanted: GetAudit) -> tuple[AuditEntry, ...]:
    """What was asked for, newest first, from a file that somebody else may be writing.

    Raises:
        ConfigError: There is no such file.
        StoreError: It cannot be read.
    """
    with _reading(path) as db:
        return _select(db, wanted)


def check_file(path: Path, marks: tuple[Head, ...] = ()) -> AuditChain:
    """Whether a file is as it was written; nothing is changed.

    Raises:
        ConfigError: There is no such file.
        StoreError: It cannot be read.
    """
    try:
        head = _read_head(head_file(path))  # before the entries: they may grow meanwhile
    except InvalidMessageError:
        head = None
    with _reading(path) as db:
        verifier, at = Verifier(head, marks), 0
        while rows := _rows(db, at, _CHUNK):
            for row in rows:
                verifier.take(row)
            at = rows[-1].number
        return verifier.result()


@contextlib.contextmanager
def _reading(path: Path) -> Iterator[sqlite3.Connection]:
    if not path.exists():
        raise ConfigError(f"there is no {path.name} in {path.parent}")
    try:
        with closing(sqlite3.connect(f"{path.absolute().as_uri()}?mode=ro", uri=True, timeout=5.0)) as db:
            yield db
    except sqlite3.Error as error:
        raise StoreError(f"the audit log {path} cannot be read: {error}") from error


def _read_head(path: Path) -> Head | None:
    try:
        return Head.read(path.read_text(encoding="utf-8"))
    except (FileNotFoundError, UnicodeDecodeError):
        return None


def _last(db: sqlite3.Connection) -> Head:
    row = db.execute("SELECT number, hash FROM entry ORDER BY number DESC LIMIT 1").fetchone()
    return Head(*row) if row else Head()


def _rows(db: sqlite3.Connection, after: int, limit: int) -> list[Row]:
    found = db.execute(
        "SELECT number, record, hash FROM entry WHERE number > ? ORDER BY number LIMIT ?", (after, limit)
    )
    return [Row(*row) for row in found]


def _select(db: sqlite3.Connection, wanted: GetAudit) -> tuple[AuditEntry, ...]:
    db.create_function("folded", 1, lambda text: str(text or "").casefold(), deterministic=True)
    conditions = [
        (bool(wanted.robot), "robot = ? COLLATE NOCASE", wanted.robot),
        (bool(wanted.effect), "effect = ?", wanted.effect),
        (bool(wanted.by), f"instr({_WHO}, ?)", wanted.by.casefold()),
        (bool(wanted.text), f"instr({_SAID}, ?)", wanted.text.casefold()),
        (wanted.since_unix_ms > 0, "unix_ms >= ?", wanted.since_unix_ms),
        (wanted.until_unix_ms > 0, "unix_ms < ?", wanted.until_unix_ms),
        (wanted.before > 0, "number < ?", wanted.before),
    ]
    where = " AND ".join(text for counts, text, _ in conditions if counts) or "true"
    values = [value for counts, _, value in conditions if counts]
    found = db.execute(
        f"SELECT number, record, hash FROM entry WHERE {where} ORDER BY number DESC LIMIT ?",
        (*values, wanted.limit),
    )
    return tuple(entry_of(Row(*row)) for row in found)
