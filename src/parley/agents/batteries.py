"""Tells operators that a battery is low: once, again when it is nearly empty, and when it is quite empty."""

from __future__ import annotations

from collections.abc import Callable
from typing import ClassVar, Final

from parley.agents.base import Node
from parley.latest import Latest
from parley.messages import topics
from parley.messages.status import ActorStatus
from parley.sentences import Sentence, sentence
from parley.transport.base import Transport

__all__ = ["Batteries"]

LOW: Final = (0.2, 0.05, 0.0)
"""At each of these it is told."""
_REFILLED: Final = 0.1
"""So much above such a level it counts as filled, and may be told again."""


class Batteries(Node):
    """Watches the heartbeats.

    Args:
        transport: Where they are.
        tell: Says something on behalf of a robot.
    """

    name: ClassVar[str] = "batteries"

    def __init__(self, transport: Transport, tell: Callable[[str, str], None]) -> None:
        super().__init__(transport)
        self._tell = tell
        self._told: Latest[str, int] = Latest()
        """How many of the levels were told of each robot."""

    async def open(self) -> None:
        """See `Node.open`."""
        await self.subscribe(topics.ACTOR_STATUS, ActorStatus, self._on_status)

    def _on_status(self, status: ActorStatus) -> None:
        charge, told = status.battery, self._told.get(status.actor) or 0
        if charge is None:
            return
        below = sum(charge <= level for level in LOW)
        if below > told:
            self._tell(status.actor, _low(status, charge))
        filled = sum(charge <= level + _REFILLED for level in LOW)
        self._told[status.actor] = max(below, min(told, filled))


def _low(status: ActorStatus, charge: float) -> Sentence:
    if charge <= 0:  # where it is told to charge, it cannot go
        return sentence("My battery is empty. Please have me brought to where I am charged.")
    number = f"{100 * charge:.0f}"
    if any("charges" in action.capabilities for action in status.catalogue):
        return sentence(
            "My battery is low: {number} %. Say “go and charge” when you can spare me.", number=number
        )
    return sentence("My battery is low: {number} %. Please see to it that I am charged soon.", number=number)
