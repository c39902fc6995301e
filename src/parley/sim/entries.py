"""What can stand in a world file: walls with doorways, things, robots, and changes to them."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Annotated, Any, Literal, Self, TypeVar

from PIL import ImageColor
from pydantic import (
    AfterValidator,
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    ValidationInfo,
    field_validator,
    model_validator,
)

from parley.files import validated
from parley.sim.robot_model import PRESETS, RobotModel
from parley.sim.solids import Shape, Solid
from parley.world.geometry import Extent, Metres, Pose2D

__all__ = [
    "Area",
    "Colour",
    "Doorway",
    "Entry",
    "Name",
    "Part",
    "RobotEntry",
    "RobotState",
    "Thing",
    "Wall",
    "WorldChanges",
]

M = TypeVar("M", bound=BaseModel)


def _check_colour(text: str) -> str:
    ImageColor.getrgb(text)  # raises ValueError, which pydantic reports with the field's path
    return text


def _preset(value: Any) -> Any:
    if isinstance(value, str):
        if value not in PRESETS:
            raise ValueError(f"no robot model {value!r}; known: {', '.join(sorted(PRESETS))}")
        return PRESETS[value]
    return value


Colour = Annotated[str, AfterValidator(_check_colour)]
"""A CSS colour name or ``#rrggbb``."""
Name = Annotated[str, Field(min_length=1, max_length=80)]
Point = tuple[Metres, Metres]
PoseTuple = tuple[Metres, Metres, float]
"""x_m, y_m, yaw_rad."""
Positive = Annotated[Extent, Field(gt=0)]


class Entry(BaseModel):
    """Base of everything in a world file: frozen, unknown keys refused."""

    model_config = ConfigDict(frozen=True, extra="forbid", populate_by_name=True, allow_inf_nan=False)


class Doorway(Entry):
    """A gap in a wall."""

    at_m: Extent
    """Distance of its middle from the wall's start."""
    width_m: Positive = 0.9


class Wall(Entry):
    """A straight wall."""

    start: Point = Field(alias="from")
    end: Point = Field(alias="to")
    thickness_m: Positive = 0.1
    height_m: Positive = 1.5
    colour: Colour = "#d9d2c5"
    doorways: tuple[Doorway, ...] = ()

    @property
    def length_m(self) -> float:
        """From start to end."""
        return math.dist(self.start, self.end)

    def solids(self) -> Iterator[Solid]:
        """The pieces that its doorways leave standing."""
        yaw = math.atan2(self.end[1] - self.start[1], self.end[0] - self.start[0])
        # Both ends reach half a thickness further, so that walls meeting at a corner leave no notch.
        begin = -self.thickness_m / 2
        gaps = sorted((door.at_m - door.width_m / 2, door.at_m + door.width_m / 2) for door in self.doorways)
        for low, high in [*gaps, (self.length_m + self.thickness_m / 2, math.inf)]:
            if low - begin > 1e-6:
                middle = (begin + low) / 2
                yield Solid(
                    "box", (low - begin, self.thickness_m, self.height_m),
                    self.start[0] + middle * math.cos(yaw), self.start[1] + middle * math.sin(yaw), 0.0,
                    yaw, _rgb(self.colour),
                )  # fmt: skip
            begin = max(begin, high)


class Area(Entry):
    """A room, or another part of the floor that has a name."""

    name: Name
    corners: tuple[Point, ...] = Field(min_length=3)
    """One after the other around it."""
    capacity: int | None = Field(default=None, ge=1)
    """So many robots may be in it at once; None: any number."""


class Part(Entry):
    """One solid of a thing."""

    shape: Shape = "box"
    size_m: tuple[Positive, Positive, Positive]
    """Full extents along its own x, y and z (a cylinder: diameter, diameter, height)."""
    at_m: tuple[Metres, Metres, Metres] = (0.0, 0.0, 0.0)
    """Where the middle of its underside is, in the thing's frame."""
    yaw_rad: float = 0.0
    colour: Colour = "gray"

    @field_validator("size_m")
    @classmethod
    def _round_cylinders_only(cls, size_m: tuple[float, ...], info: ValidationInfo) -> tuple[float, ...]:
        if info.data.get("shape") == "cylinder" and size_m[0] != size_m[1]:
            raise ValueError("a cylinder's first two sizes are its diameter and must be equal")
        return size_m


