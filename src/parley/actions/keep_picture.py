"""KeepPicture: remember what the camera sees now as a picture with a name."""

from __future__ import annotations

from typing import Final

from parley.actions.context import ActionContext
from parley.actions.inspect import FEED
from parley.umrf.action import action

__all__ = ["UNNAMED", "keep_picture"]

UNNAMED: Final = "what I saw"
"""What a picture is called that nobody gave a name."""


@action(
    label="Keep a picture of what I see: {name}",
    phrases=(
        "keep the picture as {name}",
        "keep this picture as {name}",
        "keep a picture as {name}",
        "keep a picture of {name}",
        "keep the picture",
        "keep this picture",
        "remember what you see",
        "remember this view",
    ),
    effects=("remembers",),
    capabilities=("camera",),
    pausable=False,
)
async def keep_picture(ctx: ActionContext, name: str = "") -> None:
    """Take a picture of what is in front and remember it, so that it can be shown again.

    Args:
        name: What the picture is called; one of the same name is replaced.
    """
    where = ctx.whereabouts()
    image = await ctx.robot.image()
    called = name.strip() or UNNAMED
    ctx.display.show(FEED, image, {"request": called})
    ctx.remember_picture(called, image, info=f"{called}, {where}")
    ctx.operator.tell(f"I keep this picture as “{called}”.", image)
