"""The chain of the audit log: each entry holds the hash of the one before. Pure.

An entry is kept as the very text that its hash was made of, so that nothing depends on how JSON is written
again. Changed, removed, swapped and inserted entries break the chain. What was cut off at its end is found by
the head: number and hash of the newest entry, kept beside the log.

Whoever may write both files can make a whole new log that fits together. Against that helps only a head that
is kept elsewhere (``parley audit verify --mark``).
"""

from __future__ import annotations

import hashlib
import json
from dataclasses import dataclass
from typing import Any, Final, Self

from parley.errors import InvalidMessageError
from parley.messages.audit import AuditChain, AuditEntry, AuditEvent

__all__ = ["GENESIS", "MAX_TEXT", "PRUNE", "Head", "Row", "Verifier", "canonical", "entry_of", "sealed"]

GENESIS: Final = "0" * 64
"""What the first entry names as the hash before it."""
PRUNE: Final = "prune"
"""Effect of the entry that says which older ones were removed because they were old."""
MAX_TEXT: Final = 4000
"""Longer words and facts are cut: one message must not fill the log."""


@dataclass(frozen=True, slots=True)
class Head:
    """The end of a chain."""

    number: int = 0
    hash: str = GENESIS

    def __str__(self) -> str:
        return f"{self.number}:{self.hash}"

    @classmethod
    def read(cls, text: str) -> Self:
        """The head that `str` wrote.

        Raises:
            InvalidMessageError: It is none.
        """
        number, _, digest = text.strip().partition(":")
        if not (number.isdecimal() and len(digest) == len(GENESIS) and digest.isalnum()):
            raise InvalidMessageError("head of the log", "", "expected NUMBER:HASH, as `verify` prints it")
        return cls(int(number), digest)


@dataclass(frozen=True, slots=True)
class Row:
    """One entry as it is stored."""

    number: int
    record: str
    """Canonical JSON of all fields but the hash."""
    hash: str

    @property
    def head(self) -> Head:
        """The end of a chain of which this is the last entry."""
        return Head(self.number, self.hash)


def canonical(value: Any) -> str:
    """The one JSON text of a value: keys in order, no spaces."""
    return json.dumps(value, sort_keys=True, separators=(",", ":"), ensure_ascii=False, allow_nan=False)


def sealed(event: AuditEvent, after: Head) -> Row:
    """`event` as the entry that follows `after`."""
    fields = event.model_dump(mode="json", include=set(AuditEvent.model_fields))
    fields["words"], fields["reason"] = _cut(event.words), _cut(event.reason)
    if len(facts := canonical(fields["detail"])) > MAX_TEXT:
        fields["detail"] = {"cut": _cut(facts)}
    record = canonical({**fields, "number": after.number + 1, "prev": after.hash})
    return Row(after.number + 1, record, _hash(record))


def entry_of(row: Row) -> AuditEntry:
    """The entry of a row; of a damaged one as much as can be read."""
    try:
        return AuditEntry.model_validate({**json.loads(row.record), "hash": row.hash})
    except (ValueError, TypeError):
        return AuditEntry(
            effect="gap",
            outcome="failed",
            reason="This entry cannot be read.",
            number=row.number,
            prev="",
            hash=row.hash,
        )


class Verifier:
    """Takes the entries of a log in their order and says what is wrong first.

    Args:
        head: The end of the chain as it was written beside the log; None: there is none, which is a fault
            in itself as soon as there is an entry.
        marks: Ends of the chain at earlier moments, kept elsewhere.
    """

    def __init__(self, head: Head | None, marks: tuple[Head, ...] = ()) -> None:
        self._head = head
        self._known = {mark.number: mark.hash for mark in (*((head,) if head else ()), *marks)}
        self._last = Head()
        self._first: Row | None = None
        self._since = self._count = 0
        self._removed: set[str] = set()
        """What entries about removal name as the last that was removed."""
        self._broken: tuple[int, str] | None = None

    def take(self, row: Row) -> None:
        """The next entry."""
        self._count += 1
        fields = _fields(row)
        before = Head(row.number - 1, str(fields.get("prev", "")))
        if self._first is None:
            self._first, self._since = row, int(fields.get("unix_ms", 0) or 0)
            self._last = before
        if self._broken is None:
            self._broken = self._fault(row, fields, before)
        if fields.get("effect") == PRUNE and isinstance(fields.get("detail"), dict):
            self._removed.add(str(fields["detail"].get("last", "")))
        self._last = row.head

    def _fault(self, row: Row, fields: dict[str, Any], before: Head) -> tuple[int, str] | None:
        if row.number != self._last.number + 1:
            missing = f"entries {self._last.number + 1} to {before.number} are missing"
            return row.number, missing if row.number > self._last.number else "it stands in the wrong place"
        if _hash(row.record) != row.hash or fields.get("number") != row.number:
            return row.number, "it was changed"
        if before.hash != self._last.hash:
            return row.number, "it does not follow from the entry before, which was changed or exchanged"
        if self._known.get(row.number, row.hash) != row.hash:
            return row.number, "the log up to here was written anew"
        return None

    def result(self) -> AuditChain:
        """What was found."""
        number, problem = self._broken or self._ends() or (0, "")
        return AuditChain(
            entries=self._count,
            since_unix_ms=self._since,
            last=str(self._last) if self._count else "",
            first_broken=number,
            problem=problem,
        )

    def _ends(self) -> tuple[int, str] | None:
        """What is wrong with the beginning or the end."""
        furthest = max(self._known, default=0)
        if furthest > self._last.number:
            return self._last.number + 1, f"the last entries, up to {furthest}, were cut off"
        if self._first is None:
            return None
        before = Head(self._first.number - 1, str(_fields(self._first).get("prev", "")))
        if before != Head() and str(before) not in self._removed:
            return self._first.number, f"the entries before it, up to {before.number}, are missing"
        if self._head is None:
            return self._last.number, "the file that holds the end of the log is missing"
        return None


def _fields(row: Row) -> dict[str, Any]:
    try:
        fields = json.loads(row.record)
    except ValueError:
        return {}
    return fields if isinstance(fields, dict) else {}


def _hash(text: str) -> str:
    return hashlib.sha256(text.encode("utf-8", "surrogatepass")).hexdigest()


def _cut(text: str) -> str:
    return text if len(text) <= MAX_TEXT else text[: MAX_TEXT - 1] + "…"
