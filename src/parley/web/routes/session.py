"""Signing in and out."""

from __future__ import annotations

from typing import Any

from fastapi import APIRouter, Request, Response

from parley.gate.table import Effect
from parley.web.bodies import CredentialPost, Done, PasskeyQuestion, SessionInfo, SessionPost
from parley.web.people.passkeys import can_have_passkeys
from parley.web.problems import WebProblem
from parley.web.routes.access import Caller, ThisDevice, ThisVisitor, Web, Who, anybody
from parley.web.sessions import SESSION_S, cookie_name

__all__ = ["origin_of", "router"]

router = APIRouter(prefix="/session", tags=["session"], dependencies=[anybody])


@router.get("")
async def get_session(request: Request, web: Web, who: Who) -> SessionInfo:
    """Whether one has to sign in, who is signed in, and what they may do."""
    return _info(request, web, who)


@router.post("")
async def post_session(
    post: SessionPost, request: Request, response: Response, web: Web, visitor: ThisVisitor
) -> SessionInfo:
    """Sign in, with what `way` of the session says; where nothing is asked for, only tell one's name."""
    token = await web.sessions.sign_in(post.secret, post.name, visitor)
    return _let_in(request, response, web, token)


@router.delete("")
async def delete_session(
    request: Request, response: Response, web: Web, device: ThisDevice, who: Who
) -> Done:
    """Sign out here."""
    if device is not None:
        await web.sessions.sign_out([device], who.by)
    _drop_cookie(request, response)
    return Done()


@router.post("/passkey/options")
async def ask_for_passkey(request: Request, web: Web) -> PasskeyQuestion:
    """What to ask the browser for, to sign in with a passkey."""
    origin = origin_of(request)
    id_, options = web.sessions.ceremonies.ask_known(origin, web.clock.wall_s())
    return PasskeyQuestion(id=id_, options=options)


@router.post("/passkey")
async def post_passkey(
    post: CredentialPost, request: Request, response: Response, web: Web, visitor: ThisVisitor
) -> SessionInfo:
    """Sign in with what the browser answered."""
    origin = origin_of(request)
    token = await web.sessions.with_passkey(post.id, post.credential, origin, visitor)
    return _let_in(request, response, web, token)


def origin_of(request: Request) -> str:
    """The address of the page, by which passkeys are bound; the guard has checked it.

    Raises:
        WebProblem: Browsers have no passkeys there.
    """
    origin = request.headers.get("origin") or f"{request.url.scheme}://{request.headers.get('host', '')}"
    if not can_have_passkeys(origin):
        raise WebProblem(
            409,
            "Passkeys need an address with a name.",
            "Open the page at http://localhost on this computer, or under the name of the server with HTTPS.",
        )
    return origin


def set_cookie(request: Request, response: Response, token: str) -> None:
    """Hand out a session."""
    https = request.url.scheme == "https"
    response.set_cookie(
        cookie_name(https=https), token, max_age=SESSION_S, httponly=True, secure=https, samesite="strict"
    )


def _drop_cookie(request: Request, response: Response) -> None:
    https = request.url.scheme == "https"
    response.delete_cookie(cookie_name(https=https), httponly=True, secure=https, samesite="strict")


def _let_in(request: Request, response: Response, web: Web, token: str) -> SessionInfo:
    set_cookie(request, response, token)
    device = web.sessions.get(token)
    by = web.sessions.principal(device, device.gadget) if device is not None else None
    return _info(request, web, Caller(web, by))


def _info(request: Request, web: Web, who: Caller) -> SessionInfo:
    details: dict[str, Any] = {}
    if who.may(Effect.SEE):
        details = {
            "name": who.by.name,
            "role": who.by.role,
            "may": tuple(effect.value for effect in Effect if who.may(effect)),
        }
    origin = f"{request.url.scheme}://{request.headers.get('host', '')}"
    return SessionInfo(
        required=web.sessions.required,
        authenticated=who.may(Effect.SEE),
        way=web.sessions.way,
        passkeys=can_have_passkeys(request.headers.get("origin") or origin),
        **details,
    )
