"""Dock: drive to a charging dock and charge there."""

from __future__ import annotations

from typing import Final

from parley.actions.context import ActionContext
from parley.actions.get_coordinates import spot_at
from parley.actions.navigate_to import navigate_to
from parley.actions.pose import Pose
from parley.errors import ActionFailure, FailureCode
from parley.sentences import sentence
from parley.umrf.action import action

__all__ = ["dock"]

_WITHIN_S: Final = 60.0
"""So long after it stands there a battery may tell the same as before."""
_LOOK_S: Final = 1.0
_FULL: Final = 0.99


@action(
    label="Charge the battery",
    effects=("moves",),
    capabilities=("drive", "charges"),
    tests={
        "go and charge": {},
        "charge your battery": {},
        "don't charge now": None,
    },
)
async def dock(ctx: ActionContext) -> None:
    """Charge the battery at the charging dock."""
    await navigate_to(ctx, await _pose_at_dock(ctx))
    before = ctx.robot.battery()
    if before is None:
        return
    began_s = ctx.clock.now_s()
    while (now := ctx.robot.battery() or 0.0) <= before and now < _FULL:
        if ctx.clock.now_s() - began_s > _WITHIN_S:
            text = sentence("I stand at the charging dock, but my battery does not charge.")
            raise ActionFailure(FailureCode.HARDWARE, text)
        await ctx.run.wait_while_paused()
        await ctx.clock.sleep(_LOOK_S)
    ctx.operator.tell(sentence("I am charging. My battery is {number} % full.", number=str(round(100 * now))))


async def _pose_at_dock(ctx: ActionContext) -> Pose:
    """Where to stand to charge: at the nearest dock.

    Raises:
        ActionFailure: `no_match`: no dock is known; `unreachable`: there is none that it can get to.
    """
    here = ctx.robot.pose()
    docks = [item for item in ctx.world.objects.objects if item.charges]
    if not docks:
        text = sentence("I know of no charging dock here. Where can I charge?")
        raise ActionFailure(FailureCode.NO_MATCH, text, {"target": "charging dock"})
    for one in sorted(docks, key=lambda item: item.gap_m(here.x_m, here.y_m)):
        spot = await spot_at(ctx, one, here)
        if spot is not None:
            return Pose.of(spot)
    text = sentence("I see no way to a charging dock.")
    raise ActionFailure(FailureCode.UNREACHABLE, text, {"target": "charging dock"})
