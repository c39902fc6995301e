"""The live stream over Socket.IO: a snapshot or what was missed, then changes; places on the map; pictures.

Nobody waits for a slow client. Each has its own place in the log and is sent what came since only when it
has taken what was sent before; of map views and pictures it gets the newest.
"""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable
from dataclasses import dataclass, field
from typing import Any, Final

import socketio
import structlog
from pydantic import BaseModel, TypeAdapter, ValidationError

from parley.gate.table import Effect, verdict
from parley.messages.attendance import Attendance
from parley.messages.map import MapView
from parley.messages.principal import Principal
from parley.web.backend import Backend
from parley.web.bodies import FeedKey, FrameMeta
from parley.web.crowd import Crowd, Seat
from parley.web.feed_state import Picture
from parley.web.models import Change
from parley.web.people.records import Gadget
from parley.web.showing import language_of, shown_in

__all__ = ["Live"]

log = structlog.get_logger(__name__)

PACE_S: Final = 0.015
"""Wall time between two sendings to a client: what happens meanwhile goes together."""
IN_FLIGHT: Final = 2
"""Pictures of one feed that a client has not confirmed yet."""
CONFIRM_WITHIN_S: Final = 2.0
"""Wall time after which a picture counts as confirmed, or lost."""
ATTENDANCE_S: Final = 5.0
"""Wall time after which it is told anew how many people are connected."""
MAX_WATCHED: Final = 64
MAX_CLIENTS: Final = 200
"""Of those who are known; the oldest gives way."""
MAX_STRANGERS: Final = 50
"""The same of those who are not."""
MAX_RENDERED: Final = 1000
"""Changes that are held ready in the form in which they travel."""
MAX_MESSAGE_BYTES: Final = 64 * 1024

_FEEDS: Final = TypeAdapter(tuple[FeedKey, ...])

Key = tuple[str, str]


class _Packet(socketio.packet.Packet):  # type: ignore[misc]
    """Finds bytes among an event's arguments; looking for them inside all others took a fifth of the work."""

    @classmethod
    def data_is_binary(cls, data: object) -> bool:
        return isinstance(data, list) and any(isinstance(item, bytes) for item in data)


@dataclass(slots=True)
class _Client:
    sid: str
    seq: int
    """Number of the newest change that was sent; -1: nothing yet."""
    seat: Seat
    who: str
    """Two pages of one person have the same."""
    wake: asyncio.Event = field(default_factory=asyncio.Event)
    """Changes or views wait."""
    look: asyncio.Event = field(default_factory=asyncio.Event)
    """Pictures wait, or there is room for one again."""
    views: dict[str, MapView] = field(default_factory=dict)
    watched: set[Key] = field(default_factory=set)
    frames: dict[Key, Picture] = field(default_factory=dict)
    """The newest picture of each feed that was not sent yet."""
    in_flight: dict[Key, list[float]] = field(default_factory=dict)
    """When the pictures went that were not confirmed yet."""
    tasks: tuple[asyncio.Task[None], ...] = ()
    session: str = ""
    """Digest of the session it came with; empty where nobody has to sign in."""
    may: Principal | None = None
    """Who it is now."""
    language: str = "en"
    """In which it is told what robots say."""


