"""Puts what comes on the topic `/parley/stop` on the stop line: one listener per line.

Robots of other processes hear the topic themselves; one that was away when it was stopped is told once it is
heard again.
"""

from __future__ import annotations

import uuid
from collections.abc import Callable, Mapping, Sequence
from contextlib import AsyncExitStack, suppress
from typing import Final

from parley.errors import InvalidMessageError, Problem
from parley.gate.stop_line import StopLine
from parley.latest import Latest
from parley.messages import ros, topics
from parley.messages.status import ActorStatus, Pulse, StopCommand
from parley.messages.wire import decode, to_string
from parley.transport.base import Publisher, Transport

__all__ = ["StopListener"]

DEPTH: Final = 1000
"""So many commands may come at once; each is carried out as soon as it is read."""
REMEMBERED: Final = 1000
"""Of so many stops is known whether they were released."""


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
        self._stack = AsyncExitStack()
        self._publisher: Publisher[ros.String] | None = None
        self._stops: Latest[str, bool] = Latest(REMEMBERED)
        """Stops that came, by their ids, and whether a person has released one since."""
        self._again: dict[str, str] = {}
        """Robot -> the id under which it is told again that it was stopped while it was away."""

    async def open(self) -> None:
        """Listen from now on."""
        subscription = await self._transport.subscribe(topics.STOP, self._take, depth=DEPTH)
        self._stack.push_async_callback(subscription.close)
        pulses = await self._transport.subscribe(topics.PULSE, self._on_pulse, along=subscription)
        self._stack.push_async_callback(pulses.close)
        if self._only is not None:
            return
        publisher = self._publisher = self._transport.publisher(topics.STOP)
        self._stack.callback(publisher.close)
        heard = await self._transport.subscribe(topics.ACTOR_STATUS, self._on_status)
        self._stack.push_async_callback(heard.close)

    async def close(self) -> None:
        """Listen no longer. Idempotent."""
        await self._stack.aclose()

    def _take(self, message: ros.String) -> None:
        try:
            command = decode(StopCommand, message.data)
        except InvalidMessageError as error:
            self._complain([Problem(error.path, error.problem, code="malformed")])
            return
        self._carry_out(command)

    def _on_pulse(self, message: ros.String) -> None:
        """Stops that were pressed while this robot was out of reach come with the first sign of the page."""
        with suppress(InvalidMessageError):  # who watches pulses says so
            told = decode(Pulse, message.data).stops
            for stop in [
                stop for stop in told if stop.command == "stop" and stop.id not in ("", *self._stops)
            ]:
                self._carry_out(stop)

    def _carry_out(self, command: StopCommand) -> None:
        targets = self._ours(command.targets)
        if command.targets and not targets:
            return
        match command.command:
            case "stop" if self._stops.get(command.id) or self._line.is_past(command.id):
                pass  # a copy that comes late must not undo what a person has decided since
            case "stop":
                if command.id not in self._again.values():
                    self._again.clear()
                if command.id:
                    self._stops[command.id] = False
                self._line.pull(targets, by=command.by, id=command.id, words=command.words, wait_s=0.0)
            case "reset":
                if problems := self._line.reset(targets, by=command.by, id=command.id, stops=command.stops):
                    self._complain(problems)
                else:
                    self._stops.update(dict.fromkeys(self._stops, True))
            case "hold":
                self._line.hold(targets, id=command.id, by=command.by, words=command.words)
            case "go_on":
                self._line.go_on(command.id)

    def _on_status(self, message: ros.String) -> None:
        """Stop a robot of another process that was latched while it could not hear it."""
        try:
            status = decode(ActorStatus, message.data)
        except InvalidMessageError:  # the nodes that need it say so
            return
        if not self._line.latched_elsewhere(status.actor):
            self._again.pop(status.actor, None)
        elif status.state not in ("stopped", "leaving") and self._publisher is not None:
            id = self._again.setdefault(status.actor, uuid.uuid4().hex)
            again = StopCommand(targets=(status.actor,), id=id, words="stopped while away")
            self._publisher.publish(to_string(again))

    def _ours(self, targets: Sequence[str]) -> tuple[str, ...]:
        if self._only is None:
            return tuple(targets)
        return tuple({self._only[name] for name in targets if name in self._only})
