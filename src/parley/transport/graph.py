"""Who is there, as far as a transport knows it."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable
from typing import Any

from parley.transport.base import Endpoint, absolute
from parley.transport.refusals import types_differ

__all__ = ["EndpointGraph"]


class EndpointGraph(ABC):
    """What transports answer about their ends and those of others. Used on the loop only."""

    def __init__(self) -> None:
        self._watchers: list[Callable[[], Any]] = []

    @abstractmethod
    def ends(self) -> Iterable[Endpoint]:
        """Who is there now."""

    def endpoints(self) -> tuple[Endpoint, ...]:
        """See `Transport.endpoints`."""
        return tuple(self.ends())

    def on_changed(self, watcher: Callable[[], Any]) -> Callable[[], None]:
        """Call `watcher` whenever somebody comes or goes; returns how to stop that."""
        self._watchers.append(watcher)
        return lambda: self._watchers.remove(watcher) if watcher in self._watchers else None

    def check(self, name: str, ros_type: str, *, service: bool) -> None:
        """Raises `TypeMismatchError` if the name is in use with another type."""
        other = self.other_type(absolute(name), ros_type, service=service)
        if other is not None:
            raise types_differ(name, other, ros_type)

    def serves(self, name: str) -> bool:
        """Whether somebody answers this service, as far as one can tell."""
        return any(end.role == "server" and end.name == absolute(name) for end in self.ends())

    def other_type(self, name: str, ros_type: str, *, service: bool) -> str | None:
        """The other type with which somebody uses a name; an unknown one differs from none."""
        for end in self.ends():
            if end.name == name and (end.role == "server") == service and end.ros_type not in ("", ros_type):
                return end.ros_type
        return None

    def changed(self) -> None:
        """Tell those who watch."""
        for watcher in list(self._watchers):
            watcher()
