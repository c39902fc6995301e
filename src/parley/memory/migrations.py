"""How the memory file came to its present form: one function per step, run once each, never edited later."""

from __future__ import annotations

import sqlite3
from collections.abc import Callable

import structlog

from parley.errors import StoreError

__all__ = ["MIGRATIONS", "migrate"]

log = structlog.get_logger(__name__)


def create_memory(db: sqlite3.Connection) -> None:
    """One row per version of a memory; rows are never changed, only ended.

    Exactly one version per name and scope is current (`ended_unix_ms` null). Triggers end the older version
    and keep the full-text index in step, so that each change of the store is a single statement: it happens
    wholly or not at all. Ids grow with time: they order memories from the oldest to the newest.
    """
    db.execute(
        """
        CREATE TABLE memory (
            id INTEGER PRIMARY KEY AUTOINCREMENT,
            name TEXT NOT NULL,
            scope TEXT NOT NULL,
            type TEXT NOT NULL CHECK (type IN ('text', 'image')),
            data TEXT NOT NULL,
            info TEXT NOT NULL,
            source TEXT NOT NULL,
            name_key TEXT NOT NULL,
            created_unix_ms INTEGER NOT NULL,
            updated_unix_ms INTEGER NOT NULL,
            ended_unix_ms INTEGER
        ) STRICT
        """
    )
    db.execute("CREATE UNIQUE INDEX memory_current ON memory (name, scope) WHERE ended_unix_ms IS NULL")
    db.execute("CREATE INDEX memory_current_key ON memory (name_key) WHERE ended_unix_ms IS NULL")
    db.execute("CREATE INDEX memory_ended ON memory (name, scope, id) WHERE ended_unix_ms IS NOT NULL")
    db.execute(
        """
        CREATE VIRTUAL TABLE memory_search USING fts5 (
            name, info, data, content = '', tokenize = 'porter unicode61'
        )
        """
    )
    db.execute(
        """
        CREATE TRIGGER memory_end_older BEFORE INSERT ON memory BEGIN
            UPDATE memory SET ended_unix_ms = NEW.updated_unix_ms
            WHERE name = NEW.name AND scope = NEW.scope AND ended_unix_ms IS NULL;
        END
        """
    )
    db.execute(
        """
        CREATE TRIGGER memory_index AFTER INSERT ON memory BEGIN
            INSERT INTO memory_search (rowid, name, info, data) VALUES (
                NEW.id, NEW.name_key, NEW.info, CASE NEW.type WHEN 'text' THEN NEW.data ELSE '' END
            );
        END
        """
    )
    db.execute(
        """
        CREATE TRIGGER memory_unindex AFTER UPDATE OF ended_unix_ms ON memory
        WHEN OLD.ended_unix_ms IS NULL AND NEW.ended_unix_ms IS NOT NULL BEGIN
            INSERT INTO memory_search (memory_search, rowid, name, info, data) VALUES (
                'delete', OLD.id, OLD.name_key, OLD.info, CASE OLD.type WHEN 'text' THEN OLD.data ELSE '' END
            );
        END
        """
    )


def bound_history(db: sqlite3.Connection) -> None:
    """Keep the newest 50 ended versions of a memory: some are overwritten every second."""
    db.execute(
        """
        CREATE TRIGGER memory_bound_history AFTER UPDATE OF ended_unix_ms ON memory
        WHEN NEW.ended_unix_ms IS NOT NULL BEGIN
            DELETE FROM memory
            WHERE name = NEW.name AND scope = NEW.scope AND ended_unix_ms IS NOT NULL AND id <= (
                SELECT id FROM memory
                WHERE name = NEW.name AND scope = NEW.scope AND ended_unix_ms IS NOT NULL
                ORDER BY id DESC LIMIT 1 OFFSET 50
            );
        END
        """
    )


def record_use(db: sqlite3.Connection) -> None:
    """When and how often a reply was founded on a memory."""
    db.execute("ALTER TABLE memory ADD COLUMN used_unix_ms INTEGER NOT NULL DEFAULT 0")
    db.execute("ALTER TABLE memory ADD COLUMN used_count INTEGER NOT NULL DEFAULT 0")


