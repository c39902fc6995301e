"""One process per data folder: two would move the same robots, each from its own half of what is known."""

from __future__ import annotations

import json
import os
import platform
import shlex
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from datetime import datetime
from pathlib import Path
from typing import IO, Final

import structlog

from parley.errors import StoreError

if sys.platform == "win32":
    import msvcrt
else:
    import fcntl

__all__ = ["held_folder"]

log = structlog.get_logger(__name__)

_NAME: Final = "in-use"
_BEHIND_TEXT: Final = 1 << 30
"""The byte that Windows locks; locked bytes cannot be read there, and the text must be."""


@contextmanager
def held_folder(folder: Path, *, unix_ms: int, name: str = _NAME) -> Iterator[None]:
    """Hold a data folder; the system gives it back when this process ends, however it ends.

    Args:
        folder: Made if it is missing.
        unix_ms: Now, for whoever asks who holds it.
        name: File that is locked: parts that can share a folder, as the page with the rest, have one each.

    Raises:
        StoreError: It cannot be written to, or another process holds it; says which one, and what to do.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
        file = (folder / name).open("a+", encoding="utf-8")
    except OSError as error:
        raise StoreError(
            f"the data folder {folder} cannot be written to ({error.strerror}); "
            "change its rights, or give another one with --data FOLDER"
        ) from error
    with file:
        if not _locked(file):
            raise StoreError(
                f"the data folder {folder} is in use{_holder(file)}. "
                "End that one first, or give this one a folder of its own with --data FOLDER"
            )
        who = {
            "pid": os.getpid(),
            "host": platform.node(),
            "since_unix_ms": unix_ms,
            "command": shlex.join(sys.argv),
        }
        file.seek(0)
        file.truncate()
        file.write(json.dumps(who) + "\n")
        file.flush()
        try:
            yield
        finally:
            with suppress(OSError):
                file.truncate(0)  # the file stays: taken away, two could hold it


def _locked(file: IO[str]) -> bool:
    """Whether this process has it now; where files cannot be locked at all, it goes on without."""
    try:
        if sys.platform == "win32":
            file.seek(_BEHIND_TEXT)
            msvcrt.locking(file.fileno(), msvcrt.LK_NBLCK, 1)
        else:
            fcntl.flock(file.fileno(), fcntl.LOCK_EX | fcntl.LOCK_NB)
    except (BlockingIOError, PermissionError):
        return False
    except OSError as error:
        log.warning("data folder cannot be locked", file=file.name, problem=str(error))
    return True


def _holder(file: IO[str]) -> str:
    """Who holds it, as far as it says so."""
    file.seek(0)
    try:
        who = json.loads(file.read(10_000))
        since = datetime.fromtimestamp(who["since_unix_ms"] / 1000).isoformat(" ", "seconds")
        return f" by process {who['pid']} on {who['host']} since {since}: {who['command']}"
    except (OSError, ValueError, LookupError, TypeError, OverflowError, RecursionError):
        return " by another process"
