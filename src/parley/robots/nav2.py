"""A robot that Nav2 drives, over any transport: goals, pose, map, laser and camera.

::

    Nav2Robot("Ada", "ws://192.168.1.5:9090")
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, Final

from parley.errors import ActionFailure
from parley.extras import needs
from parley.messages.actions import ActionWire, CancelGoalRequest
from parley.messages.ros_robot import NavigateGoal, PoseStamped, Release, navigate_to_pose
from parley.robots.base import DriveLimits
from parley.robots.nav2_errors import failure_of
from parley.robots.ros_robot import RosRobot
from parley.robots.ros_senses import RosTopics
from parley.transport.base import Outcome, SentGoal, Transport

__all__ = ["SLOW_DRIVE", "Nav2Robot", "Nav2Setup"]

SLOW_DRIVE: Final = DriveLimits(max_speed_mps=0.4, max_turn_radps=1.5)


@dataclass(frozen=True, slots=True)
class Nav2Setup:
    """What a robot is like; the names are those of Nav2's own examples."""

    release: Release = "jazzy"
    """Which messages its Nav2 has."""
    action: str = "navigate_to_pose"
    topics: RosTopics = field(default_factory=RosTopics)
    radius_m: float = 0.25
    limits: DriveLimits = SLOW_DRIVE


class Nav2Robot(RosRobot):
    """See the module.

    Args:
        name: How people call it.
        connect: The address of its rosbridge, `ws://...`; or what makes another transport, opened in a
            thread of its own.
        setup: What it is like.
    """

    def __init__(
        self, name: str, connect: str | Callable[[], Transport], setup: Nav2Setup | None = None
    ) -> None:
        setup = setup or Nav2Setup()
        goals = _NavigateToPose(setup.topics.name(setup.action), setup.release)
        made = connect if callable(connect) else lambda: _bridge(connect)
        super().__init__(name, made, goals, setup.topics, setup.radius_m, setup.limits)


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


def _bridge(address: str) -> Transport:
    with needs("rosbridge"):
        from parley.transport.rosbridge import RosbridgeTransport
    return RosbridgeTransport(address)
