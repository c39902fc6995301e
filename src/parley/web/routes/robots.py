"""Who is there."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Path

from parley.gate.table import Effect
from parley.web.bodies import Done, RobotPost
from parley.web.models import RobotView
from parley.web.routes.access import Web, Who, may, module

__all__ = ["router"]

router = APIRouter(prefix="/robots", tags=["robots"], dependencies=[module("robots")])

Name = Annotated[str, Path(max_length=100)]


@router.get("", dependencies=[may(Effect.SEE)])
async def get_robots(web: Web) -> list[RobotView]:
    """All robots."""
    return list(web.state.robots.views.values())


@router.post("", dependencies=[may(Effect.SETTING)])
async def post_robot(post: RobotPost, web: Web, who: Who) -> RobotView:
    """List a robot by name; it is listed until somebody takes it off, whether or not it is there."""
    added = await web.add_robot(post.name)
    who.note(Effect.SETTING, f"added the robot {added.name}")
    return added


@router.get("/{name}", dependencies=[may(Effect.SEE)])
async def get_robot(name: Name, web: Web) -> RobotView:
    """One robot."""
    return web.robot(name)


@router.delete("/{name}", dependencies=[may(Effect.SETTING)])
async def delete_robot(name: Name, web: Web, who: Who) -> Done:
    """Take a robot off the list that is not there."""
    await web.remove_robot(name)
    who.note(Effect.SETTING, f"removed the robot {name}")
    return Done()
