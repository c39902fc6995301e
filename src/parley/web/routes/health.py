"""Whether the server is well, and what it is."""

from __future__ import annotations

from fastapi import APIRouter, Request
from starlette.concurrency import run_in_threadpool
from starlette.responses import Response

from parley import __version__
from parley.gate.table import Effect
from parley.messages.principal import ROLES
from parley.web.bodies import Health
from parley.web.models import ServerInfo
from parley.web.routes.access import Web, Who, anybody, may

__all__ = ["router"]

router = APIRouter(tags=["server"])


@router.get("/health", dependencies=[anybody])
async def get_health() -> Health:
    """Whether the server is well."""
    return Health(ok=True, version=__version__)


@router.get("/info", dependencies=[may(Effect.SEE)])
async def get_info(web: Web) -> ServerInfo:
    """What the page should know about the system behind it."""
    return web.info


@router.get(
    "/qr.svg",
    response_class=Response,
    responses={200: {"content": {"image/svg+xml": {}}}},
    dependencies=[may(Effect.SEE)],
)
async def get_qr(request: Request, web: Web, who: Who) -> Response:
    """The address for phones, to be read with a camera; where devices are paired, with the code for one.

    The code is for who may be as much themselves: nobody lets others in as more than they are.
    """
    from parley.web.addresses import paired, qr_svg

    address = web.addresses[0] if web.addresses else str(request.base_url)
    may_pair = who.by.role in ROLES and ROLES.index(who.by.role) >= ROLES.index(web.sessions.codes.role)
    text = paired(address, web.sessions.code if may_pair else "")
    return Response(await run_in_threadpool(qr_svg, text), media_type="image/svg+xml")
