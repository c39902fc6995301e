"""The emergency stop, which nothing else delays."""

from __future__ import annotations

import uuid

from fastapi import APIRouter

from parley.gate.table import Effect
from parley.messages.status import StopCommand
from parley.web.bodies import Done, StopPost
from parley.web.routes.access import Web, Who, may

__all__ = ["router"]

router = APIRouter(prefix="/stop", tags=["stop"])


@router.post("", dependencies=[may(Effect.STOP, Effect.RESET)])
async def post_stop(post: StopPost, web: Web, who: Who) -> Done:
    """Send an emergency stop or its reset; what became of it is in each robot's `stop`."""
    who.need(Effect.STOP if post.command == "stop" else Effect.RESET)
    named = tuple(web.state.robots.resolve(name) or name for name in post.targets)
    stop = StopCommand(command=post.command, targets=named, id=post.id or uuid.uuid4().hex, by=who.by)
    web.link.send(stop)
    return Done()
