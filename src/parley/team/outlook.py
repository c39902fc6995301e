"""How far away everything is for one robot, and until when it is busy: what sharing is decided by."""

from __future__ import annotations

import asyncio
import math
from collections.abc import Awaitable, Callable, Sequence
from dataclasses import dataclass
from typing import Final

from parley.gate.judge import PlannedStep
from parley.messages.chat import ActionCall
from parley.messages.status import ActionInfo
from parley.team.allotment import Member
from parley.world.geometry import Pose2D
from parley.world.occupancy import NO_MAP, OccupancyMap
from parley.world.planning import way_lengths_m

__all__ = ["Outlook", "Survey", "Task", "survey"]

Task = tuple[ActionCall, ...]
"""Steps that only one robot can do, in their order."""
Survey = Callable[
    [str, Sequence[ActionInfo], Pose2D, Sequence[ActionCall], Sequence[Task]], Awaitable["Outlook | None"]
]
"""What one robot has before it: its actions, where it is, what it is still to do, and the tasks."""
Resolve = Callable[[Sequence[ActionCall], Pose2D], Awaitable[Sequence[PlannedStep]]]
_STEP_S: Final = 5.0
"""What a step counts that is no way, if its action does not say how long it takes."""
_MARGIN_M: Final = 0.04


@dataclass(frozen=True, slots=True)
class Outlook:
    """Of one robot."""

    ways_m: tuple[float, ...]
    """By task: how far it is from where the robot is now."""
    busy_s: float
    """Until it is done with what it has been told."""
    first_s: tuple[float, ...]
    next_s: tuple[tuple[float, ...], ...]

    def member(self, name: str, able: Sequence[bool]) -> Member:
        """The robot with its times; infinite where it is not able."""
        times = [
            tuple(time if can else math.inf for time, can in zip(row, able, strict=True))
            for row in (self.first_s, *self.next_s)
        ]
        return Member(name, times[0], tuple(times[1:]))


async def survey(
    resolve: Resolve,
    occupancy: OccupancyMap,
    pose: Pose2D,
    pending: Sequence[ActionCall],
    tasks: Sequence[Task],
    *,
    radius_m: float,
    speed_mps: float,
) -> Outlook:
    """Work it out; ways are searched beside the loop.

    Args:
        resolve: Says where steps lead from a place on.
        occupancy: The map; with `NO_MAP` it counts how far it is as the crow flies.
        pose: Where the robot is.
        pending: What it is still to do.
        tasks: What may come to it.
        radius_m: Of the robot.
        speed_mps: How fast it drives.
    """

    async def lengths(start: Pose2D, goals: Sequence[tuple[float, float]]) -> list[float]:
        if occupancy is NO_MAP:
            return [math.dist((start.x_m, start.y_m), goal) for goal in goals]
        return await asyncio.to_thread(way_lengths_m, occupancy, start, goals, radius_m=radius_m + _MARGIN_M)

    async def walked(start: Pose2D, steps: Sequence[PlannedStep]) -> tuple[float, Pose2D]:
        """How long steps take, ways included, and where they end."""
        time_s, here = 0.0, start
        for step in steps:
            if step.info is not None and "moves" in step.info.effects and step.place is not None:
                (way_m,) = await lengths(here, [(step.place.x, step.place.y)])
                time_s, here = time_s + way_m / speed_mps, Pose2D(step.place.x, step.place.y)
            elif step.info is None or not step.info.only_finds:
                time_s += step.info.duration_s or _STEP_S if step.info is not None else _STEP_S
        return time_s, here

    busy_s, free_at = await walked(pose, await resolve(pending, pose))
    entries: list[tuple[float, float] | None] = []
    exits: list[Pose2D] = []
    work_s: list[float] = []
    for task in tasks:
        steps = await resolve(task, free_at)
        place = next((step.place for step in steps if step.place is not None), None)
        entry = (place.x, place.y) if place is not None else None
        entries.append(entry)
        time_s, end = await walked(Pose2D(*entry) if entry else free_at, steps)
        work_s.append(time_s)
        exits.append(end)
    goals = [entry for entry in entries if entry is not None]

    async def ways(start: Pose2D) -> list[float]:
        known = iter(await lengths(start, goals) if goals else ())
        return [0.0 if entry is None else next(known) for entry in entries]

    async def times(start: Pose2D, before_s: float) -> tuple[float, ...]:
        found = await ways(start)
        return tuple(before_s + way / speed_mps + work for way, work in zip(found, work_s, strict=True))

    return Outlook(
        tuple(await ways(pose)),
        busy_s,
        await times(free_at, busy_s),
        tuple([await times(at, 0.0) for at in exits]),
    )
