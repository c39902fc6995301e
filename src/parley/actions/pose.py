"""The pose parameters that locating and driving actions share (flat names ``pose::position::x`` ...)."""

from __future__ import annotations

from dataclasses import dataclass, field

from parley.world.geometry import Pose2D

__all__ = ["Orientation", "Pose", "Position"]


@dataclass(frozen=True, slots=True)
class Position:
    """A point in the map frame, metres."""

    x: float
    y: float
    z: float = 0.0


@dataclass(frozen=True, slots=True)
class Orientation:
    """Roll, pitch, yaw in the map frame, radians (REP 103)."""

    r: float = 0.0
    p: float = 0.0
    y: float = 0.0


@dataclass(frozen=True, slots=True)
class Pose:
    """Position and orientation in the map frame."""

    position: Position
    orientation: Orientation = field(default_factory=Orientation)

    @classmethod
    def of(cls, pose: Pose2D) -> Pose:
        """The planar pose, lying on the floor."""
        return cls(Position(pose.x_m, pose.y_m), Orientation(y=pose.yaw_rad))

    def planar(self) -> Pose2D:
        """What a driving robot can use of it."""
        return Pose2D(self.position.x, self.position.y, self.orientation.y)
