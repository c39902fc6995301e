"""Who did what."""

from __future__ import annotations

from typing import Annotated, Final

from fastapi import APIRouter, Query

from parley.errors import UnavailableError
from parley.gate.audit_text import told
from parley.gate.table import Effect
from parley.messages import topics
from parley.messages.audit import AuditList, GetAudit
from parley.sentences import SpokenLanguage, in_language
from parley.web.backend import Backend
from parley.web.models import LogLine, LogPage
from parley.web.problems import WebProblem
from parley.web.routes.access import Web, may, module

__all__ = ["Moment", "Part", "ask_log", "router"]

router = APIRouter(prefix="/audit", tags=["log"], dependencies=[module("log"), may(Effect.AUDIT)])

_LONGEST: Final = 200
Part = Annotated[str, Query(max_length=_LONGEST)]
Moment = Annotated[int, Query(ge=0, le=2**53)]


@router.get("")
async def get_log(
    web: Web,
    robot: Part = "",
    by: Part = "",
    effect: Annotated[str, Query(max_length=50)] = "",
    q: Part = "",
    since: Moment = 0,
    until: Moment = 0,
    before: Moment = 0,
    limit: Annotated[int, Query(ge=1, le=500)] = 100,
    verify: bool = False,
    language: SpokenLanguage = "en",
) -> LogPage:
    """Entries, newest first, in sentences of a language; `before` is a number and leads on to older ones."""
    wanted = GetAudit(
        robot=robot, by=by, effect=effect, text=q, since_unix_ms=since, until_unix_ms=until, before=before,
        limit=limit + 1, verify=verify,
    )  # fmt: skip
    found = await ask_log(web, wanted)
    lines = tuple(
        LogLine(
            number=entry.number,
            unix_ms=entry.unix_ms,
            effect=entry.effect,
            outcome=entry.outcome,
            robot=entry.robot,
            text=in_language(told(entry), language),
            words=entry.words if entry.effect == Effect.SPEAK.value else "",
        )
        for entry in found.entries[:limit]
    )
    complete = len(found.entries) <= limit
    return LogPage(lines=lines, complete=complete, chain=found.chain, problem=found.problem)


async def ask_log(web: Backend, wanted: GetAudit) -> AuditList:
    """Ask whoever writes down who did what.

    Raises:
        WebProblem: Nobody does, or it cannot be read.
    """
    try:
        found = await web.link.ask(topics.GET_AUDIT, wanted, AuditList)
    except UnavailableError as error:
        raise WebProblem(503, "Nobody writes down who did what.", "Start the part that does.") from error
    if found.problem and not found.entries and not found.chain:
        raise WebProblem(503, "The log cannot be read at the moment.", "Try again.")
    return found
