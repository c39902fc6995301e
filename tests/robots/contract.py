"""What every robot class promises about its drive; put yours through `DRIVE_CONTRACT`, in wall time."""

from __future__ import annotations

import asyncio
import threading
import time
from collections.abc import Awaitable, Callable

from parley.robots.base import COMMAND_LIFETIME_S, Robot, Velocity

__all__ = ["DRIVE_CONTRACT", "RESTS_WITHIN_S"]

RESTS_WITHIN_S = 0.5
"""After the last command that counts."""
SLOW, STILL_MPS = Velocity(0.2), 0.02


async def commands_expire_although_the_loop_is_blocked(robot: Robot) -> None:
    assert COMMAND_LIFETIME_S < RESTS_WITHIN_S
    await _drive_on(robot)
    stood_s = _blocked(robot, 1.2)
    assert 0.1 < stood_s < RESTS_WITHIN_S + 0.1, f"it stood after {stood_s:.2f} s"


async def a_halt_from_any_thread_holds_until_it_is_released(robot: Robot) -> None:
    await _drive_on(robot)
    for _ in range(2):  # a second time changes nothing
        thread = threading.Thread(target=robot.halt)
        thread.start()
        thread.join()
    stood_s = _blocked(robot, 0.8)
    assert stood_s < RESTS_WITHIN_S, f"it stood after {stood_s:.2f} s"
    rests_at = robot.pose()
    for _ in range(6):
        robot.drive(SLOW)
        await asyncio.sleep(0.05)
    robot.release()
    await asyncio.sleep(0.3)
    assert robot.pose().distance_to(rests_at) < 0.02, "neither a command while halted nor a release moves it"
    await _drive_on(robot)


DRIVE_CONTRACT: tuple[Callable[[Robot], Awaitable[None]], ...] = (
    commands_expire_although_the_loop_is_blocked,
    a_halt_from_any_thread_holds_until_it_is_released,
)


async def _drive_on(robot: Robot) -> None:
    """Drive until it moves."""
    async with asyncio.timeout(5):
        while robot.velocity().linear_mps < SLOW.linear_mps / 2:
            robot.drive(SLOW)
            await asyncio.sleep(0.05)
    robot.drive(SLOW)


def _blocked(robot: Robot, for_s: float) -> float:
    """Block the loop; after how long it stood."""
    began_s = time.monotonic()
    stood_s = for_s
    while (now_s := time.monotonic() - began_s) < for_s:
        stood_s = for_s if abs(robot.velocity().linear_mps) > STILL_MPS else min(stood_s, now_s)
        time.sleep(0.01)
    return stood_s
