"""What robots did, today and earlier."""

from __future__ import annotations

from collections.abc import Callable
from typing import Annotated, Final

from fastapi import APIRouter, Query
from starlette.responses import Response

from parley.gate.table import Effect
from parley.messages.audit import AuditEntry, GetAudit
from parley.messages.incident import GetIncidents
from parley.sentences import SpokenLanguage
from parley.web.backend import Backend
from parley.web.models import Handover, HistoryPage, RoundView
from parley.web.problems import WebProblem
from parley.web.round_file import round_file
from parley.web.rounds import rounds_of, running_graphs, told_lines, waiting
from parley.web.routes.access import Web, may, module
from parley.web.routes.incidents import ask_incidents
from parley.web.routes.log import Moment, Part, ask_log

__all__ = ["router"]

router = APIRouter(prefix="/history", tags=["log"], dependencies=[module("log"), may(Effect.SEE)])

_LONGEST_MS: Final = 24 * 3600 * 1000
"""A round that took longer is looked for no further: its end is not known."""
_LATE_MS: Final = 3000
"""What a robot says about the end comes behind the end."""
_MOST: Final = 999


@router.get("")
async def get_history(
    web: Web,
    robot: Part = "",
    by: Part = "",
    q: Part = "",
    since: Moment = 0,
    until: Moment = 0,
    before: Moment = 0,
    limit: Annotated[int, Query(ge=1, le=200)] = 50,
    language: SpokenLanguage = "en",
) -> HistoryPage:
    """What robots were told to do and how it ended, newest first; `before` is a number and leads on."""
    wanted = GetAudit(
        robot=robot, text=q, since_unix_ms=since, until_unix_ms=until, before=before, limit=limit + 1
    )
    rounds, complete = await _rounds(web, wanted, language)
    if q:  # what was wished while it went on stands with its end
        rounds, complete = await _with_later_words(web, wanted, rounds, complete, language)
    named = [one for one in rounds if by.casefold() in f"{one.by} {one.approved_by}".casefold()]
    return HistoryPage(rounds=tuple(named), complete=complete)


@router.get("/handover")
async def get_handover(
    web: Web, since: Moment, until: Moment = 0, robot: Part = "", language: SpokenLanguage = "en"
) -> Handover:
    """What the next shift has to know about a time."""
    until = until or web.clock.unix_ms()
    span = GetAudit(robot=robot, since_unix_ms=since, until_unix_ms=until, limit=_MOST)
    rounds, complete = await _rounds(web, span, language)
    told: dict[str, list[AuditEntry]] = {}
    for name, effects in (("stops", (Effect.STOP, Effect.RESET)), ("rules", (Effect.RULE, Effect.POLICY))):
        found = [await ask_log(web, span.model_copy(update={"effect": effect.value})) for effect in effects]
        told[name] = [entry for one in found for entry in one.entries]
    return Handover(
        since_unix_ms=since,
        until_unix_ms=until,
        rounds=tuple(reversed(rounds)),
        complete=complete,
        waits=waiting(web.state, robot, language),
        stops=told_lines(told["stops"], language),
        rules=told_lines(told["rules"], language),
    )


@router.get("/file", response_class=Response, responses={200: {"content": {"text/html": {}}}})
async def get_round_file(
    web: Web, number: Annotated[int, Query(ge=1, le=2**53)], language: SpokenLanguage = "en"
) -> Response:
    """One round with what was said and its pictures, as one file to keep or to send."""
    rounds, _ = await _rounds(web, GetAudit(before=number + 1, limit=1), language)
    if not rounds or rounds[0].number != number:
        raise WebProblem(404, "Nothing began with that entry of the log.")
    (told,) = rounds
    until = (told.ended_unix_ms or web.clock.unix_ms()) + _LATE_MS
    said = await web.store.said(told.robot, told.unix_ms, until)
    keys = [key for _, key in await web.store.seen(told.robot, told.unix_ms, until)]
    pictures = [picture for key in keys if (picture := await web.store.picture(key)) is not None]
    return Response(
        round_file(told, said, pictures, language),
        media_type="text/html",
        headers={"Content-Disposition": f'attachment; filename="round-{number}.html"'},
    )


async def _rounds(
    web: Backend,
    wanted: GetAudit,
    language: SpokenLanguage,
    keep: Callable[[RoundView], bool] = lambda _: True,
) -> tuple[list[RoundView], bool]:
    """Newest first, and whether nothing older fits."""
    starts = (await ask_log(web, wanted.model_copy(update={"effect": "start"}))).entries
    if not starts:
        return [], True
    span = {"since_unix_ms": starts[-1].unix_ms, "until_unix_ms": starts[0].unix_ms + _LONGEST_MS}
    since = GetAudit(robot=wanted.robot, limit=_MOST + 1, **span)
    told = [await ask_log(web, since.model_copy(update={"effect": effect})) for effect in ("start", "end")]
    others = [entry for one in told for entry in one.entries]
    complete = len(starts) < wanted.limit
    shown = starts if complete or wanted.limit == 1 else starts[:-1]
    incidents = (await ask_incidents(web, GetIncidents(robot=wanted.robot, limit=_MOST))).incidents
    rounds = rounds_of(shown, others, running_graphs(web.state), incidents, language)
    return [await _with_pictures(web, one) for one in rounds if keep(one)], complete


async def _with_later_words(
    web: Backend, wanted: GetAudit, found: list[RoundView], complete: bool, language: SpokenLanguage
) -> tuple[list[RoundView], bool]:
    """And those of which only the end says the words that are looked for."""
    text = wanted.text.casefold()
    known = {one.number for one in found}

    def says(one: RoundView) -> bool:
        return one.number not in known and text in one.words.casefold()

    all_of_it = wanted.model_copy(update={"text": "", "limit": _MOST})
    more, whole = await _rounds(web, all_of_it, language, keep=says)
    both = sorted([*found, *more], key=lambda one: one.number, reverse=True)
    most = wanted.limit - 1
    return both[:most], complete and whole and len(both) <= most


async def _with_pictures(web: Backend, one: RoundView) -> RoundView:
    seen = await web.store.seen(one.robot, one.unix_ms, one.ended_unix_ms or web.clock.unix_ms())
    return one.model_copy(update={"pictures": tuple(f"/api/chat/images/{key}" for _, key in seen)})
