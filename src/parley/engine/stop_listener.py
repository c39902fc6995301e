"""Puts what comes on the topic `/parley/stop` on the stop line: one listener per line."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Final

from parley.errors import InvalidMessageError, Problem
from parley.gate.stop_line import StopLine
from parley.messages import ros, topics
from parley.messages.status import StopCommand
from parley.messages.wire import decode
from parley.transport.base import Subscription, Transport

__all__ = ["StopListener"]

DEPTH: Final = 1000
"""So many commands may come at once; each is carried out as soon as it is read."""


class StopListener:
    """Listens between `open` and `close`.

    Args:
        line: Where stops go.
        transport: Where they come from.
        complain: Told why one was refused.
        only: Names by which those are called who are on this line -> who it is; others' stops are not ours.
            None: whoever is named is latched, also if it is not there.
    """

    def __init__(
        self,
        line: StopLine,
        transport: Transport,
        complain: Callable[[Sequence[Problem]], None],
        only: Mapping[str, str] | None = None,
    ) -> None:
        self._line, self._transport, self._complain, self._only = line, transport, complain, only
        self._subscription: Subscription | None = None

    async def open(self) -> None:
        """Listen from now on."""
        self._subscription = await self._transport.subscribe(topics.STOP, self._take, depth=DEPTH)

    async def close(self) -> None:
        """Listen no longer. Idempotent."""
        subscription, self._subscription = self._subscription, None
        if subscription is not None:
            await subscription.close()

    def _take(self, message: ros.String) -> None:
        try:
            command = decode(StopCommand, message.data)
        except InvalidMessageError as error:
            self._complain([Problem(error.path, error.problem, code="malformed")])
            return
        targets = self._ours(command.targets)
        if command.targets and not targets:
            return
        match command.command:
            case "stop":
                self._line.pull(targets, by=command.by, id=command.id, words=command.words, wait_s=0.0)
            case "reset":
                if problems := self._line.reset(targets, by=command.by, id=command.id):
                    self._complain(problems)
            case "hold":
                self._line.hold(targets, id=command.id, by=command.by, words=command.words)
            case "go_on":
                self._line.go_on(command.id)

    def _ours(self, targets: Sequence[str]) -> tuple[str, ...]:
        if self._only is None:
            return tuple(targets)
        return tuple({self._only[name] for name in targets if name in self._only})
