"""A journal in the form of another release is kept beside the new one instead of being written over.

What is in it cannot be gone on with here, but people may want to look something up, or to go back.
"""

from __future__ import annotations

import contextlib
import itertools
import sqlite3
from pathlib import Path
from typing import Final

import structlog

__all__ = ["put_aside_other_form"]

log = structlog.get_logger(__name__)

_PARTS: Final = ("", "-wal", "-shm")
"""What a file consists of after a kill, by what follows its name; what is not written back yet is in them."""


def put_aside_other_form(path: Path, form: int) -> Path | None:
    """Rename the journal in `path` if it is of another form, and log where it went; blocks, so use a thread.

    What cannot be read is left to whoever opens the file.

    Args:
        path: The journal; there may be none.
        form: The form that this release writes.

    Returns:
        Where it is now, or None if it stays.
    """
    try:
        found = _form(path)
        if found in (None, form):
            return None
        aside = next(name for name in _names(path, found or 0) if not name.exists())
        for part in _PARTS:
            with contextlib.suppress(FileNotFoundError):
                path.with_name(path.name + part).rename(aside.with_name(aside.name + part))
    except (OSError, sqlite3.Error) as error:
        log.error("journal of another release cannot be put aside", file=str(path), reason=str(error))
        return None
    log.warning(
        "journal of another release put aside; what was interrupted then is not gone on with",
        file=str(path),
        now=str(aside),
    )
    return aside


def _form(path: Path) -> int | None:
    """Which form a file has; None if there is none, or nothing in it."""
    if not path.is_file() or path.stat().st_size == 0:
        return None
    with contextlib.closing(sqlite3.connect(path)) as connection:
        (tables,) = connection.execute("SELECT count(*) FROM sqlite_master").fetchone()
        (form,) = connection.execute("PRAGMA user_version").fetchone()
    return int(form) if tables else None


def _names(path: Path, form: int) -> itertools.chain[Path]:
    first = path.with_name(f"{path.stem}.form-{form}{path.suffix}")
    others = (path.with_name(f"{path.stem}.form-{form}-{n}{path.suffix}") for n in itertools.count(2))
    return itertools.chain([first], others)
