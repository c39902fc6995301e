"""Who is there."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Path

from parley.web.bodies import Done, RobotPost
from parley.web.models import RobotView
from parley.web.routes.access import Web, module

__all__ = ["router"]

router = APIRouter(prefix="/robots", tags=["robots"], dependencies=[module("robots")])

Name = Annotated[str, Path(max_length=100)]


@router.get("")
async def get_robots(web: Web) -> list[RobotView]:
    """All robots."""
    return list(web.state.robots.views.values())


@router.post("")
async def post_robot(post: RobotPost, web: Web) -> RobotView:
    """List a robot by name; it is listed until somebody takes it off, whether or not it is there."""
    return await web.add_robot(post.name)


@router.get("/{name}")
async def get_robot(name: Name, web: Web) -> RobotView:
    """One robot."""
    return web.robot(name)


@router.delete("/{name}")
async def delete_robot(name: Name, web: Web) -> Done:
    """Take a robot off the list that is not there."""
    await web.remove_robot(name)
    return Done()
