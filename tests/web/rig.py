"""A real server over real sockets; the other side of the topics is played over a real transport."""

from __future__ import annotations

import asyncio
import io
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from typing import Any, TypeVar

import httpx
import socketio
from PIL import Image
from pydantic import BaseModel

from parley.clock import Clock, WallClock
from parley.messages import topics
from parley.messages.audit import AuditEvent
from parley.messages.chat import ChatAction, ChatFeedback, ChatInput
from parley.messages.ros import CompressedImage, Header, String, Time
from parley.messages.status import ActorStatus, PlanDecision, StopCommand
from parley.messages.topics import Topic, display_topic
from parley.messages.wire import decode, to_string
from parley.transport.local import LocalTransport
from parley.web.config import WebConfig
from parley.web.server import WebServer

P = TypeVar("P", bound=BaseModel)


def picture(kind: str = "JPEG", width_px: int = 2, height_px: int = 1) -> bytes:
    """A small picture."""
    out = io.BytesIO()
    Image.new("RGB", (width_px, height_px)).save(out, kind)
    return out.getvalue()


JPEG = picture()


class HandClock(WallClock):
    """Wall time that goes on only when a test says so."""

    def __init__(self) -> None:
        self._began_s, self._began_ms = super().wall_s(), super().unix_ms()
        self.ahead_s = 0.0

    def wall_s(self) -> float:
        return self._began_s + self.ahead_s

    def unix_ms(self) -> int:
        return self._began_ms + int(self.ahead_s * 1000)


