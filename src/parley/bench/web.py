"""The page's server under load, over real sockets: feedback of many robots and many pictures at once.

Three processes: robots that only send (`web_load`), the server with the display interface (this one), and a
page that only listens (`web_page`). Each picture carries the time of its taking, so that it can be said where
it waited. Then the same load once more with a real browser (`web_browser`) in the page's place.
"""

from __future__ import annotations

import asyncio
import base64
import contextlib
import gc
import json
import os
import resource
import sys
import time
from collections.abc import AsyncIterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from starlette.types import ASGIApp, Message, Receive, Scope, Send

from parley.agents.display.display_interface import DisplayInterface
from parley.bench.engine import share
from parley.bench.web_browser import BrowserFigures, measure_browser
from parley.bench.web_load import TOPICS, feed_name, robot_name
from parley.clock import WallClock
from parley.errors import ParleyError
from parley.messages import topics
from parley.messages.ros import String
from parley.transport.local import LocalTransport
from parley.web.feed_state import Picture

__all__ = ["WebFigures", "measure_web"]

WARM_UP_S: Final = 1.0
_STAGES: Final = ("heard", "at_web", "queued", "written")
"""Of a picture in the server: read from the robots; made ready by the display interface; given to the page's
socket; taken by the network."""

_IMAGE: Final = '"image":"'


@dataclass(frozen=True, slots=True)
class WebFigures:
    """What one load did; robots, server and page are processes on the same machine."""

    robots: int
    feeds: int
    seconds: float
    change_ms: tuple[float, ...]
    """Wall time from an engine's progress to the page, for each that was shown."""
    frame_ms: tuple[float, ...]
    """Wall time from a picture's taking to the page, for each that was shown."""
    stage_ms: Mapping[str, tuple[float, ...]]
    """Wall time from a picture's taking to each of the stages in the server, for those that were shown."""
    server_ms: tuple[float, ...]
    """Of each picture, the wall time between the first stage and the last."""
    frames_taken: int
    server_cpu_share: float
    """Processor time of the server's process per wall time; the display interface is in it."""
    page_cpu_share: float
    starved_share: float
    """Time in which the server's loop could have run, but others had the processor; 0 if unknown."""
    load_average: float
    """Of the machine in the last minute: with more than its cores, all waits are longer."""
    rss_mb: float
    browser: BrowserFigures | None = None
    """What a real browser made of the same load, apart from everything above."""
    no_browser: str = ""
    """Why there is none."""

    def facts(self) -> dict[str, Any]:
        """The server with a page that only listens, for printing."""
        stages = {
            f"frame_{stage}_p95_ms": round(share(ages, 0.95), 1) for stage, ages in self.stage_ms.items()
        }
        return {
            "robots": self.robots,
            "feeds": self.feeds,
            "seconds": round(self.seconds, 1),
            "changes": len(self.change_ms),
            "change_p50_ms": round(share(self.change_ms, 0.5), 1),
            "change_p95_ms": round(share(self.change_ms, 0.95), 1),
            "frames_taken": self.frames_taken,
            "frames_shown": len(self.frame_ms),
            **stages,
            "frame_in_server_p50_ms": round(share(self.server_ms, 0.5), 1),
            "frame_in_server_p95_ms": round(share(self.server_ms, 0.95), 1),
            "frame_p50_ms": round(share(self.frame_ms, 0.5), 1),
            "frame_p95_ms": round(share(self.frame_ms, 0.95), 1),
            "server_cpu_share": round(self.server_cpu_share, 2),
            "page_cpu_share": round(self.page_cpu_share, 2),
            "server_starved_share": round(self.starved_share, 2),
            "load_average": round(self.load_average, 1),
            "cores": os.cpu_count(),
            "peak_rss_mb": round(self.rss_mb),
        }


class _Probe:
    """Notes when each picture reached each stage in the server, by the stamp at its end."""

    def __init__(self) -> None:
        self.at_ns: dict[str, dict[int, int]] = {stage: {} for stage in _STAGES}

    def take(self) -> dict[str, dict[int, int]]:
        """What was noted until now; it is not noted any longer."""
        taken = self.at_ns
        self.at_ns = {stage: {} for stage in _STAGES}
        return taken

    def note(self, stage: str, data: bytes) -> None:
        """A picture is there."""
        self.at_ns[stage].setdefault(int.from_bytes(data[-8:]), time.time_ns())

    def on_picture(self, _: tuple[str, str], picture: Picture) -> None:
        """The page's server has a picture."""
        self.note("at_web", picture.data)

    def around(self, app: ASGIApp) -> ASGIApp:
        """Watch what is written to the sockets of pages."""

        async def watched(scope: Scope, receive: Receive, send: Send) -> None:
            async def noting(message: Message) -> None:
                data = message.get("bytes") if message["type"] == "websocket.send" else None
                if data:
                    self.note("queued", data)
                await send(message)
                if data:
                    self.note("written", data)

            await app(scope, receive, noting)

        return watched


