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

What happens there by itself stands under `events` (see `parley.sim.events`).

Metres and radians in the map frame. Unknown keys are refused, and every error names the file and the field.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping
from typing import Any, Final, Self

from pydantic import Field

from parley.errors import FileFormatError
from parley.files import TextFile, parse_yaml, validated
from parley.sim.entries import Area, Colour, Entry, Name, RobotEntry, RobotState, Thing, Wall, WorldChanges
from parley.sim.events import WorldEvent
from parley.world.geometry import Pose2D
from parley.world.object_map import MapArea, MapObject, ObjectMap

__all__ = ["RobotEntry", "Thing", "WorldChanges", "WorldFile"]


_MAX_AREA_M2: Final = 100_000
_MAX_INSIDE: Final = 50
_PAINT_M: Final = 0.01
"""What is no higher is driven over."""


class WorldFile(Entry, TextFile):
    """A world as described by its file."""

    name: Name
    floor: Colour = "#b9a58a"
    walls: tuple[Wall, ...] = ()
    areas: tuple[Area, ...] = ()
    things: tuple[Thing, ...] = ()
    robots: tuple[RobotEntry, ...] = Field(min_length=1)
    standby: tuple[RobotEntry, ...] = ()
    """More robots, in it only where they are wanted (`with_robots`)."""
    events: tuple[WorldEvent, ...] = ()
    """What happens in it by itself."""

    @classmethod
    def parse(cls, text: str, file: str = "world file") -> Self:
        """Read the YAML text of a world; `file` is only for messages.

        Raises:
            FileFormatError: Names the file and the field.
        """
        world = validated(cls, parse_yaml(text, file), file)._consistent(file)
        world._check_standby(file)
        world._check_starts(file)
        world._check_events(file)
        return world

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
                update={"pose": changes.move.get(robot.name, robot.pose)} | _told(changes, robot.name)
            )
            for robot in self.robots
        ]
        events = tuple(event for event in self.events if event.name not in changes.cancel)
        changed = self.model_copy(
            update={"things": (*things, *changes.add), "robots": tuple(robots), "events": events}
        )
        return changed._consistent(file)

    def with_robots(self, names: Collection[str], file: str = "robots") -> Self:
        """This world with these of its robots, those that stand by among them; `file` is only for messages.

        Raises:
            FileFormatError: It has no robot of that name, none is named, or an event is about one left out.
        """
        everybody = (*self.robots, *self.standby)
        known = [robot.name for robot in everybody]
        for name in names:
            if name not in known:
                raise FileFormatError(file, name, f"the world {self.name!r} has: {', '.join(known)}")
        if not names:
            raise FileFormatError(file, "robots", "there must be one at least")
        here = tuple(robot for robot in everybody if robot.name in names)
        away = tuple(robot for robot in everybody if robot.name not in names)
        world = self.model_copy(update={"robots": here, "standby": away})
        world._check_events(file)
        return world

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

    def with_poses(self, poses: Mapping[str, Pose2D]) -> Self:
        """This world with things standing elsewhere."""
        things = tuple(
            thing.model_copy(update={"pose": (pose.x_m, pose.y_m, pose.yaw_rad)})
            if pose is not None
            else thing
            for thing, pose in ((thing, poses.get(thing.name)) for thing in self.things)
        )
        return self.model_copy(update={"things": things})

    def with_models(self, model: str) -> Self:
        """This world with other robots of the same names.

        Raises:
            FileFormatError: There is no such model.
        """
        robots = [robot.model_dump(exclude={"model"}) | {"model": model} for robot in self.robots]
        return self.model_copy(
            update={"robots": tuple(validated(RobotEntry, robot, "model") for robot in robots)}
        )

    def in_hand(self, robot: str) -> Thing | None:
        """What a robot carries."""
        return next((thing for thing in self.things if thing.held_by == robot), None)

    def carrier_of(self, thing: Thing) -> str | None:
        """The robot that carries a thing, or what it stands in."""
        while thing.inside is not None:
            thing = self.thing(thing.inside)
        return thing.held_by

    def standing(self) -> tuple[Thing, ...]:
        """The things that no robot carries."""
        return tuple(thing for thing in self.things if self.carrier_of(thing) is None)

    def with_thing(self, thing: Thing) -> Self:
        """This world with a thing as it is now."""
        things = tuple(thing if other.name == thing.name else other for other in self.things)
        return self.model_copy(update={"things": things})

    def base_of(self, thing: Thing) -> Pose2D:
        """Where a thing's frame stands in the map frame, or in that of the robot that carries it."""
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
        areas = tuple(MapArea(area.name, area.corners, area.capacity) for area in self.areas)
        return ObjectMap(tuple(self._map_object(thing) for thing in self.things if thing.listed), areas)

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
        held = tuple(thing.held_by for thing in changes.add if thing.held_by)
        for field, names, known in (
            ("add.held_by", held, robots),
            ("remove", changes.remove, things),
            ("move", changes.move, things | robots),
            ("robots", changes.robots, robots),
            ("cancel", changes.cancel, {event.name for event in self.events}),
        ):
            for name in names:
                if name not in known:
                    raise FileFormatError(file, f"{field}.{name}", f"the world {self.name!r} has no {name!r}")

    def in_the_way(self, robot: RobotEntry, room_m: float = 0.0) -> str:
        """What is nearer than `room_m` to a robot where it starts, or in it; empty: nothing."""
        solids = [
            (f"walls[{index}]", solid) for index, wall in enumerate(self.walls) for solid in wall.solids()
        ]
        solids += [
            (thing.name, solid) for thing in self.things for solid in thing.solids(self.base_of(thing))
        ]
        reach_m = robot.model.radius_m + room_m
        near = (
            name
            for name, solid in solids
            if solid.z_m < robot.model.height_m
            and solid.z_m + solid.size_m[2] > _PAINT_M
            and solid.distance_m(robot.pose[0], robot.pose[1]) < reach_m
        )
        return next(near, "")

    def _check_starts(self, file: str) -> None:
        """Refuse robots that start inside something: physics would throw them about."""
        for field, robots in (("robots", self.robots), ("standby", self.standby)):
            for index, robot in enumerate(robots):
                if name := self.in_the_way(robot):
                    raise FileFormatError(
                        file, f"{field}[{index}].pose", f"{robot.name!r} would start in {name!r}"
                    )

    def _check_standby(self, file: str) -> None:
        """Refuse a name that two robots would have."""
        seen = {robot.name for robot in self.robots}
        for index, robot in enumerate(self.standby):
            if robot.name in seen:
                raise FileFormatError(file, f"standby[{index}].name", f"{robot.name!r} is used twice")
            seen.add(robot.name)

    def _check_events(self, file: str) -> None:
        """Refuse events that cannot happen: what they change has to be there, one after the other."""
        world, earlier = self, set[str]()
        for index, event in enumerate(self.events):
            field = f"events[{index}]"
            if event.name in earlier:
                raise FileFormatError(file, f"{field}.name", f"{event.name!r} is used twice")
            if event.after is not None and event.after not in earlier:
                raise FileFormatError(file, f"{field}.after", f"no earlier event is called {event.after!r}")
            near = event.near
            if near is not None and near.thing not in {thing.name for thing in world.things}:
                raise FileFormatError(file, f"{field}.near.thing", f"the world has no {near.thing!r}")
            if near is not None and near.robot not in ("", *(robot.name for robot in self.robots)):
                raise FileFormatError(file, f"{field}.near.robot", f"the world has no robot {near.robot!r}")
            world = world.with_changes(event.change, f"{file}: {field}.change")
            earlier.add(event.name)

    def _consistent(self, file: str) -> Self:
        """Check what one entry alone cannot know."""
        self._check_unique(file)
        self._check_walls(file)
        self._check_holders(file)
        self._check_extent(file)
        return self

    def _check_extent(self, file: str) -> None:
        """The map of a world is drawn in cells."""
        solids = [(f"walls[{at}]", each) for at, wall in enumerate(self.walls) for each in wall.solids()]
        for at, thing in enumerate(self.things):
            solids += [(f"things[{at}]", each) for each in thing.solids(self.base_of(thing))]
        x_min = y_min = math.inf
        x_max = y_max = -math.inf
        for field, solid in solids:
            low_x, low_y, high_x, high_y = solid.extent_m()
            x_min, y_min, x_max, y_max = (
                min(x_min, low_x),
                min(y_min, low_y),
                max(x_max, high_x),
                max(y_max, high_y),
            )
            if (x_max - x_min) * (y_max - y_min) > _MAX_AREA_M2:
                raise FileFormatError(file, field, f"the world is larger than {_MAX_AREA_M2:,} square metres")

    def _check_unique(self, file: str) -> None:
        seen: set[str] = set()
        things, robots = [thing.name for thing in self.things], [robot.name for robot in self.robots]
        areas = [area.name for area in self.areas]
        for kind, names in (("things", things), ("robots", robots), ("areas", areas)):
            for index, name in enumerate(names):
                if name in seen:
                    raise FileFormatError(file, f"{kind}[{index}].name", f"{name!r} is used twice")
                seen.add(name)

    def _check_walls(self, file: str) -> None:
        for index, wall in enumerate(self.walls):
            if wall.length_m == 0.0:
                raise FileFormatError(file, f"walls[{index}].to", "the wall has no length")
            for number, door in enumerate(wall.doorways):
                if not door.width_m / 2 <= door.at_m <= wall.length_m - door.width_m / 2:
                    problem = f"the doorway does not fit into a wall of {wall.length_m:.2f} m"
                    raise FileFormatError(file, f"walls[{index}].doorways[{number}].at_m", problem)

    def _check_holders(self, file: str) -> None:
        holders = {thing.name: thing.inside for thing in self.things}
        for index, thing in enumerate(self.things):
            chain = [thing.name]
            while (holder := holders[chain[-1]]) is not None:
                if len(chain) > _MAX_INSIDE:
                    problem = f"stands inside more than {_MAX_INSIDE} other things"
                    raise FileFormatError(file, f"things[{index}].inside", problem)
                if holder not in holders or holder in chain:
                    problem = "contains itself" if holder in chain else "is not a thing of this world"
                    raise FileFormatError(file, f"things[{index}].inside", f"{holder!r} {problem}")
                chain.append(holder)


def _told(changes: WorldChanges, robot: str) -> dict[str, Any]:
    """What of a robot's state changes."""
    state = changes.robots.get(robot, RobotState())
    return {name: getattr(state, name) for name in state.model_fields_set}
