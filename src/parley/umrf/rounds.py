"""Spontaneous nodes end a round only when everything they set off before has been stopped (10.7)."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping

from parley.umrf.model import Result

__all__ = ["Rounds"]


class Rounds:
    """Which ends wait for which nodes, by full name.

    Args:
        ready: Told the node and how it ended once a round is over.
    """

    def __init__(self, ready: Callable[[str, Result], None]) -> None:
        self._ready = ready
        self._waiting: dict[str, tuple[set[str], Result]] = {}

    @property
    def pending(self) -> Mapping[str, Result]:
        """The rounds that are not over yet."""
        return {name: result for name, (_, result) in self._waiting.items()}

    def wait(self, name: str, others: Iterable[str], result: Result) -> None:
        """The round of `name` is over once all `others` are; at once if there are none."""
        self._waiting[name] = (set(others), result)
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
                self._ready(name, found[1])
