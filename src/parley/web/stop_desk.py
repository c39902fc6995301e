"""Where stops come in: before everything else, in the front's own loop."""

from __future__ import annotations

import asyncio
import uuid
from collections.abc import Callable
from typing import Final

import structlog
from pydantic import ValidationError
from starlette.responses import Response
from starlette.types import ASGIApp, Message, Receive, Scope, Send
from starlette.websockets import WebSocket, WebSocketDisconnect, WebSocketState

from parley.gate.stop_words import has_stop_word
from parley.messages.principal import Principal
from parley.web.bodies import ChatPost, StopAnswer, StopPost
from parley.web.stopping import Stop, Stopper

__all__ = ["LINE", "StopDesk"]

log = structlog.get_logger(__name__)

STOP: Final = "/api/stop"
LINE: Final = "/api/stop/line"
CHAT: Final = "/api/chat"
MAX_READ_BYTES: Final = 64 * 1024
"""Of a message that is looked through for stop words here; larger ones are when they are sent on."""
LOOK_S: Final = 0.05
"""Wall time between two looks at how the robots fare."""
WATCHED_S: Final = 10.0
"""Wall time for which is told how they fare."""
KEPT_WITHIN_S: Final = 0.25
"""Wall time for which an answer waits until the stop is on disk; the robots were stopped before."""
BEAT_S: Final = 2.0
"""Wall time between two signs of life on the line."""
NOT_LET_IN: Final = 1008
"""Code with which the line is hung up on who was signed out."""


class StopDesk:
    """ASGI app: answers stops itself, at once, and hands everything else on.

    ``POST /api/stop`` is one stop. `/api/stop/line` is a WebSocket that a page keeps open, so that a stop
    needs no new connection: it gets `StopPost` and answers `StopAnswer`, again whenever something changed;
    `{}` is a sign of life. Messages with a stop word hold their robots here, before anybody reads them.

    Args:
        app: Answers everything else.
        stopper: Carries out.
        principal: On whose account a request or socket is.
    """

    def __init__(
        self, app: ASGIApp, stopper: Stopper, principal: Callable[[Scope], Principal | None]
    ) -> None:
        self._app, self._stopper, self._principal = app, stopper, principal

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer one request or socket."""
        path = scope.get("path", "")
        if scope["type"] == "websocket" and path == LINE:
            await self._line(WebSocket(scope, receive, send))
        elif scope["type"] == "http" and scope["method"] == "POST" and path in (STOP, CHAT):
            messages, body = await _read(receive)
            if path == CHAT:
                send = self._hold(scope, body, send)
            answer = await self._stop(scope, body) if path == STOP else None
            if answer is None:
                await self._app(scope, _again(messages, receive), send)
            else:
                await answer(scope, receive, send)
        else:
            await self._app(scope, receive, send)

    async def _stop(self, scope: Scope, body: bytes) -> Response | None:
        """Stop; None: it is a reset, or nothing that can be read."""
        try:
            post = StopPost.model_validate_json(body)
        except ValidationError:
            return None  # whoever answers it says what is wrong with it
        if post.command != "stop":
            return None
        stop = self._begun(post, self._principal(scope))
        await self._written()
        return Response(self._told(stop).model_dump_json(), media_type="application/json")

    def _hold(self, scope: Scope, body: bytes, send: Send) -> Send:
        """Hold robots if a message has a stop word; who was held goes on where the message is refused."""
        if len(body) > MAX_READ_BYTES:
            return send
        try:
            post = ChatPost.model_validate_json(body)
        except ValidationError:
            return send
        if not has_stop_word(post.text):
            return send
        self._stopper.hold(post.targets, by=self._principal(scope), id=post.id, words=post.text)

        async def watched(message: Message) -> None:
            if message["type"] == "http.response.start" and 400 <= message["status"] < 500:
                self._stopper.go_on(post.id)  # nobody will read it, and whoever said it is told
            await send(message)

        return watched

    async def _line(self, socket: WebSocket) -> None:
        await socket.accept()
        watching: asyncio.Task[None] | None = None
        beating = asyncio.create_task(self._beat(socket))
        try:
            while _is_open(socket):
                text = await socket.receive_text()
                try:
                    post = StopPost.model_validate_json(text)
                except ValidationError as error:
                    log.warning("unreadable stop", reason=str(error))
                    continue
                by = self._principal(socket.scope)
                if post.command == "stop" and by is not None:
                    stop = self._begun(post, by)
                    if watching is not None:
                        watching.cancel()
                    watching = asyncio.create_task(self._watch(socket, stop))
        except (WebSocketDisconnect, KeyError):
            pass  # hung up, or bytes where text is agreed on
        finally:
            for task in (beating, watching):
                if task is not None:
                    task.cancel()

    async def _beat(self, socket: WebSocket) -> None:
        """Give signs of life, and hang up on whom is not let in any more."""
        while self._principal(socket.scope) is not None:
            await socket.send_text("{}")
            await asyncio.sleep(BEAT_S)
        await socket.close(NOT_LET_IN)

    async def _watch(self, socket: WebSocket, stop: Stop) -> None:
        """Tell how the robots fare, whenever that changed."""
        told: StopAnswer | None = None
        for _ in range(int(WATCHED_S / LOOK_S)):
            now = self._told(stop)
            if now != told and _is_open(socket):
                told = now
                await socket.send_text(now.model_dump_json())
            await asyncio.sleep(LOOK_S)

    def _begun(self, post: StopPost, by: Principal | None) -> Stop:
        return self._stopper.stop(post.targets, by=by, id=post.id or uuid.uuid4().hex)

    async def _written(self) -> None:
        written = self._stopper.written
        if written is not None:
            await asyncio.wait([asyncio.wrap_future(written)], timeout=KEPT_WITHIN_S)

    def _told(self, stop: Stop) -> StopAnswer:
        return StopAnswer(id=stop.id, robots=self._stopper.states(stop), kept=self._stopper.is_kept(stop))


def _is_open(socket: WebSocket) -> bool:
    """Whether we have not hung up."""
    return socket.application_state is WebSocketState.CONNECTED


async def _read(receive: Receive) -> tuple[list[Message], bytes]:
    """A request that has come as a whole already."""
    messages = [await receive()]
    while messages[-1].get("more_body"):
        messages.append(await receive())
    return messages, b"".join(message.get("body", b"") for message in messages)


def _again(messages: list[Message], receive: Receive) -> Receive:
    waiting = iter(messages)

    async def replay() -> Message:
        return next(waiting, None) or await receive()

    return replay
