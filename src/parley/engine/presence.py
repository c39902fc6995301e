"""The heartbeat by which others know that an actor is there, what it can do and how it fares."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Mapping, Sequence
from typing import Final, Literal

import structlog

from parley.engine.runs import GraphRuns
from parley.errors import ActionFailure
from parley.messages.passages import PassageClaim
from parley.messages.status import ActionInfo, ActorStatus, OrderState, PoseInfo
from parley.robots.base import Robot
from parley.umrf.model import GraphState

__all__ = ["Presence", "is_at_rest"]

log = structlog.get_logger(__name__)

REST_LINEAR_MPS: Final = 0.01
REST_ANGULAR_RADPS: Final = 0.02
"""Measured velocities below these count as standing still: sensors are never quite silent."""

SPACING_S: Final = 0.01
"""Wall time between two statuses: each names all graphs, and a hundred may begin at once."""

State = Literal["idle", "running", "paused", "stopped", "leaving"]


def is_at_rest(robot: Robot) -> bool:
    """Whether the measured velocity is zero."""
    velocity = robot.velocity()
    return velocity.speed_mps <= REST_LINEAR_MPS and abs(velocity.angular_radps) <= REST_ANGULAR_RADPS


class Presence:
    """Sends the status every `heartbeat_s` of wall time, and at once when it changes after a quiet moment.

    Args:
        actor: Whose status it is.
        runs: Its graphs.
        catalogue: Gives its actions as they are now.
        robot: Its robot, if it has one.
        publish: Where the status goes.
        heartbeat_s: Wall time between two unchanged ones.
        unix_ms: Tells what the clock shows.
        stop: Gives the id of the emergency stop in force.
        holds: Gives those of the holds in force.
        orders: Tells how far each order is.
        claim: Tells what it wants of places that only so many may be in.
    """

    def __init__(
        self,
        actor: str,
        runs: GraphRuns,
        catalogue: Callable[[], Sequence[ActionInfo]],
        robot: Robot | None,
        publish: Callable[[ActorStatus], None],
        *,
        heartbeat_s: float,
        unix_ms: Callable[[], int] = lambda: 0,
        stop: Callable[[], str] = lambda: "",
        holds: Callable[[], tuple[str, ...]] = lambda: (),
        orders: Callable[[], Mapping[str, OrderState]] = dict,
        claim: Callable[[], PassageClaim | None] = lambda: None,
    ) -> None:
        self._actor, self._runs, self._catalogue = actor, runs, catalogue
        self._robot, self._publish, self._heartbeat_s = robot, publish, heartbeat_s
        self._unix_ms, self._stop, self._holds = unix_ms, stop, holds
        self._orders, self._claim = orders, claim
        self._sequence = 0
        self._changed = asyncio.Event()
        self._task: asyncio.Task[None] | None = None

    def open(self) -> None:
        """Start to beat."""
        self._task = asyncio.create_task(self._beat(), name=f"heartbeat {self._actor}")

    def changed(self) -> None:
        """The status may be different now."""
        self._changed.set()

    async def close(self) -> None:
        """Say goodbye and stop. Idempotent."""
        task, self._task = self._task, None
        if task is None:
            return
        task.cancel()
        await asyncio.wait([task])
        self._send("leaving")

    async def _beat(self) -> None:
        while True:
            self._changed.clear()
            try:
                self._send(self._state())
            except Exception:
                # A robot whose driver has a defect must not look as if it had left.
                log.exception("status failed", actor=self._actor)
            await asyncio.sleep(SPACING_S)
            try:
                async with asyncio.timeout(self._heartbeat_s - SPACING_S):
                    await self._changed.wait()
            except TimeoutError:
                continue

    def _send(self, state: State) -> None:
        pose, at_rest = self._measure()
        self._publish(
            ActorStatus(
                actor=self._actor,
                state=state,
                sequence=self._sequence,
                pose=pose,
                at_rest=at_rest,
                battery=self._robot.battery() if self._robot is not None else None,
                trouble=self._robot.trouble() if self._robot is not None else "",
                graphs={run.name: run.state.value for run in self._runs.all},
                orders=dict(self._orders()),
                claim=self._claim(),
                catalogue=tuple(self._catalogue()),
                unix_ms=self._unix_ms(),
                stop=self._stop(),
                holds=self._holds(),
            )
        )
        self._sequence += 1

    def _state(self) -> State:
        if self._runs.latched:
            return "stopped"
        runs = self._runs.all
        if any(run.state is GraphState.RUNNING and not run.holding for run in runs):
            return "running"
        if any(run.holding for run in runs):
            return "paused"
        return "running" if any(run.state is GraphState.STOPPING for run in runs) else "idle"

    def _measure(self) -> tuple[PoseInfo | None, bool | None]:
        if self._robot is None:
            return None, None
        try:
            pose = self._robot.pose()
            return PoseInfo(x=pose.x_m, y=pose.y_m, yaw=pose.yaw_rad), is_at_rest(self._robot)
        except ActionFailure:  # a robot without localisation is still there
            return None, None
