"""What every robot promises, tried out on a robot: of yours too. It moves about two metres forward doing so.

Everything is measured in wall time. `parley robot check` runs this; so do our own tests with our own robots.
"""

from __future__ import annotations

import asyncio
import math
import threading
from collections.abc import AsyncIterator, Awaitable, Callable
from dataclasses import dataclass
from typing import Final

from parley.clock import WallClock
from parley.errors import ActionFailure
from parley.robots.base import COMMAND_LIFETIME_S, NavigationControl, Robot, Velocity
from parley.world.geometry import Pose2D

__all__ = ["PROMISES", "Kept", "Promise", "blocked", "check_robot"]

RESTS_WITHIN_S: Final = 0.5
"""After the last command that counts."""
SLOW: Final = Velocity(0.2)
STILL: Final = Velocity()
STILL_MPS: Final = 0.02
MOVES_WITHIN_S: Final = 5.0
AHEAD_M: Final = 1.0
_BEAT_S: Final = 0.05


class BrokenError(AssertionError):
    """A promise is not kept; the text says what was seen."""


@dataclass(frozen=True, slots=True)
class Kept:
    """What became of one promise."""

    promise: str
    """In words."""
    kept: bool
    text: str = ""
    """What was seen instead."""


Promise = Callable[[Robot], Awaitable[None]]
_clock = WallClock()


async def check_robot(robot: Robot) -> AsyncIterator[Kept]:
    """Try out every promise, one after the other; the robot is stopped between them.

    Args:
        robot: With two metres of free floor before it, and a map on which that is free if it plans ways.
    """
    for promise in PROMISES:
        told = (promise.__doc__ or promise.__name__).strip().rstrip(".")
        try:
            await promise(robot)
        except BrokenError as broken:
            yield Kept(told, False, str(broken))
        except (ActionFailure, TimeoutError, NotImplementedError) as error:
            yield Kept(told, False, f"{type(error).__name__}: {error}")
        else:
            yield Kept(told, True)
        finally:
            robot.release()
            robot.drive(STILL)
            await asyncio.sleep(RESTS_WITHIN_S)


async def it_measures(robot: Robot) -> None:
    """It knows where it is and that it stands."""
    pose, velocity = robot.pose(), robot.velocity()
    numbers = (pose.x_m, pose.y_m, pose.yaw_rad, velocity.linear_mps, velocity.angular_radps)
    _expect(all(map(math.isfinite, numbers)), f"pose() and velocity() give {numbers}")
    _expect(_stands(robot), f"nobody commands it, and it moves with {velocity.linear_mps:.2f} m/s")
    _expect(robot.radius_m > 0, f"radius_m is {robot.radius_m}")


async def its_pose_follows(robot: Robot) -> None:
    """Driving forward, its pose moves the way it faces, and a command of zero stops it."""
    before = robot.pose()
    await _drive_on(robot)
    for _ in range(round(1.0 / _BEAT_S)):
        robot.drive(SLOW)
        await asyncio.sleep(_BEAT_S)
    robot.drive(STILL)
    await _rests(robot, "a command of zero")
    after = robot.pose()
    ahead = (after.x_m - before.x_m) * math.cos(before.yaw_rad)
    ahead += (after.y_m - before.y_m) * math.sin(before.yaw_rad)
    _expect(ahead > 0.1, f"after a second at {SLOW.linear_mps} m/s it is {ahead:.2f} m farther ahead")


async def commands_expire(robot: Robot) -> None:
    """A command expires after 0.3 s, also while the main loop is blocked."""
    await _drive_on(robot)
    stood_s = blocked(robot, 1.2)
    _expect(stood_s > 0.1, f"it stood after {stood_s:.2f} s: commands come every {_BEAT_S} s at best")
    limit_s = max(RESTS_WITHIN_S, COMMAND_LIFETIME_S) + 0.1
    _expect(stood_s < limit_s, f"it stood after {stood_s:.2f} s, not within {limit_s:.1f} s")


