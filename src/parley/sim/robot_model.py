"""What a simulated robot is made of: footprint, speeds, camera and lidar."""

from __future__ import annotations

import math
from collections.abc import Mapping
from types import MappingProxyType

from pydantic import BaseModel, ConfigDict, Field

__all__ = ["PRESETS", "CameraModel", "LidarModel", "RobotModel"]


class _Part(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)


class CameraModel(_Part):
    """A pinhole camera looking forward."""

    width_px: int = Field(default=320, ge=16, le=1920)
    height_px: int = Field(default=240, ge=16, le=1080)
    fov_rad: float = Field(default=math.radians(69.4), gt=0.1, lt=3.0)
    """Horizontal opening angle."""
    mount_height_m: float = Field(default=0.25, gt=0)
    """Above the floor."""
    mount_forward_m: float = 0.08
    """In front of the robot's centre."""
    aside_rad: float = Field(default=0.0, ge=0, le=math.pi)
    """How far pictures can be taken to either side: it turns on a neck, or others like it look there."""
    pitch_rad: float = Field(default=0.12, gt=-1.5, lt=1.5)
    """Upwards is positive."""


class LidarModel(_Part):
    """A planar scanner turning a whole circle; its first beam points forward."""

    beams: int = Field(default=360, ge=8, le=4096)
    range_m: float = Field(default=8.0, gt=0)
    mount_height_m: float = Field(default=0.18, gt=0)
    noise_m: float = Field(default=0.01, ge=0)
    """Standard deviation of a range."""


class RobotModel(_Part):
    """A robot with a round footprint, on a differential drive or, with `max_lateral_mps`, omnidirectional."""

    radius_m: float = Field(gt=0)
    height_m: float = Field(gt=0)
    mass_kg: float = Field(default=2.0, gt=0)
    max_speed_mps: float = Field(gt=0)
    max_turn_radps: float = Field(gt=0)
    max_lateral_mps: float = Field(default=0.0, ge=0)
    """How fast it walks or rolls sideways; 0: it cannot."""
    max_acceleration_mps2: float = Field(default=0.5, gt=0)
    max_turn_acceleration_radps2: float = Field(default=3.0, gt=0)
    endurance_s: float | None = Field(default=None, gt=0)
    """How long a full battery lasts; None: the robot cannot tell how full it is."""
    charging_s: float = Field(default=1800.0, gt=0)
    """In how long an empty battery fills at a dock."""
    base_height_m: float | None = Field(default=None, gt=0)
    """Up to where it is as wide as its radius; above is a slim body. None: a little over half its height."""
    arm_reach_m: float | None = Field(default=None, gt=0)
    """How far from its middle it can take things; None: it has no arm."""
    legs: bool = False
    """Whether it looks like a body on four legs."""
    colour: str = "#2b2f36"
    camera: CameraModel | None = CameraModel()
    lidar: LidarModel = LidarModel()

    @property
    def hand_m(self) -> tuple[float, float]:
        """How far in front of its middle, and how high, it carries what it has taken; 0, 0 without an arm."""
        reach_m = self.arm_reach_m or 0.0
        return 0.45 * reach_m, 0.75 * reach_m


_TIAGO = RobotModel(
    radius_m=0.27,
    height_m=1.2,
    base_height_m=0.35,
    mass_kg=70.0,
    max_speed_mps=0.8,
    max_turn_radps=1.4,
    endurance_s=5.0 * 3600,
    colour="#d9dde2",
    camera=CameraModel(mount_height_m=1.1, mount_forward_m=0.12, pitch_rad=-0.5, fov_rad=1.2, aside_rad=1.24),
    lidar=LidarModel(range_m=12.0, mount_height_m=0.2),
)

PRESETS: Mapping[str, RobotModel] = MappingProxyType(
    {
        "turtlebot3_waffle": RobotModel(
            radius_m=0.2, height_m=0.3, max_speed_mps=0.26, max_turn_radps=1.82, endurance_s=2.0 * 3600
        ),
        "tiago": _TIAGO,
        "tiago_with_arm": _TIAGO.model_copy(update={"arm_reach_m": 1.1}),
        "spot": RobotModel(
            radius_m=0.42,
            height_m=0.7,
            legs=True,
            mass_kg=32.0,
            max_speed_mps=0.9,
            max_turn_radps=1.5,
            max_lateral_mps=0.5,
            endurance_s=1.5 * 3600,
            colour="#e3b81f",
            camera=CameraModel(
                mount_height_m=0.62, mount_forward_m=0.3, pitch_rad=-0.32, fov_rad=1.4, aside_rad=math.pi
            ),
            lidar=LidarModel(range_m=10.0, mount_height_m=0.35),
        ),
    }
)
"""Robots that a world file may name instead of describing them."""
