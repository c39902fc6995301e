"""A robot that Nav2 drives, over any transport: goals, pose, map, laser and camera.

::

    Nav2Robot("Ada", "ws://192.168.1.5:9090")
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from parley.errors import ActionFailure
from parley.messages.actions import ActionWire, CancelGoalRequest
from parley.messages.ros_robot import NavigateGoal, PoseStamped, Release, navigate_to_pose
from parley.robots.nav2_errors import failure_of
from parley.robots.ros_robot import Connect, RosRobot, RosSetup
from parley.transport.base import Outcome, SentGoal, Transport

__all__ = ["Nav2Robot", "Nav2Setup"]


@dataclass(frozen=True, slots=True)
class Nav2Setup(RosSetup):
    """See `RosSetup`; the names are those of Nav2's own examples."""

    action: str = "navigate_to_pose"
    release: Release = "jazzy"
    """Which messages its Nav2 has."""


class Nav2Robot(RosRobot):
    """See the module.

    Args:
        name: How people call it.
        connect: Where it is: the address of its rosbridge, `ws://...`, or what makes another transport.
        setup: What it is like.
    """

    def __init__(self, name: str, connect: Connect, setup: Nav2Setup | None = None) -> None:
        setup = setup or Nav2Setup()
        super().__init__(name, connect, _NavigateToPose(setup.goals, setup.release), setup)


class _NavigateToPose:
    """See `Goals`."""

    def __init__(self, name: str, release: Release) -> None:
        self._action = navigate_to_pose(name, release)

    async def open(self, transport: Transport) -> None:
        self._transport = transport
        self._client = await transport.action_client(self._action)

    async def send(
        self, target: PoseStamped, on_remaining: Callable[[float], None], *, timeout_s: float
    ) -> SentGoal[Any]:
        def on_feedback(told: Any) -> None:
            if told.distance_remaining > 0:  # nothing before there is a way
                on_remaining(round(told.distance_remaining, 2))

        return await self._client.send(NavigateGoal(target), timeout_s=timeout_s, on_feedback=on_feedback)

    async def call_off(self, *, timeout_s: float) -> bool:
        wire = ActionWire(self._action)
        answer = await self._transport.call(wire.cancel, CancelGoalRequest(), timeout_s=timeout_s)
        return not answer.goals_canceling

    def failure(self, outcome: Outcome[Any], *, moved: bool) -> ActionFailure:
        code, says = getattr(outcome.result, "error_code", 0), getattr(outcome.result, "error_msg", "")
        return failure_of(code, says, moved=moved)
