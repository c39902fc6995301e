"""What the robots of this process know of each other's parts, so that one can wait for another.

How far a part is its engine says; what has not come to an engine yet, the planner. So a wait outlives both:
whoever of them is started anew tells it again.
"""

from __future__ import annotations

import asyncio
import contextlib
from collections.abc import Sequence
from contextlib import AsyncExitStack
from typing import Final

from parley.actions.mates import PartOutlook
from parley.agents.presence import Presence, linked_to
from parley.clock import Clock
from parley.errors import InvalidMessageError
from parley.latest import Latest
from parley.messages import topics
from parley.messages.ros import String
from parley.messages.status import ActorStatus, PlanProposal, PlanStep, PlanUpdate
from parley.messages.wire import decode, decode_plan
from parley.opening import OpenedTogether
from parley.transport.base import Transport

__all__ = ["UNKNOWN_FOR_S", "MateBook", "Mates"]

UNKNOWN_FOR_S: Final = 5.0
"""So long, in wall time, nobody need know of a part: between planner and engine it is on its way."""
_LOOK_S: Final = 1.0
_OVER: Final = frozenset({"finished", "skipped", "stopped"})


class MateBook:
    """How far other robots are. A plain object.

    Args:
        presence: Who is there; it is told the heartbeats.
        clock: Its wall time counts.
    """

    def __init__(self, presence: Presence, clock: Clock) -> None:
        self._presence, self._clock = presence, clock
        self._plans: Latest[str, PlanUpdate] = Latest()
        self._proposals: Latest[str, PlanProposal] = Latest()
        self._unknown_s: Latest[tuple[str, str], float] = Latest()
        """Since when nobody knows of a part that is waited for."""

    def on_status(self, status: ActorStatus) -> None:
        """An engine tells how it fares."""
        self._presence.on_status(status)

    def on_plan(self, told: PlanUpdate | PlanProposal) -> None:
        """The planner tells what a robot is to do, or what waits for a yes."""
        if isinstance(told, PlanUpdate):
            self._plans[told.target] = told
        else:
            self._proposals[told.id] = told

    def outlook(self, robot: str, order: str) -> PartOutlook:
        """See `parley.actions.mates.Mates.outlook`."""
        status = self._presence.get(robot)
        if status is not None:
            known = status.orders.get(order) if order else self._idle(status)
            own = [step for step in self._steps(robot) if step.order == order]
            left_out = bool(own) and all(step.state in _OVER for step in own) and own[-1].state != "finished"
            if known == "done" or (known in ("open", "failed") and not left_out):
                self._unknown_s.pop((robot, order), None)
                return known
            if self._is_planned(robot, order, own):
                self._unknown_s.pop((robot, order), None)
                return "open"
            if known is not None:
                return "lost"
        now_s = self._clock.wall_s()
        since_s = self._unknown_s.setdefault((robot, order), now_s)
        return "open" if now_s - since_s < UNKNOWN_FOR_S else "lost"

    def _idle(self, status: ActorStatus) -> PartOutlook:
        busy = any(step.state not in _OVER for step in self._steps(status.actor))
        return "open" if busy or status.state != "idle" else "done"

    def _steps(self, robot: str) -> Sequence[PlanStep]:
        plan = self._plans.get(robot)
        return plan.steps if plan is not None else ()

    def _is_planned(self, robot: str, order: str, own: Sequence[PlanStep]) -> bool:
        """Whether it is to be done, though its engine need not know of it yet."""
        plan = self._plans.get(robot)
        asked = {one.id for one in self._proposals.values() if one.target == robot and one.order == order}
        waits = plan is None or plan.waits is None or bool(asked & {*plan.waits})
        return any(step.state not in _OVER for step in own) or (bool(asked) and waits)


class Mates(OpenedTogether):
    """Implements `parley.actions.mates.Mates`; use with ``async with``.

    Args:
        transport: Where the others are.
        clock: Its wall time says who is gone.
    """

    def __init__(self, transport: Transport, clock: Clock) -> None:
        super().__init__()
        self._transport = transport
        self._presence = Presence(clock, on_change=lambda *_: self._tell(), linked=linked_to(transport))
        self._book = MateBook(self._presence, clock)
        self._changed = asyncio.Event()

    def outlook(self, robot: str, order: str) -> PartOutlook:
        """See `parley.actions.mates.Mates.outlook`."""
        return self._book.outlook(robot, order)

    async def changed(self) -> None:
        """See `parley.actions.mates.Mates.changed`."""
        with contextlib.suppress(TimeoutError):
            async with asyncio.timeout(_LOOK_S):  # that nobody speaks any more is no event
                await self._changed.wait()

    async def _open(self, stack: AsyncExitStack) -> None:
        watch = asyncio.create_task(self._presence.watch(), name="mates")
        stack.callback(watch.cancel)
        for topic, hear in ((topics.ACTOR_STATUS, self._on_status), (topics.PLAN, self._on_plan)):
            stack.push_async_callback((await self._transport.subscribe(topic, hear)).close)

    def _on_status(self, message: String) -> None:
        with contextlib.suppress(InvalidMessageError):  # whoever is in charge of them says so
            self._book.on_status(decode(ActorStatus, message.data))
            self._tell()

    def _on_plan(self, message: String) -> None:
        with contextlib.suppress(InvalidMessageError):
            self._book.on_plan(decode_plan(message.data))
            self._tell()

    def _tell(self) -> None:
        """Whoever waits looks now; the next one waits for the next change."""
        self._changed.set()
        self._changed = asyncio.Event()
