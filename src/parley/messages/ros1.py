"""The messages of ROS 1's move_base, which drives to places as an action of actionlib: five topics.

Sources: actionlib_msgs, move_base_msgs. Names of types are spelt as those of ROS 2.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import IntEnum

from parley.messages.ros import Header, Time
from parley.messages.ros_robot import Empty, PoseStamped

__all__ = [
    "ActionGoalId", "ActionGoalStatus", "ActionGoalStatusArray", "ActionlibState", "MoveBaseActionFeedback",
    "MoveBaseActionGoal", "MoveBaseActionResult", "MoveBaseFeedback", "MoveBaseGoal",
]  # fmt: skip


class ActionlibState(IntEnum):
    """Where a goal stands (actionlib_msgs/GoalStatus)."""

    PENDING = 0
    ACTIVE = 1
    PREEMPTED = 2
    SUCCEEDED = 3
    ABORTED = 4
    REJECTED = 5
    PREEMPTING = 6
    RECALLING = 7
    RECALLED = 8
    LOST = 9

    @property
    def is_over(self) -> bool:
        """Whether nothing more comes of it."""
        return self not in (self.PENDING, self.ACTIVE, self.PREEMPTING, self.RECALLING)


@dataclass(frozen=True, slots=True)
class ActionGoalId:
    """actionlib_msgs/GoalID; on the topic of cancelling an empty one means all goals."""

    stamp: Time = field(default_factory=Time)
    id: str = ""


@dataclass(frozen=True, slots=True)
class ActionGoalStatus:
    """actionlib_msgs/GoalStatus; `status` is an `ActionlibState`."""

    goal_id: ActionGoalId = field(default_factory=ActionGoalId)
    status: int = 0
    text: str = ""


@dataclass(frozen=True, slots=True)
class ActionGoalStatusArray:
    """actionlib_msgs/GoalStatusArray."""

    header: Header = field(default_factory=Header)
    status_list: tuple[ActionGoalStatus, ...] = ()


@dataclass(frozen=True, slots=True)
class MoveBaseGoal:
    """move_base_msgs/MoveBaseGoal."""

    target_pose: PoseStamped = field(default_factory=PoseStamped)


@dataclass(frozen=True, slots=True)
class MoveBaseFeedback:
    """move_base_msgs/MoveBaseFeedback."""

    base_position: PoseStamped = field(default_factory=PoseStamped)


@dataclass(frozen=True, slots=True)
class MoveBaseActionGoal:
    """move_base_msgs/MoveBaseActionGoal."""

    header: Header = field(default_factory=Header)
    goal_id: ActionGoalId = field(default_factory=ActionGoalId)
    goal: MoveBaseGoal = field(default_factory=MoveBaseGoal)


@dataclass(frozen=True, slots=True)
class MoveBaseActionFeedback:
    """move_base_msgs/MoveBaseActionFeedback."""

    header: Header = field(default_factory=Header)
    status: ActionGoalStatus = field(default_factory=ActionGoalStatus)
    feedback: MoveBaseFeedback = field(default_factory=MoveBaseFeedback)


@dataclass(frozen=True, slots=True)
class MoveBaseActionResult:
    """move_base_msgs/MoveBaseActionResult; the result itself is empty."""

    header: Header = field(default_factory=Header)
    status: ActionGoalStatus = field(default_factory=ActionGoalStatus)
    result: Empty = field(default_factory=Empty)
