"""Wait: stand by for a while."""

from __future__ import annotations

from typing import Final

from parley.actions.context import ActionContext
from parley.errors import ActionFailure, FailureCode
from parley.umrf.action import action

__all__ = ["LONGEST_S", "wait"]

LONGEST_S: Final = 24 * 3600.0
_SLICE_S: Final = 1.0


@action(
    label="Wait for {duration} seconds",
    effects=("waits",),
    kinds={"duration": "duration"},
    units={"duration": "seconds"},
    tests={"wait for ten minutes": {"duration": 600}, "wait 30 seconds": {"duration": 30}},
)
async def wait(ctx: ActionContext, duration: float) -> None:
    """Wait for some time; a pause does not count.

    Args:
        duration: How long, in seconds.
    """
    if not 0 < duration <= LONGEST_S:
        text = f"I can wait for up to {LONGEST_S / 3600:.0f} hours, not for {duration:g} seconds."
        raise ActionFailure(FailureCode.NOT_CAPABLE, text, {"duration": duration})
    left_s = duration
    while left_s > 0:
        await ctx.run.wait_while_paused()
        began_s = ctx.clock.now_s()
        await ctx.clock.sleep(min(_SLICE_S, left_s))
        left_s -= ctx.clock.now_s() - began_s
        ctx.run.progress(min(1.0, 1.0 - left_s / duration), f"{max(0.0, left_s):.0f} s to go")
