"""A simulated robot behind the interface of ROS 1's move_base."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from contextlib import AbstractAsyncContextManager, asynccontextmanager
from typing import Any, Final

from parley.errors import ActionFailure
from parley.messages import ros1
from parley.messages.ros1 import ActionlibState
from parley.messages.topics import QoS, Topic
from parley.robots.base import NavigationControl
from parley.robots.nav2_simulated import DRIVE_S, SimulatedNav2
from parley.robots.ros1 import MOVE_BASE
from parley.robots.ros_values import header, planar, stamped

__all__ = ["SimulatedMoveBase"]

STATUS_S: Final = 0.2
KEPT: Final = 5
"""Of how many goals that are over it still tells."""


class SimulatedMoveBase(SimulatedNav2):
    """See `SimulatedNav2`; goals are those of move_base, of which a new one takes the place of the last."""

    def _serving(self) -> AbstractAsyncContextManager[Any]:
        return self._move_base()

    @asynccontextmanager
    async def _move_base(self) -> AsyncIterator[None]:
        topics: dict[str, Topic[Any]] = {
            name: Topic(self._names.name(f"move_base/{name}"), kind, ros_type, QoS(depth=10))
            for name, (kind, ros_type) in MOVE_BASE.items()
        }
        self._driving: asyncio.Task[None] | None = None
        self._goals: dict[str, ros1.ActionGoalStatus] = {}
        self._said = {
            name: self._transport.publisher(topics[name]) for name in ("status", "feedback", "result")
        }
        heard = [
            await self._transport.subscribe(topics["goal"], self._on_goal),
            await self._transport.subscribe(topics["cancel"], self._on_cancel),
        ]
        telling = asyncio.create_task(self._tell_status(), name=f"move_base of {self.robot.name}")
        try:
            yield
        finally:
            for end in heard:
                await end.close()
            tasks = [task for task in (telling, self._driving) if task is not None]
            for task in tasks:
                task.cancel()
            await asyncio.gather(*tasks, return_exceptions=True)
            for publisher in self._said.values():
                publisher.close()

    async def _on_goal(self, told: ros1.MoveBaseActionGoal) -> None:
        await self._call_off()
        self._now(told.goal_id, ActionlibState.ACTIVE)
        self._driving = asyncio.create_task(self._drive_to(told), name=f"goal of {self.robot.name}")

    async def _on_cancel(self, told: ros1.ActionGoalId) -> None:
        going = self._goals.get(told.id)
        if not told.id or (going is not None and going.status == ActionlibState.ACTIVE):
            await self._call_off()

    async def _call_off(self) -> None:
        driving, self._driving = self._driving, None
        if driving is not None:
            driving.cancel()
            await asyncio.gather(driving, return_exceptions=True)

    async def _drive_to(self, told: ros1.MoveBaseActionGoal) -> None:
        target = told.goal.target_pose.pose

        def on_progress(_: float) -> None:
            here = stamped(self.robot.pose(), self._names.map_frame, self._clock.unix_ms())
            status = self._goals[told.goal_id.id]
            feedback = ros1.MoveBaseFeedback(here)
            self._said["feedback"].publish(ros1.MoveBaseActionFeedback(here.header, status, feedback))

        try:
            await self.robot.navigate(
                planar(target.position, target.orientation),
                NavigationControl(on_progress, lambda: False),
                timeout_s=DRIVE_S,
            )
        except ActionFailure as failure:
            self._now(told.goal_id, ActionlibState.ABORTED, failure.message)
        except asyncio.CancelledError:
            self._now(told.goal_id, ActionlibState.PREEMPTED)
            raise
        else:
            self._now(told.goal_id, ActionlibState.SUCCEEDED)

    def _now(self, goal_id: ros1.ActionGoalId, state: ActionlibState, text: str = "") -> None:
        status = self._goals[goal_id.id] = ros1.ActionGoalStatus(goal_id, state, text)
        for old in list(self._goals)[:-KEPT]:
            del self._goals[old]
        if state.is_over:
            top = header(self._names.map_frame, self._clock.unix_ms())
            self._said["result"].publish(ros1.MoveBaseActionResult(top, status))
        self._show()

    def _show(self) -> None:
        top = header("", self._clock.unix_ms())
        self._said["status"].publish(ros1.ActionGoalStatusArray(top, tuple(self._goals.values())))

    async def _tell_status(self) -> None:
        while True:
            self._show()
            await asyncio.sleep(STATUS_S)
