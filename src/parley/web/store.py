"""What the page's server keeps over restarts: conversation, pictures, robots, policies.

What `keep` returned for survives `kill -9`.
"""

from __future__ import annotations

import json
import sqlite3
import uuid
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import Final, Self

from pydantic import TypeAdapter

from parley.clock import Clock
from parley.errors import StoreError
from parley.memory.database import Database
from parley.messages.chat import ChatInput
from parley.web.link import Pressed
from parley.web.models import ChatEntry

__all__ = ["KeptPicture", "WebStore"]

_MESSAGES: Final = TypeAdapter(tuple[ChatInput, ...])
_PRESSED: Final = TypeAdapter[Pressed](Pressed)
MAX_PICTURES = 1000
"""The oldest pictures go when there are more."""


@dataclass(frozen=True, slots=True)
class KeptPicture:
    """A picture that was attached to a message, or that a robot took."""

    id: str
    media_type: str
    data: bytes


class WebStore:
    """Made by `open`. All methods raise `parley.errors.StoreError` when the file cannot be used."""

    def __init__(self, database: Database) -> None:
        self._database = database

    @classmethod
    async def open(cls, path: Path | str, clock: Clock) -> Self:
        """Open or create the file; use as ``async with await WebStore.open(...)``.

        Args:
            path: The file, or ``:memory:``.
            clock: For the name of a damaged file, which is put aside.

        Raises:
            StoreError: It cannot be used, or a newer Parley wrote it.
        """
        return cls(await Database.open(path, prepare=_prepare, unix_ms=clock.unix_ms(), what="chat"))

    async def __aenter__(self) -> Self:
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        await self._database.close()

    async def keep(
        self,
        entries: Sequence[ChatEntry],
        pictures: Sequence[KeptPicture] = (),
        messages: Sequence[ChatInput] = (),
    ) -> None:
        """Store entries as they stand, all or none; it is durable afterwards.

        Args:
            entries: What was said.
            pictures: Attached to it.
            messages: What goes to robots for the first entry; they count as unsent until `mark_sent`.
        """
        rows = [(e.id, e.seq, _names(e.targets), e.message.casefold(), e.model_dump_json()) for e in entries]
        images = [_picture_row(picture) for picture in pictures]
        unsent = [(entries[0].id, _MESSAGES.dump_json(tuple(messages)).decode())] if messages else []

        def work(db: sqlite3.Connection) -> None:
            db.execute("BEGIN IMMEDIATE")
            try:
                db.executemany(
                    "INSERT INTO chat (id, seq, robots, folded, entry) VALUES (?, ?, ?, ?, ?)"
                    " ON CONFLICT (id) DO UPDATE SET seq = excluded.seq, robots = excluded.robots,"
                    " folded = excluded.folded, entry = excluded.entry",
                    rows,
                )
                db.executemany("INSERT INTO outbox VALUES (?, ?)", unsent)
                if images:
                    db.executemany("INSERT OR IGNORE INTO picture VALUES (?, ?, ?)", images)
                    _drop_oldest(db)
                db.execute("COMMIT")
            except BaseException:
                if db.in_transaction:
                    db.execute("ROLLBACK")
                raise

        await self._database.run(work)

    async def mark_sent(self, key: str) -> None:
        """Remember that an operator's message went out."""
        await self._database.run(lambda db: db.execute("DELETE FROM outbox WHERE id = ?", (key,)))

    async def unsent(self, key: str = "") -> list[tuple[ChatEntry, tuple[ChatInput, ...]]]:
        """What perhaps did not go out, oldest first, with what goes to robots; all, or that of one key."""
        rows = await self._database.run(
            lambda db: db.execute(
                "SELECT entry, messages FROM outbox JOIN chat USING (id) WHERE ? IN ('', id) ORDER BY seq",
                (key,),
            ).fetchall()
        )
        return [(ChatEntry.model_validate_json(row[0]), _MESSAGES.validate_json(row[1])) for row in rows]

    async def pressed(self) -> tuple[str, int]:
        """What this page's server is called over restarts, and the number of the last press there."""

        def work(db: sqlite3.Connection) -> tuple[str, int]:
            db.execute("INSERT OR IGNORE INTO setting VALUES ('server', 'page', ?)", (uuid.uuid4().hex,))
            (page,) = db.execute("SELECT value FROM setting WHERE kind = 'server'").fetchone()
            last = db.execute("SELECT seq FROM sqlite_sequence WHERE name = 'press'").fetchone()
            return str(page), int(last[0]) if last else 0

        return await self._database.run(work)

    async def keep_press(self, press: Pressed, unix_ms: int) -> None:
        """Store what a button does until `drop_press`; it is durable afterwards."""
        assert press.press is not None
        row = (press.press.number, unix_ms, press.model_dump_json())
        await self._database.run(lambda db: db.execute("INSERT INTO press VALUES (?, ?, ?)", row))

    async def drop_press(self, press: Pressed) -> None:
        """It was taken, or somebody was told that it was not."""
        assert press.press is not None
        row = (press.press.number,)
        await self._database.run(lambda db: db.execute("DELETE FROM press WHERE number = ?", row))

    async def presses(self) -> list[tuple[int, Pressed]]:
        """What an earlier run left, and when it was pressed, oldest first."""
        rows = await self._database.run(
            lambda db: db.execute("SELECT unix_ms, message FROM press ORDER BY number").fetchall()
        )
        return [(int(row[0]), _PRESSED.validate_json(row[1])) for row in rows]

    async def entry(self, key: str) -> ChatEntry | None:
        """The entry of that key; None if there is none."""
        row = await self._database.run(
            lambda db: db.execute("SELECT entry FROM chat WHERE id = ?", (key,)).fetchone()
        )
        return ChatEntry.model_validate_json(row[0]) if row else None

    async def page(
        self, *, before: int | None = None, limit: int = 50, words: str = "", robot: str = ""
    ) -> tuple[list[ChatEntry], bool]:
        """A piece of the conversation.

        Args:
            before: Only entries with a smaller `seq`.
            limit: At most so many: the newest of those that fit.
            words: Only entries whose text contains each of these words, whatever the capitals.
            robot: Only what was said to or by this robot.

        Returns:
            The entries, oldest first, and whether nothing older is left.
        """
        conditions, values = ["seq < ?"], [before if before is not None else 2**62]
        parameters: list[object] = [*values]
        for word in words.casefold().split():
            conditions.append("instr(folded, ?) > 0")
            parameters.append(word)
        if robot:
            conditions.append("instr(robots, ?) > 0")
            parameters.append(_names([robot]))
        sql = f"SELECT entry FROM chat WHERE {' AND '.join(conditions)} ORDER BY seq DESC LIMIT ?"
        parameters.append(limit + 1)
        rows = await self._database.run(lambda db: db.execute(sql, parameters).fetchall())
        found = [ChatEntry.model_validate_json(row[0]) for row in rows[:limit]]
        return found[::-1], len(rows) <= limit

    async def open_questions(self) -> list[ChatEntry]:
        """Questions that were open when the server ended."""
        rows = await self._database.run(
            lambda db: db.execute("SELECT entry FROM chat WHERE entry ->> 'question' = 'open'").fetchall()
        )
        return [ChatEntry.model_validate_json(row[0]) for row in rows]

    async def picture(self, key: str) -> KeptPicture | None:
        """An attached picture, or None."""
        row = await self._database.run(
            lambda db: db.execute("SELECT id, media_type, data FROM picture WHERE id = ?", (key,)).fetchone()
        )
        return KeptPicture(*row) if row else None

    async def keep_seen(self, robot: str, unix_ms: int, picture: KeptPicture) -> None:
        """Store what a robot took a picture of; the same one is stored once."""

        def work(db: sqlite3.Connection) -> None:
            with db:
                db.execute("INSERT OR IGNORE INTO picture VALUES (?, ?, ?)", _picture_row(picture))
                db.execute("INSERT OR IGNORE INTO seen VALUES (?, ?, ?)", (picture.id, robot, unix_ms))
                _drop_oldest(db)

        await self._database.run(work)

    async def seen(self, robot: str, since_unix_ms: int, until_unix_ms: int) -> list[tuple[int, str]]:
        """When a robot took which pictures that are still kept, oldest first."""
        rows = await self._database.run(
            lambda db: db.execute(
                "SELECT unix_ms, picture FROM seen JOIN picture ON picture.id = seen.picture"
                " WHERE robot = ? AND unix_ms BETWEEN ? AND ? ORDER BY unix_ms LIMIT 200",
                (robot, since_unix_ms, until_unix_ms),
            ).fetchall()
        )
        return [(int(unix_ms), str(key)) for unix_ms, key in rows]

    async def said(self, robot: str, since_unix_ms: int, until_unix_ms: int) -> list[ChatEntry]:
        """What was said to and by a robot in a time, oldest first."""
        rows = await self._database.run(
            lambda db: db.execute(
                "SELECT entry FROM chat WHERE instr(robots, ?) > 0"
                " AND entry ->> 'unix_ms' BETWEEN ? AND ? ORDER BY seq LIMIT 500",
                (_names([robot]), since_unix_ms, until_unix_ms),
            ).fetchall()
        )
        return [ChatEntry.model_validate_json(row[0]) for row in rows]

    async def settings(self, kind: str) -> dict[str, str]:
        """All settings of a kind (`robot`, `policy`), name -> value."""
        rows = await self._database.run(
            lambda db: db.execute(
                "SELECT name, value FROM setting WHERE kind = ? ORDER BY rowid", (kind,)
            ).fetchall()
        )
        return dict(rows)

    async def set(self, kind: str, name: str, value: str) -> None:
        """Keep a setting."""
        await self._database.run(
            lambda db: db.execute(
                "INSERT INTO setting VALUES (?, ?, ?) ON CONFLICT DO UPDATE SET value = excluded.value",
                (kind, name, value),
            )
        )

    async def rename(self, kind: str, was: str, name: str, value: str) -> None:
        """Keep a setting under another name; it stands where it stood."""
        await self._database.run(
            lambda db: db.execute(
                "UPDATE setting SET name = ?, value = ? WHERE kind = ? AND name = ?", (name, value, kind, was)
            )
        )

    async def unset(self, kind: str, name: str) -> None:
        """Drop a setting."""
        await self._database.run(
            lambda db: db.execute("DELETE FROM setting WHERE kind = ? AND name = ?", (kind, name))
        )


