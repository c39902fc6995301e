"""What the planner did with the orders of one chat interface, so that a reply says what is really so."""

from __future__ import annotations

import asyncio
from collections.abc import Sequence
from typing import Final

from parley.agents.planner.ordering import WEIGHED_WITHIN_S
from parley.messages import topics
from parley.messages.chat import ChatAction
from parley.messages.status import PlanRuling
from parley.transport.base import Transport

__all__ = ["Rulings"]

_WITHIN_S: Final = WEIGHED_WITHIN_S + 3.0
"""Wall time in which a planner says what became of an order; longer than it may weigh one."""


class Rulings:
    """Waits for rulings.

    Args:
        transport: Tells whether a planner that rules is there; the thesis's does not.
    """

    def __init__(self, transport: Transport) -> None:
        self._transport = transport
        self._waits: dict[tuple[str, str], asyncio.Future[PlanRuling]] = {}

    def on_ruling(self, ruling: PlanRuling) -> None:
        """The planner says what became of an order."""
        wait = self._waits.get((ruling.order, ruling.target))
        if wait is not None and not wait.done():
            wait.set_result(ruling)

    def expect(self, order: ChatAction) -> None:
        """Called before an order is sent; only what has steps or commands for plans is ruled about."""
        memory = ("add_memory", "remove_memory")
        plans = order.queue or any(c.command not in memory for c in order.system_cmd)
        ends = self._transport.endpoints()
        rules = any(e.role == "publisher" and e.name == topics.RULING.name for e in ends)
        if rules and (plans or order.needs_yes):
            loop = asyncio.get_running_loop()
            self._waits |= {(order.id, target): loop.create_future() for target in order.targets}

    async def about(self, order: ChatAction, within_s: float = _WITHIN_S) -> Sequence[PlanRuling] | None:
        """What became of an order, robot by robot; empty where nobody rules, None if not in time."""
        keys = [(order.id, target) for target in order.targets]
        waits = [self._waits[key] for key in keys if key in self._waits]
        try:
            if waits:
                async with asyncio.timeout(within_s):
                    await asyncio.wait(waits)
        except TimeoutError:
            return None
        finally:
            for key in keys:
                self._waits.pop(key, None)
        return [wait.result() for wait in waits if wait.done() and not wait.cancelled()]
