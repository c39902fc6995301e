"""One actor's end of the stop line: its drive in the thread that pulls, graphs and reports on the loop."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Coroutine
from typing import Any, Final, Literal

import structlog

from parley.engine.presence import is_at_rest
from parley.engine.runs import GraphRuns
from parley.errors import ActionFailure, Problem
from parley.gate.stop_line import StopLine
from parley.messages.status import StopCommand, StopReport
from parley.robots.base import Robot
from parley.umrf.model import NodeState
from parley.umrf.motion import Motions

__all__ = ["EmergencyStop"]

log = structlog.get_logger(__name__)

REST_CHECK_S: Final = 0.02
REST_TIMEOUT_S: Final = 3.0
"""Wall time within which a stopped robot must have come to rest."""
WRITTEN_TIMEOUT_S: Final = 1.0
"""Wall time within which a stop must have been written down."""


_GOING: Final = (NodeState.RUNNING, NodeState.PAUSE_REQUESTED)


class EmergencyStop:
    """Stops, holds and releases one actor; tied to the line between `open` and `close`.

    Args:
        actor: Whose stop it is.
        robot: Its robot, if it has one.
        runs: Its graphs.
        motions: What its runs may do.
        line: The line.
        report: Told what becomes of each stop.
        complain: Told what went wrong with a stop.
        changed: Told every command that stops, holds or releases the actor, once it was carried out.
        rest_timeout_s: Wall time after which is said what still moves or goes on.
    """

    def __init__(
        self,
        actor: str,
        robot: Robot | None,
        runs: GraphRuns,
        motions: Motions,
        line: StopLine,
        *,
        report: Callable[[StopReport], None],
        complain: Callable[[Problem], None],
        changed: Callable[[StopCommand], None] = lambda _: None,
        rest_timeout_s: float = REST_TIMEOUT_S,
    ) -> None:
        self._actor, self._robot, self._runs, self._motions, self._line = actor, robot, runs, motions, line
        self._report, self._complain, self._changed = report, complain, changed
        self._rest_timeout_s = rest_timeout_s
        self._tasks: set[asyncio.Task[None]] = set()
        self._watching: list[asyncio.Task[None]] = []
        self._drive_problem = ""
        self._detach: Callable[[], None] = lambda: None

    def open(self) -> None:
        """Tie the actor to the line; on the loop that owns its graphs."""
        loop = asyncio.get_running_loop()

        def told(command: StopCommand) -> None:
            loop.call_soon_threadsafe(self._told, command)

        self._detach = self._line.attach(self._actor, halt=self._halt, resume=self._resume, told=told)

    async def close(self) -> None:
        """Untie it, and end what still watches or waits."""
        self._detach()
        tasks = list(self._tasks)
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)

    # -- in the thread that pulls ---------------------------------------------------------------------------

    def _halt(self) -> None:
        if self._line.latched(self._actor):
            self._motions.stop()
        self._drive_problem = ""
        if self._robot is not None:
            try:
                self._robot.halt()
            except ActionFailure as failure:
                self._drive_problem = failure.message
                raise

    def _resume(self) -> None:
        if self._robot is not None:
            self._robot.release()
        self._motions.release()

    # -- on the loop ----------------------------------------------------------------------------------------

    def _told(self, command: StopCommand) -> None:
        if command.command == "stop":
            self._runs.pause_all()
            self._motions.settle()
            self._watch(command.id)
        elif command.command == "reset":
            self._stop_watching()
            self._say("reset", command.id)
        self._changed(command)

    def _watch(self, command_id: str) -> None:
        self._stop_watching()
        if self._drive_problem:
            log.error("stop failed", actor=self._actor, reason=self._drive_problem)
            self._tell(
                f"The stop failed: {self._drive_problem}", "use the switch on the robot", "stop_failed"
            )
        self._watching = [self._spawn(self._follow(command_id)), self._spawn(self._watch_actions())]

    def _stop_watching(self) -> None:
        for task in self._watching:
            task.cancel()
        self._watching = []

    async def _follow(self, command_id: str) -> None:
        """Say that the stop is in force once it is written down, then what the robot does."""
        try:
            async with asyncio.timeout(WRITTEN_TIMEOUT_S):
                problem = await asyncio.shield(asyncio.wrap_future(self._line.written))
        except TimeoutError:
            problem = f"not within {WRITTEN_TIMEOUT_S:g} s"
        if problem:
            text = f"{self._actor} is stopped, but that could not be written down ({problem})"
            self._tell(
                text, "look at the disk; should the program end, everybody counts as stopped", "not_kept"
            )
        self._say("received", command_id)
        await self._watch_rest(command_id)

    async def _watch_rest(self, command_id: str) -> None:
        """Say once whether it stands, and later if that has changed."""
        try:
            async with asyncio.timeout(self._rest_timeout_s):
                await self._rest()
        except TimeoutError:
            log.error("robot still moves", actor=self._actor, after_s=self._rest_timeout_s)
            text = f"{self._actor} still moves {self._rest_timeout_s:g} s after the stop"
            self._say("moving", command_id)
            self._tell(text, "use the switch on the robot", "still_moving")
            await self._rest()
        except ActionFailure as failure:
            text = f"{self._actor} does not say whether it stands: {failure.message}"
            self._say("silent", command_id)
            self._tell(text, "look whether it stands", "no_answer")
            return
        self._say("at_rest", command_id)

    async def _rest(self) -> None:
        while self._robot is not None and not is_at_rest(self._robot):  # noqa: ASYNC110 - cannot be awaited
            await asyncio.sleep(REST_CHECK_S)

    async def _watch_actions(self) -> None:
        """Say which actions that move the robot do not stand still, although its drive does."""
        await asyncio.sleep(self._rest_timeout_s)
        for run in self._runs.all:
            for node in run.snapshot().nodes:
                spec = self._runs.catalogue.get(node.name)
                if node.state in _GOING and spec is not None and "moves" in spec.effects:
                    self.ignored(node.full_name)

    def ignored(self, node: str) -> None:
        """Say that an action went on in spite of the stop."""
        log.error("action ignores the stop", actor=self._actor, node=node)
        text = f"{node} goes on in spite of the stop; it cannot move {self._actor} any more"
        self._complain(Problem(node, text, "end it before the reset", "ignores_stop"))

    def _tell(self, text: str, remedy: str, code: str) -> None:
        self._complain(Problem("", text, remedy, code))

    def _say(
        self, state: Literal["received", "at_rest", "moving", "silent", "reset"], command_id: str
    ) -> None:
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
            self._tell(f"The stop failed: {error}", "use the switch on the robot", "stop_failed")