def order_by_time(db: sqlite3.Connection) -> None:
    """Memories that come from another file bring their times, so ids no longer tell which is newer.

    Rows that ended elsewhere may now be inserted as they are: they end nothing and are not searched.
    """
    db.execute("CREATE INDEX memory_time ON memory (updated_unix_ms)")
    db.execute("CREATE INDEX memory_current_time ON memory (updated_unix_ms) WHERE ended_unix_ms IS NULL")
    for trigger in ("memory_end_older", "memory_index", "memory_bound_history"):
        db.execute(f"DROP TRIGGER {trigger}")
    db.execute(
        """
        CREATE TRIGGER memory_end_older BEFORE INSERT ON memory WHEN NEW.ended_unix_ms IS NULL BEGIN
            UPDATE memory SET ended_unix_ms = NEW.updated_unix_ms
            WHERE name = NEW.name AND scope = NEW.scope AND ended_unix_ms IS NULL;
        END
        """
    )
    db.execute(
        """
        CREATE TRIGGER memory_index AFTER INSERT ON memory WHEN NEW.ended_unix_ms IS NULL BEGIN
            INSERT INTO memory_search (rowid, name, info, data) VALUES (
                NEW.id, NEW.name_key, NEW.info, CASE NEW.type WHEN 'text' THEN NEW.data ELSE '' END
            );
        END
        """
    )
    for event in ("UPDATE OF ended_unix_ms", "INSERT"):
        db.execute(
            f"""
            CREATE TRIGGER memory_bound_history_{event.split()[0].lower()} AFTER {event} ON memory
            WHEN NEW.ended_unix_ms IS NOT NULL BEGIN
                DELETE FROM memory WHERE id IN (
                    SELECT id FROM memory
                    WHERE name = NEW.name AND scope = NEW.scope AND ended_unix_ms IS NOT NULL
                    ORDER BY updated_unix_ms DESC, id DESC LIMIT -1 OFFSET 50
                );
            END
            """
        )


def keep_vectors(db: sqlite3.Connection) -> None:
    """What a memory means, as numbers, for those who have an embedding model; dropped with the memory."""
    db.execute(
        """
        CREATE TABLE memory_vector (
            memory INTEGER PRIMARY KEY, model TEXT NOT NULL, vector BLOB NOT NULL
        ) STRICT
        """
    )
    db.execute(
        """
        CREATE TRIGGER memory_drop_vector AFTER UPDATE OF ended_unix_ms ON memory
        WHEN NEW.ended_unix_ms IS NOT NULL BEGIN
            DELETE FROM memory_vector WHERE memory = NEW.id;
        END
        """
    )


def say_how_known(db: sqlite3.Connection) -> None:
    """Whether a memory was told, seen or concluded, and the words it was taken from."""
    db.execute("ALTER TABLE memory ADD COLUMN way TEXT NOT NULL DEFAULT ''")
    db.execute("ALTER TABLE memory ADD COLUMN words TEXT NOT NULL DEFAULT ''")


MIGRATIONS: tuple[Callable[[sqlite3.Connection], None], ...] = (
    create_memory,
    bound_history,
    record_use,
    order_by_time,
    keep_vectors,
    say_how_known,
)
"""In order. Their names are recorded in the file: do not rename, do not edit, append."""


def migrate(db: sqlite3.Connection, *, unix_ms: int) -> None:
    """Run the steps that this file has not seen, all in one transaction with the record that they ran.

    Args:
        db: A connection in autocommit mode.
        unix_ms: When, for the record.

    Raises:
        StoreError: The file was written by a newer Parley.
    """
    db.execute("BEGIN IMMEDIATE")
    try:
        db.execute(
            "CREATE TABLE IF NOT EXISTS migration (name TEXT PRIMARY KEY, unix_ms INTEGER NOT NULL) STRICT"
        )
        seen = {name for (name,) in db.execute("SELECT name FROM migration")}
        if unknown := seen - {step.__name__ for step in MIGRATIONS}:
            raise StoreError(
                f"the memory file was written by a newer version of Parley ({', '.join(sorted(unknown))}); "
                "update Parley or use another file"
            )
        for step in MIGRATIONS:
            if step.__name__ not in seen:
                step(db)
                db.execute("INSERT INTO migration VALUES (?, ?)", (step.__name__, unix_ms))
                log.debug("memory file brought up to date", step=step.__name__)
    except BaseException:
        db.execute("ROLLBACK")
        raise
    db.execute("COMMIT")
