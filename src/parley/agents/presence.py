"""Who is there: robots known by their heartbeats (`/parley/actor_status`), without any registration."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Final

from parley.clock import Clock
from parley.gate.control import Control
from parley.gate.stop_words import called
from parley.gate.table import Effect, verdict
from parley.messages import topics
from parley.messages.plain import named_in
from parley.messages.status import ActorStatus, StopCommand, StopReport
from parley.sentences import sentence
from parley.transport.base import Transport

__all__ = ["ACQUAINTED_S", "LOST_AFTER_S", "STARVED_AFTER_S", "Presence", "linked_to"]

LOST_AFTER_S: Final = 5.0
"""Wall time without a heartbeat after which a robot counts as gone."""
ACQUAINTED_S: Final = 1.5
"""Wall time after its start in which a node has heard of everybody who is there: they say so every second."""
STARVED_AFTER_S: Final = 20.0
"""The same for one whose ends are still on the transport: its machine is short of time, or hangs."""


def linked_to(transport: Transport) -> Callable[[str], bool]:
    """Whether the engine of a robot still has its ends on `transport`, whatever is heard of it."""

    def linked(actor: str) -> bool:
        name = topics.actor_graph_get(actor).name
        return any(end.role == "server" and end.name == name for end in transport.endpoints())

    return linked


_STOPPING: Final = ("stop", "emergency_stop")


@dataclass(slots=True)
class _Seen:
    status: ActorStatus
    at_s: float


class Presence:
    """The newest status of each robot.

    Args:
        clock: Its wall time decides who is gone.
        known: Names that exist although they send no heartbeat (engines that are not ours).
        on_change: Called with a robot's name and whether it joined (True) or left (False).
        linked: Whether a silent robot's engine can still be reached; it may just be slow.
    """

    def __init__(
        self,
        clock: Clock,
        known: tuple[str, ...] = (),
        on_change: Callable[[str, bool], None] | None = None,
        *,
        linked: Callable[[str], bool] = lambda _: False,
    ) -> None:
        self._clock, self._known, self._on_change, self._linked = clock, known, on_change, linked
        self._seen: dict[str, _Seen] = {}
        self._left: set[str] = set()

    def on_status(self, status: ActorStatus) -> None:
        """Take over a heartbeat."""
        joined = status.actor not in self._seen
        if status.state == "leaving":
            self._leave(status.actor)
            return
        self._seen[status.actor] = _Seen(status, self._clock.wall_s())
        self._left.discard(status.actor)
        if joined and self._on_change is not None:
            self._on_change(status.actor, True)

    def on_stop_report(self, report: StopReport) -> None:
        """A stop is in force, or was released: that counts before the next heartbeat says so."""
        seen = self._seen.get(report.actor)
        if report.state == "reset":
            self._released(report.actor)
        elif seen is not None:
            status = seen.status.model_copy(update={"state": "stopped"})
            self._seen[report.actor] = _Seen(status, seen.at_s)

    def on_reset(self, command: StopCommand) -> None:
        """A person releases stops. Whether it holds the engine says, to who goes on too early as well."""
        if verdict(command.by, Effect.RESET) == "allow":
            for name in command.targets or tuple(self._seen):
                self._released(name)

    def _released(self, name: str) -> None:
        seen = self._seen.get(name)
        if seen is not None and seen.status.state == "stopped":
            state = "paused" if "PAUSED" in seen.status.graphs.values() else "idle"
            self._seen[name] = _Seen(seen.status.model_copy(update={"state": state}), seen.at_s)

    def expire(self, *, late_s: float = 0.0) -> None:
        """Forget who was silent for too long; called now and then.

        Args:
            late_s: How much later than it wanted the caller comes, in wall time. So long nothing was heard
                here, whoever spoke, and nobody is blamed for it.
        """
        now_s = self._clock.wall_s()
        for seen in self._seen.values():
            seen.at_s = min(now_s, seen.at_s + max(0.0, late_s))
        for name in [name for name, seen in self._seen.items() if self._is_gone(name, now_s - seen.at_s)]:
            self._leave(name)

    def _is_gone(self, name: str, silent_s: float) -> bool:
        return silent_s > LOST_AFTER_S and (silent_s > STARVED_AFTER_S or not self._linked(name))

    async def watch(self) -> None:
        """Look every now and then who was silent for too long; our own lateness is nobody's."""
        while True:
            due_s = self._clock.wall_s() + LOST_AFTER_S / 4
            await asyncio.sleep(LOST_AFTER_S / 4)
            self.expire(late_s=self._clock.wall_s() - due_s)

    def get(self, name: str) -> ActorStatus | None:
        """The newest status of a robot that is there, or None."""
        seen = self._seen.get(name)
        return seen.status if seen is not None else None

    def names(self) -> tuple[str, ...]:
        """Everybody who is there or configured, sorted."""
        return tuple(sorted({*self._seen, *self._known}))

    def ever(self) -> tuple[str, ...]:
        """`names`, and who left: a stop of all means them, too."""
        return tuple(sorted({*self.names(), *self._left}))

    @property
    def gone(self) -> frozenset[str]:
        """Who was there and left: nobody speaks for them."""
        return frozenset(self._left)

    def resolve(self, name: str) -> str | None:
        """The robot that `name` means, whatever its capitals; None if there never was one.

        One that left is meant as well: it may only be out of hearing, and a stop must be tried even so.
        """
        wanted = name.strip().casefold()
        return next(
            (known for known in (*self.names(), *sorted(self._left)) if known.casefold() == wanted), None
        )

    def knows_all(self, names: Iterable[str]) -> bool:
        """Whether all of these were ever there; of no names, whether anybody was."""
        wanted = list(names)
        return all(self.resolve(name) is not None for name in wanted) and bool(wanted or self.ever())

    def is_there(self, name: str) -> bool:
        """Whether the robot `name` is there or configured."""
        return name in self._seen or name in self._known

    def named_in(self, message: str) -> list[str]:
        """The robots that a message calls by name."""
        return list(named_in(message, self.ever()))

    def called_in(self, message: str) -> list[str]:
        """The robots that a call to stop is for by its words: those that it names, or all."""
        return list(called(message, self.ever()))

    def meant_by(self, message: str, control: Control) -> list[str]:
        """The robots that an order of control is for by its words; who says "all" stops all, and no more."""
        return self.called_in(message) if control in _STOPPING else self.named_in(message)

    def known_text(self) -> str:
        """Who is there, as a sentence for the operator."""
        names = self.names()
        if not names:
            return sentence("No robot is there at the moment.")
        return sentence("I know {names}.", names=", ".join(names))

    def _leave(self, name: str) -> None:
        if self._seen.pop(name, None) is None:
            return
        self._left.add(name)
        if self._on_change is not None:
            self._on_change(name, False)
