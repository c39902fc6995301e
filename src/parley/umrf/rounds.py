"""Spontaneous nodes end a round only when everything they set off before has been stopped (10.7)."""

from __future__ import annotations

from collections.abc import Callable, Iterable

__all__ = ["Rounds"]


class Rounds:
    """Which ends wait for which nodes, by full name."""

    def __init__(self) -> None:
        self._waiting: dict[str, tuple[set[str], Callable[[], None]]] = {}

    def wait(self, name: str, others: Iterable[str], then: Callable[[], None]) -> None:
        """Call `then` once all `others` are over; at once if there are none."""
        self._waiting[name] = (set(others), then)
        self._call_ready()

    def over(self, name: str) -> None:
        """A node is over."""
        for others, _ in self._waiting.values():
            others.discard(name)
        self._call_ready()

    def __contains__(self, name: str) -> bool:
        return name in self._waiting

    def _call_ready(self) -> None:
        for name in [name for name, (others, _) in self._waiting.items() if not others]:
            if (found := self._waiting.pop(name, None)) is not None:
                found[1]()
