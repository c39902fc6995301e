"""Says whose turn it is at places with room for so many robots only (`/parley/passages`)."""

from __future__ import annotations

import asyncio
from typing import ClassVar, Final

from parley.agents.base import Node
from parley.agents.presence import Presence, linked_to
from parley.clock import Clock
from parley.messages import topics
from parley.messages.passages import PassageList
from parley.messages.status import ActorStatus
from parley.team.passages import PassageBook
from parley.transport.base import Transport

__all__ = ["QUIET_S", "Passages"]

QUIET_S: Final = 1.5
"""So long after its start, in wall time, it gives nothing: who holds what, robots say with each heartbeat."""


class Passages(Node):
    """Hears what robots claim and gives it in turn.

    Args:
        transport: Where robots are.
        clock: Its wall time says who is gone.
    """

    name: ClassVar[str] = "passages"

    def __init__(self, transport: Transport, clock: Clock) -> None:
        super().__init__(transport)
        self._book = PassageBook(gives=False)
        self._presence = Presence(clock, on_change=self._on_presence, linked=linked_to(transport))
        self._told = PassageList()

    async def open(self) -> None:
        """See `Node.open`."""
        self.announce(topics.PASSAGES)
        await self.subscribe(topics.ACTOR_STATUS, ActorStatus, self._on_status)
        self.spawn(self._presence.watch(), name="presence")
        self.spawn(self._begin(), name="passages")

    async def _begin(self) -> None:
        await asyncio.sleep(QUIET_S)
        self._book.gives = True
        self._settle()

    def _on_status(self, status: ActorStatus) -> None:
        self._presence.on_status(status)
        self._book.take(status.actor, status.claim)
        if status.state == "leaving":
            self._book.leave(status.actor)
        self._settle()

    def _on_presence(self, robot: str, joined: bool) -> None:
        if not joined:
            self._book.lose(robot)
            self._settle()

    def _settle(self) -> None:
        told = self._book.settle()
        if told != self._told:
            self._told = told
            self.publish(topics.PASSAGES, told)
