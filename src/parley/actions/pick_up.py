"""PickUp: look for a thing, and take it into the hand."""

from __future__ import annotations

from parley.actions.context import ActionContext
from parley.actions.inspect import FEED, not_seen
from parley.errors import ActionFailure, FailureCode, LanguageError
from parley.robots.base import Arm
from parley.sentences import listed, sentence
from parley.umrf.action import action

__all__ = ["arm_of", "pick_up"]


@action(
    label="Pick up: {thing}",
    effects=("grasps",),
    capabilities=("camera", "arm"),
    pausable=False,
    kinds={"thing": "thing"},
    tests={
        "pick up the box": {"thing": "box"},
        "grab the red crate": {"thing": "red crate"},
        "don't pick up the box": None,
    },
)
async def pick_up(ctx: ActionContext, thing: str) -> None:
    """Pick up a thing that is in front.

    Args:
        thing: What to take.
    """
    arm = arm_of(ctx)
    image = await ctx.robot.image()
    ctx.display.show(FEED, image, {"request": thing})
    try:
        report = await ctx.language.inspect(image, f"whether there is a {thing}")
    except LanguageError as error:
        text = sentence("I took the picture, but I cannot tell what is in it just now.")
        raise ActionFailure(FailureCode.UNAVAILABLE, text) from error
    if not report.things:
        raise not_seen(image, thing, report.text, ctx.world.objects)
    if len(report.things) > 1:
        names = [found.label for found in report.things]
        text = sentence("I see several: {names}. Which one shall I take?", names=listed(names))
        raise ActionFailure(FailureCode.AMBIGUOUS, text, {"target": thing, "candidates": names})
    await arm.pick_up(report.things[0])
    for item in ctx.world.objects.objects:
        if item.found and item.description == arm.holds:  # it does not lie where it was found
            await ctx.world.forget(item)
    ctx.operator.tell(sentence("I have the {thing} in my hand.", thing=arm.holds))


def arm_of(ctx: ActionContext) -> Arm:
    """The robot's arm.

    Raises:
        ActionFailure: `not_capable`: it has none.
    """
    arm = ctx.robot.arm
    if arm is None:
        text = sentence("I have no arm. I can go there and tell you what I see.")
        raise ActionFailure(FailureCode.NOT_CAPABLE, text)
    return arm
