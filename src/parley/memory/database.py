"""One SQLite file and the one thread that touches it.

Work crosses to the thread by one door, `Database.run`, as a plain function over the connection, one after the
other. That makes each piece of work whole (nothing interleaves, no lock) and costs one crossing however many
statements it has.
"""

from __future__ import annotations

import asyncio
import os
import sqlite3
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack, contextmanager
from itertools import count
from pathlib import Path
from typing import Self, TypeVar

import structlog

from parley.errors import StoreError
from parley.memory.salvage import Salvaged, salvage

try:
    import fcntl
except ImportError:  # Windows
    fcntl = None  # type: ignore[assignment]

__all__ = ["Database"]

T = TypeVar("T")

log = structlog.get_logger(__name__)

_BUSY_TIMEOUT_S = 5.0
"""How long a change waits for another process that is writing."""
_RETRY_S = 0.02
_TRIES = 250
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
        self.salvaged = Salvaged()
        """What could be kept of it."""

    @property
    def notice(self) -> str:
        """What the operator should know about the file, in plain words; usually empty."""
        if self.put_aside is None:
            return ""
        kept = "A new one was begun, and nothing from before is remembered."
        if self.salvaged.kept:
            lost = "the rest is lost" if self.salvaged.gaps else "nothing is known to be lost"
            kept = f"What could still be read ({self.salvaged.kept} entries) was kept; {lost}."
        return f"The {self._what} file was damaged. It was put aside as {self.put_aside.name}. {kept}"

    @classmethod
    async def open(
        cls,
        path: Path | str,
        *,
        prepare: Callable[[sqlite3.Connection], None],
        unix_ms: int,
        what: str = "memory",
        renews_damaged: bool = True,
    ) -> Self:
        """Open or create a file; of a damaged one, what can be read is kept (see `notice`).

        The damaged file itself is put aside as ``<name>.corrupt-<unix_ms>`` first.

        Args:
            path: The file, or ``:memory:``. Missing folders are made.
            prepare: Brings the file to the form that is wanted.
            unix_ms: Now, for the name of a damaged file.
            what: What is in the file, for messages.
            renews_damaged: False leaves a damaged file as it is, which is an error then.

        Raises:
            StoreError: The file cannot be created, read or written.
        """
        thread = ThreadPoolExecutor(max_workers=1, thread_name_prefix=what)
        loop = asyncio.get_running_loop()
        try:
            connection, aside, salvaged = await loop.run_in_executor(
                thread, _open, path, prepare, unix_ms, renews_damaged
            )
        except BaseException as error:
            thread.shutdown(wait=False)
            if isinstance(error, sqlite3.Error | OSError):
                raise StoreError(f"the {what} file {path} cannot be used: {error}") from error
            raise
        database = cls(path, thread, connection, what)
        database.put_aside, database.salvaged = aside, salvaged
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


def _open(
    path: Path | str, prepare: Callable[[sqlite3.Connection], None], unix_ms: int, renews_damaged: bool
) -> tuple[sqlite3.Connection, Path | None, Salvaged]:
    """A connection, where a damaged file went, and what was kept of it."""
    with _alone(path):
        try:
            return _connect(path, prepare), None, Salvaged()
        except sqlite3.DatabaseError as error:
            if not (renews_damaged and _is_damage(error)):
                raise
            aside = _put_aside(Path(path), unix_ms)
            connection = _connect(path, prepare)
            try:
                salvaged = salvage(aside, connection)
            except BaseException:
                connection.close()
                raise
            log.error(
                "file damaged",
                path=str(path),
                aside=str(aside),
                problem=str(error),
                kept=salvaged.kept,
                gaps=salvaged.gaps,
            )
            return connection, aside, salvaged


@contextmanager
def _alone(path: Path | str) -> Iterator[None]:
    """While no other process opens a file of this folder: two that find one damaged must not both rename it.

    Where folders cannot be locked, and after as long as a change waits, it goes on without.
    """
    if str(path) == ":memory:":
        yield
        return
    folder = Path(path).parent
    folder.mkdir(parents=True, exist_ok=True)
    with ExitStack() as stack:
        try:
            handle = os.open(folder, os.O_RDONLY)
            stack.callback(os.close, handle)
            _lock(handle)
        except OSError as error:
            log.debug("folder not locked", folder=str(folder), problem=str(error))
        yield


def _lock(handle: int) -> None:
    for _ in range(_TRIES if fcntl is not None else 0):
        try:
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
            return
        except BlockingIOError:
            threading.Event().wait(_RETRY_S)


def _connect(path: Path | str, prepare: Callable[[sqlite3.Connection], None]) -> sqlite3.Connection:
    if str(path) != ":memory:":
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
        for (table,) in connection.execute("SELECT name FROM sqlite_master WHERE sql LIKE '%USING fts5%'"):
            connection.execute(f"INSERT INTO {table} ({table}) VALUES ('integrity-check')")
    except BaseException:
        connection.close()
        raise
    return connection


def _use_wal(connection: sqlite3.Connection) -> None:
    """Switch to the write-ahead log; SQLite itself does not wait where two processes do so at once."""
    for _ in range(_TRIES):
        try:
            connection.execute("PRAGMA journal_mode = WAL")
            return
        except sqlite3.OperationalError as error:
            if error.sqlite_errorcode & 0xFF != sqlite3.SQLITE_BUSY:
                raise
        threading.Event().wait(_RETRY_S)
    connection.execute("PRAGMA journal_mode = WAL")


class _DamagedError(sqlite3.DatabaseError):
    """SQLite can read the file but found it inconsistent."""


def _is_damage(error: sqlite3.Error) -> bool:
    code = getattr(error, "sqlite_errorcode", 0) & 0xFF
    return isinstance(error, _DamagedError) or code in (sqlite3.SQLITE_CORRUPT, sqlite3.SQLITE_NOTADB)


def _put_aside(path: Path, unix_ms: int) -> Path:
    """Rename a damaged file together with what SQLite keeps beside it, to a name that nothing has."""
    names = (f"{path.name}.corrupt-{unix_ms}{f'-{number}' if number else ''}" for number in count())
    aside = next(each for each in map(path.with_name, names) if not each.exists())
    path.rename(aside)
    for suffix in ("-wal", "-shm"):
        beside = path.with_name(path.name + suffix)
        if beside.exists():
            beside.rename(aside.with_name(aside.name + suffix))
    return aside
