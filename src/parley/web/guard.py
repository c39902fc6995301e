"""Stands before everything: who may talk to this server, from where, how much, and how answers are sealed."""

from __future__ import annotations

import asyncio
import base64
import hmac
import secrets
from collections.abc import Iterable, MutableMapping
from http.cookies import CookieError, SimpleCookie
from typing import Any, Final
from urllib.parse import urlsplit

from starlette.types import ASGIApp, Message, Receive, Scope, Send

from parley.clock import Clock
from parley.web.limits import Rate
from parley.web.patience import seat_of
from parley.web.people.records import Device
from parley.web.problems import WebProblem, problem_response
from parley.web.sessions import Sessions, cookie_name

__all__ = ["Guard"]

SAFE_METHODS: Final = frozenset({"GET", "HEAD", "OPTIONS"})
MAX_BODY_BYTES: Final = 64 * 1024
MAX_UPLOAD_BYTES: Final = 20 * 1024 * 1024
"""For the addresses that take pictures."""
MAX_UPLOADS: Final = 8
"""Large bodies that are held at once, of those who are known and of strangers; more wait their turn."""
VISIT: Final = "parley_visit"
BODY_WITHIN_S: Final = 30.0
"""Wall time in which a body must have come."""
_TOO_LARGE: Final = "That is more than this server takes."
_SMALLER: Final = "Use smaller or fewer pictures."
_UPLOADS: Final = ("/api/chat", "/api/memory")
_OPEN: Final = frozenset(
    {"/api/session", "/api/session/passkey", "/api/session/passkey/options", "/api/health"}
)
_LIVE: Final = "/socket.io"
_STOP: Final = "/api/stop"
_SOCKETS: Final = (_LIVE, "/api/stop/line")

_HEADERS: Final = (
    (b"x-content-type-options", b"nosniff"),
    (b"x-frame-options", b"DENY"),
    (b"referrer-policy", b"no-referrer"),
    (b"cross-origin-opener-policy", b"same-origin"),
    (b"cross-origin-resource-policy", b"same-origin"),
    (b"permissions-policy", b"camera=(self), microphone=(self), geolocation=()"),
)


class Guard:
    """ASGI middleware.

    Args:
        app: What is guarded.
        sessions: Who is signed in.
        clock: Wall time.
        hosts: Names under which this server is reached (of the `Host` header, without port); a page of
            another name that leads here is an attack.
        origins: Other origins whose pages may talk to this server.
        https: Whether it is served so.
    """

    def __init__(
        self,
        app: ASGIApp,
        sessions: Sessions,
        clock: Clock,
        *,
        hosts: Iterable[str],
        origins: Iterable[str] = (),
        https: bool = False,
    ) -> None:
        self._app, self._sessions, self._clock = app, sessions, clock
        self._hosts = {host.casefold() for host in hosts}
        self._origins = {origin.rstrip("/").casefold() for origin in origins}
        self._https = https
        self._visits = Visits()
        self._uploads = {known: asyncio.Semaphore(MAX_UPLOADS) for known in (True, False)}
        self._changes = Rate(per_s=20, burst=60)
        self._reads = Rate(per_s=100, burst=400)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Let a request in, or refuse it."""
        if scope["type"] not in ("http", "websocket"):
            await self._app(scope, receive, send)
            return
        headers = {name.decode("latin-1"): value.decode("latin-1") for name, value in scope["headers"]}
        nonce = base64.b64encode(secrets.token_bytes(12)).decode()
        scope.setdefault("state", {})["nonce"] = nonce
        sealed = self._seal(send, scope, nonce)
        try:
            session = self._admit(scope, headers)
            who = self._who(session, headers)
            if who:
                seat_of(scope).known(who)
            self._check_rate(scope, who)
        except WebProblem as problem:
            await _refuse(problem, scope, receive, sealed)
            return
        scope["state"]["session"], scope["state"]["who"] = session, who
        if not who and not self._sessions.required and _opens_page(scope):
            sealed = _with_cookie(sealed, self._visits.new(), https=self._https)
        if scope["type"] != "http" or scope["method"] in SAFE_METHODS:
            await self._app(scope, receive, sealed)
        elif scope["path"].startswith(_UPLOADS) and _is_large(headers):
            async with self._uploads[bool(who)]:
                await self._take(scope, receive, sealed)
        else:
            await self._take(scope, receive, sealed)

    async def _take(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer a request with a body."""
        try:
            receive = await _whole(receive, _limit(scope["path"]))
        except WebProblem as problem:
            await _refuse(problem, scope, receive, send)
            return
        await self._app(scope, receive, send)

    def _admit(self, scope: Scope, headers: MutableMapping[str, str]) -> Device | None:
        """Check a request from the outside to the inside.

        Raises:
            WebProblem: It is not let in.
        """
        self._check_host(headers)
        path, method = scope["path"], scope.get("method", "GET")
        is_live = path.startswith(_SOCKETS)
        if is_live or method not in SAFE_METHODS:
            self._check_origin(headers)
        self._check_size(path, headers)
        session = self._sessions.get(_cookie(headers.get("cookie", ""), cookie_name(https=self._https)))
        is_inside = is_live or (path.startswith("/api/") and path not in _OPEN)
        if is_inside and self._sessions.required and session is None:
            raise WebProblem(401, "You are not signed in.", "Sign in first.")
        return session

    def _who(self, session: Device | None, headers: MutableMapping[str, str]) -> str:
        """Known by a session, or, where nobody has to sign in, by having opened the page; else empty."""
        if session is not None:
            return session.digest
        visit = "" if self._sessions.required else _cookie(headers.get("cookie", ""), VISIT)
        return visit if self._visits.holds(visit) else ""

    def _check_host(self, headers: MutableMapping[str, str]) -> None:
        host = urlsplit(f"//{headers.get('host', '')}")
        try:
            name = (host.hostname or "").casefold()
        except ValueError:
            name = ""
        if name not in self._hosts:
            raise WebProblem(403, "This server is not reached by that name.", "Use the address it shows.")

    def _check_origin(self, headers: MutableMapping[str, str]) -> None:
        """Browsers say whose page it is that sends; programs need not."""
        origin = headers.get("origin", "").rstrip("/").casefold()
        if not origin or origin in self._origins:
            return
        own = f"{'https' if self._https else 'http'}://{headers.get('host', '').casefold()}"
        if origin != own:
            raise WebProblem(
                403, "A page of another address may not do that.", "Use the page of this server."
            )

    def _check_size(self, path: str, headers: MutableMapping[str, str]) -> None:
        length = headers.get("content-length", "0")
        if not length.isdecimal() or int(length) > _limit(path):
            raise WebProblem(413, _TOO_LARGE, _SMALLER)

    def _check_rate(self, scope: Scope, who: str) -> None:
        """Stopping is never slowed down; everything else has its measure, for each who is known."""
        if scope["path"].startswith(_STOP):
            return
        who = who or str((scope.get("client") or ("", 0))[0])
        rate = self._reads if scope.get("method", "GET") in SAFE_METHODS else self._changes
        wait_s = rate.take(who, self._clock.wall_s())
        if wait_s > 0:
            raise WebProblem(
                429,
                "That was too much at once.",
                "Wait a moment.",
                headers={"Retry-After": str(int(wait_s) + 1)},
            )

    def _seal(self, send: Send, scope: Scope, nonce: str) -> Send:
        policy = (
            "default-src 'none'; script-src 'self'; "
            f"style-src 'self' 'nonce-{nonce}'; img-src 'self' data: blob:; connect-src 'self'; "
            "font-src 'self'; manifest-src 'self'; media-src 'self' blob:; worker-src 'self'; "
            "base-uri 'none'; form-action 'self'; frame-ancestors 'none'"
        )
        extra = [*_HEADERS, (b"content-security-policy", policy.encode())]
        if self._https:
            extra.append((b"strict-transport-security", b"max-age=31536000"))
        is_data = scope["path"].startswith(("/api/", _LIVE))

        async def sealed(message: Message) -> None:
            if message["type"] in ("http.response.start", "websocket.http.response.start"):
                headers = [*message.get("headers", ()), *extra]
                if is_data and not any(name.lower() == b"cache-control" for name, _ in headers):
                    headers.append((b"cache-control", b"no-store"))
                message = {**message, "headers": headers}
            await send(message)

        return sealed


