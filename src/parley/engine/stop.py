"""The emergency stop: the drive first, then the graphs, and no motion until a person resets it."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Coroutine
from typing import Any, Final, Literal

import structlog

from parley.engine.presence import is_at_rest
from parley.engine.runs import GraphRuns
from parley.errors import ActionFailure, Problem
from parley.messages.status import StopReport
from parley.robots.base import Robot
from parley.umrf.model import NodeState

__all__ = ["EmergencyStop"]

log = structlog.get_logger(__name__)

REST_CHECK_S: Final = 0.02
REST_TIMEOUT_S: Final = 3.0
"""Wall time within which a stopped robot must have come to rest."""


_GOING: Final = (NodeState.RUNNING, NodeState.PAUSE_REQUESTED)


class EmergencyStop:
    """Stops and resets one actor.

    Args:
        actor: Whose stop it is.
        robot: Its robot, if it has one.
        runs: Its graphs; their `latched` is kept here.
        report: Told `received`, `at_rest` and `reset`.
        complain: Told what went wrong with a stop.
        remember: Told at once whether the stop is latched, to be known after a restart.
        rest_timeout_s: Wall time after which is said what still moves or goes on.
    """

    def __init__(
        self,
        actor: str,
        robot: Robot | None,
        runs: GraphRuns,
        *,
        report: Callable[[StopReport], None],
        complain: Callable[[Problem], None],
        remember: Callable[[bool], None] = lambda _: None,
        rest_timeout_s: float = REST_TIMEOUT_S,
    ) -> None:
        self._actor, self._robot, self._runs = actor, robot, runs
        self._report, self._complain, self._remember = report, complain, remember
        self._rest_timeout_s = rest_timeout_s
        self._tasks: set[asyncio.Task[None]] = set()
        self._resetting: asyncio.Task[None] | None = None

    async def stop(self, command_id: str = "") -> None:
        """Stop now; returns as soon as the drive was told and the graphs are pausing."""
        self._runs.latched = True
        if self._resetting is not None:  # a stop beats a reset that is under way
            self._resetting.cancel()
        self._say("received", command_id)
        if self._robot is not None:
            self._spawn(self._stop_drive(self._robot))
            await asyncio.sleep(0)  # the drive is told before anything else happens, and may take its time
        self._remember(True)
        self._runs.pause_all()
        self._spawn(self._watch_rest(command_id))
        self._spawn(self._watch_actions())

    def reset(self, command_id: str = "") -> None:
        """Allow motion again; the graphs stay paused until somebody resumes them."""
        self._resetting = self._spawn(self._reset(command_id))

    async def close(self) -> None:
        """End what still watches or waits."""
        tasks = list(self._tasks)
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)

    async def _reset(self, command_id: str) -> None:
        if self._robot is not None:
            try:
                await self._robot.release()
            except ActionFailure as failure:
                self._complain(
                    Problem("", f"The stop cannot be reset: {failure.message}", "try again", "reset_failed")
                )
                return
        self._runs.latched = False
        self._remember(False)
        self._say("reset", command_id)

    async def _stop_drive(self, robot: Robot) -> None:
        try:
            await robot.stop()
        except ActionFailure as failure:
            log.error("stop failed", actor=self._actor, reason=failure.message)
            self._complain(
                Problem(
                    "", f"The stop failed: {failure.message}", "use the switch on the robot", "stop_failed"
                )
            )

    async def _watch_rest(self, command_id: str) -> None:
        robot = self._robot
        if robot is not None:
            try:
                async with asyncio.timeout(self._rest_timeout_s):
                    while not is_at_rest(robot):  # noqa: ASYNC110 - a robot's velocity cannot be awaited
                        await asyncio.sleep(REST_CHECK_S)
            except TimeoutError:
                log.error("robot still moves", actor=self._actor, after_s=self._rest_timeout_s)
                self._complain(
                    Problem(
                        "",
                        f"{self._actor} still moves {self._rest_timeout_s:g} s after the stop",
                        "use the switch on the robot",
                        "still_moving",
                    )
                )
                return
        self._say("at_rest", command_id)

    async def _watch_actions(self) -> None:
        """Say which actions that move the robot do not stand still, although its drive does."""
        await asyncio.sleep(self._rest_timeout_s)
        if not self._runs.latched:
            return
        for run in self._runs.all:
            for node in run.snapshot().nodes:
                spec = self._runs.catalogue.get(node.name)
                if node.state in _GOING and spec is not None and "moves" in spec.effects:
                    log.error(
                        "action ignores the stop", actor=self._actor, graph=run.name, node=node.full_name
                    )
                    text = f"{node.full_name} goes on in spite of the stop; the drive is held still"
                    self._complain(Problem(node.full_name, text, "end it before the reset", "ignores_stop"))

    def _say(self, state: Literal["received", "at_rest", "reset"], command_id: str) -> None:
        self._report(StopReport(actor=self._actor, id=command_id, state=state))

    def _spawn(self, work: Coroutine[Any, Any, None]) -> asyncio.Task[None]:
        task = asyncio.create_task(work, name=f"emergency stop {self._actor}")
        self._tasks.add(task)
        task.add_done_callback(self._done)
        return task

    def _done(self, task: asyncio.Task[None]) -> None:
        self._tasks.discard(task)
        if not task.cancelled() and (error := task.exception()) is not None:
            log.error("emergency stop failed", actor=self._actor, exc_info=error)
            self._complain(
                Problem("", f"The stop failed: {error}", "use the switch on the robot", "stop_failed")
            )
