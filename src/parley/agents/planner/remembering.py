"""What a command of an order asks to be remembered or forgotten. Pure."""

from __future__ import annotations

import uuid

from parley.errors import Problem
from parley.messages.chat import SystemCommand
from parley.messages.memory import AddToMemory, MemoryBody, RemoveMemory
from parley.messages.principal import Principal

__all__ = ["memory_change"]


def memory_change(
    command: SystemCommand, by: Principal | None = None
) -> AddToMemory | RemoveMemory | Problem | None:
    """The message for the memory on somebody's account, why there can be none, or None for other commands."""
    arguments = command.arguments
    if command.command == "remove_memory":
        name = str(arguments.get("name") or arguments.get("parameters") or "")
        scope = arguments["scope"] if isinstance(arguments.get("scope"), str) else None
        return RemoveMemory.of(name, by, scope)
    if command.command != "add_memory":
        return None
    if not isinstance(arguments.get("data"), str):
        return Problem("system_cmd.add_memory.data", "expected a text to remember", code="invalid_message")
    body = MemoryBody(
        type="image" if arguments.get("type") == "image" else "text",
        data=arguments["data"],
        info=str(arguments.get("info") or arguments["data"]),
        scope=str(arguments.get("scope") or ""),
        source=str(arguments.get("source") or ""),
        way=arguments["way"] if arguments.get("way") in ("told", "seen", "concluded") else "",
        words=str(arguments.get("words") or ""),
        by=by,
    )
    return AddToMemory({str(arguments.get("name") or f"memory_{uuid.uuid4().hex[:12]}"): body})
