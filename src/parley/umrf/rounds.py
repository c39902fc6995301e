"""Spontaneous nodes end a round only when everything they set off before has been stopped (10.7)."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from parley.umrf.model import Result

__all__ = ["Rounds"]


class Rounds:
    """Which ends wait for which nodes, by full name."""

    def __init__(self) -> None:
        self._waiting: dict[str, tuple[set[str], Result]] = {}

    @property
    def pending(self) -> Mapping[str, Result]:
        """The rounds that are not over yet."""
        return {name: result for name, (_, result) in self._waiting.items()}

    def wait(self, name: str, others: Iterable[str], result: Result) -> None:
        """The round of `name` is over once all `others` are; at once if there are none."""
        self._waiting[name] = (set(others), result)

    def over(self, name: str) -> None:
        """A node is over."""
        for others, _ in self._waiting.values():
            others.discard(name)

    def __contains__(self, name: str) -> bool:
        return name in self._waiting

    def take_ready(self) -> Iterator[tuple[str, Result]]:
        """Each node whose round is over now, once, and how it ended."""
        for name in [name for name, (others, _) in self._waiting.items() if not others]:
            if (found := self._waiting.pop(name, None)) is not None:
                yield name, found[1]
