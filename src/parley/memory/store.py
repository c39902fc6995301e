"""What is remembered, in one SQLite file: what `MemoryStore.add` returned survives `kill -9`."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any, Self

from parley.clock import Clock, WallClock
from parley.memory.database import Database
from parley.memory.migrations import migrate
from parley.memory.on_file import OnFile
from parley.memory.retrieval import name_key
from parley.memory.rows import COLUMNS, COLUMNS_WITHOUT_PICTURES, read_entry
from parley.memory.search import search_words
from parley.memory.transfer import MergeCounts, merge
from parley.messages.memory import MemoryEntry, taught_name

__all__ = ["MemoryStore"]


class MemoryStore(OnFile):
    """The memory of all robots, with a scope for what concerns one robot only. Made by `open`.

    A `scope` argument of the reading methods means: None, everything; a robot's name, everybody's memories
    and that robot's; the empty string, everybody's alone. All methods raise `parley.errors.StoreError` when
    the file cannot be read or written, and a change that raised it changed nothing.
    """

    def __init__(self, database: Database, clock: Clock) -> None:
        super().__init__(database)
        self._clock = clock

    @property
    def database(self) -> Database:
        """The file's one door, for what else is kept beside the memories."""
        return self._database

    @classmethod
    async def open(cls, path: Path | str, clock: Clock | None = None) -> Self:
        """Open or create the memory file; use as ``async with await MemoryStore.open(...)``.

        A damaged file is put aside and what can be read of it kept; `notice` then says so.

        Args:
            path: The file, or ``:memory:`` for a memory that ends with the process.
            clock: For time stamps; wall time if left out.

        Raises:
            StoreError: The file cannot be created, read or written, or a newer Parley wrote it.
        """
        clock = clock or WallClock()
        now = clock.unix_ms()
        database = await Database.open(path, prepare=lambda db: migrate(db, unix_ms=now), unix_ms=now)
        return cls(database, clock)

    async def add(self, entry: MemoryEntry) -> MemoryEntry:
        """Remember `entry`; a memory of the same name and scope is replaced and goes to the history.

        Returns:
            The entry as stored, with its times. It is durable.
        """
        # Time stamps never tie or go back, whatever the machine's clock does: later facts beat earlier ones.
        rows = await self._rows(
            f"""
            INSERT INTO memory
                (name, scope, type, data, info, source, way, words, name_key, created_unix_ms,
                 updated_unix_ms)
            SELECT :name, :scope, :type, :data, :info, :source, :way, :words, :key, coalesce((
                SELECT created_unix_ms FROM memory
                WHERE name = :name AND scope = :scope AND ended_unix_ms IS NULL
            ), stamp), stamp
            FROM (SELECT max(:now, coalesce((
                SELECT max(updated_unix_ms) + 1 FROM memory
            ), 0)) AS stamp)
            RETURNING {COLUMNS}
            """,
            {**entry.model_dump(), "key": name_key(entry.name), "now": self._clock.unix_ms()},
        )
        return read_entry(rows[0])

    async def is_known(self, name: str, ways: Sequence[str]) -> bool:
        """Whether something holds under this name, or one that differs only in how it is written.

        Args:
            name: Of a memory.
            ways: How it must be known, see `MemoryBody.way`.
        """
        rows = await self._rows(
            "SELECT way FROM memory WHERE name_key = :key AND ended_unix_ms IS NULL", {"key": name_key(name)}
        )
        return any(way in ways for (way,) in rows)

    async def remove(self, name: str, scope: str | None = "") -> bool:
        """Forget the memory `name` of `scope` (None: of every scope); the history keeps it.

        Returns:
            Whether there was one.
        """
        rows = await self._rows(
            "UPDATE memory SET ended_unix_ms = :now WHERE name = :name AND ended_unix_ms IS NULL"
            " AND (:scope IS NULL OR scope = :scope) RETURNING id",
            {"name": name, "scope": scope, "now": self._clock.unix_ms()},
        )
        return bool(rows)

    async def restore(self, name: str, scope: str = "") -> MemoryEntry | None:
        """Remember again what was forgotten last under this name: forgetting undone.

        Returns:
            The memory as it stands now; None if there is one (nothing was forgotten) or never was.
        """
        if await self.get(name, scope) is not None:
            return None
        older = [entry for entry in await self.history(name) if entry.scope == scope]
        return await self.add(older[-1]) if older else None

    async def mark_used(self, names: Sequence[str], robots: Sequence[str] = ()) -> None:
        """Record that a reply was founded on these memories.

        Args:
            names: Of the memories; unknown ones are passed over.
            robots: Who replied: of one name, a robot's own memory counts before everybody's.
        """
        found: set[tuple[str, str]] = set()
        for name in names:
            scopes = {entry.scope for entry in await self.named(name)}
            found |= {(name, robot if robot in scopes else "") for robot in (robots or ("",))}
        now = self._clock.unix_ms()
        values = [(now, name, scope) for name, scope in sorted(found)]
        sql = (
            "UPDATE memory SET used_unix_ms = ?, used_count = used_count + 1"
            " WHERE name = ? AND scope = ? AND ended_unix_ms IS NULL"
        )

        def work(db: Any) -> None:
            db.execute("BEGIN IMMEDIATE")
            try:
                db.executemany(sql, values)
            except BaseException:
                db.execute("ROLLBACK")
                raise
            db.execute("COMMIT")

        if values:
            await self._database.run(work)

    async def merge(self, entries: Sequence[MemoryEntry], history: Sequence[MemoryEntry] = ()) -> MergeCounts:
        """Take over memories of another file: all or, if it fails, nothing. See `transfer.merge`."""
        now = self._clock.unix_ms()
        return await self._database.run(lambda db: merge(db, entries, history, unix_ms=now))

    async def get(self, name: str, scope: str = "") -> MemoryEntry | None:
        """The memory of exactly this name and scope, if there is one."""
        rows = await self._rows(
            f"SELECT {COLUMNS} FROM memory WHERE name = :name AND scope = :scope AND ended_unix_ms IS NULL",
            {"name": name, "scope": scope},
        )
        return read_entry(rows[0]) if rows else None

    async def named(self, name: str, scope: str | None = None) -> list[MemoryEntry]:
        """The memories of exactly this name, oldest first."""
        return await self._current("AND name = :name ORDER BY updated_unix_ms", scope, name=name)

    async def all(
        self, scope: str | None = None, kind: str = "", *, pictures: bool = True
    ) -> list[MemoryEntry]:
        """Everything that is remembered now, oldest first.

        Args:
            scope: A robot's name: its own memories and everybody's; None: all.
            kind: `text` or `image`: only those.
            pictures: Whether pictures come with their data.
        """
        return await self._current(
            "AND (:kind = '' OR type = :kind) ORDER BY updated_unix_ms", scope, pictures, kind=kind
        )

    async def taught(self, scope: str | None = None) -> list[MemoryEntry]:
        """What people taught their words to mean, oldest first; `scope` as in `all`."""
        rest = "AND name >= :first AND name < :behind ORDER BY updated_unix_ms"
        first = taught_name("")[0]
        found = await self._current(rest, scope, first=first, behind=chr(ord(first) + 1))
        return [entry for entry in found if entry.taught]

    async def picture_chars(self, scope: str | None = None) -> int:
        """How long the data of all pictures is together; `scope` as in `all`."""
        rows = await self._rows(
            "SELECT coalesce(sum(length(data)), 0) FROM memory WHERE ended_unix_ms IS NULL"
            " AND type = 'image' AND (:scope IS NULL OR scope IN ('', :scope))",
            {"scope": scope},
        )
        return int(rows[0][0])

    async def newest(
        self, limit: int, scope: str | None = None, kind: str = "", *, pictures: bool = True
    ) -> list[MemoryEntry]:
        """The `limit` memories that were added or changed last, newest first; the rest as in `all`."""
        return await self._current(
            "AND (:kind = '' OR type = :kind) ORDER BY updated_unix_ms DESC LIMIT :limit",
            scope,
            pictures,
            limit=limit,
            kind=kind,
        )

    async def history(self, name: str = "") -> list[MemoryEntry]:
        """The older versions of a memory, replaced or forgotten, oldest first; at most 50 per scope.

        Without a name: of all memories.
        """
        rows = await self._rows(
            f"SELECT {COLUMNS} FROM memory WHERE (:name = '' OR name = :name) AND ended_unix_ms IS NOT NULL"
            " ORDER BY updated_unix_ms, id",
            {"name": name},
        )
        return [read_entry(row) for row in rows]

    async def search(self, query: str, limit: int = 20, scope: str | None = None) -> list[MemoryEntry]:
        """The memories that a request in everyday words is about, best first.

        A memory whose name is the request comes first, then by how telling the shared words are.
        """
        named = await self._current(
            "AND name_key = :key ORDER BY updated_unix_ms DESC", scope, key=name_key(query)
        )
        worded = await self._database.run(lambda db: search_words(db, query, limit=limit, scope=scope))
        unique = {(entry.name, entry.scope): entry for entry in [*named, *worded]}
        return list(unique.values())[:limit]

    async def _current(
        self, rest: str, scope: str | None, pictures: bool = True, **values: Any
    ) -> list[MemoryEntry]:
        columns = COLUMNS if pictures else COLUMNS_WITHOUT_PICTURES
        rows = await self._rows(
            f"SELECT {columns} FROM memory WHERE ended_unix_ms IS NULL"
            f" AND (:scope IS NULL OR scope IN ('', :scope)) {rest}",
            {"scope": scope, **values},
        )
        return [read_entry(row) for row in rows]

    async def _rows(self, sql: str, values: dict[str, Any]) -> list[Any]:
        return await self._database.run(lambda db: db.execute(sql, values).fetchall())
