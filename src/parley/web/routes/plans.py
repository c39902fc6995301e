"""Controlling plans, deciding about proposals, editing."""

from __future__ import annotations

from typing import Annotated, Any, Final

from fastapi import APIRouter, Path

from parley.messages.chat import ChatAction, CommandName, SystemCommand
from parley.messages.status import PlanDecision
from parley.web.bodies import DecisionPost, Done, PlanCommandPost, PolicyPut, StepsPut
from parley.web.models import PlanView
from parley.web.problems import WebProblem
from parley.web.routes.access import Web, module

__all__ = ["router"]

router = APIRouter(prefix="/plans", tags=["plans"], dependencies=[module("plan")])

Robot = Annotated[str, Path(max_length=100)]

_COMMANDS: Final[dict[str, CommandName]] = {
    "pause": "stop",
    "resume": "start",
    "skip": "skip",
    "clear": "clear",
    "pop": "pop",
}


@router.get("/{robot}")
async def get_plans(robot: Robot, web: Web) -> list[PlanView]:
    """The plan of a robot and its other graphs."""
    name = web.robot(robot).name
    return [view for (owner, _), view in web.state.plans.views.items() if owner == name]


@router.post("/{robot}/command")
async def post_command(robot: Robot, post: PlanCommandPost, web: Web) -> Done:
    """Pause, go on, skip the step in progress, drop one step or everything."""
    name = web.robot(robot).name
    if post.command == "pop" and post.index is None:
        raise WebProblem(422, "It is not said which step.", "Say which step to drop.", path="index")
    arguments: dict[str, Any] = {"parameters": post.index} if post.command == "pop" else {}
    command = SystemCommand(command=_COMMANDS[post.command], arguments=arguments)
    web.link.send(ChatAction(system_cmd=(command,), targets=(name,)))
    return Done()


@router.post("/{robot}/decision")
async def post_decision(robot: Robot, post: DecisionPost, web: Web) -> Done:
    """Approve, reject or edit the steps that wait for a yes."""
    name = web.robot(robot).name
    proposal = web.state.plans.proposals.get(post.id)
    if proposal is None or proposal.robot != name or post.id in web.state.plans.decided:
        raise WebProblem(409, "This plan is no longer waiting for an answer.", path="id")
    web.link.send(PlanDecision(id=post.id, target=name, decision=post.decision, steps=post.steps))
    return Done()


@router.put("/{robot}/policy")
async def put_policy(robot: Robot, put: PolicyPut, web: Web) -> Done:
    """Decide whether new steps of the robot wait for a yes."""
    await web.set_policy(web.robot(robot).name, put.policy)
    return Done()


@router.put("/{robot}/steps")
async def put_steps(robot: Robot, put: StepsPut, web: Web) -> Done:
    """Replace all steps that have not begun; the plan shows whether that was taken."""
    name = web.robot(robot).name
    plan = next((v for v in web.state.plans.views.values() if v.robot == name and v.kind == "plan"), None)
    if plan is None:
        raise WebProblem(409, f"{name} has no plan to change.", "Tell it what to do first.")
    if web.state.plans.is_past(name, put.revision):
        raise WebProblem(
            409, "The plan has changed meanwhile.", "Look at it and change it again.", path="revision"
        )
    web.link.send(PlanDecision(target=name, decision="edit", steps=put.steps, revision=put.revision))
    return Done()
