"""WaitForRobot: begin when another robot has done its part."""

from __future__ import annotations

from parley.actions.ask_operator import ask_operator
from parley.actions.context import ActionContext
from parley.sentences import sentence
from parley.umrf.action import action

__all__ = ["wait_for_robot"]


@action(
    label="Wait until {robot} has done its part",
    effects=("waits",),
    kinds={"robot": "text", "order": "id"},
)
async def wait_for_robot(ctx: ActionContext, robot: str, order: str = "") -> None:
    """Wait until another robot has done its part; if it will not, a person is asked.

    Args:
        robot: The name of the other robot.
        order: Which part, as orders are called between robots; empty: all that it has to do.
    """
    warned = False
    while (outlook := ctx.mates.outlook(robot, order)) != "done":
        if outlook == "lost":
            question = sentence("{robot} has not done its part. Shall I begin all the same?", robot=robot)
            await ask_operator(ctx, question)
            return
        if outlook == "failed" and not warned:
            ctx.operator.tell(
                sentence("{robot} is in trouble with its part. I go on waiting for it.", robot=robot)
            )
        warned = outlook == "failed"
        await ctx.mates.changed()
    await ctx.run.wait_while_paused()
    ctx.operator.tell(sentence("{robot} has done its part, so I begin.", robot=robot))
