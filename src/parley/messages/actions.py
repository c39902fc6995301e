"""Long tasks as ROS 2 actions have them: a goal, feedback on the way, a result, and a way to call it off.

On the wire it is three services and two topics, named after it (`ActionWire`).
"""

from __future__ import annotations

from dataclasses import dataclass, field, make_dataclass
from enum import IntEnum
from typing import Any, Generic, TypeVar

from parley.messages.ros import Time
from parley.messages.topics import QoS, Service, Topic

__all__ = [
    "Action",
    "ActionWire",
    "CancelCode",
    "CancelGoalRequest",
    "CancelGoalResponse",
    "GetResultRequest",
    "GoalId",
    "GoalInfo",
    "GoalState",
    "GoalStatus",
    "GoalStatusArray",
    "SendGoalResponse",
]

Goal = TypeVar("Goal")
Result = TypeVar("Result")
Feedback = TypeVar("Feedback")


class GoalState(IntEnum):
    """Where a goal stands (action_msgs/msg/GoalStatus)."""

    UNKNOWN = 0
    ACCEPTED = 1
    EXECUTING = 2
    CANCELING = 3
    SUCCEEDED = 4
    CANCELED = 5
    ABORTED = 6

    @property
    def is_over(self) -> bool:
        """Whether nothing more comes of it."""
        return self >= GoalState.SUCCEEDED


class CancelCode(IntEnum):
    """What an action server says to a call to cancel (action_msgs/srv/CancelGoal)."""

    NONE = 0
    REJECTED = 1
    UNKNOWN_GOAL_ID = 2
    GOAL_TERMINATED = 3


@dataclass(frozen=True, slots=True)
class GoalId:
    """unique_identifier_msgs/msg/UUID: 16 bytes."""

    uuid: bytes = bytes(16)


@dataclass(frozen=True, slots=True)
class GoalInfo:
    """action_msgs/msg/GoalInfo: which goal, and when it was accepted."""

    goal_id: GoalId = field(default_factory=GoalId)
    stamp: Time = field(default_factory=Time)


@dataclass(frozen=True, slots=True)
class GoalStatus:
    """action_msgs/msg/GoalStatus; `status` is a `GoalState`."""

    goal_info: GoalInfo = field(default_factory=GoalInfo)
    status: int = GoalState.UNKNOWN


@dataclass(frozen=True, slots=True)
class GoalStatusArray:
    """action_msgs/msg/GoalStatusArray."""

    status_list: tuple[GoalStatus, ...] = ()


@dataclass(frozen=True, slots=True)
class CancelGoalRequest:
    """action_msgs/srv/CancelGoal, request: one goal; with an id of zeros those up to `stamp`, or all."""

    goal_info: GoalInfo = field(default_factory=GoalInfo)


@dataclass(frozen=True, slots=True)
class CancelGoalResponse:
    """action_msgs/srv/CancelGoal, response; `return_code` is a `CancelCode`."""

    return_code: int = CancelCode.NONE
    goals_canceling: tuple[GoalInfo, ...] = ()


@dataclass(frozen=True, slots=True)
class SendGoalResponse:
    """The answer to a goal, of any action."""

    accepted: bool = False
    stamp: Time = field(default_factory=Time)


@dataclass(frozen=True, slots=True)
class GetResultRequest:
    """Which goal's result is asked for, of any action."""

    goal_id: GoalId = field(default_factory=GoalId)


@dataclass(frozen=True, slots=True)
class Action(Generic[Goal, Result, Feedback]):
    """An action and everything both sides must agree on. A result needs no arguments to be made: empty."""

    name: str
    goal: type[Goal]
    result: type[Result]
    feedback: type[Feedback]
    ros_type: str


class ActionWire(Generic[Goal, Result, Feedback]):
    """The services and topics that carry one action.

    Attributes:
        send_goal: Takes `goal_id` and `goal`; answered when the goal is accepted or refused.
        get_result: Takes `goal_id`; answered with `status` and `result` when the goal is over.
        cancel: Calls off one goal or all.
        feedback: Carries `goal_id` and `feedback`.
        status: Where each goal stands; latched.
    """

    def __init__(self, action: Action[Goal, Result, Feedback]) -> None:
        base, ros = f"{action.name}/_action", action.ros_type
        self.send_goal: Service[Any, SendGoalResponse] = Service(
            f"{base}/send_goal",
            _record("SendGoalRequest", goal_id=GoalId, goal=action.goal),
            SendGoalResponse,
            f"{ros}_SendGoal",
        )
        self.get_result: Service[GetResultRequest, Any] = Service(
            f"{base}/get_result",
            GetResultRequest,
            _record("GetResultResponse", status=int, result=action.result),
            f"{ros}_GetResult",
        )
        self.cancel: Service[CancelGoalRequest, CancelGoalResponse] = Service(
            f"{base}/cancel_goal", CancelGoalRequest, CancelGoalResponse, "action_msgs/srv/CancelGoal"
        )
        self.feedback: Topic[Any] = Topic(
            f"{base}/feedback",
            _record("FeedbackMessage", goal_id=GoalId, feedback=action.feedback),
            f"{ros}_FeedbackMessage",
        )
        self.status: Topic[GoalStatusArray] = Topic(
            f"{base}/status",
            GoalStatusArray,
            "action_msgs/msg/GoalStatusArray",
            QoS(latched=True, depth=1),
        )


def _record(name: str, **fields: type) -> type[Any]:
    return make_dataclass(name, fields.items(), frozen=True, slots=True)
