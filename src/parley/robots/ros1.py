"""A robot with ROS 1 and move_base, through the rosbridge on it.

::

    Ros1Robot("Ada", "ws://192.168.1.5:9090")
"""

from __future__ import annotations

import asyncio
import math
import uuid
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Final

from parley.errors import ActionFailure, TransportTimeoutError, UnavailableError
from parley.messages import ros1
from parley.messages.actions import GoalState
from parley.messages.ros1 import ActionlibState
from parley.messages.ros_robot import Empty, PoseStamped
from parley.messages.topics import QoS, Topic
from parley.robots.nav2_errors import failure_of
from parley.robots.ros_robot import Connect, RosRobot, RosSetup
from parley.transport.base import Outcome, Publisher, SentGoal, Transport

__all__ = ["MOVE_BASE", "Ros1Robot", "Ros1Setup"]

_ENDS: Final = {
    ActionlibState.SUCCEEDED: GoalState.SUCCEEDED,
    ActionlibState.PREEMPTED: GoalState.CANCELED,
    ActionlibState.RECALLED: GoalState.CANCELED,
}

MOVE_BASE: Final[dict[str, tuple[type[Any], str]]] = {
    "goal": (ros1.MoveBaseActionGoal, "move_base_msgs/msg/MoveBaseActionGoal"),
    "cancel": (ros1.ActionGoalId, "actionlib_msgs/msg/GoalID"),
    "status": (ros1.ActionGoalStatusArray, "actionlib_msgs/msg/GoalStatusArray"),
    "feedback": (ros1.MoveBaseActionFeedback, "move_base_msgs/msg/MoveBaseActionFeedback"),
    "result": (ros1.MoveBaseActionResult, "move_base_msgs/msg/MoveBaseActionResult"),
}
"""The topics of the action, and their types."""


@dataclass(frozen=True, slots=True)
class Ros1Setup(RosSetup):
    """See `RosSetup`."""

    action: str = "move_base"


class Ros1Robot(RosRobot):
    """See the module.

    Args:
        name: How people call it.
        connect: Where it is: the address of its rosbridge, `ws://...`, or what makes another transport.
        setup: What it is like.
    """

    def __init__(self, name: str, connect: Connect, setup: Ros1Setup | None = None) -> None:
        setup = setup or Ros1Setup()
        super().__init__(name, connect, _MoveBase(setup.goals), setup, ros=1)


class _Sent:
    """See `SentGoal`."""

    def __init__(self, id_: str, target: PoseStamped, on_remaining: Callable[[float], None]) -> None:
        self.id, self.target, self.on_remaining = id_, target, on_remaining
        self.state = GoalState.UNKNOWN
        self.known = asyncio.Event()
        self.ended: asyncio.Future[str] = asyncio.get_running_loop().create_future()
        """With the words of move_base."""

    def now(self, status: ros1.ActionGoalStatus) -> None:
        """The robot told where it stands."""
        if self.state.is_over or status.status not in frozenset(ActionlibState):
            return
        told = ActionlibState(status.status)
        self.state = _ENDS.get(told, GoalState.ABORTED) if told.is_over else GoalState.EXECUTING
        self.known.set()
        if told.is_over and not self.ended.done():
            self.ended.set_result(status.text)

    async def outcome(self, *, timeout_s: float) -> Outcome[Any]:
        try:
            async with asyncio.timeout(timeout_s):
                text = await asyncio.shield(self.ended)
        except TimeoutError as error:
            raise TransportTimeoutError(f"move_base is not there after {timeout_s} s") from error
        return Outcome(self.state, text or Empty())

    async def cancel(self, *, timeout_s: float) -> bool:
        return False  # all goals are called off together: `_MoveBase.call_off`


class _MoveBase:
    """See `Goals`: an actionlib client."""

    def __init__(self, action: str) -> None:
        self._topics: dict[str, Topic[Any]] = {
            name: Topic(f"{action}/{name}", kind, ros_type, QoS(depth=10))
            for name, (kind, ros_type) in MOVE_BASE.items()
        }
        self._sent: _Sent | None = None
        self._told = asyncio.Condition()
        self._going: int | None = None
        """How many goals are not over, by the newest word; None: there was none."""

    async def open(self, transport: Transport) -> None:
        self._goal: Publisher[Any] = transport.publisher(self._topics["goal"])
        self._cancel: Publisher[Any] = transport.publisher(self._topics["cancel"])
        await transport.subscribe(self._topics["status"], self._on_status)
        await transport.subscribe(self._topics["feedback"], self._on_feedback)
        await transport.subscribe(self._topics["result"], self._on_result)

    async def send(
        self, target: PoseStamped, on_remaining: Callable[[float], None], *, timeout_s: float
    ) -> SentGoal[Any]:
        sent = self._sent = _Sent(f"parley-{uuid.uuid4().hex}", target, on_remaining)
        goal_id = ros1.ActionGoalId(target.header.stamp, sent.id)
        self._goal.publish(ros1.MoveBaseActionGoal(target.header, goal_id, ros1.MoveBaseGoal(target)))
        try:
            async with asyncio.timeout(timeout_s):
                await sent.known.wait()
        except TimeoutError as error:
            raise TransportTimeoutError("move_base does not say that it takes the goal") from error
        return sent

    async def call_off(self, *, timeout_s: float) -> bool:
        self._cancel.publish(ros1.ActionGoalId())
        self._going = None
        try:
            async with asyncio.timeout(timeout_s), self._told:
                await self._told.wait_for(lambda: self._going is not None)
        except TimeoutError as error:
            raise UnavailableError("move_base tells nothing; does it run?") from error
        return self._going == 0

    def failure(self, outcome: Outcome[Any], *, moved: bool) -> ActionFailure:
        return failure_of(0, outcome.result if isinstance(outcome.result, str) else "", moved=moved)

    async def _on_status(self, told: ros1.ActionGoalStatusArray) -> None:
        going = 0
        for status in told.status_list:
            going += status.status in frozenset(ActionlibState) and not ActionlibState(status.status).is_over
            self._on_goal(status)
        async with self._told:
            self._going = going
            self._told.notify_all()

    def _on_goal(self, status: ros1.ActionGoalStatus) -> None:
        if self._sent is not None and status.goal_id.id == self._sent.id:
            self._sent.now(status)

    def _on_result(self, told: ros1.MoveBaseActionResult) -> None:
        self._on_goal(told.status)

    def _on_feedback(self, told: ros1.MoveBaseActionFeedback) -> None:
        if self._sent is not None and told.status.goal_id.id == self._sent.id:
            here, there = told.feedback.base_position.pose.position, self._sent.target.pose.position
            self._sent.on_remaining(round(math.hypot(there.x - here.x, there.y - here.y), 2))
