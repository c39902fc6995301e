"""Everything as it stands, and what changed since: the live stream for those who ask instead of listening."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Query

from parley.gate.table import Effect
from parley.web.models import Change, Snapshot
from parley.web.problems import WebProblem
from parley.web.routes.access import Web, may

__all__ = ["router"]

router = APIRouter(tags=["live"], dependencies=[may(Effect.SEE)])


@router.get("/snapshot")
async def get_snapshot(web: Web) -> Snapshot:
    """Everything as it stands."""
    return web.snapshot()


@router.get("/changes")
async def get_changes(
    web: Web, since: Annotated[int, Query(ge=0)], run: Annotated[str, Query(max_length=100)] = ""
) -> list[Change]:
    """What changed after the number `since` of the log `run` (empty: the present one), each thing once."""
    log = web.state.log
    changes = log.since(since) if run in ("", log.run) else None
    if changes is None:
        raise WebProblem(409, "What happened since then is not known any more.", "Ask for the snapshot.")
    return changes
