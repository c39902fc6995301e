"""Memories found by what they mean, beside those found by their words.

Vectors stand in the memory file beside the memories and are made in the background. Where the server is gone,
words alone decide, and people are told once.
"""

from __future__ import annotations

import asyncio
import sqlite3
from collections.abc import Callable, Sequence
from types import TracebackType
from typing import Final, Self

import numpy as np
import structlog

from parley.clock import Clock
from parley.errors import LanguageError, StoreError
from parley.memory.embedder import Embedder, RefusedTextError
from parley.memory.retrieval import words
from parley.memory.rows import COLUMNS, read_entry
from parley.memory.store import MemoryStore
from parley.memory.vectors import Vectors, VectorTable, make_sieve
from parley.messages.memory import MemoryEntry

__all__ = ["GONE", "Meanings", "fused"]

log = structlog.get_logger(__name__)

GONE: Final = (
    "The service that finds memories by their meaning does not answer."
    " I look for the words themselves meanwhile."
)
"""What people are told once, each time the server is lost."""

_BATCH: Final = 64
_LOOKED_AT: Final = 2000
"""So many memories or vectors at a time are read from the file: others wait for it."""
_FLOAT_BYTES: Final = 4
_MAX_CHARS: Final = 2000
"""Of one memory: what it is about stands at its beginning."""
_SPARE: Final = 1000
"""So many forgotten vectors may stay in working memory."""


class Meanings:
    """Keeps a vector for each memory and finds those that are alike. Use as ``async with``.

    Args:
        store: An open store; it outlives this.
        embedder: Makes the vectors.
        clock: Wall time, for when to try again.
        tell: Told once when the server is gone.
        retry_s: Wall time for which a server that failed is left alone.
        min_alike: Least cosine of a find.
    """

    def __init__(
        self,
        store: MemoryStore,
        embedder: Embedder,
        clock: Clock,
        *,
        tell: Callable[[str], None] = lambda _: None,
        retry_s: float = 30.0,
        min_alike: float = 0.2,
    ) -> None:
        self._store, self._embedder, self._clock, self._tell = store, embedder, clock, tell
        self._retry_s, self._min_alike = retry_s, min_alike
        self._table, self._loaded = VectorTable(), False
        self._seen_id = 0
        self._most = 0
        """So many may stand in working memory before what was forgotten is cleared out."""
        self._retry_at_s = 0.0
        self._gone = False
        self._wanted = asyncio.Event()
        self._task: asyncio.Task[None] | None = None
        self.settled = asyncio.Event()
        """Set while every memory that can have a vector has one, or the server is gone."""

    async def __aenter__(self) -> Self:
        self.wake()
        self._task = asyncio.create_task(self._work(), name="meanings of memories")
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._task is not None:
            self._task.cancel()
            await asyncio.gather(self._task, return_exceptions=True)

    def wake(self) -> None:
        """There may be memories without a vector."""
        self.settled.clear()
        self._wanted.set()

    async def alike(self, request: str, limit: int, scope: str | None = None) -> list[MemoryEntry]:
        """The memories whose meaning is nearest to a request, nearest first.

        Nothing while the server is gone, and as long as no memory has a vector.
        """
        if self._clock.wall_s() < self._retry_at_s or not request.strip():
            return []
        if self._gone:
            self.wake()
        if not len(self._table):
            return []
        try:
            vector = (await self._embedder.embed([request[:_MAX_CHARS]]))[0]
        except LanguageError as error:
            self._lost(error)
            return []
        self._gone = False
        view = self._table.view
        if vector.shape[0] != view.vectors.shape[1]:
            log.warning("vectors of another length", model=self._embedder.model)
            return []
        # Not on the file's thread: comparing many takes a while; words are looked up meanwhile.
        ranked = await asyncio.to_thread(view.nearest, vector, 8 * limit, self._min_alike)
        return await self._store.database.run(lambda db: _holding(db, ranked, limit, scope))

    # -- in the background -----------------------------------------------------------------------------

    async def _work(self) -> None:
        while True:
            await self._wanted.wait()
            self._wanted.clear()
            try:
                await self._embed_missing()
            except LanguageError as error:
                self._lost(error)
            except StoreError as error:
                log.warning("meanings not kept", problem=str(error))
            if not self._wanted.is_set():
                self.settled.set()

    async def _embed_missing(self) -> None:
        if not self._loaded:
            await self._load()
        if self._clock.wall_s() < self._retry_at_s:
            return
        model = self._embedder.model
        while True:
            after = self._seen_id
            batch, upto = await self._store.database.run(
                lambda db, a=after: _missing(db, model, a)  # type: ignore[misc]
            )
            if upto == after:
                return
            await self._make_up(batch)
            self._seen_id = upto

    async def _make_up(self, batch: Sequence[tuple[int, str]]) -> None:
        """Make and keep the vectors of a batch."""
        if not batch:
            return
        done, vectors = await self._embed(batch)
        self._gone = False
        if done:
            model = self._embedder.model
            await self._store.database.run(lambda db: _keep(db, model, done, vectors))
            self._table = await asyncio.to_thread(self._table.extended, done, vectors)
            if len(self._table) > self._most:
                await self._load()  # what was forgotten goes
            await self._make_sieve()

    async def _embed(self, batch: Sequence[tuple[int, str]]) -> tuple[list[int], Vectors]:
        """Vectors of a batch; a text that the server will not have is left out, the rest goes on."""
        try:
            return [identity for identity, _ in batch], await self._embedder.embed(
                [text for _, text in batch]
            )
        except RefusedTextError:
            done: list[int] = []
            rows: list[Vectors] = []
            for identity, text in batch:
                try:
                    rows.append(await self._embedder.embed([text]))
                    done.append(identity)
                except RefusedTextError as error:
                    log.warning("memory without a meaning", memory=identity, problem=str(error))
            return done, np.concatenate(rows) if rows else np.zeros((0, 1), np.float32)

    async def _load(self) -> None:
        """Read what stands in the file, a little at a time: nobody waits for it."""
        model, table, after = self._embedder.model, VectorTable(), -1
        while rows := await self._store.database.run(lambda db, a=after: _kept(db, model, a)):  # type: ignore[misc]
            table = await asyncio.to_thread(_extended, table, rows)
            after = rows[-1][0]
        self._table = table
        self._most = 2 * len(table) + _SPARE
        self._loaded = True
        await self._make_sieve()

    async def _make_sieve(self) -> None:
        if self._table.wants_sieve:
            self._table.adopt(await asyncio.to_thread(make_sieve, self._table.view))

    def _lost(self, error: LanguageError) -> None:
        log.warning("memories found by words alone", problem=str(error))
        self._retry_at_s = self._clock.wall_s() + self._retry_s
        if not self._gone:
            self._gone = True
            self._tell(GONE)