class Robots:
    """Publishes as robots and nodes would, and keeps what the server sent to them."""

    def __init__(self, transport: LocalTransport) -> None:
        self.transport = transport
        self.inputs: list[ChatInput] = []
        self.orders: list[ChatAction] = []
        self.decisions: list[PlanDecision] = []
        self.stops: list[StopCommand] = []
        self.audited: list[AuditEvent] = []

    async def listen(self) -> None:
        """Hear what operators send."""
        await self._collect(topics.CHAT_INPUT, ChatInput, self.inputs)
        await self._collect(topics.CHAT_ACTION, ChatAction, self.orders)
        await self._collect(topics.PLAN_DECISION, PlanDecision, self.decisions)
        await self._collect(topics.STOP, StopCommand, self.stops)
        await self._collect(topics.AUDIT, AuditEvent, self.audited)

    async def _collect(self, topic: Topic[String], kind: type[P], into: list[P]) -> None:
        await self.transport.subscribe(topic, lambda message: into.append(decode(kind, message.data)))

    def tell(self, topic: Topic[String], payload: BaseModel) -> None:
        """Publish once."""
        publisher = self.transport.publisher(topic)
        publisher.publish(to_string(payload))
        publisher.close()

    def appear(self, name: str = "Ada", state: str = "idle", **more: Any) -> None:
        """Send one heartbeat."""
        self.tell(topics.ACTOR_STATUS, ActorStatus.model_validate({"actor": name, "state": state, **more}))

    def say(self, text: str, *, name: str = "Ada", **more: Any) -> None:
        """Speak."""
        self.tell(
            topics.CHAT_FEEDBACK, ChatFeedback.model_validate({"message": text, "targets": [name], **more})
        )

    def ask(self, text: str, *choices: str, name: str = "Ada", question_id: str = "q1") -> None:
        """Ask and await an answer."""
        self.say(text, name=name, type="request", choices=choices, id=question_id)

    def show(self, name: str, feed: str, data: bytes = JPEG, unix_ms: int = 1_790_000_000_000) -> None:
        """Publish a finished picture."""
        stamp = Time(unix_ms // 1000, unix_ms % 1000 * 1_000_000)
        self.transport.publisher(display_topic(name, feed)).publish(
            CompressedImage(Header(stamp, feed), "jpeg", data)
        )


class Page:
    """What a page in a browser does: listens, and applies what it hears."""

    def __init__(self) -> None:
        self.io = socketio.AsyncClient(reconnection=False)
        self.snapshots: list[dict[str, Any]] = []
        self.batches: list[list[dict[str, Any]]] = []
        self.views: list[dict[str, Any]] = []
        self.frames: list[tuple[dict[str, Any], bytes]] = []
        self.run, self.seq = "", -1
        self.confirms = True
        self._changed = asyncio.Event()
        self.io.on("snapshot", self._on_snapshot)
        self.io.on("changes", self._on_changes)
        self.io.on("view", self._on_view)
        self.io.on("frame", self._on_frame)

    async def open(self, url: str, *, again: bool = False, language: str = "en", **options: Any) -> None:
        """Connect, as somebody new or after a break."""
        auth = {"run": self.run, "since": self.seq} if again else {}
        auth["language"] = language
        await self.io.connect(url, auth=auth, transports=["websocket"], **options)

    @property
    def changes(self) -> list[dict[str, Any]]:
        """All changes that came, in order."""
        return [change for batch in self.batches for change in batch]

    def of(self, kind: str) -> list[dict[str, Any]]:
        """All changes of one kind."""
        return [change for change in self.changes if change["kind"] == kind]

    async def close(self) -> None:
        """Hang up, also where connecting failed."""
        await self.io.disconnect()
        if self.io.eio.http is not None:
            await self.io.eio.http.close()

    async def until(self, condition: Callable[[], object]) -> None:
        """Wait until what came makes `condition` true."""
        async with asyncio.timeout(20):
            while not condition():
                self._changed.clear()
                await self._changed.wait()

    def _on_snapshot(self, snapshot: dict[str, Any]) -> None:
        self.snapshots.append(snapshot)
        self.run, self.seq = snapshot["run"], snapshot["seq"]
        self._changed.set()

    def _on_changes(self, batch: list[dict[str, Any]]) -> None:
        self.batches.append(batch)
        self.seq = batch[-1]["seq"]
        self._changed.set()

    def _on_view(self, view: dict[str, Any]) -> None:
        self.views.append(view)
        self._changed.set()

    async def _on_frame(self, meta: dict[str, Any], data: bytes) -> None:
        self.frames.append((meta, data))
        self._changed.set()
        if not self.confirms:
            await asyncio.Event().wait()


class Rig:
    """One server with everything around it."""

    def __init__(self, server: WebServer, robots: Robots, http: httpx.AsyncClient) -> None:
        self.server, self.robots, self.http = server, robots, http
        self.pages: list[Page] = []

    @property
    def url(self) -> str:
        """Where the server is."""
        return self.server.url

    async def page(self, **options: Any) -> Page:
        """A page that is open and has its snapshot."""
        page = Page()
        self.pages.append(page)
        await page.open(self.url, **options)
        await page.until(lambda: page.snapshots)
        return page

    async def heard(self) -> None:
        """Wait until the server has handled everything that was published before."""
        log = self.server.backend.state.log
        marker = f"marker {log.seq}"
        done = asyncio.Event()
        log.listen(done.set)
        self.robots.appear(marker)
        async with asyncio.timeout(10):
            while marker not in self.server.backend.state.robots.views:
                done.clear()
                await done.wait()
        self.server.backend.state.remove_robot(marker)
        ends = self.robots.transport._subscriptions.values()
        while any(end._queue for some in ends for end in some):  # noqa: ASYNC110 - many messages are overtaken
            await asyncio.sleep(0)

    async def until(self, condition: Callable[[], object]) -> None:
        """Wait until something changes so that `condition` holds."""
        changed = asyncio.Event()
        self.server.backend.state.log.listen(changed.set)
        async with asyncio.timeout(20):
            while not condition():
                changed.clear()
                await changed.wait()


@asynccontextmanager
async def served(*names: str, clock: Clock | None = None, **settings: Any) -> AsyncIterator[Rig]:
    """A server on a free port, with robots of these names.

    Args:
        names: Robots that are there.
        clock: The server's.
        settings: Of `WebConfig`.
    """
    async with LocalTransport() as transport:
        robots = Robots(transport)
        await robots.listen()
        async with (
            WebServer(transport, WebConfig(port=0, **settings), clock=clock) as server,
            httpx.AsyncClient(base_url=server.url, verify=False, timeout=20) as http,
        ):
            rig = Rig(server, robots, http)
            for name in names:
                robots.appear(name)
            await rig.until(lambda: set(names) <= set(server.backend.state.robots.views))
            try:
                yield rig
            finally:
                for page in rig.pages:
                    await page.close()
        assert transport.handler_failures == 0
