"""NavigateTo: drive to a pose on the map (thesis 5.1.2)."""

from __future__ import annotations

import math
from typing import Final

from parley.actions.context import ActionContext
from parley.actions.pose import Pose
from parley.errors import ActionFailure, FailureCode
from parley.robots.base import NavigationControl
from parley.umrf.action import Outcome, action
from parley.world.object_map import ObjectMap
from parley.world.whereabouts import called

__all__ = ["TIMEOUT_S", "navigate_to"]

TIMEOUT_S: Final = 600.0
"""Robot time after which a drive counts as failed; long enough to cross a building at walking pace."""


@action(
    label="Go to {place}",
    phrases=("go to {place}", "drive to {place}", "move to {place}", "come to {place}"),
    effects=("moves",),
    capabilities=("drive",),
)
async def navigate_to(ctx: ActionContext, pose: Pose) -> Outcome:
    """Drive to a place and face the given way.

    Args:
        pose: Where to, in the map frame.
    """
    start = ctx.robot.pose()
    total_m = max(start.distance_to(pose.planar()), 0.1)

    left_m, waiting = total_m, ""

    def on_progress(remaining_m: float) -> None:
        nonlocal total_m, left_m
        total_m, left_m = max(total_m, remaining_m), remaining_m
        far = None if waiting else 1.0 - remaining_m / total_m
        ctx.run.progress(far, waiting or f"{remaining_m:.1f} m to go")

    def on_waiting(text: str) -> None:
        nonlocal waiting
        if waiting != text:
            waiting = text
            on_progress(left_m)

    control = NavigationControl(on_progress=on_progress, paused=lambda: ctx.run.paused, waits=on_waiting)
    try:
        arrived = await ctx.robot.navigate(pose.planar(), control, timeout_s=TIMEOUT_S)
    except ActionFailure as failure:
        raise _in_words(failure, ctx.world.objects) from failure
    return Outcome(facts={"pose": Pose.of(arrived)})


def _in_words(failure: ActionFailure, known: ObjectMap) -> ActionFailure:
    """The same failure with the place where the way is blocked named by what people know there."""
    at = failure.details.get("at")
    if failure.code is not FailureCode.BLOCKED or not isinstance(at, dict) or not known.objects:
        return failure
    nearest = min(known.objects, key=lambda item: math.hypot(item.x_m - at["x"], item.y_m - at["y"]))
    text = f"Something is in the way by {called(nearest.description)}, and I found no way around it."
    return ActionFailure(failure.code, text, {**failure.details, "near": nearest.id})
