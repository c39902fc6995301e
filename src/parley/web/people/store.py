"""`people.db`: accounts, passkeys, devices that are signed in, and what happened to them.

The server and `parley people` may write it at the same time; the rules that must hold whoever writes (there
is always a supervisor) are kept inside one transaction.
"""

from __future__ import annotations

import secrets
import sqlite3
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from types import TracebackType
from typing import Any, Final, Self, TypeVar

from parley.clock import Clock
from parley.errors import ParleyError, StoreError
from parley.memory.database import Database
from parley.messages.audit import AuditEvent
from parley.messages.principal import Principal, Role
from parley.web.people.records import Device, Gadget, Passkey, Person, key_of, name_problem

__all__ = ["FILE", "PeopleError", "PeopleStore", "Roll"]

T = TypeVar("T")

FILE: Final = "people.db"


class PeopleError(ParleyError):
    """What is wanted cannot be done with people; the text says why, in plain words."""


@dataclass(frozen=True, slots=True)
class Roll:
    """Everything that is kept, as it stands."""

    people: dict[str, Person] = field(default_factory=dict)
    passkeys: dict[str, Passkey] = field(default_factory=dict)
    devices: dict[str, Device] = field(default_factory=dict)


class PeopleStore:
    """Made by `open`. All methods raise `parley.errors.StoreError` when the file cannot be used."""

    def __init__(self, database: Database, clock: Clock) -> None:
        self._database, self._clock = database, clock

    @classmethod
    async def open(cls, path: Path | str, clock: Clock) -> Self:
        """Open or create the file; use as ``async with await PeopleStore.open(...)``.

        Raises:
            StoreError: It cannot be used. A damaged one stays so: without accounts a door would be open.
        """
        database = await Database.open(
            path, prepare=_prepare, unix_ms=clock.unix_ms(), what="people", renews_damaged=False
        )
        return cls(database, clock)

    async def __aenter__(self) -> Self:
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        await self._database.close()

    async def version(self) -> int:
        """Another number whenever somebody else wrote."""
        return await self._database.run(lambda db: int(db.execute("PRAGMA data_version").fetchone()[0]))

    async def salt(self) -> bytes:
        """A random number of this file, made once."""

        def work(db: sqlite3.Connection) -> bytes:
            db.execute("INSERT OR IGNORE INTO setting VALUES ('salt', ?)", (secrets.token_hex(16),))
            return bytes.fromhex(db.execute("SELECT value FROM setting WHERE name = 'salt'").fetchone()[0])

        return await self._database.run(work)

    async def roll(self) -> Roll:
        """Everything that is kept; devices whose time is over are dropped."""
        now_ms = self._clock.unix_ms()

        def work(db: sqlite3.Connection) -> Roll:
            db.execute("DELETE FROM device WHERE ends_unix_ms <= ?", (now_ms,))
            people = [_person(row) for row in db.execute("SELECT * FROM person ORDER BY key")]
            keys = [Passkey(*row) for row in db.execute("SELECT * FROM passkey ORDER BY created_unix_ms")]
            devices = [_device(row) for row in db.execute("SELECT * FROM device ORDER BY created_unix_ms")]
            return Roll({p.key: p for p in people}, {k.id: k for k in keys}, {d.digest: d for d in devices})

        return await self._database.run(work)

    # -- people ----------------------------------------------------------------------------------------

    async def add(self, name: str, role: Role, hashed: str, by: Principal) -> Role:
        """Make an account; the first one is a supervisor's.

        Returns:
            The role that it has.

        Raises:
            PeopleError: The name is taken, or cannot be one.
        """
        if problem := name_problem(name):
            raise PeopleError(problem)
        now_ms = self._clock.unix_ms()

        def work(db: sqlite3.Connection) -> Role:
            is_first = not db.execute("SELECT 1 FROM person LIMIT 1").fetchone()
            given: Role = "supervisor" if is_first else role
            if db.execute("SELECT 1 FROM person WHERE key = ?", (key_of(name),)).fetchone():
                raise PeopleError(f"There is an account called {name} already.")
            db.execute(
                "INSERT INTO person VALUES (?, ?, ?, ?, ?, 0, 0)", (key_of(name), name, given, hashed, now_ms)
            )
            self._note(db, by, f"added {name} as {given}", name)
            return given

        return await self._change(work)

    async def set_role(self, name: str, role: Role, by: Principal) -> None:
        """Give somebody another role.

        Raises:
            PeopleError: There is nobody of that name, or nobody would be a supervisor any more.
        """

        def work(db: sqlite3.Connection) -> None:
            person = _named(db, name)
            db.execute("UPDATE person SET role = ? WHERE key = ?", (role, person.key))
            _need_supervisor(db)
            self._note(db, by, f"made {person.name} a {role}", person.name)

        await self._change(work)

    async def set_disabled(self, name: str, disabled: bool, by: Principal) -> None:
        """Keep somebody out, or let them in again.

        Raises:
            PeopleError: There is nobody of that name, or nobody would be a supervisor any more.
        """

        def work(db: sqlite3.Connection) -> None:
            person = _named(db, name)
            db.execute("UPDATE person SET disabled = ? WHERE key = ?", (int(disabled), person.key))
            _need_supervisor(db)
            if disabled:
                db.execute("DELETE FROM device WHERE person = ?", (person.key,))
            self._note(db, by, f"{'disabled' if disabled else 'enabled'} {person.name}", person.name)

        await self._change(work)

    async def set_password(self, name: str, hashed: str, by: Principal, *, keep: str = "") -> None:
        """Give somebody another password; they are signed out everywhere.

        Args:
            name: Whose.
            hashed: Its hash.
            by: Who does it.
            keep: Digest of a device that stays signed in.

        Raises:
            PeopleError: There is nobody of that name.
        """

        def work(db: sqlite3.Connection) -> None:
            person = _named(db, name)
            db.execute("UPDATE person SET hash = ? WHERE key = ?", (hashed, person.key))
            db.execute("DELETE FROM device WHERE person = ? AND digest <> ?", (person.key, keep))
            self._note(db, by, f"changed the password of {person.name}", person.name)

        await self._change(work)

    async def remove(self, name: str, by: Principal) -> None:
        """Remove an account, with its passkeys, and sign out its devices.

        Raises:
            PeopleError: There is nobody of that name, or nobody would be a supervisor any more.
        """

        def work(db: sqlite3.Connection) -> None:
            person = _named(db, name)
            for table in ("passkey", "device"):
                db.execute(f"DELETE FROM {table} WHERE person = ?", (person.key,))
            db.execute("DELETE FROM person WHERE key = ?", (person.key,))
            _need_supervisor(db)
            self._note(db, by, f"removed {person.name}", person.name)

        await self._change(work)

    # -- passkeys --------------------------------------------------------------------------------------

    async def add_passkey(self, passkey: Passkey, by: Principal) -> None:
        """Keep a passkey.

        Raises:
            PeopleError: It is kept already.
        """

        def work(db: sqlite3.Connection) -> None:
            if db.execute("SELECT 1 FROM passkey WHERE id = ?", (passkey.id,)).fetchone():
                raise PeopleError("This passkey is known already.")
            db.execute(
                "INSERT INTO passkey VALUES (?, ?, ?, ?, ?, ?, ?)",
                (passkey.id, passkey.person, passkey.name, passkey.public_key, passkey.count,
                 passkey.created_unix_ms, passkey.seen_unix_ms),
            )  # fmt: skip
            self._note(db, by, f"added the passkey {passkey.name}", by.name)

        await self._change(work)

    async def used_passkey(self, key: str, count: int) -> None:
        """Somebody signed in with it."""
        now_ms = self._clock.unix_ms()
        await self._database.run(
            lambda db: db.execute(
                "UPDATE passkey SET count = ?, seen_unix_ms = ? WHERE id = ?", (count, now_ms, key)
            )
        )

    async def remove_passkey(self, key: str, by: Principal) -> None:
        """Forget a passkey."""

        def work(db: sqlite3.Connection) -> None:
            db.execute("DELETE FROM passkey WHERE id = ?", (key,))
            self._note(db, by, "removed a passkey", by.name)

        await self._change(work)

    # -- devices ---------------------------------------------------------------------------------------

    async def keep_device(self, device: Device, *, instead_of: str) -> None:
        """Keep who is signed in, in the place of another device."""
        gadget = device.gadget

        def work(db: sqlite3.Connection) -> None:
            db.execute("DELETE FROM device WHERE digest = ?", (instead_of,))
            db.execute(
                "INSERT INTO device VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)",
                (device.digest, device.id, device.person, device.name, device.role, device.way, device.stamp,
                 gadget.kind, gadget.browser, gadget.address, device.created_unix_ms, device.seen_unix_ms,
                 device.ends_unix_ms),
            )  # fmt: skip
            if device.person:
                db.execute(
                    "UPDATE person SET seen_unix_ms = ? WHERE key = ?",
                    (device.created_unix_ms, device.person),
                )

        await self._change(work)

    async def drop_devices(self, digests: list[str], by: Principal | None = None, words: str = "") -> None:
        """Sign devices out.

        Args:
            digests: Which.
            by: Who does it, if that is to be told of.
            words: What was done, then.
        """

        def work(db: sqlite3.Connection) -> None:
            db.executemany("DELETE FROM device WHERE digest = ?", [(digest,) for digest in digests])
            if by is not None:
                self._note(db, by, words, by.name)

        await self._change(work)

    async def saw(self, seen: dict[str, int]) -> None:
        """When devices were last heard of, by digest."""
        rows = [(unix_ms, digest) for digest, unix_ms in seen.items()]
        await self._database.run(
            lambda db: db.executemany("UPDATE device SET seen_unix_ms = ? WHERE digest = ?", rows)
        )

    # -- what happened ---------------------------------------------------------------------------------

    async def take_happened(self) -> list[AuditEvent]:
        """What was done to people and not told of yet."""

        def work(db: sqlite3.Connection) -> list[AuditEvent]:
            rows = db.execute("DELETE FROM happened RETURNING event").fetchall()
            return [AuditEvent.model_validate_json(row[0]) for row in rows]

        return await self._database.run(work)

    def _note(self, db: sqlite3.Connection, by: Principal, words: str, name: str) -> None:
        event = AuditEvent(
            effect="people", by=by, words=words, detail={"name": name}, unix_ms=self._clock.unix_ms()
        )
        db.execute("INSERT INTO happened (event) VALUES (?)", (event.model_dump_json(),))

    async def _change(self, work: Callable[[sqlite3.Connection], T]) -> T:
        """Do it all or not at all."""

        def whole(db: sqlite3.Connection) -> T:
            db.execute("BEGIN IMMEDIATE")
            try:
                result = work(db)
                db.execute("COMMIT")
            except BaseException:
                if db.in_transaction:
                    db.execute("ROLLBACK")
                raise
            return result

        return await self._database.run(whole)