async def measure_web(
    *,
    robots: int = 50,
    feedback_hz: float = 10.0,
    feeds: int = 8,
    feed_hz: float = 10.0,
    seconds: float = 10.0,
    browser: bool = True,
) -> WebFigures:
    """Load a server and let one page listen, then one in a real browser if there is one and `browser` is set.

    Raises:
        ParleyError: The page heard nothing.
    """
    from parley.web.config import WebConfig
    from parley.web.server import WebServer

    probe = _Probe()
    async with (
        LocalTransport() as transport,
        DisplayInterface(transport, WallClock(), min_interval_s=0.0),
        WebServer(transport, WebConfig(port=0), around=probe.around) as server,
        _load(transport, probe, robots, feedback_hz, feeds, feed_hz),
    ):
        server.backend.picture_listeners.append(probe.on_picture)
        keys = [{"robot": robot_name(n % robots), "name": feed_name(n)} for n in range(feeds)]
        gc.freeze()  # as `parley demo` does
        before_s, began_s, starved_s = time.process_time(), time.perf_counter(), -_starved_s()
        async with _process("web_page", server.url, str(seconds + WARM_UP_S), json.dumps(keys)) as page:
            out, _ = await page.communicate()
        starved_s += _starved_s()
        wall_s, cpu_s = time.perf_counter() - began_s, time.process_time() - before_s
        load_average, stages = os.getloadavg()[0], probe.take()
        drawn, why_not = await _drawn(server.url, seconds, feeds) if browser else (None, "not asked for")
    heard = json.loads(out)
    if not heard["changes"] or (feeds and not heard["frames"]):
        raise ParleyError("the page heard nothing, so nothing was measured")
    frames = [stamp for stamp, _ in heard["frames"]]
    return WebFigures(
        robots=robots,
        feeds=feeds,
        seconds=wall_s,
        change_ms=_ages(heard["changes"]),
        frame_ms=_ages(heard["frames"]),
        stage_ms={
            stage: _ages([(stamp, at_ns[stamp]) for stamp in frames if stamp in at_ns])
            for stage, at_ns in stages.items()
        },
        server_ms=_ages(
            [
                (at_ns, stages["written"][stamp])
                for stamp, at_ns in stages["heard"].items()
                if stamp in stages["written"]
            ]
        ),
        frames_taken=len(stages["heard"]),
        server_cpu_share=cpu_s / wall_s,
        page_cpu_share=heard["cpu_s"] / wall_s,
        starved_share=starved_s / wall_s,
        load_average=load_average,
        rss_mb=resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024,
        browser=drawn,
        no_browser=why_not,
    )


async def _drawn(address: str, seconds: float, feeds: int) -> tuple[BrowserFigures | None, str]:
    """What a real browser made of it, or why there is nothing."""
    try:
        return await measure_browser(address, seconds, feeds), ""
    except ParleyError as error:
        return None, str(error)


def _starved_s() -> float:
    """How long this thread has waited for a processor until now, where the system says so (Linux)."""
    try:
        return int(Path("/proc/thread-self/schedstat").read_text().split()[1]) / 1e9
    except (OSError, IndexError, ValueError):
        return 0.0


def _ages(pairs: list[tuple[int, int]]) -> tuple[float, ...]:
    """Milliseconds between the two times of each pair; one zero where there is none."""
    return tuple((came_ns - made_ns) / 1e6 for made_ns, came_ns in pairs) or (0.0,)


@contextlib.asynccontextmanager
async def _process(module: str, *arguments: str) -> AsyncIterator[asyncio.subprocess.Process]:
    """A process that ends with what it is for, and hears of Ctrl-C from nobody else."""
    process = await asyncio.create_subprocess_exec(
        sys.executable, "-m", f"parley.bench.{module}", *arguments,
        stdout=asyncio.subprocess.PIPE, limit=8 * 1024 * 1024, start_new_session=True,
    )  # fmt: skip
    try:
        yield process
    finally:
        with contextlib.suppress(ProcessLookupError):  # it has ended already
            process.kill()
        await process.wait()


@contextlib.asynccontextmanager
async def _load(
    transport: LocalTransport, probe: _Probe, robots: int, feedback_hz: float, feeds: int, feed_hz: float
) -> AsyncIterator[None]:
    """Publish what the robots' process sends."""
    async with _process("web_load", str(robots), str(feedback_hz), str(feeds), str(feed_hz)) as process:
        assert process.stdout is not None
        hearing = asyncio.create_task(_hear(process.stdout, transport, probe), name="robots of the bench")
        try:
            yield
        finally:
            hearing.cancel()
            await asyncio.gather(hearing, return_exceptions=True)


async def _hear(lines: asyncio.StreamReader, transport: LocalTransport, probe: _Probe) -> None:
    publishers = {name: transport.publisher(topic) for name, topic in TOPICS.items()}
    while line := await lines.readline():
        name, _, text = line.decode().rstrip("\n").partition(" ")
        publishers[name].publish(String(text))
        if name == topics.DISPLAY_FEED.name:
            began = text.index(_IMAGE) + len(_IMAGE)
            end = text.index('"', began)
            probe.note("heard", base64.b64decode(text[end - 16 : end]))