def fused(
    lexical: Sequence[MemoryEntry], alike: Sequence[MemoryEntry], *, first: str = ""
) -> list[MemoryEntry]:
    """Two rankings as one: who stands high in either stands high (reciprocal ranks).

    Args:
        lexical: By words, best first.
        alike: By meaning, best first.
        first: A memory of this name stands before all others.
    """
    score: dict[tuple[str, str], float] = {}
    entries: dict[tuple[str, str], MemoryEntry] = {}
    for ranking in (lexical, alike):
        for rank, entry in enumerate(ranking):
            key = (entry.name, entry.scope)
            score[key] = score.get(key, 0.0) + 1.0 / (60 + rank)
            entries[key] = entry
    wanted = words(first)
    order = sorted(
        score, key=lambda key: (bool(wanted) and words(key[0]) == wanted, score[key]), reverse=True
    )
    return [entries[key] for key in order]


def _missing(db: sqlite3.Connection, model: str, after: int) -> tuple[list[tuple[int, str]], int]:
    """Some memories without a vector behind the one with the number `after`, and how far was looked.

    Only so far that searches need not wait for it.
    """
    (end,) = db.execute(
        "SELECT max(id) FROM (SELECT id FROM memory WHERE id > ? ORDER BY id LIMIT ?)", (after, _LOOKED_AT)
    ).fetchone()
    if end is None:
        return [], after
    rows = db.execute(
        "SELECT m.id, m.name_key, m.info, CASE m.type WHEN 'text' THEN substr(m.data, 1, ?) ELSE '' END"
        " FROM memory m LEFT JOIN memory_vector v ON v.memory = m.id AND v.model = ?"
        " WHERE m.id > ? AND m.id <= ? AND m.ended_unix_ms IS NULL AND v.memory IS NULL"
        " ORDER BY m.id LIMIT ?",
        (_MAX_CHARS, model, after, end, _BATCH),
    ).fetchall()
    texts = [(row[0], ". ".join(part for part in row[1:] if part)[:_MAX_CHARS]) for row in rows]
    return texts, texts[-1][0] if len(texts) == _BATCH else end


def _keep(db: sqlite3.Connection, model: str, ids: Sequence[int], vectors: Vectors) -> None:
    """Write vectors of memories that still hold."""
    rows = [
        (identity, model, vector.tobytes(), identity) for identity, vector in zip(ids, vectors, strict=True)
    ]
    db.execute("BEGIN IMMEDIATE")
    try:
        db.executemany(
            "INSERT OR REPLACE INTO memory_vector SELECT ?, ?, ?"
            " WHERE EXISTS (SELECT 1 FROM memory WHERE id = ? AND ended_unix_ms IS NULL)",
            rows,
        )
    except BaseException:
        db.execute("ROLLBACK")
        raise
    db.execute("COMMIT")


def _kept(db: sqlite3.Connection, model: str, after: int) -> list[tuple[int, bytes]]:
    """Some vectors behind that of the memory with the number `after`."""
    return db.execute(
        "SELECT memory, vector FROM memory_vector WHERE model = ? AND memory > ? ORDER BY memory LIMIT ?",
        (model, after, _LOOKED_AT),
    ).fetchall()


def _extended(table: VectorTable, rows: Sequence[tuple[int, bytes]]) -> VectorTable:
    """With what stood in the file; vectors of another length than the first are passed over."""
    length = table.length or len(rows[0][1]) // _FLOAT_BYTES
    fitting = [(identity, vector) for identity, vector in rows if len(vector) == length * _FLOAT_BYTES]
    if not fitting:
        return table
    joined = np.frombuffer(b"".join(vector for _, vector in fitting), np.float32)
    return table.extended([identity for identity, _ in fitting], joined.reshape(-1, length))


def _holding(
    db: sqlite3.Connection, ranked: Sequence[int], limit: int, scope: str | None
) -> list[MemoryEntry]:
    found: list[MemoryEntry] = []
    for identity in ranked:
        row = db.execute(
            f"SELECT {COLUMNS} FROM memory WHERE id = ? AND ended_unix_ms IS NULL"
            " AND (? IS NULL OR scope IN ('', ?))",
            (identity, scope, scope),
        ).fetchone()
        if row is not None:
            found.append(read_entry(row))
        if len(found) == limit:
            break
    return found
