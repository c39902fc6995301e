"""Worlds from YAML: walls with doorways, things, robots; and changes to them given as data.

::

    name: two rooms
    walls:
      - {from: [0, 0], to: [4, 0]}
      - {from: [4, 0], to: [4, 3], doorways: [{at_m: 1.5, width_m: 0.9}]}
    things:
      - name: box_1
        class: box
        description: red box by the door
        pose: [1.0, 2.0, 0.0]
        parts: [{shape: box, size_m: [0.4, 0.3, 0.3], colour: red}]
    robots:
      - {name: A, model: turtlebot3_waffle, pose: [2.0, 1.0, 0.0]}

Metres and radians in the map frame. Unknown keys are refused, and every error names the file and the field.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Annotated, Any, Literal, Self, TypeVar

import yaml
from PIL import ImageColor
from pydantic import (
    AfterValidator,
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    ValidationError,
    ValidationInfo,
    field_validator,
)

from parley.errors import FileFormatError
from parley.sim.robot_model import PRESETS, RobotModel
from parley.sim.solids import Shape, Solid
from parley.world.geometry import Pose2D
from parley.world.object_map import MapObject, ObjectMap

__all__ = ["Doorway", "Part", "RobotEntry", "Thing", "Wall", "WorldChanges", "WorldFile"]

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
Point = tuple[float, float]
PoseTuple = tuple[float, float, float]
"""x_m, y_m, yaw_rad."""
Positive = Annotated[float, Field(gt=0)]


class _Entry(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid", populate_by_name=True, allow_inf_nan=False)


class Doorway(_Entry):
    """A gap in a wall."""

    at_m: float = Field(ge=0)
    """Distance of its middle from the wall's start."""
    width_m: Positive = 0.9


class Wall(_Entry):
    """A straight wall."""

    start: Point = Field(alias="from")
    end: Point = Field(alias="to")
    thickness_m: Positive = 0.1
    height_m: Positive = 1.5
    colour: Colour = "#d9d2c5"
    doorways: tuple[Doorway, ...] = ()

    def solids(self) -> Iterator[Solid]:
        """The pieces that its doorways leave standing."""
        length = math.dist(self.start, self.end)
        yaw = math.atan2(self.end[1] - self.start[1], self.end[0] - self.start[0])
        # Both ends reach half a thickness further, so that walls meeting at a corner leave no notch.
        begin = -self.thickness_m / 2
        gaps = sorted((door.at_m - door.width_m / 2, door.at_m + door.width_m / 2) for door in self.doorways)
        for low, high in [*gaps, (length + self.thickness_m / 2, math.inf)]:
            if low - begin > 1e-6:
                middle = (begin + low) / 2
                yield Solid(
                    "box", (low - begin, self.thickness_m, self.height_m),
                    self.start[0] + middle * math.cos(yaw), self.start[1] + middle * math.sin(yaw), 0.0,
                    yaw, _rgb(self.colour),
                )  # fmt: skip
            begin = max(begin, high)


class Part(_Entry):
    """One solid of a thing."""

    shape: Shape = "box"
    size_m: tuple[Positive, Positive, Positive]
    """Full extents along its own x, y and z (a cylinder: diameter, diameter, height)."""
    at_m: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """Where the middle of its underside is, in the thing's frame."""
    yaw_rad: float = 0.0
    colour: Colour = "gray"

    @field_validator("size_m")
    @classmethod
    def _round_cylinders_only(cls, size_m: tuple[float, ...], info: ValidationInfo) -> tuple[float, ...]:
        if info.data.get("shape") == "cylinder" and size_m[0] != size_m[1]:
            raise ValueError("a cylinder's first two sizes are its diameter and must be equal")
        return size_m


class Thing(_Entry):
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
    z_m: float = Field(default=0.0, ge=0)
    """Height of its underside above the floor."""
    inside: Name | None = None
    """The thing it stands in or on; it moves and disappears with that."""
    front_rad: float | None = None
    """Direction its usable side faces, in its own frame."""
    parts: tuple[Part, ...] = Field(min_length=1)
    mapped: bool = True
    """Whether it is drawn on the occupancy map (known before, not found out by driving)."""
    listed: bool = True
    """Whether it is in the object map."""

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


class RobotEntry(_Entry):
    """A robot and where it starts."""

    name: Name
    model: Annotated[RobotModel, BeforeValidator(_preset)]
    """A preset's name or a description."""
    pose: PoseTuple
    camera: Literal["working", "broken"] = "working"


class WorldChanges(_Entry):
    """What is different in one run; names that do not exist are refused."""

    remove: tuple[Name, ...] = ()
    """Things that are not there."""
    add: tuple[Thing, ...] = ()
    move: dict[str, PoseTuple] = Field(default_factory=dict)
    """Things or robots and their other poses."""
    camera: dict[str, Literal["working", "broken"]] = Field(default_factory=dict)
    """Robots and the state of their cameras."""

    @classmethod
    def parse(cls, raw: Mapping[str, Any], file: str = "changes") -> Self:
        """Check changes that come as plain data; `file` is only for messages.

        Raises:
            FileFormatError: Names the field.
        """
        return _checked(cls, dict(raw), file)