class Live:
    """The Socket.IO server of a backend. Use as ``async with``."""

    def __init__(self, backend: Backend) -> None:
        self._backend = backend
        self._clients: dict[str, _Client] = {}
        self._crowd = Crowd(MAX_STRANGERS, MAX_CLIENTS)
        self._leaving: set[asyncio.Task[None]] = set()
        self._telling: asyncio.Task[None] | None = None
        self._rendering: dict[tuple[int, str], dict[str, Any]] = {}
        self._closed = False
        self.server = socketio.AsyncServer(
            serializer=_Packet,
            async_mode="asgi",
            cors_allowed_origins=[],  # the guard checks origins for all requests alike
            max_http_buffer_size=MAX_MESSAGE_BYTES,
            async_handlers=False,
            ping_interval=10,
            ping_timeout=10,
            http_compression=False,
        )
        self.effects: dict[str, Effect] = {}
        """What each event that clients send does; whoever may not do that is not heard."""
        self.server.on("connect", self._on_connect)
        self.server.on("disconnect", self._on_disconnect)
        self._on("watch", Effect.SEE, self._on_watch)

    async def __aenter__(self) -> Live:
        self._backend.state.log.listen(self._wake_all)
        self._backend.view_listeners.append(self._on_view)
        self._backend.picture_listeners.append(self._on_picture)
        self._telling = asyncio.create_task(self._tell_attendance(), name="web attendance")
        self._backend.sessions.listeners.append(self._check_clients)
        return self

    async def __aexit__(self, *exc: object) -> None:
        await self.close()

    async def close(self) -> None:
        """Say goodbye to everybody. Idempotent."""
        if self._closed:
            return
        self._closed = True
        if self._telling is not None:
            self._telling.cancel()
        for client in list(self._clients.values()):
            await self.server.disconnect(client.sid)
            await self._drop(client)
        await self.server.shutdown()

    # -- clients ---------------------------------------------------------------------------------------

    async def _on_connect(self, sid: str, environ: dict[str, Any], auth: object = None) -> bool:
        if self._closed:
            return False
        scope = environ["asgi.scope"]
        seat = self._crowd.sit(str((scope.get("client") or ("",))[0]), lambda: self._let_go(sid))
        if who := scope["state"]["who"]:
            seat.known(who)
        log_of_changes = self._backend.state.log
        since = auth.get("since") if isinstance(auth, dict) else None
        is_same_run = isinstance(auth, dict) and auth.get("run") == log_of_changes.run
        is_number = isinstance(since, int) and not isinstance(since, bool)
        seq = since if isinstance(since, int) and is_same_run and is_number and since >= 0 else -1
        session = scope["state"].get("session")
        client = _Client(sid, seq, seat, who or sid, session=session.digest if session else "")
        client.may = self._principal(client)
        if client.may is None:
            return False
        client.language = language_of(str(auth.get("language", "")) if isinstance(auth, dict) else "")
        self._clients[sid] = client
        client.views = dict(self._backend.state.views) if seq >= 0 else {}
        client.wake.set()
        self._attendance()
        client.tasks = (
            asyncio.create_task(self._guarded(client, self._serve), name=f"web client {sid}"),
            asyncio.create_task(self._guarded(client, self._show), name=f"web pictures {sid}"),
        )
        return True

    # -- who they are ----------------------------------------------------------------------------------

    def _on(self, event: str, effect: Effect, handle: Callable[..., Awaitable[Any]]) -> None:
        """Hear an event of clients who may do what it does."""
        self.effects[event] = effect

        async def check(sid: str, *data: Any) -> Any:
            client = self._clients.get(sid)
            if client is None or verdict(client.may, effect) != "allow" or client.may is None:
                return None
            return await handle(sid, *data)

        self.server.on(event, check)

    def _principal(self, client: _Client) -> Principal | None:
        sessions = self._backend.sessions
        device = sessions.holding(client.session) if client.session else None
        if client.session and device is None:
            return None
        return sessions.principal(device, Gadget())

    def _check_clients(self) -> None:
        """Who came and who may do what has changed: some are out, and some are something else."""
        for client in list(self._clients.values()):
            before, client.may = client.may, self._principal(client)
            if client.may is None:
                task = asyncio.create_task(self._send_away(client), name=f"web goodbye {client.sid}")
                self._leaving.add(task)
                task.add_done_callback(self._leaving.discard)
            elif client.may != before:
                task = asyncio.create_task(self._emit(client, "session", {}), name=f"web role {client.sid}")
                self._leaving.add(task)
                task.add_done_callback(self._leaving.discard)

    async def _send_away(self, client: _Client) -> None:
        await self._drop(client)
        await self.server.disconnect(client.sid)

    async def _on_disconnect(self, sid: str, *reason: object) -> None:
        client = self._clients.get(sid)
        if client is not None:
            await self._drop(client)

    def _attendance(self) -> None:
        people = len({client.who for client in self._clients.values()})
        self._backend.link.send(Attendance(server=self._backend.state.log.run, people=people))

    async def _tell_attendance(self) -> None:
        while True:
            self._attendance()
            await asyncio.sleep(ATTENDANCE_S)

    def _let_go(self, sid: str) -> None:
        """It gives way to somebody else."""
        log.warning("a live stream gives way", sid=sid)
        task = asyncio.create_task(self.server.disconnect(sid), name=f"web goodbye {sid}")
        self._leaving.add(task)
        task.add_done_callback(self._leaving.discard)

    async def _drop(self, client: _Client) -> None:
        self._clients.pop(client.sid, None)
        client.seat.free()
        self._attendance()
        for key in client.watched:
            self._backend.feeds.unwatch(key)
        client.watched = set()
        others = [task for task in client.tasks if task is not asyncio.current_task()]
        for task in others:
            task.cancel()
        await asyncio.gather(*others, return_exceptions=True)

    async def _on_watch(self, sid: str, wanted: object = None) -> None:
        """A client says which feeds it looks at: all of them, each time."""
        client = self._clients.get(sid)
        if client is None or "display" in self._backend.config.without:
            return
        try:
            keys = {(feed.robot, feed.name) for feed in _FEEDS.validate_python(wanted)[:MAX_WATCHED]}
        except ValidationError:
            return
        feeds, known = self._backend.feeds, self._backend.state.feeds
        for key in keys - client.watched:
            feeds.watch(key)
            if key in known.pictures:
                client.frames[key] = known.pictures[key]
        for key in client.watched - keys:
            feeds.unwatch(key)
            client.frames.pop(key, None)
        client.watched = keys
        client.look.set()

    # -- what is new -----------------------------------------------------------------------------------

    def _wake_all(self) -> None:
        for client in self._clients.values():
            client.wake.set()

    def _on_view(self, view: MapView) -> None:
        for client in self._clients.values():
            client.views[view.actor] = view
            client.wake.set()

    def _on_picture(self, key: Key, picture: Picture) -> None:
        for client in self._clients.values():
            if key in client.watched:
                client.frames[key] = picture
                client.look.set()

    # -- sending ---------------------------------------------------------------------------------------

    async def _guarded(self, client: _Client, work: Callable[[_Client], Awaitable[None]]) -> None:
        """One client's trouble is no other's; it connects anew and starts from a snapshot."""
        try:
            await work(client)
        except asyncio.CancelledError:
            raise
        except Exception:
            log.exception("client dropped", sid=client.sid)
            await self.server.disconnect(client.sid)

    async def _serve(self, client: _Client) -> None:
        """Send changes and views to one client, always the newest, never more than it takes."""
        while True:
            await client.wake.wait()
            client.wake.clear()
            await asyncio.sleep(0)  # what else happens in this turn of the loop goes along
            await self._taken(client)
            await self._send_changes(client)
            await self._send_views(client)
            await asyncio.sleep(PACE_S)

    async def _show(self, client: _Client) -> None:
        """Send pictures to one client as they come: they are old soon, so they wait for nothing else."""
        while True:
            await client.look.wait()
            client.look.clear()
            await self._taken(client)
            await self._send_frames(client)

    async def _taken(self, client: _Client) -> None:
        """Wait until what was sent before left for the network."""
        eio_sid = self.server.manager.eio_sid_from_sid(client.sid, "/")
        socket = self.server.eio.sockets.get(eio_sid) if eio_sid else None
        if socket is not None:
            await socket.queue.join()

    async def _send_changes(self, client: _Client) -> None:
        changes = self._backend.state.log.since(client.seq) if client.seq >= 0 else None
        if changes is None:
            snapshot = self._backend.snapshot()
            client.seq = snapshot.seq
            await self._emit(client, "snapshot", shown_in(client.language, snapshot))
        elif changes:
            client.seq = changes[-1].seq
            await self._emit(
                client, "changes", [self._rendered(change, client.language) for change in changes]
            )

    def _rendered(self, change: Change, language: str) -> dict[str, Any]:
        """A change as it travels; made once for all clients of a language that are about in step."""
        found = self._rendering.get((change.seq, language))
        if found is None:
            found = self._rendering[change.seq, language] = shown_in(language, change)
            if len(self._rendering) > MAX_RENDERED:
                del self._rendering[next(iter(self._rendering))]
        return found

    async def _send_views(self, client: _Client) -> None:
        views, client.views = client.views, {}
        for view in views.values():
            await self._emit(client, "view", _plain(view))

    async def _send_frames(self, client: _Client) -> None:
        now_s = self._backend.clock.wall_s()
        for key in list(client.frames):
            if key not in client.frames:
                continue  # it looked away while another picture was sent
            flying = [at_s for at_s in client.in_flight.get(key, ()) if now_s - at_s < CONFIRM_WITHIN_S]
            client.in_flight[key] = flying
            if len(flying) >= IN_FLIGHT:
                loop = asyncio.get_running_loop()
                loop.call_later(CONFIRM_WITHIN_S, client.look.set)  # should none of them be confirmed
            else:
                picture = client.frames.pop(key)
                flying.append(now_s)
                meta = FrameMeta(robot=key[0], name=key[1], unix_ms=picture.unix_ms, number=picture.number)
                await self._emit(
                    client, "frame", (_plain(meta), picture.data), self._confirm(client, key, now_s)
                )

    def _confirm(self, client: _Client, key: Key, sent_s: float) -> Callable[..., None]:
        def confirmed(*_: object) -> None:
            flying = client.in_flight.get(key, [])
            if sent_s in flying:
                flying.remove(sent_s)
            if key in client.frames:
                client.look.set()

        return confirmed

    async def _emit(
        self, client: _Client, event: str, data: Any, callback: Callable[..., None] | None = None
    ) -> None:
        await self.server.emit(event, data, to=client.sid, callback=callback)


def _plain(model: BaseModel) -> dict[str, Any]:
    return model.model_dump(mode="json")
