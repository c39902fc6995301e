"""NavigateTo: drive to a pose on the map (thesis 5.1.2)."""

from __future__ import annotations

from typing import Final

from parley.actions.context import ActionContext
from parley.actions.pose import Pose
from parley.robots.base import NavigationControl
from parley.umrf.action import action
from parley.world.geometry import Pose2D

__all__ = ["TIMEOUT_S", "navigate_to"]

TIMEOUT_S: Final = 600.0
"""Robot time after which a drive counts as failed; long enough to cross a building at walking pace."""


@action(
    phrases=("go to {place}", "drive to {place}", "move to {place}", "come to {place}"),
    effects=("moves",),
    capabilities=("drive",),
)
async def navigate_to(ctx: ActionContext, pose: Pose) -> None:
    """Drive to a place and face the given way.

    Args:
        pose: Where to, in the map frame.
    """
    start = ctx.robot.pose()
    total_m = max(start.distance_to(pose.planar()), 0.1)

    def on_progress(remaining_m: float) -> None:
        nonlocal total_m
        total_m = max(total_m, remaining_m)
        ctx.run.progress(1.0 - remaining_m / total_m, f"{remaining_m:.1f} m")

    control = NavigationControl(on_progress=on_progress, paused=lambda: ctx.run.paused)
    arrived = await ctx.robot.navigate(pose.planar(), control, timeout_s=TIMEOUT_S)
    ctx.run.progress(1.0, _where(arrived))


def _where(pose: Pose2D) -> str:
    return f"x {pose.x_m:.2f} m, y {pose.y_m:.2f} m"
