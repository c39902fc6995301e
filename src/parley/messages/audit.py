"""`/parley/audit`: what happened on whose account, for the log that nobody can change unseen."""

from __future__ import annotations

from typing import Any, Literal

from pydantic import Field

from parley.messages.base import Payload
from parley.messages.principal import Principal

__all__ = ["AuditChain", "AuditEntry", "AuditEvent", "AuditList", "GetAudit"]


class AuditEvent(Payload):
    """One thing that somebody wanted and what became of it."""

    effect: str
    """A word of `parley.gate.table.Effect`, or of the same kind: `start`, `end`, `sign_in`, `sign_out`."""
    by: Principal | None = None
    """On whose account; None: a program that nobody vouches for."""
    robot: str = ""
    outcome: Literal["done", "asked", "refused", "failed"] = "done"
    words: str = ""
    """What a person said or pressed."""
    digest: str = ""
    """Of the plan it was about."""
    reason: str = ""
    """Why it was refused or asked about, in plain words."""
    detail: dict[str, Any] = Field(default_factory=dict)
    """Facts, e.g. labels of the steps, the name of a memory, a graph."""
    unix_ms: int = 0


class AuditEntry(AuditEvent):
    """An event as it stands in the log."""

    number: int
    """Counts from 1 without gaps."""
    prev: str
    """The hash of the entry before."""
    hash: str


class GetAudit(Payload):
    """Request of `/parley/get_audit`; what is left empty does not narrow the answer."""

    robot: str = Field(default="", max_length=200)
    by: str = Field(default="", max_length=200)
    """Part of the name, the device or the kind of whoever it was; capitals do not count."""
    effect: str = Field(default="", max_length=50)
    text: str = Field(default="", max_length=200)
    """Part of the words, the reason or the facts; capitals do not count."""
    since_unix_ms: int = 0
    until_unix_ms: int = 0
    """The first moment that no longer counts; 0: no bound."""
    before: int = 0
    """For paging: only entries with a smaller number."""
    limit: int = Field(default=100, ge=1, le=1000)
    verify: bool = False
    """Whether the chain is checked as well."""


class AuditChain(Payload):
    """What checking the log found."""

    entries: int = 0
    since_unix_ms: int = 0
    """When the oldest entry was written."""
    last: str = ""
    """``number:hash`` of the newest entry: kept elsewhere it can be compared later."""
    first_broken: int = 0
    """Number of the first entry that is not as it was written; 0: none."""
    problem: str = ""
    """What is wrong there; empty: the log is whole."""


class AuditList(Payload):
    """Response of `/parley/get_audit`."""

    entries: tuple[AuditEntry, ...] = ()
    """Newest first."""
    chain: AuditChain | None = None
    """If checking was asked for."""
    problem: str = ""
    """Why there is no answer, or why some of it is not written yet, in plain words."""
