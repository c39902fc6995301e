"""Driving to a goal with a map and a lidar: plan, follow, plan anew around what the map does not know.

It needs no more of a robot than a pose, a scan and a drive (`Vehicle`), so anything with these can be driven.
"""

from __future__ import annotations

import asyncio
import math
from typing import Protocol

import numpy as np
import structlog

from parley.clock import Clock
from parley.errors import ActionFailure, FailureCode
from parley.gate.fence import Fence
from parley.robots.base import DriveLimits, LaserScan, NavigationControl, Velocity
from parley.robots.dynamic_window import choose_velocity
from parley.robots.obstacles import ObservedObstacles, scan_points
from parley.world.geometry import Pose2D, wrap_angle
from parley.world.occupancy import OccupancyMap
from parley.world.planning import NoPathError, Path, plan_path

__all__ = ["Navigator", "Vehicle"]

log = structlog.get_logger(__name__)

CYCLE_S = 0.1
"""Robot time between two decisions."""
ARRIVED_M, ARRIVED_RAD = 0.05, 0.05
"""How near is near enough; the simulated drive ends well within twice that."""

_REPLAN_S = 1.0
_PROGRESS_S = 0.3
_LOOKAHEAD_M = 0.4
_LOOK_AGAIN_S = 4.0
"""For so long the robot waits and looks before it believes that there is no way."""
_STUCK_M, _STUCK_S = 0.1, 12.0
_CAREFUL_WITHIN_M = 0.8
"""What lies further away cannot be hit before the next few decisions."""
_STRAYED_M = 0.3
_HELD_POLL_S = 0.02
_PLAN_MARGIN_M = 0.04
_KEEP_OUT_MARGIN_M = 0.02


class Vehicle(Protocol):
    """What is driven."""

    @property
    def radius_m(self) -> float:
        """Of its footprint."""
        ...

    @property
    def stopped(self) -> bool:
        """Whether it is held by `Robot.halt`."""
        ...

    def pose(self) -> Pose2D:
        """In the map frame."""
        ...

    def velocity(self) -> Velocity:
        """Measured."""
        ...

    def scan(self) -> LaserScan:
        """The newest sweep."""
        ...

    def drive(self, velocity: Velocity) -> None:
        """Command a velocity."""
        ...


