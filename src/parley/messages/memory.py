"""Memory payloads (thesis 4.3.8.2, design sections 2 and 6)."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Field, RootModel

from parley.messages.base import Payload

__all__ = [
    "AddToMemory",
    "GetMemory",
    "MemoryBody",
    "MemoryEntry",
    "MemoryEvent",
    "MemoryReply",
    "RemoveMemory",
]

MemoryName = Annotated[str, Field(min_length=1, max_length=200)]

RETURN_ALL = "return all memories"
"""The request text that returns everything (thesis)."""


class MemoryBody(Payload):
    """What stands behind a memory's name on the wire."""

    type: Literal["text", "image"] = "text"
    data: str
    """The text, or the picture as base64."""
    info: str = ""
    """One line saying what it is about."""
    scope: str = ""
    """Ours: the robot it belongs to; empty means everybody's."""
    source: str = ""
    """Ours: who said or saw it, e.g. ``operator`` or a robot's name."""


class MemoryEntry(MemoryBody):
    """A memory with its name and, when it comes from the store, its time."""

    name: MemoryName
    created_unix_ms: int = 0
    """When it was first added; 0 while it is not stored."""
    updated_unix_ms: int = 0
    """When it last changed; 0 while it is not stored."""
    used_unix_ms: int = 0
    """When a reply was last founded on it; 0 if never."""
    used_count: int = 0
    """How many replies were founded on it."""

    def body(self) -> dict[str, Any]:
        """The object behind the name on the wire."""
        return self.model_dump(exclude={"name"}, exclude_defaults=True) | {
            "type": self.type, "data": self.data, "info": self.info,
        }  # fmt: skip


class AddToMemory(RootModel[dict[MemoryName, MemoryBody]]):
    """`add_to_memory`: name -> body."""

    def entries(self) -> list[MemoryEntry]:
        """The entries with their names inside."""
        return [MemoryEntry(name=name, **body.model_dump()) for name, body in self.root.items()]


class RemoveMemory(RootModel[dict[str, Any]]):
    """`remove_memory`: the keys are the names to forget; what stands behind them does not matter."""


class GetMemory(Payload):
    """Request of `get_memory`."""

    request: str
    scope: str = ""
    """Ours: only global memories and those of this robot; empty = all."""


class MemoryReply(RootModel[dict[MemoryName, MemoryBody]]):
    """Response of `get_memory`: name -> body, oldest first."""

    def entries(self) -> list[MemoryEntry]:
        """The entries with their names inside."""
        return [MemoryEntry(name=name, **body.model_dump()) for name, body in self.root.items()]


class MemoryEvent(Payload):
    """`/parley/memory_event`: something was durably changed, or could not be."""

    kind: Literal["added", "removed", "failed"]
    name: str
    message: str = ""
    """Why it failed, in plain words."""