class WorldFile(_Entry):
    """A world as described by its file."""

    name: Name
    floor: Colour = "#b9a58a"
    walls: tuple[Wall, ...] = ()
    things: tuple[Thing, ...] = ()
    robots: tuple[RobotEntry, ...] = Field(min_length=1)

    @classmethod
    def load(cls, path: Path) -> Self:
        """Read a world file.

        Raises:
            FileFormatError: Names the file and the field.
        """
        try:
            return cls.parse(path.read_text(encoding="utf-8"), file=path.name)
        except OSError as error:
            raise FileFormatError(path.name, "", f"cannot be read: {error.strerror}") from error
        except UnicodeDecodeError as error:
            raise FileFormatError(path.name, "", f"is not UTF-8 text: {error.reason}") from error

    @classmethod
    def parse(cls, text: str, file: str = "world file") -> Self:
        """Read the YAML text of a world; `file` is only for messages.

        Raises:
            FileFormatError: Names the file and the field.
        """
        try:
            raw = yaml.safe_load(text)
        except yaml.YAMLError as error:
            raise FileFormatError(file, "", f"not valid YAML: {error}") from error
        return _checked(cls, raw, file)._consistent(file)

    def with_changes(self, changes: WorldChanges | Mapping[str, Any], file: str = "changes") -> Self:
        """This world after `changes`; `file` is only for messages.

        Raises:
            FileFormatError: A change is malformed or names something that is not in the world.
        """
        if not isinstance(changes, WorldChanges):
            changes = WorldChanges.parse(changes, file)
        self._check_names(changes, file)
        gone = set(changes.remove)
        # Every chain of `inside` is as long as there are things, at most.
        while more := {t.name for t in self.things if t.inside in gone} - gone:
            gone |= more
        things = [
            thing.model_copy(update={"pose": changes.move.get(thing.name, thing.pose)})
            for thing in self.things
            if thing.name not in gone
        ]
        robots = [
            robot.model_copy(
                update={
                    "pose": changes.move.get(robot.name, robot.pose),
                    "camera": changes.camera.get(robot.name, robot.camera),
                }
            )
            for robot in self.robots
        ]
        changed = self.model_copy(update={"things": (*things, *changes.add), "robots": tuple(robots)})
        return changed._consistent(file)

    def thing(self, name: str) -> Thing:
        """The thing of that name.

        Raises:
            KeyError: There is none.
        """
        for thing in self.things:
            if thing.name == name:
                return thing
        raise KeyError(name)

    def robot(self, name: str) -> RobotEntry:
        """The robot of that name.

        Raises:
            KeyError: There is none.
        """
        for robot in self.robots:
            if robot.name == name:
                return robot
        raise KeyError(name)

    def base_of(self, thing: Thing) -> Pose2D:
        """Where a thing's frame stands in the map frame."""
        own = Pose2D(*thing.pose)
        if thing.inside is None:
            return own
        holder = self.base_of(self.thing(thing.inside))
        cos, sin = math.cos(holder.yaw_rad), math.sin(holder.yaw_rad)
        return Pose2D(
            holder.x_m + cos * own.x_m - sin * own.y_m,
            holder.y_m + sin * own.x_m + cos * own.y_m,
            holder.yaw_rad + own.yaw_rad,
        )

    def object_map(self) -> ObjectMap:
        """The object map of everything listed."""
        return ObjectMap(tuple(self._map_object(thing) for thing in self.things if thing.listed))

    def _map_object(self, thing: Thing) -> MapObject:
        base = self.base_of(thing)
        extents = [solid.extent_m() for solid in thing.solids(base)]
        x_min, y_min = min(e[0] for e in extents), min(e[1] for e in extents)
        x_max, y_max = max(e[2] for e in extents), max(e[3] for e in extents)
        front = None if thing.front_rad is None else math.remainder(base.yaw_rad + thing.front_rad, math.tau)
        return MapObject(
            id=thing.name,
            description=thing.words,
            class_name=thing.class_name,
            x_m=round((x_min + x_max) / 2, 3),
            y_m=round((y_min + y_max) / 2, 3),
            width_m=round(x_max - x_min, 3),
            height_m=round(y_max - y_min, 3),
            aliases=thing.aliases,
            front_rad=None if front is None else round(front, 4),
        )

    def _check_names(self, changes: WorldChanges, file: str) -> None:
        things = {thing.name for thing in self.things}
        robots = {robot.name for robot in self.robots}
        for field, names, known in (
            ("remove", changes.remove, things),
            ("move", changes.move, things | robots),
            ("camera", changes.camera, robots),
        ):
            for name in names:
                if name not in known:
                    raise FileFormatError(file, f"{field}.{name}", f"the world {self.name!r} has no {name!r}")

    def _consistent(self, file: str) -> Self:
        """Check what one entry alone cannot know."""
        seen: set[str] = set()
        for kind, names in (
            ("things", [t.name for t in self.things]),
            ("robots", [r.name for r in self.robots]),
        ):
            for index, name in enumerate(names):
                if name in seen:
                    raise FileFormatError(file, f"{kind}[{index}].name", f"{name!r} is used twice")
                seen.add(name)
        for index, wall in enumerate(self.walls):
            if wall.start == wall.end:
                raise FileFormatError(file, f"walls[{index}].to", "the wall has no length")
        holders = {thing.name: thing.inside for thing in self.things}
        for index, thing in enumerate(self.things):
            chain = [thing.name]
            while (holder := holders[chain[-1]]) is not None:
                if holder not in holders or holder in chain:
                    problem = "contains itself" if holder in chain else "is not a thing of this world"
                    raise FileFormatError(file, f"things[{index}].inside", f"{holder!r} {problem}")
                chain.append(holder)
        return self


def _checked(kind: type[M], raw: Any, file: str) -> M:
    try:
        return kind.model_validate(raw)
    except ValidationError as error:
        first = error.errors(include_url=False, include_input=False)[0]
        where = "".join(f"[{p}]" if isinstance(p, int) else f".{p}" for p in first["loc"]).lstrip(".")
        raise FileFormatError(file, where, first["msg"]) from error


def _rgb(colour: str) -> tuple[int, int, int]:
    red, green, blue = ImageColor.getrgb(colour)[:3]
    return red, green, blue
