"""What is remembered, in one SQLite file: what `MemoryStore.add` returned survives `kill -9`.

Every change is one SQL statement (see `parley.memory.migrations`), so changes may be made concurrently and
cancelled at any point without a lock: each happens wholly or not at all.
"""

from __future__ import annotations

import sqlite3
from collections.abc import Iterable, Sequence
from pathlib import Path
from types import TracebackType
from typing import Any, Self

import aiosqlite
import structlog

from parley.clock import Clock, WallClock
from parley.errors import StoreError
from parley.memory.migrations import migrate
from parley.memory.retrieval import (
    Hits,
    final_order,
    fts_phrase,
    name_key,
    query_terms,
    scores,
    worth_completing,
)
from parley.messages.memory import MemoryEntry

__all__ = ["MemoryStore"]

log = structlog.get_logger(__name__)

_COLUMNS = "name, scope, type, data, info, source, created_unix_ms, updated_unix_ms"
_PER_TERM = 300
"""How many memories, the newest, are considered per term: bounds a search whatever the size of the store."""
_BUSY_TIMEOUT_S = 5.0


class MemoryStore:
    """The memory of all robots, with a scope for what concerns one robot only. See `open`.

    A `scope` argument of the reading methods means: None, everything; a robot's name, everybody's memories
    and that robot's; the empty string, everybody's alone.
    """

    def __init__(self, db: aiosqlite.Connection, clock: Clock, *, notice: str = "") -> None:
        self._db, self._clock = db, clock
        self.notice = notice
        """What the operator should know about the file, in plain words; usually empty."""

    @classmethod
    async def open(cls, path: Path | str, clock: Clock | None = None) -> Self:
        """Open or create the memory file; use as ``async with await MemoryStore.open(...)``.

        A damaged file is put aside as ``<name>.corrupt-<unix ms>`` and a new one begun; `notice` says so.

        Args:
            path: The file, or ``:memory:`` for a memory that ends with the process.
            clock: For time stamps.

        Raises:
            StoreError: The file cannot be created, read or written, or a newer Parley wrote it.
        """
        clock = clock or WallClock()
        try:
            return cls(await _connect(path, clock), clock)
        except sqlite3.DatabaseError as error:
            if not _is_damage(error):
                raise _told(path, error) from error
            aside = _put_aside(Path(path), clock.unix_ms())
            notice = (
                f"The memory file was damaged. It was put aside as {aside.name}; "
                "a new one was begun, and nothing from before is remembered."
            )
            log.error("memory file damaged", path=str(path), aside=str(aside), problem=str(error))
        try:
            return cls(await _connect(path, clock), clock, notice=notice)
        except sqlite3.DatabaseError as error:
            raise _told(path, error) from error

    async def __aenter__(self) -> Self:
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        await self.close()

    async def close(self) -> None:
        """Close the file. Idempotent."""
        await self._db.close()

    async def add(self, entry: MemoryEntry) -> MemoryEntry:
        """Remember `entry`; a memory of the same name and scope is replaced and goes to the history.

        Returns:
            The entry as stored, with its times. It is durable.

        Raises:
            StoreError: It could not be written; nothing was changed.
        """
        # Time stamps never tie or go back, whatever the machine's clock does: later facts beat earlier ones.
        rows = await self._rows(
            f"""
            INSERT INTO memory
                (name, scope, type, data, info, source, name_key, created_unix_ms, updated_unix_ms)
            SELECT :name, :scope, :type, :data, :info, :source, :key, coalesce((
                SELECT created_unix_ms FROM memory
                WHERE name = :name AND scope = :scope AND ended_unix_ms IS NULL
            ), stamp), stamp
            FROM (SELECT max(:now, coalesce((
                SELECT updated_unix_ms + 1 FROM memory ORDER BY id DESC LIMIT 1
            ), 0)) AS stamp)
            RETURNING {_COLUMNS}
            """,
            {**entry.model_dump(), "key": name_key(entry.name), "now": self._clock.unix_ms()},
        )
        return _entry(rows[0])

    async def remove(self, name: str, scope: str | None = "") -> bool:
        """Forget the memory `name` of `scope` (None: of every scope); the history keeps it.

        Returns:
            Whether there was one.

        Raises:
            StoreError: It could not be written; nothing was changed.
        """
        rows = await self._rows(
            "UPDATE memory SET ended_unix_ms = :now WHERE name = :name AND ended_unix_ms IS NULL"
            " AND (:scope IS NULL OR scope = :scope) RETURNING id",
            {"name": name, "scope": scope, "now": self._clock.unix_ms()},
        )
        return bool(rows)

    async def get(self, name: str, scope: str = "") -> MemoryEntry | None:
        """The memory of exactly this name and scope, if there is one."""
        rows = await self._rows(
            f"SELECT {_COLUMNS} FROM memory WHERE name = ? AND scope = ? AND ended_unix_ms IS NULL",
            (name, scope),
        )
        return _entry(rows[0]) if rows else None

    async def all(self, scope: str | None = None) -> list[MemoryEntry]:
        """Everything that is remembered now, oldest first."""
        return await self._current(scope, "ORDER BY id")

    async def newest(self, limit: int, scope: str | None = None) -> list[MemoryEntry]:
        """The `limit` memories that were added or changed last, newest first."""
        return await self._current(scope, "ORDER BY id DESC LIMIT :limit", limit=limit)

    async def history(self, name: str) -> list[MemoryEntry]:
        """The older versions of a memory, replaced or forgotten, oldest first; at most 50 per scope."""
        rows = await self._rows(
            f"SELECT {_COLUMNS} FROM memory WHERE name = ? AND ended_unix_ms IS NOT NULL ORDER BY id", (name,)
        )
        return [_entry(row) for row in rows]

    async def search(self, query: str, limit: int = 20, scope: str | None = None) -> list[MemoryEntry]:
        """The memories that a request in everyday words is about, best first.

        A memory whose name is the request comes first, then by how telling the shared words are.
        """
        named = await self._current(scope, "AND name_key = :key ORDER BY id DESC", key=name_key(query))
        best = await self._lexical(query_terms(query), limit, scope)
        unique = {(entry.name, entry.scope): entry for entry in [*named, *best]}
        return list(unique.values())[:limit]

    async def _lexical(
        self, terms: Sequence[tuple[str, ...]], limit: int, scope: str | None
    ) -> list[MemoryEntry]:
        hits = {term: await self._hits(term, scope) for term in terms}
        hits = {term: hit for term, hit in hits.items() if hit.ids}
        if not hits:
            return []
        newest_id = max(hit.ids[0] for hit in hits.values())
        weights = {term: hit.weight(newest_id) for term, hit in hits.items()}
        found = {term: set(hit.ids) for term, hit in hits.items()}
        rare = [term for term, hit in hits.items() if hit.complete]
        await self._complete(found, rare, worth_completing(hits, weights), scope)
        score = scores(found, weights)
        ranked = sorted(score, key=lambda identity: (score[identity], identity), reverse=True)
        entries = await self._by_id(ranked[: limit * 4])
        return final_order([(identity, score[identity], entry) for identity, entry in entries], weights)

    async def _hits(self, term: tuple[str, ...], scope: str | None) -> Hits:
        """The newest memories with `term`; for a word nobody used, those with a longer word of that start."""
        ids = await self._match(fts_phrase(term), scope)
        if not ids and len(term) == 1 and len(term[0]) >= 4:
            ids = await self._match(fts_phrase(term) + " *", scope)
        return Hits(tuple(ids), complete=len(ids) < _PER_TERM)

    async def _complete(
        self,
        found: dict[tuple[str, ...], set[int]],
        rare: Sequence[tuple[str, ...]],
        common: Sequence[tuple[str, ...]],
        scope: str | None,
    ) -> None:
        """Find the older memories with common words, as far as they can still matter.

        That is where a common word stands beside a rare one, or common words stand together.
        """
        beside_rare = " OR ".join(fts_phrase(term) for term in rare)
        together: list[tuple[str, ...]] = []
        for term in common:
            if rare:
                found[term].update(await self._match(f"({beside_rare}) AND {fts_phrase(term)}", scope))
            expression = " AND ".join(fts_phrase(part) for part in [*together, term])
            if together and (ids := await self._match(expression, scope)):
                for part in [*together, term]:
                    found[part].update(ids)
            elif together:
                continue
            together.append(term)

    async def _match(self, expression: str, scope: str | None) -> list[int]:
        """Ids of the newest memories that an FTS5 expression matches."""
        rows = await self._rows(
            "SELECT s.rowid FROM memory_search s JOIN memory m ON m.id = s.rowid"
            " WHERE memory_search MATCH :expression AND (:scope IS NULL OR m.scope IN ('', :scope))"
            " ORDER BY s.rowid DESC LIMIT :limit",
            {"expression": expression, "scope": scope, "limit": _PER_TERM},
        )
        return [identity for (identity,) in rows]

    async def _by_id(self, ids: Sequence[int]) -> list[tuple[int, MemoryEntry]]:
        marks = ", ".join("?" * len(ids))
        rows = await self._rows(f"SELECT id, {_COLUMNS} FROM memory WHERE id IN ({marks})", tuple(ids))
        return [(row[0], _entry(row[1:])) for row in rows]

    async def _current(self, scope: str | None, rest: str, **values: Any) -> list[MemoryEntry]:
        rows = await self._rows(
            f"SELECT {_COLUMNS} FROM memory WHERE ended_unix_ms IS NULL"
            f" AND (:scope IS NULL OR scope IN ('', :scope)) {rest}",
            {"scope": scope, **values},
        )
        return [_entry(row) for row in rows]

    async def _rows(self, sql: str, values: Any = ()) -> list[tuple[Any, ...]]:
        try:
            return [tuple(row) for row in await self._db.execute_fetchall(sql, values)]
        except (sqlite3.Error, ValueError) as error:
            # aiosqlite says ValueError when the connection is closed.
            raise _told("the memory", error) from error


