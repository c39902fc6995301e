"""Spontaneous nodes end a round only when everything they set off before has been stopped (10.7).

Until then they count as running, so that what is said to them in between is obeyed.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass

from parley.umrf.model import Result

__all__ = ["Rounds"]


@dataclass(slots=True)
class _Round:
    others: set[str]
    """Who is not over yet."""
    result: Result
    held: bool = False

    @property
    def next(self) -> bool:
        """Whether another one follows."""
        return self.result in (Result.ON_TRUE, Result.ON_FALSE)


class Rounds:
    """Which ends wait for which nodes, by full name."""

    def __init__(self) -> None:
        self._waiting: dict[str, _Round] = {}

    @property
    def pending(self) -> Mapping[str, Result]:
        """The rounds that are not over yet."""
        return {name: item.result for name, item in self._waiting.items()}

    def wait(self, name: str, others: Iterable[str], result: Result) -> None:
        """The round of `name` is over once all `others` are; at once if there are none."""
        self._waiting[name] = _Round(set(others), result)

    def over(self, name: str) -> None:
        """A node is over."""
        for item in self._waiting.values():
            item.others.discard(name)

    def stop(self, name: str) -> None:
        """No other round of that node, if it is between two."""
        if name in self._waiting and self._waiting[name].next:
            self._waiting[name].result = Result.ON_STOPPED

    def pause(self, name: str) -> None:
        """Hold back what follows, if that node is between two rounds."""
        if name in self._waiting:
            self._waiting[name].held = self._waiting[name].next

    def resume(self) -> None:
        """Hold nothing back any more."""
        for item in self._waiting.values():
            item.held = False

    def between(self, name: str) -> bool:
        """Whether that node waits to go on with another round."""
        return name in self._waiting and self._waiting[name].next

    def __contains__(self, name: str) -> bool:
        return name in self._waiting

    def take_ready(self) -> Iterator[tuple[str, Result, bool]]:
        """Each node whose round is over now, once, how it ended, and whether what follows is held back."""
        while ready := [name for name, item in self._waiting.items() if not item.others]:
            item = self._waiting.pop(ready[0])
            yield ready[0], item.result, item.held
            self.over(ready[0])
