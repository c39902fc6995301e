"""Place: put down what is in the hand."""

from __future__ import annotations

import math
from typing import Final

from parley.actions.context import ActionContext
from parley.actions.pick_up import arm_of
from parley.errors import ActionFailure, FailureCode
from parley.sentences import sentence
from parley.umrf.action import action
from parley.world.object_map import MapObject
from parley.world.whereabouts import called

__all__ = ["place"]

_INSIDE_M: Final = 0.15
"""So far from the edge of what it stands on."""
_WITHIN_M: Final = 1.0
"""From the robot's edge."""


@action(
    label="Put down: {thing}",
    effects=("places",),
    capabilities=("arm",),
    pausable=False,
    kinds={"thing": "thing"},
    tests={
        "put the box down": {"thing": "box"},
        "put down the red crate": {"thing": "red crate"},
        "don't put the box down": None,
    },
)
async def place(ctx: ActionContext, thing: str = "") -> None:
    """Put down what is in the hand.

    Args:
        thing: What to put down; what is in the hand, if not said.
    """
    arm = arm_of(ctx)
    held = arm.holds
    if not held:
        raise ActionFailure(
            FailureCode.NOT_CAPABLE, sentence("I have nothing in my hand."), {"wanted": thing}
        )
    here = ctx.robot.pose()
    ahead = [
        item
        for item in ctx.world.objects.objects
        if item.gap_m(here.x_m, here.y_m) <= ctx.robot.radius_m + _WITHIN_M and item.width_m * item.height_m
    ]
    if not ahead:
        text = sentence("There is nothing here to put the {thing} on. Where shall I put it?", thing=held)
        raise ActionFailure(FailureCode.UNREACHABLE, text, {"target": held})
    on = min(ahead, key=lambda item: _aside(item, here.x_m, here.y_m, here.yaw_rad))
    await arm.put_down(*_spot(on, here.x_m, here.y_m))
    what = sentence("I have put the {thing} on {place}.", thing=held, place=called(on.description))
    ctx.operator.tell(what)


def _aside(item: MapObject, x_m: float, y_m: float, yaw_rad: float) -> float:
    """How far the nearest of a thing is off the way in which a robot looks."""
    near_x, near_y = _edge(item, x_m, y_m)
    return abs(math.remainder(math.atan2(near_y - y_m, near_x - x_m) - yaw_rad, math.tau))


def _edge(item: MapObject, x_m: float, y_m: float) -> tuple[float, float]:
    half_x, half_y = item.width_m / 2, item.height_m / 2
    return (
        min(max(x_m, item.x_m - half_x), item.x_m + half_x),
        min(max(y_m, item.y_m - half_y), item.y_m + half_y),
    )


def _spot(item: MapObject, x_m: float, y_m: float) -> tuple[float, float]:
    """A little in from the edge that is nearest, towards the middle."""
    near_x, near_y = _edge(item, x_m, y_m)
    way_m = math.hypot(item.x_m - near_x, item.y_m - near_y)
    share = min(1.0, _INSIDE_M / way_m) if way_m else 1.0
    return near_x + (item.x_m - near_x) * share, near_y + (item.y_m - near_y) * share
