"""The emergency stop, which nothing else delays."""

from __future__ import annotations

import uuid

from fastapi import APIRouter

from parley.messages.principal import person
from parley.messages.status import StopCommand
from parley.web.bodies import Done, StopPost
from parley.web.routes.access import Web

__all__ = ["router"]

router = APIRouter(prefix="/stop", tags=["stop"])


@router.post("")
async def post_stop(post: StopPost, web: Web) -> Done:
    """Send an emergency stop or its reset; what became of it is in each robot's `stop`."""
    named = tuple(web.state.robots.resolve(name) or name for name in post.targets)
    by = person(device="page")
    web.link.send(StopCommand(command=post.command, targets=named, id=post.id or uuid.uuid4().hex, by=by))
    return Done()
