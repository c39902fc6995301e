"""What of a memory may be believed, by who sends it. Pure."""

from __future__ import annotations

from parley.gate.table import Effect, verdict
from parley.messages.memory import MemoryEntry
from parley.messages.principal import Principal

__all__ = ["may_forget", "vouched"]


def vouched(entry: MemoryEntry, by: Principal | None) -> MemoryEntry:
    """A memory as far as its sender can vouch for it: that a person told it only a person says.

    Args:
        entry: As it came.
        by: Who sends it.
    """
    if by is not None and by.is_person:
        return entry
    if by is not None and by.kind in ("robot", "engine"):
        way = "seen" if by.kind == "robot" and entry.way != "concluded" else "concluded"
        return entry.model_copy(update={"way": way, "words": ""})
    return entry.model_copy(update={"way": "", "words": "", "source": str(by or "program")})


def may_forget(entry: MemoryEntry, by: Principal | None) -> bool:
    """Whether somebody may have a memory forgotten; what is only a program's word any program takes back."""
    return entry.way == "" or verdict(by, Effect.FORGET) == "allow"
