"""The emergency stop and its reset. Stops are answered by the `StopDesk` before they come here."""

from __future__ import annotations

import uuid

from fastapi import APIRouter

from parley.gate.table import Effect
from parley.web.bodies import StopAnswer, StopPost
from parley.web.problems import WebProblem
from parley.web.routes.access import Web, Who, may

__all__ = ["router"]

router = APIRouter(prefix="/stop", tags=["stop"])


@router.post("", dependencies=[may(Effect.STOP, Effect.RESET)])
async def post_stop(post: StopPost, web: Web, who: Who) -> StopAnswer:
    """Send an emergency stop or its reset; what became of it is in each robot's `stop`."""
    who.need(Effect.STOP if post.command == "stop" else Effect.RESET)
    key, by = post.id or uuid.uuid4().hex, who.by
    if post.command == "stop":
        return StopAnswer(id=key, robots=web.stopper.states(web.stopper.stop(post.targets, by=by, id=key)))
    refused = web.stopper.reset(post.targets, by=by, id=key)
    if refused:
        raise WebProblem(409, refused[:1].upper() + refused[1:] + ".", "Look at the robots, and try again.")
    return StopAnswer(id=key, robots={})
