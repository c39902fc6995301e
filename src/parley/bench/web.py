"""The page's server under load, over real sockets: feedback of many robots and many pictures at once."""

from __future__ import annotations

import asyncio
import base64
import io
import json
import resource
import sys
import time
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from PIL import Image

from parley.bench.engine import share
from parley.clock import WallClock
from parley.errors import ParleyError
from parley.messages import topics
from parley.messages.chat import ActionCall
from parley.messages.display import DisplayFeed
from parley.messages.ros import String
from parley.messages.status import ActorStatus, GraphEvent, PlanStep, PlanUpdate
from parley.messages.wire import to_string
from parley.nodes.display_interface import DisplayInterface
from parley.transport.base import Publisher
from parley.transport.local import LocalTransport

__all__ = ["WebFigures", "measure_web"]

STEPS: Final = 6
WARM_UP_S: Final = 1.0


@dataclass(frozen=True, slots=True)
class WebFigures:
    """What one load did; the page is a process of its own on the same machine."""

    robots: int
    feeds: int
    seconds: float
    change_ms: tuple[float, ...]
    """Wall time from an engine's progress to the page's socket, for each that was shown."""
    frame_ms: tuple[float, ...]
    """Wall time from a picture's taking to the page's socket, for each that was shown."""
    frames_sent: int
    server_cpu_share: float
    """Processor time of the server's process per wall time; load generator and display interface included."""
    rss_mb: float

    def facts(self) -> dict[str, Any]:
        """For printing."""
        return {
            "robots": self.robots,
            "feeds": self.feeds,
            "seconds": round(self.seconds, 1),
            "changes": len(self.change_ms),
            "change_p50_ms": round(share(self.change_ms, 0.5), 1),
            "change_p95_ms": round(share(self.change_ms, 0.95), 1),
            "frames_taken": self.frames_sent,
            "frames_shown": len(self.frame_ms),
            "frame_p50_ms": round(share(self.frame_ms, 0.5), 1),
            "frame_p95_ms": round(share(self.frame_ms, 0.95), 1),
            "server_cpu_share": round(self.server_cpu_share, 2),
            "peak_rss_mb": round(self.rss_mb),
        }


async def measure_web(
    *,
    robots: int = 50,
    feedback_hz: float = 10.0,
    feeds: int = 8,
    feed_hz: float = 10.0,
    seconds: float = 10.0,
) -> WebFigures:
    """Load a server and let one page listen.

    Raises:
        ParleyError: The page heard nothing.
    """
    from parley.web.config import WebConfig
    from parley.web.server import WebServer

    async with (
        LocalTransport() as transport,
        DisplayInterface(transport, WallClock(), min_interval_s=0.0),
        WebServer(transport, WebConfig(port=0)) as server,
    ):
        names = [f"robot_{number}" for number in range(robots)]
        _begin(transport, names)
        keys = [{"robot": names[number % robots], "name": f"camera_{number}"} for number in range(feeds)]
        page = await asyncio.create_subprocess_exec(
            sys.executable, "-m", "parley.bench.web_page", server.url, str(seconds + WARM_UP_S),
            json.dumps(keys), stdout=asyncio.subprocess.PIPE,
        )  # fmt: skip
        before_s, began_s = time.process_time(), time.perf_counter()
        load = [asyncio.create_task(_feedback(transport.publisher(topics.GRAPH_EVENTS), names, feedback_hz))]
        taken = [0]
        picture = _picture()
        feed = transport.publisher(topics.DISPLAY_FEED)
        load += [asyncio.create_task(_film(feed, key, picture, feed_hz, taken)) for key in keys]
        out, _ = await page.communicate()
        wall_s, cpu_s = time.perf_counter() - began_s, time.process_time() - before_s
        for task in load:
            task.cancel()
        await asyncio.gather(*load, return_exceptions=True)
    heard = json.loads(out)
    if not heard["change_ms"] or (feeds and not heard["frame_ms"]):
        raise ParleyError("the page heard nothing, so nothing was measured")
    return WebFigures(
        robots=robots,
        feeds=feeds,
        seconds=wall_s,
        change_ms=tuple(heard["change_ms"]),
        frame_ms=tuple(heard["frame_ms"]) or (0.0,),
        frames_sent=taken[0],
        server_cpu_share=cpu_s / wall_s,
        rss_mb=resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024,
    )


def _begin(transport: LocalTransport, names: list[str]) -> None:
    """Let the robots appear, each with a plan."""
    status, plans = transport.publisher(topics.ACTOR_STATUS), transport.publisher(topics.PLAN)
    steps = tuple(
        PlanStep(action=ActionCall(name="Move"), node=f"Move_{n}", state="queued" if n else "running")
        for n in range(STEPS)
    )
    for name in names:
        status.publish(to_string(ActorStatus(actor=name, state="running")))
        plans.publish(
            to_string(PlanUpdate(target=name, graph_name=f"{name}_g", state="running", steps=steps))
        )


async def _feedback(publisher: Publisher[String], names: list[str], rate_hz: float) -> None:
    """Progress of all robots, spread evenly over time."""
    sequence = 0
    due_s = time.perf_counter()
    while True:
        for name in names:
            event = GraphEvent(
                actor=name,
                graph_name=f"{name}_g",
                sequence=sequence,
                kind="progress",
                node="Move_0",
                progress=0.5,
                progress_text=str(time.time_ns()),
            )
            publisher.publish(to_string(event))
            due_s += 1 / (rate_hz * len(names))
            await asyncio.sleep(max(0.0, due_s - time.perf_counter()))
        sequence += 1


async def _film(
    publisher: Publisher[String], key: dict[str, str], picture: bytes, rate_hz: float, taken: list[int]
) -> None:
    due_s = time.perf_counter()
    while True:
        data = base64.b64encode(picture + time.time_ns().to_bytes(8)).decode()
        publisher.publish(to_string(DisplayFeed(target=key["robot"], name=key["name"], image=data)))
        taken[0] += 1
        due_s += 1 / rate_hz
        await asyncio.sleep(max(0.0, due_s - time.perf_counter()))


def _picture() -> bytes:
    """A JPEG of 640x480 with as much in it as a camera's."""
    rng = np.random.default_rng(1)
    coarse = rng.integers(0, 255, (60, 80, 3), dtype=np.uint8)
    out = io.BytesIO()
    Image.fromarray(coarse).resize((640, 480)).save(out, "JPEG", quality=85)
    return out.getvalue()
