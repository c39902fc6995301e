"""What several robots do together: one yes for all parts; pause, go on and cancel for all or for one."""

from __future__ import annotations

from typing import Annotated, Final, Literal

from fastapi import APIRouter, Path
from starlette.responses import Response

from parley.agents.planner.mission_graph import mission_graph
from parley.gate.table import Effect
from parley.messages.chat import ChatAction, CommandName, SystemCommand
from parley.messages.status import PlanDecision
from parley.messages.team import OVER, MissionInfo, MissionPart
from parley.umrf.io import write_graph
from parley.web.backend import Backend
from parley.web.bodies import Done, MissionCommandPost
from parley.web.problems import WebProblem
from parley.web.routes.access import Web, Who, may, module

__all__ = ["router"]

router = APIRouter(prefix="/missions", tags=["plans"], dependencies=[module("plan")])

Identity = Annotated[str, Path(max_length=100)]

_COMMANDS: Final[dict[str, CommandName]] = {"pause": "stop", "resume": "start", "clear": "clear"}
_EFFECTS: Final[dict[str, Effect]] = {
    "pause": Effect.PAUSE,
    "resume": Effect.RESUME,
    "clear": Effect.CLEAR,
    "approve": Effect.APPROVE,
    "reject": Effect.REJECT,
}


@router.get("", dependencies=[may(Effect.SEE)])
async def get_missions(web: Web) -> list[MissionInfo]:
    """Those that go on, and the last that ended; oldest first."""
    return list(web.state.missions)


@router.get("/{identity}/graph", response_class=Response, dependencies=[may(Effect.SEE)])
async def get_mission_graph(identity: Identity, web: Web) -> Response:
    """All of it, as it was ordered, as one UMRF graph of several actors: a file for other programs."""
    mission = _named(identity, web)
    if mission is None:
        raise WebProblem(404, "Nothing of that is going on any more.", "Look at it again.")
    return Response(
        write_graph(mission_graph(mission)),
        media_type="application/json",
        headers={"Content-Disposition": f'attachment; filename="mission-{mission.id}.umrf.json"'},
    )


def _named(identity: str, web: Backend) -> MissionInfo | None:
    return next((one for one in web.state.missions if one.id == identity), None)


@router.post("/{identity}/command", dependencies=[may(*_EFFECTS.values())])
async def post_mission_command(identity: Identity, post: MissionCommandPost, web: Web, who: Who) -> Done:
    """Say yes or no to all parts at once; pause, go on with or cancel all of it, or one robot's part."""
    who.need(_EFFECTS[post.command])
    mission = _named(identity, web)
    parts = mission.parts if mission is not None else ()
    parts = tuple(part for part in parts if post.robot in ("", part.robot) and part.state not in OVER)
    if not parts:
        raise WebProblem(409, "Nothing of that is going on any more.", "Look at it again.")
    if post.command == "approve" or post.command == "reject":
        for decision in _decisions(post.command, parts, post, web):
            await web.outbox.press(decision.model_copy(update={"by": who.by}))
        return Done()
    for part in parts:
        arguments = {"order": part.order} if post.command == "clear" else {}
        command = SystemCommand(command=_COMMANDS[post.command], arguments=arguments)
        await web.outbox.press(ChatAction(system_cmd=(command,), targets=(part.robot,), by=who.by))
    return Done()


def _decisions(
    decision: Literal["approve", "reject"],
    parts: tuple[MissionPart, ...],
    post: MissionCommandPost,
    web: Web,
) -> list[PlanDecision]:
    """All or nothing: a part that is not as it was shown lets none begin."""
    waiting = [
        proposal
        for part in parts
        if (proposal := web.state.plans.proposals.get(part.proposal)) is not None
        and proposal.id not in web.state.plans.decided
    ]
    if not waiting:
        raise WebProblem(409, "This plan is no longer waiting for an answer.")
    if decision == "approve" and {one.id: one.digest for one in waiting} != post.shown:
        raise WebProblem(
            409, "This is not the plan that waits for a yes.", "Look at it and decide again.", path="shown"
        )
    return [
        PlanDecision(id=one.id, target=one.robot, decision=decision, digest=one.digest) for one in waiting
    ]