class Visits:
    """Cookies of pages that were opened where nobody has to sign in; they only tell pages from strangers."""

    def __init__(self) -> None:
        self._key = secrets.token_bytes(32)

    def new(self) -> str:
        """Of another page."""
        name = secrets.token_hex(8)
        return f"{name}.{self._seal(name)}"

    def holds(self, visit: str) -> bool:
        """Whether it is one of ours, of this run."""
        name, _, sealed = visit.partition(".")
        return hmac.compare_digest(self._seal(name).encode(), sealed.encode())

    def _seal(self, name: str) -> str:
        return hmac.new(self._key, name.encode(), "sha256").hexdigest()[:32]


def _opens_page(scope: Scope) -> bool:
    """Pages begin with an address of no data; when they connect anew they ask first who is signed in."""
    is_page = not scope["path"].startswith(("/api/", _LIVE, "/assets/")) or scope["path"] == "/api/session"
    return is_page and scope.get("method") == "GET"


def _with_cookie(send: Send, visit: str, *, https: bool) -> Send:
    cookie = f"{VISIT}={visit}; Path=/; HttpOnly; SameSite=Strict" + ("; Secure" if https else "")

    async def sending(message: Message) -> None:
        if message["type"] == "http.response.start":
            message = {**message, "headers": [*message["headers"], (b"set-cookie", cookie.encode())]}
        await send(message)

    return sending


def _is_large(headers: MutableMapping[str, str]) -> bool:
    """Whether a body is more than words, or may be."""
    return int(headers.get("content-length", MAX_UPLOAD_BYTES)) > MAX_BODY_BYTES


def _limit(path: str) -> int:
    return MAX_UPLOAD_BYTES if path.startswith(_UPLOADS) else MAX_BODY_BYTES


async def _whole(receive: Receive, limit: int) -> Receive:
    """Take a body in, whether or not its length was told, and hand it on as it came.

    Raises:
        WebProblem: It is too large or comes too slowly.
    """
    messages: list[Message] = []
    taken, more = 0, True
    try:
        async with asyncio.timeout(BODY_WITHIN_S):
            while more:
                messages.append(await receive())
                taken += len(messages[-1].get("body", b""))
                more = bool(messages[-1].get("more_body"))
                if taken > limit:
                    raise WebProblem(413, _TOO_LARGE, _SMALLER)
    except TimeoutError as error:
        raise WebProblem(408, "That came too slowly.", "Try again.") from error
    waiting = iter(messages)

    async def replay() -> Message:
        return next(waiting, None) or await receive()

    return replay


def _cookie(text: str, name: str) -> str:
    try:
        found = SimpleCookie(text).get(name)
    except CookieError:
        return ""
    return found.value if found is not None else ""


async def _refuse(problem: WebProblem, scope: Scope, receive: Receive, send: Send) -> None:
    if scope["type"] == "http":
        await problem_response(problem)(scope, receive, send)
        return
    answer: dict[str, Any] = {"type": "websocket.close", "code": 1008, "reason": problem.detail}
    await receive()
    await send(answer)
