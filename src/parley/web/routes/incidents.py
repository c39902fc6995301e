"""What went wrong, and how it ended."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Query

from parley.errors import UnavailableError
from parley.gate.table import Effect
from parley.messages import topics
from parley.messages.incident import GetIncidents, Incident, IncidentList
from parley.web.backend import Backend
from parley.web.routes.access import Web, may, module
from parley.web.showing import Reader, shown_in

__all__ = ["ask_incidents", "router"]

router = APIRouter(
    prefix="/incidents", tags=["incidents"], dependencies=[module("incidents"), may(Effect.SEE)]
)


@router.get("")
async def get_incidents(
    web: Web,
    reader: Reader,
    robot: Annotated[str, Query(max_length=100)] = "",
    limit: Annotated[int, Query(ge=1, le=1000)] = 100,
) -> list[Incident]:
    """Incidents, newest first; where nobody keeps them, those that this server heard of."""
    found = await ask_incidents(web, GetIncidents(robot=robot, limit=limit))
    return list(IncidentList.model_validate(shown_in(reader, found)).incidents)


async def ask_incidents(web: Backend, wanted: GetIncidents) -> IncidentList:
    """Ask whoever keeps them; where nobody does, those that this server heard of, newest first."""
    try:
        return await web.link.ask(topics.GET_INCIDENTS, wanted, IncidentList)
    except UnavailableError:
        heard = [item for item in web.state.incidents.values() if wanted.robot in ("", item.robot)]
        return IncidentList(incidents=tuple(heard[::-1][: wanted.limit]))