async def _connect(path: Path | str, clock: Clock) -> aiosqlite.Connection:
    """Open the file, bring it to its present form and check that it is sound."""
    if str(path) != ":memory:":
        try:
            Path(path).parent.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise StoreError(f"the folder for the memory file {path} cannot be made: {error}") from error
    db = await aiosqlite.connect(path, isolation_level=None, timeout=_BUSY_TIMEOUT_S)
    try:
        await db.execute("PRAGMA journal_mode = WAL")
        await db.execute("PRAGMA synchronous = FULL")
        for step in await migrate(db, unix_ms=clock.unix_ms()):
            log.info("memory file brought up to date", step=step, path=str(path))
        ((verdict,),) = await db.execute_fetchall("PRAGMA quick_check(1)")
        if verdict != "ok":
            raise _Damaged(verdict)
    except BaseException:
        await db.close()
        raise
    return db


class _Damaged(sqlite3.DatabaseError):
    """SQLite can read the file but found it inconsistent."""


def _is_damage(error: sqlite3.Error) -> bool:
    code = getattr(error, "sqlite_errorcode", 0) & 0xFF
    return isinstance(error, _Damaged) or code in (sqlite3.SQLITE_CORRUPT, sqlite3.SQLITE_NOTADB)


def _put_aside(path: Path, unix_ms: int) -> Path:
    """Rename a damaged file together with what SQLite keeps beside it."""
    aside = path.with_name(f"{path.name}.corrupt-{unix_ms}")
    try:
        path.rename(aside)
        for suffix in ("-wal", "-shm"):
            beside = path.with_name(path.name + suffix)
            if beside.exists():
                beside.rename(aside.with_name(aside.name + suffix))
    except OSError as error:
        raise StoreError(f"the memory file {path} is damaged and cannot be put aside: {error}") from error
    return aside


def _told(path: Path | str, error: Exception) -> StoreError:
    return StoreError(f"{path} cannot be read or written: {error}")


def _entry(row: Iterable[Any]) -> MemoryEntry:
    return MemoryEntry(**dict(zip(_COLUMNS.split(", "), row, strict=True)))
