"""Who may stay when it gets crowded: those whom nobody knows give way first, and never crowd out the others.

Pure: whoever has to leave is told by a function that was handed in.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Final

__all__ = ["Crowd", "Seat"]


@dataclass(slots=True, eq=False)
class Seat:
    """The place of one connection."""

    leave: Callable[[], object]
    """Ends the connection; `free` is called all the same once it has ended."""
    _bench: _Bench
    _group: str
    _known: _Bench

    def known(self, who: str) -> None:
        """Whose connection it is, as soon as that is known; from then on no stranger takes its place."""
        if self._bench is self._known and self._group == who:
            return
        self.free()
        self._bench, self._group = self._known, who
        self._bench.add(who, self)

    def free(self) -> None:
        """The connection has ended. Idempotent."""
        self._bench.remove(self._group, self)


@dataclass(slots=True, eq=False)
class _Bench:
    """So many places in all, so many for each; of those with most, the oldest gives way."""

    most: int
    most_each: int
    taken: int = 0
    groups: dict[str, dict[Seat, None]] = field(default_factory=dict)
    """Who sits here, by whose they are, the oldest first."""

    def add(self, group: str, seat: Seat) -> None:
        self.groups.setdefault(group, {})[seat] = None
        self.taken += 1
        if len(self.groups[group]) > self.most_each:
            self._shed(group)
        elif self.taken > self.most:
            self._shed(max(self.groups, key=lambda name: len(self.groups[name])))

    def remove(self, group: str, seat: Seat) -> None:
        seats = self.groups.get(group, {})
        if seat in seats:
            del seats[seat]
            self.taken -= 1
        if not seats:
            self.groups.pop(group, None)

    def _shed(self, group: str) -> None:
        oldest = next(iter(self.groups[group]))
        self.remove(group, oldest)
        oldest.leave()


_EACH: Final = 2
"""Of all places, one address or person has at most one part in so many."""


class Crowd:
    """All connections of one server.

    Args:
        strangers: Most connections of visitors of whom nothing is known yet; half of them from one address.
        known: Most connections of those who are; half of them of one person.
    """

    def __init__(self, strangers: int, known: int) -> None:
        self._strangers = _Bench(strangers, max(strangers // _EACH, 1))
        self._known = _Bench(known, max(known // _EACH, 1))

    def sit(self, address: str, leave: Callable[[], object]) -> Seat:
        """Give a new connection a place; the oldest stranger of the most crowded address may lose its own.

        Args:
            address: Whence it comes.
            leave: Ends it, when it has to give way.
        """
        seat = Seat(leave, self._strangers, address, self._known)
        self._strangers.add(address, seat)
        return seat

    def shed(self) -> None:
        """Let the oldest stranger of the most crowded address go: there is no room at all."""
        groups = self._strangers.groups
        if groups:
            self._strangers._shed(max(groups, key=lambda name: len(groups[name])))