_FORMS: Final = (
    """
    CREATE TABLE chat (
        id TEXT PRIMARY KEY,
        seq INTEGER NOT NULL,
        robots TEXT NOT NULL,
        folded TEXT NOT NULL,
        entry TEXT NOT NULL,
        sent INTEGER NOT NULL DEFAULT 0
    ) STRICT;
    CREATE INDEX chat_seq ON chat (seq);
    CREATE TABLE picture (id TEXT PRIMARY KEY, media_type TEXT NOT NULL, data BLOB NOT NULL) STRICT;
    CREATE TABLE setting (
        kind TEXT NOT NULL, name TEXT NOT NULL, value TEXT NOT NULL, PRIMARY KEY (kind, name)
    ) STRICT;
    """,
    """
    ALTER TABLE chat DROP COLUMN sent;
    CREATE TABLE outbox (id TEXT PRIMARY KEY, messages TEXT NOT NULL) STRICT;
    CREATE TABLE session (
        digest TEXT PRIMARY KEY, name TEXT NOT NULL, ends_unix_ms INTEGER NOT NULL
    ) STRICT;
    """,
    """
    DROP TABLE session;
    DELETE FROM setting WHERE kind = 'door';
    """,
    """
    CREATE TABLE seen (picture TEXT PRIMARY KEY, robot TEXT NOT NULL, unix_ms INTEGER NOT NULL) STRICT;
    CREATE INDEX seen_when ON seen (robot, unix_ms);
    """,
    """
    CREATE TABLE press (
        number INTEGER PRIMARY KEY AUTOINCREMENT, unix_ms INTEGER NOT NULL, message TEXT NOT NULL
    ) STRICT;
    """,
)
"""What each version adds to the one before."""


