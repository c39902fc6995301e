"""Follow: go after a person whom the robot sees, and keep a distance."""

from __future__ import annotations

import asyncio
import math
from dataclasses import dataclass
from typing import Final

from parley.actions.context import ActionContext
from parley.actions.pose import Pose
from parley.actions.steering import steer
from parley.errors import ActionFailure, FailureCode
from parley.robots.base import NavigationControl, SeenPerson, Velocity
from parley.umrf.action import Outcome, action
from parley.world.approach import approach_pose
from parley.world.geometry import Pose2D, wrap_angle
from parley.world.object_map import MapObject

__all__ = ["LONGEST_S", "follow"]

LONGEST_S: Final = 3600.0
_DISTANCE_M: Final = 1.2
"""Between the robot's middle and the person's."""
_BODY_M: Final = 0.25
"""What a person takes, from their middle."""
_SLACK_M: Final = 0.4
"""So much farther away they may be before the robot sets off, and so far they may go on before it turns."""
_LOOK_S: Final = 0.3
_AHEAD_RAD: Final = 0.3
_TURN_RADPS: Final = 0.8
_DRIVE_S: Final = 120.0
_SPEAKER: Final = frozenset({"", "me", "us", "you", "operator"})
_ANYBODY: Final = _SPEAKER | {"him", "her", "them", "person", "somebody", "someone"}


@action(
    label="Follow {person} for {duration} seconds",
    phrases=("follow {person}",),
    effects=("follows", "moves"),
    capabilities=("drive", "lidar", "sees_people"),
    kinds={"person": "person", "duration": "duration"},
    units={"duration": "seconds"},
    tests={
        "follow me": {},
        "follow Kim": {"person": "Kim"},
        "come with me": {},
        "don't follow me": None,
    },
)
async def follow(ctx: ActionContext, person: str, duration: float = 0.0) -> Outcome:
    """Follow a person at a distance.

    Args:
        person: Whom.
        duration: How long, in seconds; as long as it goes, if not said.
    """
    if not 0 <= duration <= LONGEST_S:
        text = f"I can follow for up to {LONGEST_S / 60:.0f} minutes, not for {duration:g} seconds."
        raise ActionFailure(FailureCode.NOT_CAPABLE, text, {"duration": duration})
    chase = _Chase(ctx, person, ctx.clock.now_s() + (duration or LONGEST_S))
    await chase.run()
    return Outcome(facts={"pose": Pose.of(ctx.robot.pose())})


