"""The ASGI app behind the guard: REST, the live stream and the page."""

from __future__ import annotations

import json
import re
from typing import Any

import socketio
from fastapi import FastAPI
from fastapi.openapi.utils import get_openapi
from starlette.requests import Request
from starlette.responses import Response
from starlette.types import ASGIApp

from parley import __version__
from parley.web.backend import Backend
from parley.web.bodies import FeedKey, FrameMeta
from parley.web.live import Live
from parley.web.pages import Pages, built_pages
from parley.web.problems import RESPONSES, install
from parley.web.routes import (
    chat,
    favourites,
    feeds,
    health,
    history,
    incidents,
    log,
    map,
    me,
    memory,
    missions,
    models,
    people,
    plans,
    push,
    robots,
    rules,
    session,
    snapshot,
    stop,
)

__all__ = ["create_api", "create_app", "openapi_text"]

_RESOURCES = (
    health, session, me, people, snapshot, chat, favourites, stop, plans, missions, robots, memory, rules,
    incidents, log, history, map, models, feeds, push,
)  # fmt: skip


def create_api() -> FastAPI:
    """The REST side; `state.backend` is to be set before it is used."""
    api = FastAPI(
        title="Parley",
        version=__version__,
        description="The operator's page and its server. The live stream is Socket.IO.",
        openapi_url="/api/openapi.json",
        docs_url=None,
        redoc_url=None,
        responses=RESPONSES,
        generate_unique_id_function=lambda route: route.name,
        separate_input_output_schemas=False,
    )
    for resource in _RESOURCES:
        api.include_router(resource.router, prefix="/api")
    install(api)
    api.openapi = lambda: _describe(api)  # type: ignore[method-assign]
    return api


def create_app(backend: Backend, live: Live) -> ASGIApp:
    """Everything that one server answers to those whom the guard lets in.

    Args:
        backend: Open.
        live: Open.
    """
    api = create_api()
    api.state.backend = backend
    pages = Pages(backend.config.static_dir or built_pages())

    async def page(request: Request) -> Response:
        return await pages.answer(request)

    api.add_route("/{path:path}", page, methods=["GET"], include_in_schema=False)
    return socketio.ASGIApp(live.server, other_asgi_app=api)  # type: ignore[no-any-return]


def _with_open_actions(schema: dict[str, Any]) -> dict[str, Any]:
    """Actions in the form in which they travel: an object whose one key is the action's name."""
    schemas = schema["components"]["schemas"]
    for name in [name for name in schemas if name.startswith("ActionCall")]:
        del schemas[name]
    schemas["ActionCall"] = {
        "type": "object",
        "additionalProperties": {"type": "object"},
        "minProperties": 1,
        "maxProperties": 1,
        "description": "One action in Chat Action form: its name -> its parameters.",
    }
    text = re.sub(r"(#/components/schemas/ActionCall)-\w+", r"\1", json.dumps(schema))
    for name in [name for name in schemas if f'"#/components/schemas/{name}"' not in text]:
        if name.split("-")[0] in ("Flow", "FlowIf", "Parameter"):
            del schemas[name]
    return json.loads(re.sub(r"(#/components/schemas/ActionCall)-\w+", r"\1", json.dumps(schema)))  # type: ignore[no-any-return]


def openapi_text() -> str:
    """The description of the interface, always the same for the same version."""
    return json.dumps(create_api().openapi(), indent=1, sort_keys=True, ensure_ascii=False) + "\n"


def _describe(api: FastAPI) -> dict[str, object]:
    """The description with what only the live stream carries."""
    if not api.openapi_schema:
        schema = get_openapi(
            title=api.title, version=api.version, description=api.description, routes=api.routes
        )
        for model in (FrameMeta, FeedKey):
            schema["components"]["schemas"][model.__name__] = model.model_json_schema()
        api.openapi_schema = _with_open_actions(schema)
    return api.openapi_schema
