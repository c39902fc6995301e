"""Controlling plans, deciding about proposals, editing."""

from __future__ import annotations

from typing import Annotated, Any, Final

from fastapi import APIRouter, Path

from parley.gate.table import Effect
from parley.messages.chat import ChatAction, CommandName, SystemCommand
from parley.messages.status import PlanDecision
from parley.web.bodies import DecisionPost, Done, PlanCommandPost, PolicyPut, StepsPut
from parley.web.models import PlanView
from parley.web.problems import WebProblem
from parley.web.routes.access import Web, Who, may, module

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
_EFFECTS: Final[dict[str, Effect]] = {
    "pause": Effect.PAUSE,
    "resume": Effect.RESUME,
    "skip": Effect.EDIT,
    "clear": Effect.CLEAR,
    "pop": Effect.EDIT,
}
_DECIDES: Final[dict[str, Effect]] = {
    "approve": Effect.APPROVE,
    "reject": Effect.REJECT,
    "edit": Effect.APPROVE,
}
"""Whoever changes what waits and lets it begin says yes to it."""


@router.get("/{robot}", dependencies=[may(Effect.SEE)])
async def get_plans(robot: Robot, web: Web) -> list[PlanView]:
    """The plan of a robot and its other graphs."""
    name = web.robot(robot).name
    return [view for (owner, _), view in web.state.plans.views.items() if owner == name]


@router.post("/{robot}/command", dependencies=[may(*_EFFECTS.values())])
async def post_command(robot: Robot, post: PlanCommandPost, web: Web, who: Who) -> Done:
    """Pause, go on, skip the step in progress, drop one step or everything."""
    who.need(_EFFECTS[post.command])
    name = web.robot(robot).name
    if post.command == "pop" and post.index is None:
        raise WebProblem(422, "It is not said which step.", "Say which step to drop.", path="index")
    arguments: dict[str, Any] = {"parameters": post.index} if post.command == "pop" else {}
    step = web.state.plans.planned(name, post.index) if post.index is not None else post.step
    if post.command in ("skip", "pop") and step:
        arguments["step"] = step
    command = SystemCommand(command=_COMMANDS[post.command], arguments=arguments)
    await web.outbox.press(ChatAction(system_cmd=(command,), targets=(name,), by=who.by))
    return Done()


@router.post("/{robot}/decision", dependencies=[may(*_DECIDES.values())])
async def post_decision(robot: Robot, post: DecisionPost, web: Web, who: Who) -> Done:
    """Approve, reject or edit the steps that wait for a yes."""
    who.need(_DECIDES[post.decision])
    name = web.robot(robot).name
    proposal = web.state.plans.proposals.get(post.id)
    decision = PlanDecision(
        id=post.id,
        target=name,
        decision=post.decision,
        steps=post.steps,
        digest=post.digest,
        by=who.by,
    )
    if proposal is None or proposal.robot != name or post.id in web.state.plans.decided:
        if post.decision == "reject":
            await web.outbox.press(decision)  # somebody's yes was quicker: what it has begun is stopped
        elif post.id not in web.state.plans.decided and name in {
            one.robot for one in web.state.plans.proposals.values()
        }:
            raise WebProblem(
                409,
                "The plan has changed just now.",
                "Look at what waits for your yes and decide again.",
                path="id",
            )
        raise WebProblem(409, "This plan is no longer waiting for an answer.", path="id")
    if post.decision == "approve" and post.digest != proposal.digest:
        raise WebProblem(
            409, "This is not the plan that waits for a yes.", "Look at it and decide again.", path="digest"
        )
    await (web.outbox.press_through if post.decision == "edit" else web.outbox.press)(decision)
    return Done()


@router.put("/{robot}/policy", dependencies=[may(Effect.POLICY)])
async def put_policy(robot: Robot, put: PolicyPut, web: Web, who: Who) -> Done:
    """Decide whether new steps of the robot wait for a yes."""
    await web.set_policy(web.robot(robot).name, put.policy, who.by)
    return Done()


@router.put("/{robot}/steps", dependencies=[may(Effect.EDIT)])
async def put_steps(robot: Robot, put: StepsPut, web: Web, who: Who) -> Done:
    """Replace all steps that have not begun."""
    name = web.robot(robot).name
    plan = next((v for v in web.state.plans.views.values() if v.robot == name and v.kind == "plan"), None)
    if plan is None:
        raise WebProblem(409, f"{name} has no plan to change.", "Tell it what to do first.")
    if web.state.plans.is_past(name, put.revision):
        raise WebProblem(
            409, "The plan has changed meanwhile.", "Look at it and change it again.", path="revision"
        )
    edit = PlanDecision(
        target=name,
        decision="edit",
        steps=put.steps,
        revision=put.revision,
        undoes=put.undoes,
        by=who.by,
    )
    await web.outbox.press_through(edit)
    return Done()
