"""Who is there, by the tokens that all show."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import structlog

from parley.errors import TypeMismatchError
from parley.transport.base import Endpoint, absolute
from parley.transport.zenoh.keys import endpoint_of

__all__ = ["Graph"]

log = structlog.get_logger(__name__)


class Graph:
    """Own ends at once, those of others as their tokens come and go. Used on the loop only."""

    def __init__(self) -> None:
        self._ends: dict[str, Endpoint] = {}
        self._own: set[str] = set()
        self._watchers: list[Callable[[], Any]] = []
        self._told: set[str] = set()

    def endpoints(self) -> tuple[Endpoint, ...]:
        """Who is there now."""
        return tuple(self._ends.values())

    def on_changed(self, watcher: Callable[[], Any]) -> Callable[[], None]:
        """Call `watcher` whenever somebody comes or goes; returns how to stop that."""
        self._watchers.append(watcher)
        return lambda: self._watchers.remove(watcher) if watcher in self._watchers else None

    def add_own(self, token: str, endpoint: Endpoint) -> None:
        """An end of this process is open; its token counts no more than this word."""
        self._own.add(token)
        self._ends[token] = endpoint
        self._changed()

    def remove_own(self, token: str) -> None:
        """An end of this process is closed. Its token may be seen a while yet, and does not count."""
        if self._ends.pop(token, None) is not None:
            self._changed()

    def seen(self, token: str, *, is_there: bool) -> None:
        """A token came or went."""
        if token in self._own:
            if not is_there:
                self._own.discard(token)
            return
        endpoint = endpoint_of(token)
        if endpoint is None or (token in self._ends) == is_there:
            return
        if is_there:
            self._tell_mismatch(endpoint)
            self._ends[token] = endpoint
        else:
            del self._ends[token]
        self._changed()

    def check(self, name: str, ros_type: str, *, service: bool) -> None:
        """Raises `TypeMismatchError` if the name is in use with another type."""
        other = self._other_type(absolute(name), ros_type, service=service)
        if other is not None:
            raise TypeMismatchError(
                f"{name} is in use as {other}, not {ros_type}; use the same type on both sides"
            )

    def serves(self, name: str) -> bool:
        """Whether somebody answers this service."""
        return any(end.role == "server" and end.name == absolute(name) for end in self._ends.values())

    def _other_type(self, name: str, ros_type: str, *, service: bool) -> str | None:
        for end in self._ends.values():
            if end.name == name and (end.role == "server") == service and end.ros_type != ros_type:
                return end.ros_type
        return None

    def _tell_mismatch(self, new: Endpoint) -> None:
        """Two who use a name with different types hear nothing of each other, and nobody would know why."""
        other = self._other_type(new.name, new.ros_type, service=new.role == "server")
        if other is not None and new.name not in self._told:
            self._told.add(new.name)
            log.warning(
                "one name is in use with two types", name=new.name, types=sorted({other, new.ros_type})
            )

    def _changed(self) -> None:
        for watcher in list(self._watchers):
            watcher()
