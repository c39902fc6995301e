"""Memory payloads (thesis 4.3.8.2, design sections 2 and 6)."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Annotated, Any, Final, Literal, Self

from pydantic import Field, RootModel, ValidationError

from parley.messages.base import Payload
from parley.messages.principal import Principal

__all__ = [
    "AddToMemory",
    "GetMemory",
    "MemoryBody",
    "MemoryEntry",
    "MemoryEvent",
    "MemoryList",
    "MemoryReply",
    "RemoveMemory",
    "StoredMemory",
    "is_taught_name",
    "taught_name",
]

MemoryName = Annotated[str, Field(min_length=1, max_length=200)]

RETURN_ALL = "return all memories"
"""The request text that returns everything (thesis)."""

_TAUGHT: Final = re.compile(r"“(?P<words>[^“”]+)” means")


def taught_name(words: str) -> str:
    """The name of the memory that says what `words` mean."""
    return f"“{words}” means"


def is_taught_name(name: str) -> bool:
    """Whether a memory of this name says what some words mean."""
    return _TAUGHT.fullmatch(name) is not None


class _Memory(Payload):
    """What is remembered under a name."""

    type: Literal["text", "image"] = "text"
    data: str
    """The text, or the picture as base64."""
    info: str = ""
    """One line saying what it is about."""
    scope: str = ""
    """Ours: the robot it belongs to; empty means everybody's."""
    source: str = ""
    """Ours: who said or saw it, e.g. ``operator`` or a robot's name."""
    way: Literal["told", "seen", "concluded", ""] = ""
    """Ours: whether a person told it, a robot saw it, or a language engine concluded it; empty: not known."""
    words: str = ""
    """Ours: the person's own words it was taken from; empty where there are none."""


class MemoryBody(_Memory):
    """What stands behind a memory's name on the wire, where it is to be remembered."""

    by: Principal | None = None
    """Ours: who sends it; None: a program that nobody vouches for. Not kept."""


class StoredMemory(_Memory):
    """A memory as the store hands it out. Ours: other programs see `type`, `data` and `info`."""

    created_unix_ms: int = 0
    """When it was first added; 0 while it is not stored."""
    updated_unix_ms: int = 0
    """When it last changed; 0 while it is not stored."""
    ended_unix_ms: int = 0
    """When it was replaced or forgotten; 0 while it holds."""
    used_unix_ms: int = 0
    """When a reply was last founded on it; 0 if never."""
    used_count: int = 0
    """How many replies were founded on it."""


class MemoryEntry(StoredMemory):
    """A memory with its name."""

    name: MemoryName

    @property
    def taught(self) -> str:
        """The words whose meaning it says, as a person told it; empty for any other memory."""
        found = _TAUGHT.fullmatch(self.name) if self.way == "told" and self.type == "text" else None
        return found["words"] if found else ""

    @property
    def is_told(self) -> bool:
        """Whether a person said it; what a robot saw or a language engine concluded is never a rule."""
        known = self.way == "told" or (self.way == "" and not self.source.startswith("program"))
        return known and "/" not in self.source and not is_taught_name(self.name)

    def body(self) -> dict[str, Any]:
        """The object behind the name on the wire."""
        return self.model_dump(exclude={"name"}, exclude_defaults=True) | {
            "type": self.type, "data": self.data, "info": self.info,
        }  # fmt: skip


class AddToMemory(RootModel[dict[MemoryName, MemoryBody]]):
    """`add_to_memory`: name -> body."""

    def entries(self) -> list[MemoryEntry]:
        """The entries with their names inside."""
        return [MemoryEntry(name=name, **body.model_dump(exclude={"by"})) for name, body in self.root.items()]


class RemoveMemory(RootModel[dict[str, Any]]):
    """`remove_memory`: the keys are the names to forget.

    Ours: an object with `scope` behind a name forgets it in that scope alone; else everywhere. Its `by` says
    who wants that.
    """

    @classmethod
    def of(cls, name: str, by: Principal | None, scope: str | None = None) -> Self:
        """Forget one memory, on somebody's account."""
        where = {} if scope is None else {"scope": scope}
        who = {} if by is None else {"by": by.model_dump(exclude_defaults=True)}
        return cls({name: where | who})

    def by_of(self, name: str) -> Principal | None:
        """Who wants that `name` is forgotten; None: a program that nobody vouches for."""
        body = self.root.get(name)
        try:
            return Principal.model_validate(body["by"]) if isinstance(body, dict) and "by" in body else None
        except ValidationError:
            return None

    def scope_of(self, name: str) -> str | None:
        """The scope in which `name` is to be forgotten; None for all."""
        body = self.root.get(name)
        scope = body.get("scope") if isinstance(body, dict) else None
        return scope if isinstance(scope, str) else None


class GetMemory(Payload):
    """Request of `get_memory`."""

    request: str
    """What the memories should matter for; for `named` and `history` the name of a memory."""
    scope: str = ""
    """Ours: a robot's name: everybody's memories and its own; empty or left out: all."""
    kind: Literal["select", "list", "search", "named", "history"] = "select"
    """Ours. `select` is the thesis's and is answered by `MemoryReply`, the others by `MemoryList`: `list` is
    everything, oldest first; `search` the best finds first, without the language engine; `named` those of
    exactly that name; `history` the versions that were replaced or forgotten, oldest first."""
    type: Literal["", "text", "image"] = ""
    """Ours: only memories of this type."""
    pictures: bool = True
    """Ours: whether pictures come with their data, which is long."""
    limit: int = Field(default=0, ge=0)
    """Ours: at most so many; 0: no bound but for `search`, which has one."""


class MemoryReply(RootModel[dict[MemoryName, StoredMemory]]):
    """Response of `get_memory`: name -> body, oldest first."""

    @classmethod
    def of(cls, entries: Iterable[MemoryEntry]) -> Self:
        """The reply that holds these entries; of one name the last."""
        return cls({entry.name: entry for entry in entries})

    def entries(self) -> list[MemoryEntry]:
        """The entries with their names inside."""
        return [MemoryEntry(name=name, **body.model_dump()) for name, body in self.root.items()]


class MemoryList(Payload):
    """Response of `get_memory` to the kinds of requests that are ours: a name may stand in several scopes."""

    memories: tuple[MemoryEntry, ...] = ()
    left_out: int = 0
    """How many older ones did not fit into one message."""


class MemoryEvent(Payload):
    """`/parley/memory_event`: something was durably changed, or could not be."""

    kind: Literal["added", "removed", "failed"]
    name: str
    scope: str = ""
    """The robot it belongs to; empty for everybody's."""
    message: str = ""
    """Why it failed, in plain words."""
    by: Principal | None = None
    """Who wants it forgotten."""
