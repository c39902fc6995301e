"""The arm of a simulated robot: what is in reach and not too large is in its hand at once."""

from __future__ import annotations

import math
from typing import Final

from parley.errors import ActionFailure, FailureCode
from parley.robots.base import Detection
from parley.sentences import sentence
from parley.sim.entries import Thing
from parley.sim.simulator import Simulator
from parley.world.geometry import Pose2D

__all__ = ["SimulatedArm"]

_GRASPS_M: Final = 0.3
"""Of larger things it gets no hold: the second longest side counts."""
_SAME_M: Final = 0.5
_HIGHEST_M: Final = 1.3
_MOVES_S: Final = 4.0


class SimulatedArm:
    """Implements `parley.robots.base.Arm`.

    Args:
        simulator: The world.
        robot: Whose arm it is.
    """

    def __init__(self, simulator: Simulator, robot: str) -> None:
        self._simulator, self._robot = simulator, robot
        self._reach_m = simulator.model(robot).arm_reach_m or 0.0

    @property
    def holds(self) -> str:
        """See `Arm.holds`."""
        held = self._simulator.world.in_hand(self._robot)
        return _called(held) if held is not None else ""

    async def pick_up(self, thing: Detection) -> None:
        """See `Arm.pick_up`."""
        if self.holds:
            text = sentence("I have the {thing} in my hand. Where shall I put it first?", thing=self.holds)
            raise ActionFailure(FailureCode.NOT_CAPABLE, text)
        await self._move()
        meant = self._meant(thing)
        solids = [*meant.solids(self._simulator.world.base_of(meant))]
        if any(sorted(solid.size_m)[1] > _GRASPS_M for solid in solids):
            text = sentence("The {thing} is too large for my hand.", thing=thing.label)
            raise ActionFailure(FailureCode.NOT_CAPABLE, text, {"wanted": thing.label})
        forward_m, height_m = self._simulator.model(self._robot).hand_m
        hand = {"held_by": self._robot, "inside": None, "pose": (forward_m, 0.0, 0.0), "z_m": height_m}
        self._simulator.become(self._simulator.world.with_thing(meant.model_copy(update=hand)))

    async def put_down(self, x_m: float, y_m: float) -> None:
        """See `Arm.put_down`."""
        if not self.holds:
            raise ActionFailure(FailureCode.NOT_CAPABLE, sentence("I have nothing in my hand."))
        await self._move()
        world = self._simulator.world
        held = world.in_hand(self._robot)
        assert held is not None
        here = self._simulator.pose(self._robot)
        self._reach(here, x_m, y_m, self.holds)
        tops = [
            solid.z_m + solid.size_m[2]
            for thing in world.standing()
            for solid in thing.solids(world.base_of(thing))
            if solid.distance_m(x_m, y_m) == 0.0
        ]
        top_m = max(tops, default=0.0)
        if top_m > _HIGHEST_M:
            text = sentence("I cannot reach up there to put the {thing} down.", thing=self.holds)
            raise ActionFailure(FailureCode.UNREACHABLE, text)
        lies = {"held_by": None, "pose": (x_m, y_m, here.yaw_rad), "z_m": top_m}
        self._simulator.become(world.with_thing(held.model_copy(update=lies)))

    async def _move(self) -> None:
        """Let the time of a movement pass.

        Raises:
            ActionFailure: `declined`: the robot is held.
        """
        await self._simulator.clock.sleep(_MOVES_S)
        if self._simulator.stopped(self._robot):
            raise ActionFailure(FailureCode.DECLINED, sentence("I am stopped, so I do not move my arm."))

    def _meant(self, seen: Detection) -> Thing:
        """What was seen, if it is within reach.

        Raises:
            ActionFailure: `no_match`: it is not there any more; `unreachable`.
        """
        world, here = self._simulator.world, self._simulator.pose(self._robot)
        x_m, y_m = (here.x_m if seen.x_m is None else seen.x_m), (here.y_m if seen.y_m is None else seen.y_m)
        alike = [thing for thing in world.standing() if _called(thing) == seen.label]
        places = [(thing, world.base_of(thing)) for thing in alike]
        near = [(math.hypot(at.x_m - x_m, at.y_m - y_m), thing.name) for thing, at in places]
        if not near or min(near)[0] > _SAME_M:
            text = sentence("The {thing} is not there any more.", thing=seen.label)
            raise ActionFailure(FailureCode.NO_MATCH, text, {"wanted": seen.label})
        meant = world.thing(min(near)[1])
        at = world.base_of(meant)
        self._reach(here, at.x_m, at.y_m, seen.label)
        return meant

    def _reach(self, here: Pose2D, x_m: float, y_m: float, thing: str) -> None:
        away_m = math.hypot(x_m - here.x_m, y_m - here.y_m)
        if away_m > self._reach_m:
            text = sentence("My arm is too short for the {thing} from here.", thing=thing)
            raise ActionFailure(FailureCode.UNREACHABLE, text, {"wanted": thing})


def _called(thing: Thing) -> str:
    return thing.label or thing.words
