"""The demonstration as a real process: a robot that drives, a page that is open, and faults put into it."""

from __future__ import annotations

import contextlib
import json
import os
import resource
import signal
import socket
import sqlite3
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

import httpx
from websockets.exceptions import WebSocketException
from websockets.sync.client import ClientConnection, connect
from websockets.typing import Origin

ROBOT = "David"
HELD_UP_S = 8.0
"""For so long the action that blocks the loop does so."""
ACTIONS = f'''
"""Actions that drive for ever, one of them in a way in which no action may."""

import asyncio
import time
from pathlib import Path

from parley.robots.base import Velocity
from parley.umrf.action import action


@action(phrases=("patrol the floor",), effects=("moves",), capabilities=("drive",))
async def patrol(ctx):
    """Patrol the floor."""
    while True:
        ctx.robot.drive(Velocity(0.1, 0.5))
        await ctx.clock.sleep(0.1)


@action(phrases=("patrol without a break",), effects=("moves",), capabilities=("drive",))
async def patrol_blocking(ctx):
    """Patrol without a break."""
    for _ in range(20):
        ctx.robot.drive(Velocity(0.1, 0.5))
        await asyncio.sleep(0.05)
    Path(__file__).with_suffix(".blocking").touch()
    time.sleep({HELD_UP_S})
    while True:
        ctx.robot.drive(Velocity(0.1, 0.5))
        await asyncio.sleep(0.05)
'''
_STOPS_WITHIN_S = 30.0


class System:
    """One process with its page. Made by `running`."""

    def __init__(self, process: subprocess.Popen[str], url: str, folder: Path, stack: ExitStack) -> None:
        self.process, self.url, self.folder, self._stack = process, url, folder, stack
        self.http = stack.enter_context(httpx.Client(base_url=url, timeout=20))
        self.line: ClientConnection
        self._presses = 0

    def open_page(self) -> None:
        """Do what a browser does: take the page and its cookie, and open the line for stopping."""
        assert self.http.get("/").status_code == 200
        cookie = "; ".join(f"{name}={value}" for name, value in self.http.cookies.items())
        self.line = self._stack.enter_context(
            connect(
                self.url.replace("http", "ws") + "api/stop/line",
                origin=Origin(self.url.rstrip("/")),
                additional_headers={"Cookie": cookie},
                open_timeout=20,
            )
        )
        assert self.line.recv(timeout=20) == "{}"

    def robot(self) -> dict[str, Any]:
        """How the robot is, as the page sees it."""
        return dict(self.http.get(f"/api/robots/{ROBOT}").json())

    def until(self, condition: Callable[[], object], within_s: float = _STOPS_WITHIN_S) -> None:
        """Wait for what another process does."""
        ends_s = time.monotonic() + within_s
        while not condition():
            assert time.monotonic() < ends_s, "it did not come to that in time"
            time.sleep(0.05)

    def say(self, text: str) -> int:
        """Say something to the robot."""
        self._presses += 1
        post = {"id": f"m{self._presses}", "text": text, "targets": [ROBOT]}
        return self.http.post("/api/chat", json=post).status_code

    def anew(self, method: str, path: str) -> httpx.Response:
        """The same page on a new connection."""
        return httpx.request(method, self.url.rstrip("/") + path, cookies=self.http.cookies, timeout=20)

    def drive(self, order: str = "patrol the floor") -> None:
        """Let the robot drive, whatever it did before."""
        self.release()
        self.say(order)
        self.until(lambda: self.robot()["at_rest"] is False)

    def release(self) -> None:
        """Reset, and forget the plan."""
        assert self.http.post("/api/stop", json={"command": "reset"}).status_code == 200
        self.until(lambda: self.robot()["state"] != "stopped")
        self.say("cancel everything")
        self.until(lambda: self.robot()["state"] == "idle")

    def press(self) -> float:
        """Press stop on the page, and wait until the robot stands as measured; how long that took."""
        self._presses += 1
        began_s = time.monotonic()
        self.line.send(json.dumps({"id": f"s{self._presses}", "targets": []}))
        while True:
            answer = json.loads(self.line.recv(timeout=_STOPS_WITHIN_S))
            if answer.get("id") == f"s{self._presses}" and answer["robots"][ROBOT] == "stands":
                return time.monotonic() - began_s

    def kill(self) -> None:
        """Kill -9."""
        self.process.kill()
        self.process.wait()


