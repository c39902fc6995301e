"""Signing in and out."""

from __future__ import annotations

from fastapi import APIRouter, Request, Response

from parley.web.bodies import Done, SessionInfo, SessionPost
from parley.web.routes.access import Author, Web
from parley.web.sessions import SESSION_S, cookie_name

__all__ = ["router"]

router = APIRouter(prefix="/session", tags=["session"])


@router.get("")
async def get_session(request: Request, web: Web, author: Author) -> SessionInfo:
    """Whether one has to sign in, and who is signed in."""
    is_in = not web.sessions.required or request.scope["state"].get("session") is not None
    return SessionInfo(required=web.sessions.required, authenticated=is_in, name=author)


@router.post("")
async def post_session(post: SessionPost, request: Request, response: Response, web: Web) -> SessionInfo:
    """Sign in with the password or pairing code; where none is asked for, only tell one's name."""
    address = request.client.host if request.client else ""
    https = request.url.scheme == "https"
    name = cookie_name(https=https)
    token = await web.sessions.open(post.secret, post.name, address, request.cookies.get(name, ""))
    response.set_cookie(name, token, max_age=SESSION_S, httponly=True, secure=https, samesite="strict")
    return SessionInfo(required=web.sessions.required, authenticated=True, name=post.name)


@router.delete("")
async def delete_session(request: Request, response: Response, web: Web) -> Done:
    """Sign out."""
    https = request.url.scheme == "https"
    name = cookie_name(https=https)
    await web.sessions.close(request.cookies.get(name, ""))
    response.delete_cookie(name, httponly=True, secure=https, samesite="strict")
    return Done()
