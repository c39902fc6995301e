"""Memories on their way from one file to another: a versioned JSON form, and merging that loses nothing."""

from __future__ import annotations

import sqlite3
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final, Literal

from pydantic import BaseModel, ConfigDict, Field

from parley.errors import FileFormatError
from parley.files import parse_json, read_text, validated
from parley.memory.pictures import check_picture
from parley.memory.retrieval import name_key
from parley.messages.memory import MemoryEntry

__all__ = ["MAX_FILE_BYTES", "ExportFile", "MergeCounts", "merge", "read_export"]

MAX_FILE_BYTES: Final = 512 * 1024 * 1024
"""A larger file is refused unread."""


class ExportFile(BaseModel):
    """What `parley memory export` writes."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    format: Literal["parley-memory"] = "parley-memory"
    version: Literal[1] = 1
    exported_unix_ms: int = 0
    memories: tuple[MemoryEntry, ...] = ()
    """What holds, oldest first."""
    history: tuple[MemoryEntry, ...] = Field(default=())
    """What was replaced or forgotten, oldest first; may be left out."""


@dataclass(frozen=True, slots=True)
class MergeCounts:
    """What became of each memory of an import."""

    added: int = 0
    """Names that were not known."""
    replaced: int = 0
    """Ours was older and went to the history."""
    kept: int = 0
    """Ours is later and stays; the one that came went to the history."""
    unchanged: int = 0
    """Known already."""


def read_export(path: Path) -> ExportFile:
    """Read an exported file, wholly or not at all.

    Raises:
        FileFormatError: It cannot be read or does not have the form; names the first field that is wrong.
    """
    try:
        size = path.stat().st_size
    except OSError as error:
        raise FileFormatError(path.name, "", f"cannot be read: {error.strerror}") from error
    if size > MAX_FILE_BYTES:
        raise FileFormatError(path.name, "", f"{size} bytes is more than the {MAX_FILE_BYTES} allowed")
    raw = parse_json(read_text(path), path.name)
    if not isinstance(raw, dict) or raw.get("format") != "parley-memory":
        raise FileFormatError(path.name, "format", "this is no export of memories (parley-memory)")
    if raw.get("version") != 1:
        raise FileFormatError(path.name, "version", f"{raw.get('version')!r} is not known here; 1 is")
    file = validated(ExportFile, raw, path.name)
    for where, entries in (("memories", file.memories), ("history", file.history)):
        seen: set[tuple[str, str]] = set()
        for index, entry in enumerate(entries):
            at = f"{where}[{index}]"
            if entry.type == "image" and (problem := check_picture(entry.data)):
                raise FileFormatError(path.name, f"{at}.data", problem)
            if _has_half_character(entry):
                raise FileFormatError(path.name, at, "it holds half a character (a lone surrogate)")
            if where == "memories" and (entry.name, entry.scope) in seen:
                raise FileFormatError(path.name, f"{at}.name", f"{entry.name!r} stands there twice")
            seen.add((entry.name, entry.scope))
    return file


def merge(
    db: sqlite3.Connection, entries: Sequence[MemoryEntry], history: Sequence[MemoryEntry], *, unix_ms: int
) -> MergeCounts:
    """Take over memories in one transaction: of one name and scope the later fact wins.

    What loses stands in the history afterwards. Times in the future are taken for now.

    Args:
        db: A connection in autocommit mode.
        entries: What holds in the other file.
        history: What was replaced or forgotten there.
        unix_ms: Now; also the time of entries that bring none.
    """
    counts = {"added": 0, "replaced": 0, "kept": 0, "unchanged": 0}
    db.execute("BEGIN IMMEDIATE")
    try:
        for entry in sorted(entries, key=lambda item: item.updated_unix_ms or unix_ms):
            counts[_take_over(db, entry, unix_ms)] += 1
        for entry in history:
            if not _is_known(db, entry):
                _insert(db, entry, unix_ms, ended=entry.ended_unix_ms or entry.updated_unix_ms or unix_ms)
    except BaseException:
        db.execute("ROLLBACK")
        raise
    db.execute("COMMIT")
    return MergeCounts(**counts)


def _take_over(db: sqlite3.Connection, entry: MemoryEntry, now: int) -> str:
    row = db.execute(
        "SELECT data, type, info, updated_unix_ms FROM memory"
        " WHERE name = ? AND scope = ? AND ended_unix_ms IS NULL",
        (entry.name, entry.scope),
    ).fetchone()
    if row is None:
        _insert(db, entry, now, ended=None)
        return "added"
    if row[:3] == (entry.data, entry.type, entry.info):
        return "unchanged"
    if row[3] <= min(entry.updated_unix_ms or now, now):
        _insert(db, entry, now, ended=None)
        return "replaced"
    if not _is_known(db, entry):
        _insert(db, entry, now, ended=row[3])
    return "kept"


def _is_known(db: sqlite3.Connection, entry: MemoryEntry) -> bool:
    found = db.execute(
        "SELECT 1 FROM memory WHERE name = ? AND scope = ? AND updated_unix_ms = ? AND data = ? LIMIT 1",
        (entry.name, entry.scope, entry.updated_unix_ms, entry.data),
    )
    return found.fetchone() is not None


def _insert(db: sqlite3.Connection, entry: MemoryEntry, now: int, *, ended: int | None) -> None:
    updated = min(entry.updated_unix_ms or now, now)
    db.execute(
        """
        INSERT INTO memory (name, scope, type, data, info, source, name_key, created_unix_ms,
            updated_unix_ms, ended_unix_ms, used_unix_ms, used_count, way, words)
        VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)
        """,
        (
            entry.name, entry.scope, entry.type, entry.data, entry.info, entry.source, name_key(entry.name),
            min(entry.created_unix_ms or updated, updated), updated,
            None if ended is None else min(ended, now), entry.used_unix_ms, entry.used_count,
            entry.way, entry.words,
        ),
    )  # fmt: skip


def _has_half_character(entry: MemoryEntry) -> bool:
    text = f"{entry.name}{entry.scope}{entry.data}{entry.info}{entry.source}{entry.words}"
    return not text.isascii() and any("\ud800" <= char <= "\udfff" for char in text)
