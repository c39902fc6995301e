"""Batteries of simulated robots: they empty while anything is to be done, and fill at what charges."""

from __future__ import annotations

from typing import Final

from parley.sim.robot_model import RobotModel
from parley.sim.world_file import WorldFile
from parley.world.geometry import Pose2D

__all__ = ["Battery", "charges"]

_REACH_M: Final = 0.8
"""So far from a robot's edge the dock may be."""


class Battery:
    """How full one is.

    Args:
        model: What it is in.
        charge: 0 to 1; None: full.
    """

    def __init__(self, model: RobotModel, charge: float | None) -> None:
        self._model = model
        self.charge = 1.0 if charge is None else charge

    @property
    def told(self) -> float | None:
        """As the robot tells it; None if it cannot tell."""
        return None if self._model.endurance_s is None else self.charge

    @property
    def is_empty(self) -> bool:
        """Whether it drives no more."""
        return self.charge <= 0.0

    def pass_time(self, seconds: float, *, works: bool, charged: bool) -> None:
        """Let time pass; it empties evenly over the model's endurance."""
        if charged:
            self.charge = min(1.0, self.charge + seconds / self._model.charging_s)
        elif works and self._model.endurance_s is not None:
            self.charge = max(0.0, self.charge - seconds / self._model.endurance_s)


def charges(world: WorldFile, model: RobotModel, pose: Pose2D) -> bool:
    """Whether something that charges is near a robot."""
    docks = (thing for thing in world.things if thing.charges)
    return any(
        solid.distance_m(pose.x_m, pose.y_m) <= model.radius_m + _REACH_M
        for dock in docks
        for solid in dock.solids(world.base_of(dock))
    )
