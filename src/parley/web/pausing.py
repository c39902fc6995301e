"""Lets robots stand and go on by what their engines hear themselves, whoever plans."""

from __future__ import annotations

import asyncio
import uuid
from typing import Final

from parley.messages.chat import ChatAction
from parley.umrf.model import GraphState
from parley.web.link import Link, Pressed, robots_of
from parley.web.state import WebState
from parley.web.stopping import Stopper

__all__ = ["Pauser"]

LOOK_S: Final = 0.05
"""Wall time between two looks at whether robots stand."""


class Pauser:
    """See the module. A drive is held besides, so that what was begun before the pause moves nothing.

    Args:
        link: Where it goes out.
        state: Says what robots do.
        stopper: Holds their drives.
    """

    def __init__(self, link: Link, state: WebState, stopper: Stopper) -> None:
        self._link, self._state, self._stopper = link, state, stopper

    def pause(self, message: Pressed) -> str:
        """Let the robots of a button stand that halts them; the id of their hold, empty if it halts none."""
        if not isinstance(message, ChatAction):
            return ""
        commands = {item.command for item in message.system_cmd if not item.arguments.get("order")}
        if commands.isdisjoint({"stop", "pause", "clear"}):
            return ""
        hold = message.press.id if message.press is not None else uuid.uuid4().hex
        self.hold(message, hold)
        for robot in message.targets:
            self._link.pause(robot, self._graphs(robot, GraphState.RUNNING))
        return hold

    def hold(self, message: Pressed, hold: str) -> None:
        """Hold those of its robots that do not stand by it, as one that was started anew."""
        free = [robot for robot in robots_of(message) if hold not in self._link.holds.get(robot, ())]
        if free:
            self._stopper.hold(free, by=message.by, id=hold, words="")

    def release(self, message: Pressed, hold: str) -> None:
        """What was held so may drive again, as far as its plan goes on."""
        self._stopper.go_on(hold, by=message.by)

    def go_on(self, message: Pressed) -> bool:
        """Let a robot go on whose plan is known and only stands still; whether it could be told to."""
        if not isinstance(message, ChatAction) or [c.command for c in message.system_cmd] != ["start"]:
            return False
        (robot,) = message.targets
        graphs = self._graphs(robot, GraphState.PAUSED)
        state, plans = self._state.robots.views[robot].state, self._state.plans
        waits = any(proposal.robot == robot for proposal in plans.proposals.values())
        mends = any(view.robot == robot and view.state == "held" for view in plans.views.values())
        if state != "paused" or waits or mends or not graphs:
            return False
        for hold in self._link.holds.get(robot, ()):
            self.release(message, hold)  # whoever began it may be gone, and a person says that it may go on
        self._link.resume(robot, graphs)
        return True

    def stand(self, robots: tuple[str, ...]) -> bool:
        """Whether all of them say that nothing goes on."""
        views = [view for robot in robots if (view := self._state.robots.views.get(robot)) is not None]
        return bool(views) and all(view.connection == "here" and view.state != "running" for view in views)

    def paused(self, robots: tuple[str, ...]) -> bool:
        """Whether all that stand could go on with what they did."""
        return all(self._graphs(robot, GraphState.PAUSED) for robot in robots)

    async def until_stand(self, robots: tuple[str, ...]) -> None:
        """Wait until they do."""
        while not self.stand(robots):  # noqa: ASYNC110 - several things say so
            await asyncio.sleep(LOOK_S)

    def _graphs(self, robot: str, state: GraphState) -> list[str]:
        """A robot's graphs in a state, by its own word or by what was heard since."""
        view = self._state.robots.views.get(robot)
        told = {} if view is None else view.graphs
        plans = self._state.plans.views.values()
        begun = [p.graph_name for p in plans if p.robot == robot and p.state == "running"]
        new = [name for name in begun if name and name not in told and state is GraphState.RUNNING]
        return [*(name for name, its in told.items() if its == state), *new]