async def a_halt_holds(robot: Robot) -> None:
    """A halt from any thread holds it until it is released; the release moves nothing."""
    await _drive_on(robot)
    for _ in range(2):  # a second time changes nothing
        thread = threading.Thread(target=robot.halt)
        thread.start()
        thread.join()
    stood_s = blocked(robot, 0.8)
    _expect(stood_s < RESTS_WITHIN_S, f"it stood after {stood_s:.2f} s, not within {RESTS_WITHIN_S} s")
    rests_at = robot.pose()
    for _ in range(6):
        robot.drive(SLOW)
        await asyncio.sleep(_BEAT_S)
    robot.release()
    await asyncio.sleep(COMMAND_LIFETIME_S)
    moved_m = robot.pose().distance_to(rests_at)
    _expect(moved_m < 0.02, f"commanded while it was halted, it moved {moved_m:.2f} m")
    await _drive_on(robot)


async def a_drive_can_be_held_and_cancelled(robot: Robot) -> None:
    """A drive to a place stands while it is paused or halted, then goes on; cancelling ends it."""
    if "drive" not in robot.capabilities:
        return
    pose, paused = robot.pose(), threading.Event()
    goal = Pose2D(
        pose.x_m + AHEAD_M * math.cos(pose.yaw_rad), pose.y_m + AHEAD_M * math.sin(pose.yaw_rad), pose.yaw_rad
    )
    control = NavigationControl(on_progress=lambda _: None, paused=paused.is_set)
    drive = asyncio.ensure_future(robot.navigate(goal, control, timeout_s=60.0))
    try:
        await _moves(robot, drive)
        paused.set()
        await _rests(robot, "paused()")
        paused.clear()
        await _moves(robot, drive)
        robot.halt()
        await _rests(robot, "halt()")
        robot.release()
        await _moves(robot, drive)
    finally:
        drive.cancel()
        await asyncio.gather(drive, return_exceptions=True)
    await _rests(robot, "cancelling")


PROMISES: Final[tuple[Promise, ...]] = (
    it_measures,
    its_pose_follows,
    commands_expire,
    a_halt_holds,
    a_drive_can_be_held_and_cancelled,
)
"""Each tries out one promise, and raises if it is not kept; what it is about is its docstring."""


def _expect(holds: bool, seen: str) -> None:
    if not holds:
        raise BrokenError(seen)


def _stands(robot: Robot) -> bool:
    return abs(robot.velocity().linear_mps) <= STILL_MPS


async def _drive_on(robot: Robot) -> None:
    """Drive until it moves."""
    until_s = _clock.wall_s() + MOVES_WITHIN_S
    while robot.velocity().linear_mps < SLOW.linear_mps / 2:
        _expect(_clock.wall_s() < until_s, f"commanded for {MOVES_WITHIN_S:.0f} s, it does not move")
        robot.drive(SLOW)
        await asyncio.sleep(_BEAT_S)
    robot.drive(SLOW)


async def _moves(robot: Robot, drive: asyncio.Future[Pose2D]) -> None:
    until_s = _clock.wall_s() + MOVES_WITHIN_S
    while robot.velocity().linear_mps < SLOW.linear_mps / 2:
        if drive.done():
            drive.result()
        _expect(not drive.done(), "navigate() ended without driving")
        _expect(_clock.wall_s() < until_s, f"navigate() does not move it within {MOVES_WITHIN_S:.0f} s")
        await asyncio.sleep(_BEAT_S)


async def _rests(robot: Robot, after: str) -> None:
    limit_s = RESTS_WITHIN_S + 2 * _BEAT_S
    until_s = _clock.wall_s() + limit_s
    while not _stands(robot):
        _expect(_clock.wall_s() < until_s, f"{after} does not bring it to rest within {limit_s:.1f} s")
        await asyncio.sleep(_BEAT_S / 5)


def blocked(robot: Robot, for_s: float) -> float:
    """Block the loop; after how long it stood."""
    began_s, waits = _clock.wall_s(), threading.Event()
    stood_s = for_s
    while (now_s := _clock.wall_s() - began_s) < for_s:
        stood_s = min(stood_s, now_s) if _stands(robot) else for_s
        waits.wait(0.01)
    return stood_s