_FORMS: Final = (
    """
    CREATE TABLE person (
        key TEXT PRIMARY KEY,
        name TEXT NOT NULL,
        role TEXT NOT NULL,
        hash TEXT NOT NULL,
        created_unix_ms INTEGER NOT NULL,
        seen_unix_ms INTEGER NOT NULL,
        disabled INTEGER NOT NULL
    ) STRICT;
    CREATE TABLE passkey (
        id TEXT PRIMARY KEY,
        person TEXT NOT NULL,
        name TEXT NOT NULL,
        public_key BLOB NOT NULL,
        count INTEGER NOT NULL,
        created_unix_ms INTEGER NOT NULL,
        seen_unix_ms INTEGER NOT NULL
    ) STRICT;
    CREATE TABLE device (
        digest TEXT PRIMARY KEY,
        id TEXT NOT NULL UNIQUE,
        person TEXT NOT NULL,
        name TEXT NOT NULL,
        role TEXT NOT NULL,
        way TEXT NOT NULL,
        stamp TEXT NOT NULL,
        kind TEXT NOT NULL,
        browser TEXT NOT NULL,
        address TEXT NOT NULL,
        created_unix_ms INTEGER NOT NULL,
        seen_unix_ms INTEGER NOT NULL,
        ends_unix_ms INTEGER NOT NULL
    ) STRICT;
    CREATE TABLE happened (id INTEGER PRIMARY KEY, event TEXT NOT NULL) STRICT;
    CREATE TABLE setting (name TEXT PRIMARY KEY, value TEXT NOT NULL) STRICT;
    """,
)
"""What each version adds to the one before."""


