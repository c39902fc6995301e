"""TakePicture: show what the camera sees now."""

from __future__ import annotations

from parley.actions.context import ActionContext
from parley.actions.inspect import FEED
from parley.umrf.action import Outcome, action

__all__ = ["take_picture"]


@action(
    label="Take a picture: {target}",
    phrases=("take a picture",),
    effects=("looks", "shows"),
    capabilities=("camera",),
    pausable=False,
    kinds={"target": "thing"},
    tests={"send me a photo": {}, "take a picture of the pump": {"target": "pump"}},
)
async def take_picture(ctx: ActionContext, target: str = "") -> Outcome:
    """Take a photo with the camera and show it.

    Args:
        target: What it is to show, if anything in particular.
    """
    where = (
        ctx.whereabouts()
    )  # before the picture: a base that is silent for a moment after it spoils nothing
    image = await ctx.robot.image()
    ctx.display.show(FEED, image, {"request": target or "picture"})
    ctx.operator.tell(f"Here is the picture, taken {where}.", image)
    seen = list(dict.fromkeys(detection.label for detection in image.detections or ()))
    return Outcome(facts={"seen": seen} if seen else {})