class Way(Entry):
    """On which way somebody walks, again and again."""

    over: tuple[Point, ...] = Field(min_length=1)
    """Points in the map frame; the first one is reached from `pose`, and behind the last comes `pose`."""
    speed_mps: Positive = 0.8


class Thing(Entry):
    """Something that stands in the world."""

    name: Name
    """Unique; also its id in the object map."""
    class_name: Name = Field(default="thing", alias="class")
    description: str = ""
    """How people would call it; default: the name."""
    aliases: tuple[Name, ...] = ()
    label: str = ""
    """What a detector calls it when it sees it; default: the description."""
    pose: PoseTuple
    """In the map frame, or in the frame of the thing that it stands in (`inside`)."""
    z_m: Extent = 0.0
    """Height of its underside above the floor."""
    inside: Name | None = None
    """The thing it stands in or on; it moves and disappears with that."""
    charges: bool = False
    """Whether it charges the robots that stand at it."""
    walks: Way | None = None
    """Whether it moves by itself, as people do; then it is on no map."""
    held_by: Name | None = None
    """The robot that has it in its hand; its pose is in the frame of that."""
    front_rad: float | None = None
    """Direction its usable side faces, in its own frame."""
    parts: tuple[Part, ...] = Field(min_length=1)
    mapped: bool = True
    """Whether it is drawn on the occupancy map (known before, not found out by driving)."""
    listed: bool = True
    """Whether it is in the object map."""

    @model_validator(mode="after")
    def _walks_freely(self) -> Self:
        if self.walks is not None and (self.mapped or self.listed or self.inside or self.held_by):
            raise ValueError("what walks is neither mapped nor listed, and stands in nothing")
        return self

    @property
    def words(self) -> str:
        """How people call it."""
        return self.description or self.name

    def solids(self, base: Pose2D) -> Iterator[Solid]:
        """Its parts in the map frame, when its own frame stands at `base`."""
        cos, sin = math.cos(base.yaw_rad), math.sin(base.yaw_rad)
        for part in self.parts:
            x, y, z = part.at_m
            yield Solid(
                part.shape, part.size_m,
                base.x_m + cos * x - sin * y, base.y_m + sin * x + cos * y, self.z_m + z,
                base.yaw_rad + part.yaw_rad, _rgb(part.colour),
            )  # fmt: skip


class RobotState(Entry):
    """How a robot is, apart from where; what is left out stays, or is as in a sound robot."""

    camera: Literal["working", "broken"] = "working"
    localisation: Literal["working", "lost"] = "working"
    """Whether it knows where it is."""
    slip: float = Field(default=0.0, ge=0, le=0.5)
    """Share of what each wheel turns that is lost on the floor, on average."""
    lidar_noise_m: float | None = Field(default=None, ge=0, le=1)
    """Standard deviation of a range; None: as its model has it."""
    battery: float | None = Field(default=None, ge=0, le=1)
    """How full it is from now on; None: full at the start."""


class RobotEntry(RobotState):
    """A robot and where it starts."""

    name: Name
    model: Annotated[RobotModel, BeforeValidator(_preset)]
    """A preset's name or a description."""
    pose: PoseTuple


class WorldChanges(Entry):
    """What is different in one run; names that do not exist are refused."""

    remove: tuple[Name, ...] = ()
    """Things that are not there."""
    add: tuple[Thing, ...] = ()
    move: dict[str, PoseTuple] = Field(default_factory=dict)
    """Things or robots and their other poses."""
    robots: dict[str, RobotState] = Field(default_factory=dict)
    """Robots, and what is different about them: faults that come or go, how full a battery is."""
    cancel: tuple[Name, ...] = ()
    """Events that do not happen."""

    @classmethod
    def parse(cls, raw: Mapping[str, Any], file: str = "changes") -> Self:
        """Check changes that come as plain data; `file` is only for messages.

        Raises:
            FileFormatError: Names the field.
        """
        return validated(cls, dict(raw), file)


def _rgb(colour: str) -> tuple[int, int, int]:
    red, green, blue = ImageColor.getrgb(colour)[:3]
    return red, green, blue
