"""Who is held by an emergency stop, in a small file of its own: whatever is in doubt counts as stopped."""

from __future__ import annotations

import json
import os
import threading
from collections.abc import Iterable, Mapping
from concurrent.futures import Future
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from parley.gate.notes import note

__all__ = ["LatchFile", "Latched"]

RETRY_S: Final = 2.0
"""Wall time after which is tried again what could not be written."""


@dataclass(frozen=True, slots=True)
class Latched:
    """Which robots are held by an emergency stop."""

    everybody: bool = False
    """Whether robots that are not named are held: all were stopped, or nobody knows who was."""
    names: frozenset[str] = frozenset()
    """Those who are held; of everybody, those who are not."""

    def holds(self, robot: str) -> bool:
        """Whether that robot is held."""
        return (robot in self.names) != self.everybody

    def stopped(self, robots: Iterable[str]) -> Latched:
        """With these held, too; none named: all."""
        named = frozenset(robots)
        if not named:
            return Latched(everybody=True)
        return Latched(self.everybody, self.names - named if self.everybody else self.names | named)

    def released(self, robots: Iterable[str], known: Iterable[str] = ()) -> Latched:
        """Without these; none named: nobody is held. Once all of `known` are free, strangers are, too."""
        named = frozenset(robots)
        if not named:
            return Latched()
        names = self.names | named if self.everybody else self.names - named
        free = self.everybody and names.issuperset(known)
        return Latched() if free else Latched(self.everybody, names)

    def to_text(self) -> str:
        """What stands in the file."""
        return json.dumps({"stopped": {"everybody": self.everybody, "names": sorted(self.names)}})

    @classmethod
    def from_text(cls, text: str) -> Latched:
        """What a file says.

        Raises:
            ValueError: It cannot be understood.
        """
        try:
            held: Mapping[str, Any] = json.loads(text)["stopped"]
            everybody, names = held["everybody"], held["names"]
        except (KeyError, TypeError, RecursionError) as error:
            raise ValueError(f"not a list of stops: {error}") from error
        if type(everybody) is not bool or type(names) is not list:
            raise ValueError("`everybody` must be true or false, and `names` a list")
        if not all(isinstance(name, str) for name in names):
            raise ValueError("`names` must be text")
        return cls(everybody, frozenset(names))


class LatchFile:
    """Writes the newest state, in a thread of its own: nobody who stops a robot waits for a disk.

    A change is written to a new file that takes the place of the old one. Where there is no room for that
    the old one is emptied, which needs none, and whoever finds an empty file takes everybody for stopped.

    Args:
        path: The file; None: nothing is kept.
    """

    def __init__(self, path: Path | None) -> None:
        self._path = path
        self._lock = threading.Lock()
        self._news = threading.Condition(self._lock)
        self._wanted: Latched | None = None
        self._waiting: Future[str] = Future()
        self._thread: threading.Thread | None = None
        self._closed = False
        self.in_doubt = False
        """Whether `read` found something that cannot be understood."""

    def read(self) -> Latched:
        """What an earlier process left; nothing, if there was none."""
        if self._path is None:
            return Latched()
        try:
            return Latched.from_text(self._path.read_text(encoding="utf-8"))
        except FileNotFoundError:
            return Latched()
        except (OSError, ValueError) as error:
            note("the stops of the last time cannot be read", file=str(self._path), reason=str(error))
            self.in_doubt = True
            return Latched(everybody=True)

    def save(self, state: Latched) -> Future[str]:
        """Have that written; done once it is on disk (with an empty text) or could not be (with the reason).

        Only the newest state is kept, so nothing piles up behind a slow disk.
        """
        if self._path is None:
            done: Future[str] = Future()
            done.set_result("")
            return done
        with self._lock:
            self._wanted = state
            if self._thread is None:
                self._thread = threading.Thread(target=self._work, name="stop latch", daemon=True)
                self._thread.start()
            self._news.notify()
            return self._waiting

    def close(self) -> None:
        """Write what is still to be written, if the disk lets it within `RETRY_S`. Idempotent."""
        with self._lock:
            self._closed = True
            self._news.notify()
            thread = self._thread
        if thread is not None:
            thread.join(RETRY_S)

    def _work(self) -> None:
        """Write whatever is newest, again and again if it cannot be written."""
        while True:
            with self._lock:
                while self._wanted is None:
                    if self._closed:
                        return
                    self._news.wait()
                state, self._wanted = self._wanted, None
                waiting, self._waiting = self._waiting, Future()
            problem = self._write(state)
            waiting.set_result(problem)
            if problem:
                with self._lock:
                    if self._closed:
                        return
                    if self._wanted is None:
                        self._news.wait(RETRY_S)
                    if self._wanted is None:
                        self._wanted = state

    def _write(self, state: Latched) -> str:
        assert self._path is not None
        new = self._path.with_name(f"{self._path.name}.new")
        try:
            self._path.parent.mkdir(parents=True, exist_ok=True)
            _write_through(new, state.to_text())
            new.replace(self._path)
            _sync_folder(self._path.parent)
        except OSError as error:
            self._empty()
            note("the stop cannot be written down", file=str(self._path), reason=str(error))
            return str(error)
        return ""

    def _empty(self) -> None:
        """Leave a file that cannot be understood, so that the next process takes everybody for stopped."""
        assert self._path is not None
        try:
            with self._path.open("r+b") as file:
                file.truncate(0)
                os.fsync(file.fileno())
        except OSError as error:
            note("nor can the old one be emptied", file=str(self._path), reason=str(error))


def _write_through(path: Path, text: str) -> None:
    handle = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o600)
    with os.fdopen(handle, "w", encoding="utf-8") as file:
        file.write(text)
        file.flush()
        os.fsync(file.fileno())


def _sync_folder(folder: Path) -> None:
    """Make a renaming last; folders cannot be opened on Windows, where it lasts by itself."""
    try:
        handle = os.open(folder, os.O_RDONLY)
    except PermissionError:
        return
    try:
        os.fsync(handle)
    finally:
        os.close(handle)
