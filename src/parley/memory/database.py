"""One SQLite file and the one thread that touches it.

Work crosses to the thread by one door, `Database.run`, as a plain function over the connection, one after the
other. That makes each piece of work whole (nothing interleaves, no lock) and costs one crossing however many
statements it has.
"""

from __future__ import annotations

import asyncio
import sqlite3
import threading
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Self, TypeVar

import structlog

from parley.errors import StoreError

__all__ = ["Database"]

T = TypeVar("T")

log = structlog.get_logger(__name__)

_BUSY_TIMEOUT_S = 5.0
"""How long a change waits for another process that is writing."""
_WAL_RETRY_S = 0.02
_WAL_TRIES = 250
"""Together as long as `_BUSY_TIMEOUT_S`."""


class Database:
    """See `open`. After `close` everything raises `StoreError`."""

    def __init__(
        self, path: Path | str, thread: ThreadPoolExecutor, connection: sqlite3.Connection, what: str
    ) -> None:
        self._path, self._thread, self._what = path, thread, what
        self._connection: sqlite3.Connection | None = connection
        self.put_aside: Path | None = None
        """Where a damaged file went, if there was one."""

    @classmethod
    async def open(
        cls,
        path: Path | str,
        *,
        prepare: Callable[[sqlite3.Connection], None],
        unix_ms: int,
        what: str = "memory",
    ) -> Self:
        """Open or create a file; a damaged one is put aside as ``<name>.corrupt-<unix_ms>`` first.

        Args:
            path: The file, or ``:memory:``. Missing folders are made.
            prepare: Brings the file to the form that is wanted.
            unix_ms: Now, for the name of a damaged file.
            what: What is in the file, for messages.

        Raises:
            StoreError: The file cannot be created, read or written.
        """
        thread = ThreadPoolExecutor(max_workers=1, thread_name_prefix=what)
        loop = asyncio.get_running_loop()
        aside: Path | None = None
        try:
            try:
                connection = await loop.run_in_executor(thread, _connect, path, prepare)
            except sqlite3.DatabaseError as error:
                if not _is_damage(error):
                    raise
                aside = await loop.run_in_executor(thread, _put_aside, Path(path), unix_ms)
                log.error("file damaged", what=what, path=str(path), aside=str(aside), problem=str(error))
                connection = await loop.run_in_executor(thread, _connect, path, prepare)
        except BaseException as error:
            thread.shutdown(wait=False)
            if isinstance(error, sqlite3.Error | OSError):
                raise StoreError(f"the {what} file {path} cannot be used: {error}") from error
            raise
        database = cls(path, thread, connection, what)
        database.put_aside = aside
        return database

    async def run(self, work: Callable[[sqlite3.Connection], T]) -> T:
        """Run `work` on the connection (autocommit) after all work before; cancelling never stops it halfway.

        Raises:
            StoreError: The file could not be read or written; a single statement then changed nothing.
        """
        connection = self._connection
        if connection is None:
            raise StoreError(f"the {self._what} is closed")
        try:
            return await asyncio.get_running_loop().run_in_executor(self._thread, work, connection)
        except (sqlite3.Error, UnicodeEncodeError) as error:
            raise StoreError(
                f"the {self._what} file {self._path} cannot be read or written: {error}"
            ) from error

    async def close(self) -> None:
        """Finish the work that waits, close the file, end the thread. Idempotent."""
        connection, self._connection = self._connection, None
        if connection is not None:
            await asyncio.get_running_loop().run_in_executor(self._thread, connection.close)
            self._thread.shutdown()  # nothing is left to do, so this does not block


def _connect(path: Path | str, prepare: Callable[[sqlite3.Connection], None]) -> sqlite3.Connection:
    if str(path) != ":memory:":
        Path(path).parent.mkdir(parents=True, exist_ok=True)
        # What people said is nobody else's business; SQLite gives the files beside it the same rights.
        Path(path).touch(mode=0o600, exist_ok=True)
    # Only the one thread uses the connection after it is made, but which that is SQLite need not know.
    connection = sqlite3.connect(path, timeout=_BUSY_TIMEOUT_S, isolation_level=None, check_same_thread=False)
    try:
        _use_wal(connection)
        # What is acknowledged must survive a power cut too.
        connection.execute("PRAGMA synchronous = FULL")
        prepare(connection)
        (verdict,) = connection.execute("PRAGMA quick_check(1)").fetchone()
        if verdict != "ok":
            raise _DamagedError(verdict)
    except BaseException:
        connection.close()
        raise
    return connection


def _use_wal(connection: sqlite3.Connection) -> None:
    """Switch to the write-ahead log; SQLite itself does not wait where two processes do so at once."""
    for _ in range(_WAL_TRIES):
        try:
            connection.execute("PRAGMA journal_mode = WAL")
            return
        except sqlite3.OperationalError as error:
            if error.sqlite_errorcode & 0xFF != sqlite3.SQLITE_BUSY:
                raise
        threading.Event().wait(_WAL_RETRY_S)
    connection.execute("PRAGMA journal_mode = WAL")


class _DamagedError(sqlite3.DatabaseError):
    """SQLite can read the file but found it inconsistent."""


def _is_damage(error: sqlite3.Error) -> bool:
    code = getattr(error, "sqlite_errorcode", 0) & 0xFF
    return isinstance(error, _DamagedError) or code in (sqlite3.SQLITE_CORRUPT, sqlite3.SQLITE_NOTADB)


def _put_aside(path: Path, unix_ms: int) -> Path:
    """Rename a damaged file together with what SQLite keeps beside it."""
    aside = path.with_name(f"{path.name}.corrupt-{unix_ms}")
    path.rename(aside)
    for suffix in ("-wal", "-shm"):
        beside = path.with_name(path.name + suffix)
        if beside.exists():
            beside.rename(aside.with_name(aside.name + suffix))
    return aside
