"""What the arguments of actions mean on the map."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable, Mapping, Sequence
from typing import Any, Final, Protocol

from parley.clock import Clock
from parley.errors import LanguageError
from parley.gate.judge import Place, PlannedStep
from parley.messages.chat import ActionCall
from parley.messages.status import ActionInfo
from parley.world.approach import approach_pose
from parley.world.geometry import Pose2D
from parley.world.object_map import MapObject
from parley.world.occupancy import OccupancyMap

__all__ = ["Ground", "Grounded", "Resolver", "place_in"]

_X: Final = "position::x"
_Y: Final = "position::y"


class Grounded(Protocol):
    """Which objects a description means (`parley.language.base.Grounding`)."""

    @property
    def outcome(self) -> str:
        """`match` if it is one."""
        ...

    @property
    def candidates(self) -> Sequence[MapObject]:
        """One for a match."""
        ...


Ground = Callable[[str, Sequence[MapObject], Pose2D | None], Awaitable[Grounded]]
"""How actions find what is meant by words: `Language.ground`."""


def place_in(values: Mapping[str, Any]) -> Place | None:
    """The point that stands among arguments, by flat name; None if there is none."""
    for name, x in values.items():
        if name == _X or name.endswith("::" + _X):
            y = values.get(name[: -len(_X)] + _Y)
            if isinstance(x, int | float) and isinstance(y, int | float):
                return Place(float(x), float(y))
    return None


def _names_a_point(names: Mapping[str, Any]) -> bool:
    return any(name == _X or name.endswith("::" + _X) for name in names)


class Resolver:
    """Finds where each step of a plan leads, one after the other, as the actions themselves would.

    Args:
        ground: How words are matched with objects.
        objects: What is on the map.
        occupancy: The map.
        radius_m: Of the robot.
        clock: Held while it computes.
    """

    def __init__(
        self,
        ground: Ground,
        objects: Sequence[MapObject],
        occupancy: OccupancyMap,
        *,
        radius_m: float,
        clock: Clock,
    ) -> None:
        self._ground, self._objects, self._map = ground, objects, occupancy
        self._radius_m, self._clock = radius_m, clock

    async def resolve(
        self, calls: Sequence[ActionCall], catalogue: Sequence[ActionInfo], pose: Pose2D | None
    ) -> tuple[PlannedStep, ...]:
        """The steps, each with the place it leads to or that it hands on."""
        infos = {info.name: info for info in catalogue}
        steps: list[PlannedStep] = []
        handed: Place | None = None
        here = pose
        for call in calls:
            info = infos.get(call.name)
            place = await self._place(call, info, here, handed)
            steps.append(PlannedStep(call, info, place))
            if place is not None and (info is None or _names_a_point(info.outputs)):
                handed = place
            elif place is not None:
                here = Pose2D(place.x, place.y)
        return tuple(steps)

    async def _place(
        self, call: ActionCall, info: ActionInfo | None, here: Pose2D | None, handed: Place | None
    ) -> Place | None:
        values = {name: item.value for name, item in call.input_parameters.items() if item.has_data}
        given = place_in(values)
        if given is not None:
            return given
        if _names_a_point(call.input_parameters) or (info is not None and _names_a_point(info.inputs)):
            return handed
        locates = info is not None and (_names_a_point(info.outputs) or "moves" in info.effects)
        if not locates:
            return None
        for value in values.values():
            if isinstance(value, str) and (found := await self.find(value, here)) is not None:
                return found
        return None

    async def find(self, words: str, here: Pose2D | None) -> Place | None:
        """Where the robot would stand for what is described; the thing itself if no such spot is known."""
        try:
            grounding = await self._ground(words, self._objects, here)
        except LanguageError:
            return None
        if grounding.outcome != "match":
            return None
        thing = grounding.candidates[0]
        spot = None
        if here is not None:
            with self._clock.hold():
                spot = await asyncio.to_thread(approach_pose, self._map, thing, here, radius_m=self._radius_m)
        wide, high = thing.width_m / 2, thing.height_m / 2
        outline = thing.x_m - wide, thing.y_m - high, thing.x_m + wide, thing.y_m + high
        at = spot if spot is not None else thing
        return Place(at.x_m, at.y_m, thing.id, outline)
