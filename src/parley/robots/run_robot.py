"""A robot as one run of an action gets it: its drive can be held and taken away."""

from __future__ import annotations

import asyncio
from dataclasses import replace

from parley.errors import ActionFailure, FailureCode
from parley.messages.status import Trouble
from parley.robots.base import (
    Arm,
    CameraImage,
    LaserScan,
    NavigationControl,
    Robot,
    SeenPerson,
    Sight,
    Velocity,
)
from parley.robots.turn import Asker, Turn
from parley.umrf.motion import Motion
from parley.world.geometry import Pose2D

__all__ = ["RunRobot"]


class RunRobot:
    """Implements `Robot` for one run; what has to do with all runs (`halt`, `release`) it refuses.

    Args:
        robot: The robot.
        motion: Whether this run may move it.
        turn: When it may go into places with room for so many only.
        person: Who is told and asked about waiting there.
    """

    def __init__(self, robot: Robot, motion: Motion, turn: Turn, person: Asker) -> None:
        self._robot, self._motion, self._turn, self._person = robot, motion, turn, person
        self.name = robot.name

    @property
    def capabilities(self) -> frozenset[str]:
        """See `Robot.capabilities`."""
        return self._robot.capabilities

    @property
    def radius_m(self) -> float:
        """See `Robot.radius_m`."""
        return self._robot.radius_m

    def pose(self) -> Pose2D:
        """See `Robot.pose`."""
        return self._robot.pose()

    def velocity(self) -> Velocity:
        """See `Robot.velocity`."""
        return self._robot.velocity()

    def scan(self) -> LaserScan:
        """See `Robot.scan`."""
        return self._robot.scan()

    def planned_path(self) -> tuple[tuple[float, float], ...]:
        """See `Robot.planned_path`."""
        return self._robot.planned_path()

    def battery(self) -> float | None:
        """See `Robot.battery`."""
        return self._robot.battery()

    def trouble(self) -> Trouble:
        """See `Robot.trouble`."""
        return self._robot.trouble()

    async def image(self) -> CameraImage:
        """See `Robot.image`."""
        return await self._robot.image()

    @property
    def sight(self) -> Sight | None:
        """See `Robot.sight`."""
        return self._robot.sight

    async def look(self, aside_rad: float) -> CameraImage:
        """See `Robot.look`."""
        return await self._robot.look(aside_rad)

    def people(self) -> tuple[SeenPerson, ...]:
        """See `Robot.people`."""
        return self._robot.people()

    @property
    def arm(self) -> Arm | None:
        """See `Robot.arm`.

        Raises:
            ActionFailure: `declined`: this run was stopped.
        """
        self._check()
        return self._robot.arm

    async def speak(self, text: str) -> None:
        """See `Robot.speak`."""
        await self._robot.speak(text)

    def drive(self, velocity: Velocity) -> None:
        """See `Robot.drive`; without permission a motion becomes standing still.

        Raises:
            ActionFailure: `declined`: the drive was taken away from this run.
        """
        if velocity == Velocity() or self._motion.allowed:
            goes = not velocity.speed_mps or self._turn.may_go()
            self._robot.drive(velocity if goes else Velocity())
            return
        self._motion.disobeyed()
        self._check()
        self._robot.drive(Velocity())

    async def navigate(self, goal: Pose2D, control: NavigationControl, *, timeout_s: float) -> Pose2D:
        """See `Robot.navigate`; it stands still while this run may not move, and ends if it never may.

        Raises:
            ActionFailure: `declined`: the drive was taken away from this run; `blocked`, `unavailable`: it
                has waited for its turn in vain.
        """
        self._check()
        motion, turn, loop = self._motion, self._turn, asyncio.get_running_loop()

        def stands() -> bool:
            if control.paused() or not motion.allowed:
                turn.rest()
                return True
            goes = turn.may_go(self._robot.planned_path())
            control.waits(turn.waits_for)
            return not goes

        held = replace(control, paused=stands)
        drive = asyncio.ensure_future(self._driven(goal, held, timeout_s))

        def end() -> None:
            loop.call_soon_threadsafe(drive.cancel)

        def stand() -> None:
            self._robot.drive(Velocity())  # at once, not when the drive looks next

        motion.on_paused.append(stand)
        forget = motion.on_revoked(end)
        turn.begin()
        waiting = asyncio.ensure_future(turn.attend(self._person))
        waiting.add_done_callback(lambda _: drive.cancel())
        try:
            return await drive
        except asyncio.CancelledError:
            task = asyncio.current_task()
            if task is None or not task.cancelling():  # only the drive was
                self._check()
                if waiting.done() and (failure := waiting.exception()) is not None:
                    raise failure from None
            raise
        finally:
            turn.end()
            waiting.cancel()
            drive.cancel()
            motion.on_paused.remove(stand)
            forget()

    async def _driven(self, goal: Pose2D, control: NavigationControl, timeout_s: float) -> Pose2D:
        """Drive there; another robot that is in a narrow place, and so in the way, is waited for."""
        while True:
            try:
                return await self._robot.navigate(goal, control, timeout_s=timeout_s)
            except ActionFailure as failure:
                at = failure.details.get("at")
                if failure.code is not FailureCode.BLOCKED or not isinstance(at, dict):
                    raise
                if not await self._turn.cleared((at["x"], at["y"])):
                    raise

    def halt(self) -> None:
        """See `Robot.halt`: standing still is always allowed, holding the robot is not an action's to do.

        Raises:
            ActionFailure: `not_capable`.
        """
        raise ActionFailure(FailureCode.NOT_CAPABLE, "An action cannot hold the robot; it can drive at zero.")

    def release(self) -> None:
        """See `Robot.release`: no action releases an emergency stop.

        Raises:
            ActionFailure: `not_capable`.
        """
        raise ActionFailure(FailureCode.NOT_CAPABLE, "An action cannot release a stop.")

    def _check(self) -> None:
        if self._motion.revoked:
            raise ActionFailure(FailureCode.DECLINED, "I was stopped, so this step may not move me any more.")