class Navigator:
    """Drives one vehicle to one goal, once."""

    def __init__(
        self,
        vehicle: Vehicle,
        limits: DriveLimits,
        occupancy: OccupancyMap,
        clock: Clock,
        control: NavigationControl,
        timeout_s: float,
        fence: Fence | None = None,
    ) -> None:
        """Nothing moves until `drive_to`; the time in which the robot is held does not count as time-out."""
        self._fence = fence
        self._vehicle, self._map, self._clock, self._control = vehicle, occupancy, clock, control
        self._limits, self._timeout_s = limits, timeout_s
        self._seen = ObservedObstacles(occupancy)
        self._driven_s = 0.0
        self._path: Path | None = None
        self._index = 0
        self._was_at, self._was_there_s = vehicle.pose(), 0.0

    @staticmethod
    def keep_out_m(radius_m: float) -> float:
        """What a robot of that radius keeps between its centre and what its lidar sees."""
        return radius_m + _KEEP_OUT_MARGIN_M

    def way_ahead(self) -> tuple[tuple[float, float], ...]:
        """What is left of the newest plan: map-frame x and y; empty before there is one."""
        if self._path is None:
            return ()
        return tuple((round(x, 3), round(y, 3)) for x, y in self._path.points_m[self._index :].tolist())

    async def drive_to(self, goal: Pose2D) -> Pose2D:
        """Drive there and return where it ended.

        Raises:
            ActionFailure: See `Robot.navigate`.
        """
        try:
            while True:
                path = await self._find_way(goal)
                if await self._follow(path):
                    break
            await self._turn_to(goal.yaw_rad)
        finally:
            self._vehicle.drive(Velocity())
        self._control.on_progress(0.0)
        return self._vehicle.pose()

    async def _find_way(self, goal: Pose2D) -> Path:
        """Plan around what was seen; without a way, stand and look again for a while before giving up."""
        waited_s = 0.0
        while True:
            if self._fence is not None and (closed := self._fence.why_closed(goal)):
                details = {"goal": _xy(goal.x_m, goal.y_m), "rule": closed.rule}
                raise ActionFailure(FailureCode.FORBIDDEN, closed.sentence, details)
            try:
                return await self._plan(goal)
            except NoPathError as error:
                if error.at is None:
                    raise await self._no_way(goal) from error
                if waited_s >= _LOOK_AGAIN_S:
                    raise self._blocked(*error.at) from error
            self._vehicle.drive(Velocity())
            await self._pass_time()
            waited_s += CYCLE_S
            self._seen.update(self._vehicle.scan(), self._vehicle.pose())

    async def _plan(self, goal: Pose2D) -> Path:
        radius_m = self._vehicle.radius_m + _PLAN_MARGIN_M
        start, seen = self._vehicle.pose(), self._seen.points_m
        grid = self._fence.walls(self._map, start) if self._fence is not None else self._map
        with self._clock.hold():
            return await asyncio.to_thread(plan_path, grid, start, goal, radius_m=radius_m, obstacles=seen)

    async def _no_way(self, goal: Pose2D) -> ActionFailure:
        """Why the map has no way: because of the rules, or without them too."""
        at = {"goal": _xy(goal.x_m, goal.y_m)}
        if self._fence is not None:
            start, radius_m = self._vehicle.pose(), self._vehicle.radius_m + _PLAN_MARGIN_M
            with self._clock.hold():
                found = await asyncio.to_thread(self._fence.why_no_way, self._map, start, goal, radius_m)
            if found:
                return ActionFailure(FailureCode.FORBIDDEN, found.sentence, {**at, "rule": found.rule})
        text = f"I know no way to ({goal.x_m:.1f}, {goal.y_m:.1f}) on my map."
        return ActionFailure(FailureCode.UNREACHABLE, text, at)

    async def _follow(self, path: Path) -> bool:
        """Follow a path to its end; False as soon as a new path should be made."""
        self._path, self._index = path, 0
        began_s = told_s = self._driven_s
        seen_before = len(self._seen)
        fenced = self._fence.closed_now if self._fence is not None else ()
        end_x, end_y = (float(value) for value in path.points_m[-1])
        while True:
            pose, scan = self._vehicle.pose(), self._vehicle.scan()
            if math.hypot(end_x - pose.x_m, end_y - pose.y_m) <= ARRIVED_M:
                return True
            self._seen.update(scan, pose)
            index = self._index = path.nearest(pose.x_m, pose.y_m, self._index)
            if self._stuck(pose):
                raise self._blocked(*path.ahead(index, _LOOKAHEAD_M))
            if self._driven_s - told_s >= _PROGRESS_S:
                told_s = self._driven_s
                self._control.on_progress(path.remaining_m(index))
            self._vehicle.drive(self._steer(path, index, pose, scan))
            held = await self._pass_time()
            if self._fence is not None and self._fence.closed_now != fenced:
                return False
            news = len(self._seen) != seen_before
            if held or (self._driven_s - began_s >= _REPLAN_S and (news or self._strayed(path, index))):
                return False

    def _steer(self, path: Path, index: int, pose: Pose2D, scan: LaserScan) -> Velocity:
        x, y = path.ahead(index, _LOOKAHEAD_M)
        cos, sin = math.cos(pose.yaw_rad), math.sin(pose.yaw_rad)
        east, north = x - pose.x_m, y - pose.y_m
        target = cos * east + sin * north, cos * north - sin * east
        return choose_velocity(
            self._vehicle.velocity(), target, scan_points(scan, _CAREFUL_WITHIN_M), self._limits, CYCLE_S
        )

    def _stuck(self, pose: Pose2D) -> bool:
        """Whether it has hardly moved for long, over any number of new plans."""
        if pose.distance_to(self._was_at) > _STUCK_M:
            self._was_at, self._was_there_s = pose, self._driven_s
        return self._driven_s - self._was_there_s > _STUCK_S

    def _strayed(self, path: Path, index: int) -> bool:
        pose = self._vehicle.pose()
        x, y = path.points_m[index]
        return math.hypot(x - pose.x_m, y - pose.y_m) > _STRAYED_M

    async def _turn_to(self, yaw_rad: float) -> None:
        while abs(error := wrap_angle(yaw_rad - self._vehicle.pose().yaw_rad)) > ARRIVED_RAD:
            limit = self._limits.max_turn_radps
            self._vehicle.drive(Velocity(0.0, float(np.clip(2.0 * error, -limit, limit))))
            await self._pass_time()

    async def _pass_time(self) -> bool:
        """Let one cycle pass; True if the robot was held meanwhile.

        Raises:
            ActionFailure: `timed_out`.
        """
        held = False
        while self._control.paused() or self._vehicle.stopped:
            if not held:
                self._vehicle.drive(Velocity())
            held = True
            # Wall time: how long a person holds a robot is not the robot's time, and in simulation
            # nobody should make time pass by waiting for it here.
            await asyncio.sleep(_HELD_POLL_S)
        if not held:
            began_s = self._clock.now_s()
            await self._clock.sleep(CYCLE_S)
            self._driven_s += self._clock.now_s() - began_s
        if self._driven_s > self._timeout_s:
            raise ActionFailure(
                FailureCode.TIMED_OUT,
                f"I did not get there within {self._timeout_s:.0f} seconds.",
                {"timeout_s": self._timeout_s},
            )
        return held

    def _blocked(self, x_m: float, y_m: float) -> ActionFailure:
        log.info("way_blocked", x_m=round(x_m, 2), y_m=round(y_m, 2))
        return ActionFailure(
            FailureCode.BLOCKED,
            f"Something that is not on my map stands in the way near ({x_m:.1f}, {y_m:.1f}), "
            "and I found no way around it.",
            {"at": _xy(x_m, y_m)},
        )


def _xy(x_m: float, y_m: float) -> dict[str, float]:
    return {"x": round(x_m, 2), "y": round(y_m, 2)}
