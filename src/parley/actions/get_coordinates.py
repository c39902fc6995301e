"""GetCoordinates: from words to a free spot in front of the thing that is meant (thesis 5.1.1)."""

from __future__ import annotations

import asyncio
from dataclasses import dataclass
from typing import Final

from parley.actions.context import ActionContext
from parley.actions.pose import Pose
from parley.errors import ActionFailure, FailureCode, LanguageError
from parley.language.base import Grounding
from parley.umrf.action import action
from parley.world.approach import approach_pose
from parley.world.geometry import Pose2D
from parley.world.object_map import MapObject
from parley.world.whereabouts import called

__all__ = ["Coordinates", "get_coordinates", "spot_at"]

_TRIES: Final = 4


@dataclass(frozen=True, slots=True)
class Coordinates:
    """Where to stand."""

    pose: Pose
    """In the map frame, facing the object."""


@action(
    label="Find out where {target} is",
    effects=("locates",),
    pausable=False,
    kinds={"target": "place"},
    tests={
        "go to the yard": {"target": "yard"},
        "drive over to the loading gate": {"target": "loading gate"},
    },
)
async def get_coordinates(ctx: ActionContext, target: str) -> Coordinates:
    """Find where to stand to be at a thing or place that is described in words.

    Args:
        target: The thing or place, as people call it.
    """
    here = ctx.robot.pose()
    try:
        grounding = await ctx.language.ground(target, ctx.world.objects.places, here)
    except LanguageError as error:
        raise ActionFailure(FailureCode.UNAVAILABLE, "I cannot look up places just now.") from error
    thing = _single(target, grounding)
    spot = await spot_at(ctx, thing, here)
    if spot is None:
        side = "in" if thing.area else "in front of"
        raise ActionFailure(
            FailureCode.UNREACHABLE,
            f"I know {called(thing.description)}, but I see no free spot {side} it that I can get to.",
            {"target": target, "object": thing.id},
        )
    return Coordinates(Pose.of(spot))


async def spot_at(ctx: ActionContext, thing: MapObject, here: Pose2D) -> Pose2D | None:
    """A free spot, kept for this robot; another one if somebody took it while it was looked for."""
    spot = None
    for _ in range(_TRIES):
        with ctx.clock.hold():
            spot = await asyncio.to_thread(
                approach_pose,
                ctx.world.occupancy,
                thing,
                here,
                radius_m=ctx.robot.radius_m,
                taken=ctx.world.taken,
            )
        if spot is None or ctx.world.claim(spot):
            break
    return spot


def _single(target: str, grounding: Grounding) -> MapObject:
    """The one object that is meant.

    Raises:
        ActionFailure: `no_match` or `ambiguous`, with the candidates in its details.
    """
    if grounding.outcome == "match":
        return grounding.candidates[0]
    details = {
        "target": target,
        "candidates": [{"id": item.id, "description": item.description} for item in grounding.candidates],
    }
    if grounding.outcome == "ambiguous":
        names = _join([item.description for item in grounding.candidates])
        raise ActionFailure(FailureCode.AMBIGUOUS, f"Several places fit “{target}”: {names}.", details)
    raise ActionFailure(FailureCode.NO_MATCH, f"I do not know any “{target}” here.", details)


def _join(names: list[str]) -> str:
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} and {names[-1]}"