@dataclass(slots=True)
class _Chase:
    """One run."""

    ctx: ActionContext
    person: str
    ends_s: float
    seen: SeenPerson | None = None
    """Where they were seen last."""

    async def run(self) -> None:
        while self.ctx.clock.now_s() < self.ends_s:
            if self._look() is None and not await self._look_around():
                raise self._lost()
            assert self.seen is not None
            away_m = self._away_m(self.seen)
            self.ctx.run.progress(None, f"{away_m:.1f} m behind {self.seen.name}")
            if away_m > _DISTANCE_M + _SLACK_M:
                await self._drive(self.seen)
            else:
                await self._turn_to(self.seen)
                await self.ctx.run.wait_while_paused()
                await self.ctx.clock.sleep(_LOOK_S)

    def _look(self) -> SeenPerson | None:
        """The one that is followed, if they are seen now; of several that fit the one that was last."""
        fitting = [one for one in self.ctx.robot.people() if self._fits(one)]
        if not fitting:
            return None
        last = self.seen
        if last is not None:
            fitting.sort(key=lambda one: math.hypot(one.x_m - last.x_m, one.y_m - last.y_m))
        self.seen = fitting[0]
        return self.seen

    def _fits(self, one: SeenPerson) -> bool:
        wanted = self.person if self.seen is None else self.seen.name
        said = set(wanted.casefold().split()) - {"the", "a"}
        return said <= _ANYBODY or said <= set(one.name.casefold().split())

    async def _look_around(self) -> bool:
        """Turn once around for whom is not seen; whether they came into sight."""
        turned, was = 0.0, self.ctx.robot.pose().yaw_rad

        def command() -> Velocity | None:
            nonlocal turned, was
            here = self.ctx.robot.pose().yaw_rad
            turned, was = turned + abs(wrap_angle(here - was)), here
            return None if self._look() is not None or turned >= math.tau else Velocity(0.0, self._side())

        await steer(self.ctx, command, lambda: "I cannot turn here.")
        return self._look() is not None

    def _side(self) -> float:
        """To which side they are sought first: the one where they were seen last."""
        if self.seen is None:
            return _TURN_RADPS
        return math.copysign(_TURN_RADPS, self._aside_rad(self.seen))

    async def _turn_to(self, one: SeenPerson) -> None:
        """Keep them in sight."""

        def command() -> Velocity | None:
            aside = self._aside_rad(self._look() or one)
            return None if abs(aside) < _AHEAD_RAD else Velocity(0.0, math.copysign(_TURN_RADPS, aside))

        await steer(self.ctx, command, lambda: "I cannot turn here.")

    async def _drive(self, one: SeenPerson) -> None:
        """Drive towards them until they have gone on, or it is near them."""
        goal = await self._beside(one)
        control = NavigationControl(on_progress=lambda _: None, paused=lambda: self.ctx.run.paused)
        drive = asyncio.ensure_future(self.ctx.robot.navigate(goal, control, timeout_s=_DRIVE_S))
        try:
            while not drive.done() and self.ctx.clock.now_s() < self.ends_s:
                sleep = asyncio.ensure_future(self.ctx.clock.sleep(_LOOK_S))
                try:
                    await asyncio.wait({drive, sleep}, return_when=asyncio.FIRST_COMPLETED)
                finally:
                    sleep.cancel()
                now = self._look()
                if now is not None and math.hypot(now.x_m - one.x_m, now.y_m - one.y_m) > _SLACK_M:
                    return
            if drive.done():
                await drive
        finally:
            drive.cancel()
            await asyncio.gather(drive, return_exceptions=True)

    async def _beside(self, one: SeenPerson) -> Pose2D:
        """Where to stand near them."""
        ctx, size_m = self.ctx, 2 * _BODY_M
        body = MapObject("", one.name, one.x_m, one.y_m, width_m=size_m, height_m=size_m)
        standoff_m = _DISTANCE_M - _BODY_M - ctx.robot.radius_m
        with ctx.clock.hold():
            goal = await asyncio.to_thread(
                approach_pose, ctx.world.occupancy, body, ctx.robot.pose(), radius_m=ctx.robot.radius_m,
                standoff_m=max(0.0, standoff_m),
            )  # fmt: skip
        if goal is None:
            text = f"I see {one.name}, but no free spot there that I can get to."
            raise ActionFailure(FailureCode.UNREACHABLE, text, {"wanted": one.name})
        return goal

    def _away_m(self, one: SeenPerson) -> float:
        here = self.ctx.robot.pose()
        return math.hypot(one.x_m - here.x_m, one.y_m - here.y_m)

    def _aside_rad(self, one: SeenPerson) -> float:
        here = self.ctx.robot.pose()
        return wrap_angle(math.atan2(one.y_m - here.y_m, one.x_m - here.x_m) - here.yaw_rad)

    def _lost(self) -> ActionFailure:
        wanted = "you" if self.person.casefold() in _SPEAKER else self.person
        details = {"wanted": self.person or "person"}
        if self.seen is None:
            text = f"I do not see {wanted}, so I cannot follow. Please come where I can see you."
            return ActionFailure(FailureCode.NO_MATCH, text, details)
        text = (
            f"I have lost {wanted}. I looked around for {wanted}, {self.ctx.whereabouts()}, and saw nobody."
        )
        return ActionFailure(FailureCode.NO_MATCH, text, details)
