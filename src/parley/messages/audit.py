"""`/parley/audit`: what happened on whose account, for the log that nobody can change unseen."""

from __future__ import annotations

from typing import Any, Literal

from pydantic import Field

from parley.messages.base import Payload
from parley.messages.principal import Principal

__all__ = ["AuditEvent"]


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
