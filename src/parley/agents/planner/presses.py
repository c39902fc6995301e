"""Presses of buttons, which come again until they are confirmed: each counts once, and none too late."""

from __future__ import annotations

import asyncio
import uuid
from typing import Final

from parley.agents.base import Node
from parley.agents.planner.robot_plans import RobotPlans
from parley.agents.presence import ACQUAINTED_S
from parley.agents.questions import SeenIds
from parley.latest import Latest
from parley.messages import topics
from parley.messages.chat import Outcome, Press, PressTaken
from parley.sentences import sentence

__all__ = ["Presses"]

TOO_LATE: Final = sentence(
    "The press of a button came too late, so nothing was done for it. Look how things stand, and press again "
    "if it still holds."
)


class Presses:
    """What was pressed on pages.

    Args:
        node: Whose topics.
        plans: Of the robots that they are for.
    """

    def __init__(self, node: Node, plans: RobotPlans) -> None:
        self._node, self._plans = node, plans
        self._run = uuid.uuid4().hex
        self._seen = SeenIds()
        self._early = True
        """Robots that are there may not have been heard of yet."""
        self._newest: Latest[tuple[str, str], int] = Latest()
        """The newest press that was heard of each page's server for each robot."""

    def open(self) -> None:
        """Tell pages that presses are confirmed here, once they are heard."""
        self._node.publish(topics.PRESS_TAKEN, PressTaken(run=self._run))
        self._node.spawn(self._get_acquainted(), name="first heartbeats")

    async def _get_acquainted(self) -> None:
        await asyncio.sleep(ACQUAINTED_S)
        self._early = False

    def counts(self, press: Press | None, robot: str, *, harmless: bool) -> bool:
        """Confirm a press; whether what it is for is to be done now.

        Args:
            press: None: it is no button.
            robot: Whom it is for.
            harmless: Whether it may also answer what an earlier process has shown: a pause, a no.
        """
        if press is None:
            return True
        if self._early and not self._plans.presence.knows_all(robot.split(",")):
            return False  # it comes again
        self._node.publish(topics.PRESS_TAKEN, PressTaken(run=self._run, id=press.id))
        if not self._seen.is_new(press.id):
            return False
        newest = self._newest.get((press.page, robot), -1)
        if press.number <= newest or (press.to != self._run and not harmless):
            self._plans.say(robot, TOO_LATE, "error")
            self.over(press, TOO_LATE)
            return False
        self._newest[press.page, robot] = press.number
        return True

    def over(self, press: Press | None, why: str = "", *, past: bool = False) -> None:
        """Tell what came of a press.

        Args:
            press: None: it is no button.
            why: It was refused; empty: it is done.
            past: Because what it was for is another by now.
        """
        if press is not None:
            outcome: Outcome = "past" if past else "refused" if why else "done"
            taken = PressTaken(run=self._run, id=press.id, outcome=outcome, why=self._node.spoken(why))
            self._node.publish(topics.PRESS_TAKEN, taken)