@contextmanager
def running(folder: Path, *options: str) -> Iterator[System]:
    """A system on the data in `folder`, with a robot that is there and a page that is open."""
    actions = folder / "actions"
    actions.mkdir(exist_ok=True)
    (actions / "patrols.py").write_text(ACTIONS)
    (actions / "patrols.blocking").unlink(missing_ok=True)
    command = [sys.executable, "-m", "parley", "demo", "nursing-home", "--no-open", "--port", "0"]
    command += ["--data", str(folder / "data"), "--actions", str(actions), *options]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    try:
        assert process.stdout is not None and process.stderr is not None
        first = process.stdout.readline()
        assert "http" in first, process.stderr.read()
        with ExitStack() as stack, contextlib.suppress(WebSocketException):
            system = System(process, first.split()[-1], folder, stack)
            system.until(lambda: system.http.get("/api/snapshot").json()["robots"])
            system.open_page()
            yield system
    finally:
        process.kill()
        process.communicate(timeout=_STOPS_WITHIN_S)


# -- faults -------------------------------------------------------------------------------------------------


@contextmanager
def databases_locked(system: System) -> Iterator[None]:
    """Another program holds every database and does not let go."""
    with ExitStack() as stack:
        for file in (system.folder / "data").rglob("*.db"):
            other = stack.enter_context(contextlib.closing(sqlite3.connect(file, isolation_level=None)))
            other.execute("BEGIN EXCLUSIVE")
        yield


@contextmanager
def disk_full(system: System) -> Iterator[None]:
    """No file of the process can become any larger, and none can be made that is not empty."""
    before = resource.prlimit(system.process.pid, resource.RLIMIT_FSIZE)
    resource.prlimit(system.process.pid, resource.RLIMIT_FSIZE, (0, before[1]))
    try:
        yield
    finally:
        with contextlib.suppress(ProcessLookupError):  # killed meanwhile
            resource.prlimit(system.process.pid, resource.RLIMIT_FSIZE, before)


def _connected(system: System) -> socket.socket:
    parts = urlsplit(system.url)
    made = socket.create_connection((str(parts.hostname), int(parts.port or 80)), timeout=20)
    made.settimeout(20)
    return made


@contextmanager
def strangers(system: System, count: int = 1500) -> Iterator[None]:
    """Connections of whom nobody knows, a third of each kind: idle, half of a head, a body that is slow."""
    host = urlsplit(system.url).netloc
    said = (
        b"",
        b"GET / HTTP/1.1\r\nHost: " + host.encode(),
        f"POST /api/chat HTTP/1.1\r\nHost: {host}\r\nContent-Length: 1000\r\n\r\n{{".encode(),
    )
    with ExitStack() as stack:
        for number in range(count):
            with contextlib.suppress(OSError):  # hung up on already
                made = stack.enter_context(contextlib.closing(_connected(system)))
                made.sendall(said[number % 3])
        yield


@contextmanager
def uploads(system: System, count: int = 20) -> Iterator[None]:
    """Large pictures that come piece by piece."""
    host = urlsplit(system.url).netloc
    head = f"POST /api/chat HTTP/1.1\r\nHost: {host}\r\nContent-Type: application/json\r\n"
    with ExitStack() as stack:
        for _ in range(count):
            made = stack.enter_context(contextlib.closing(_connected(system)))
            made.sendall(f"{head}Content-Length: {15_000_000}\r\n\r\n".encode() + b" " * 200_000)
        yield


@contextmanager
def sockets(system: System, count: int = 150) -> Iterator[None]:
    """Live streams of whom nobody knows, each asking for everything."""
    with ExitStack() as stack:
        for _ in range(count):
            address = system.url.replace("http", "ws") + "socket.io/?EIO=4&transport=websocket"
            with contextlib.suppress(OSError, WebSocketException):
                stack.enter_context(connect(address, open_timeout=20)).send("40")
        yield


@contextmanager
def loop_blocked(system: System) -> Iterator[None]:
    """An action computes on the loop and lets nobody else have it."""
    system.drive("patrol without a break")
    marker = system.folder / "actions" / "patrols.blocking"
    system.until(marker.exists)
    marker.unlink()
    yield


@contextmanager
def frozen(system: System) -> Iterator[None]:
    """The process is not run at all for a while, as on a machine that swaps."""
    os.kill(system.process.pid, signal.SIGSTOP)
    try:
        yield
    finally:
        with contextlib.suppress(ProcessLookupError):  # killed meanwhile
            os.kill(system.process.pid, signal.SIGCONT)