def _prepare(db: sqlite3.Connection) -> None:
    (version,) = db.execute("PRAGMA user_version").fetchone()
    if version > len(_FORMS):
        raise StoreError("a newer Parley wrote the chat file; use that one, or another folder")
    for number, form in enumerate(_FORMS[version:], version + 1):
        db.executescript(f"BEGIN; {form} PRAGMA user_version = {number}; COMMIT;")
    _, _, file = db.execute("PRAGMA database_list").fetchone()
    for path in (Path(f"{file}{ending}") for ending in ("", "-wal", "-shm")):
        if file and path.exists():
            path.chmod(0o600)  # conversations are nobody else's business


def _picture_row(picture: KeptPicture) -> tuple[str, str, bytes]:
    return (picture.id, picture.media_type, picture.data)


def _drop_oldest(db: sqlite3.Connection) -> None:
    db.execute("DELETE FROM picture WHERE rowid <= (SELECT max(rowid) FROM picture) - ?", (MAX_PICTURES,))
    db.execute("DELETE FROM seen WHERE picture NOT IN (SELECT id FROM picture)")


def _names(targets: Iterable[str]) -> str:
    """Robots' names so that one of them can be looked for as a text."""
    return json.dumps([name.casefold() for name in targets], ensure_ascii=False)[1:-1]
