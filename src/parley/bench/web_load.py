"""Robots without bodies, for measuring the page's server: a process of its own that only sends.

Run as ``python -m parley.bench.web_load ROBOTS FEEDBACK_HZ FEEDS FEED_HZ``; prints one line per message, its
topic and its JSON, until it is killed. What it sends carries the time at which it was made.
"""

from __future__ import annotations

import base64
import io
import sys
import time
from collections.abc import Iterator
from heapq import heapify, heapreplace
from typing import Final

import numpy as np
from PIL import Image
from pydantic import BaseModel

from parley.messages import topics
from parley.messages.chat import ActionCall
from parley.messages.display import DisplayFeed
from parley.messages.ros import String
from parley.messages.status import ActorStatus, GraphEvent, PlanStep, PlanUpdate
from parley.messages.topics import Topic
from parley.messages.wire import encode

__all__ = ["TOPICS", "feed_name", "main", "robot_name"]

TOPICS: Final[dict[str, Topic[String]]] = {
    topic.name: topic
    for topic in (topics.ACTOR_STATUS, topics.PLAN, topics.GRAPH_EVENTS, topics.DISPLAY_FEED)
}
"""What is sent, by name."""
STEPS: Final = 6


def robot_name(number: int) -> str:
    """What the robots are called."""
    return f"robot_{number}"


def feed_name(number: int) -> str:
    """What the feeds are called."""
    return f"camera_{number}"


def _line(topic: Topic[String], payload: BaseModel) -> bytes:
    return f"{topic.name} {encode(payload)}\n".encode()


def _beginnings(robots: int) -> Iterator[bytes]:
    """The robots appear, each with a plan."""
    steps = tuple(
        PlanStep(action=ActionCall(name="Move"), node=f"Move_{n}", state="queued" if n else "running")
        for n in range(STEPS)
    )
    for name in map(robot_name, range(robots)):
        yield _line(topics.ACTOR_STATUS, ActorStatus(actor=name, state="running"))
        plan = PlanUpdate(target=name, graph_name=f"{name}_g", state="running", steps=steps)
        yield _line(topics.PLAN, plan)


def _progress(name: str, sequence: int) -> bytes:
    event = GraphEvent(
        actor=name,
        graph_name=f"{name}_g",
        sequence=sequence,
        kind="progress",
        node="Move_0",
        progress=0.5,
        progress_text=str(time.time_ns()),
    )
    return _line(topics.GRAPH_EVENTS, event)


def _picture(jpeg: bytes, robot: str, feed: str) -> bytes:
    """A picture whose last eight bytes are the time of its taking."""
    data = base64.b64encode(jpeg + time.time_ns().to_bytes(8)).decode()
    return _line(topics.DISPLAY_FEED, DisplayFeed(target=robot, name=feed, image=data))


def _jpeg() -> bytes:
    """A JPEG of 640x480 with as much in it as a camera's."""
    rng = np.random.default_rng(1)
    coarse = rng.integers(0, 255, (60, 80, 3), dtype=np.uint8)
    out = io.BytesIO()
    Image.fromarray(coarse).resize((640, 480)).save(out, "JPEG", quality=85)
    return out.getvalue()


def main(arguments: list[str]) -> None:
    """Send as the command line says, spread evenly over time."""
    robots, feeds = int(arguments[0]), int(arguments[2])
    feedback_hz, feed_hz = float(arguments[1]), float(arguments[3])
    jpeg, out = _jpeg(), sys.stdout.buffer
    for line in _beginnings(robots):
        out.write(line)
    began_s = time.perf_counter()
    due = [(began_s + n / (feedback_hz * robots), 1 / feedback_hz, 0, n) for n in range(robots)]
    due += [(began_s + n / (feed_hz * feeds), 1 / feed_hz, 1, n) for n in range(feeds)]
    heapify(due)
    sequence = 0
    while True:
        at_s, period_s, is_picture, number = due[0]
        if (wait_s := at_s - time.perf_counter()) > 0:
            out.flush()
            time.sleep(wait_s)
        if is_picture:
            out.write(_picture(jpeg, robot_name(number % robots), feed_name(number)))
        else:
            sequence += 1
            out.write(_progress(robot_name(number), sequence))
        heapreplace(due, (at_s + period_s, period_s, is_picture, number))


if __name__ == "__main__":
    main(sys.argv[1:])