def _prepare(db: sqlite3.Connection) -> None:
    (version,) = db.execute("PRAGMA user_version").fetchone()
    if version > len(_FORMS):
        raise StoreError("a newer Parley wrote the people file; use that one, or another folder")
    for number, form in enumerate(_FORMS[version:], version + 1):
        db.executescript(f"BEGIN; {form} PRAGMA user_version = {number}; COMMIT;")


def _person(row: tuple[Any, ...]) -> Person:
    _, name, role, hashed, created, seen, disabled = row
    return Person(name, role, hashed, created, seen, bool(disabled))


def _device(row: tuple[Any, ...]) -> Device:
    digest, key, person, name, role, way, stamp, kind, browser, address, created, seen, ends = row
    gadget = Gadget(kind, browser, address)
    return Device(digest, key, person, name, role, way, stamp, gadget, created, seen, ends)


def _named(db: sqlite3.Connection, name: str) -> Person:
    row = db.execute("SELECT * FROM person WHERE key = ?", (key_of(name),)).fetchone()
    if row is None:
        raise PeopleError(f"There is no account called {name}.")
    return _person(row)


def _need_supervisor(db: sqlite3.Connection) -> None:
    """Without one nobody could make accounts any more; the last account of all neither goes nor sinks."""
    if not db.execute("SELECT 1 FROM person WHERE role = 'supervisor' AND NOT disabled LIMIT 1").fetchone():
        raise PeopleError("This is the last supervisor. Make somebody else a supervisor first.")
