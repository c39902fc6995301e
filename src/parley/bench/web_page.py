"""A page without a browser, for measuring: a process of its own that listens and says how old the news is.

Run as ``python -m parley.bench.web_page URL SECONDS FEEDS``; prints one JSON line.
"""

from __future__ import annotations

import asyncio
import json
import sys
import time
from typing import Any

from websockets.asyncio.client import ClientConnection, connect

__all__ = ["Page", "main"]


class Page:
    """Speaks as much of Socket.IO as the page needs."""

    def __init__(self) -> None:
        self.changes: list[tuple[int, int]] = []
        """When each step's progress was made and when it came, in nanoseconds of wall time."""
        self.frames: list[tuple[int, int]] = []
        """The same for pictures."""
        self.last_seq = 0
        self._meta: tuple[str, Any] | None = None

    async def listen(self, url: str, seconds: float, feeds: list[dict[str, str]]) -> None:
        """Watch `feeds` and take everything for so many seconds of wall time."""
        address = url.replace("http", "ws", 1) + "socket.io/?EIO=4&transport=websocket"
        async with connect(address, max_size=None, proxy=None) as socket:
            ends_s = time.monotonic() + seconds
            while (left_s := ends_s - time.monotonic()) > 0:
                try:
                    async with asyncio.timeout(left_s):
                        message = await socket.recv()
                except TimeoutError:
                    break
                await self._take(socket, message, feeds)

    async def _take(
        self, socket: ClientConnection, message: str | bytes, feeds: list[dict[str, str]]
    ) -> None:
        if isinstance(message, bytes):
            await self._picture(socket, message)
        elif message.startswith("0"):
            await socket.send("40{}")
        elif message.startswith("40"):
            await socket.send(f"42{json.dumps(['watch', feeds])}")
        elif message == "2":
            await socket.send("3")
        elif message.startswith("45"):
            _, _, rest = message[2:].partition("-")
            confirmation, _, body = rest.partition("[")
            self._meta = (confirmation, json.loads(f"[{body}"))
        elif message.startswith("42"):
            event, *values = json.loads(message[2:])
            if event == "changes":
                self._take_changes(values[0])

    async def _picture(self, socket: ClientConnection, data: bytes) -> None:
        """The time of taking stands in the last eight bytes."""
        if self._meta is not None:
            self.frames.append((int.from_bytes(data[-8:]), time.time_ns()))
            await socket.send(f"43{self._meta[0]}[]")

    def _take_changes(self, changes: list[dict[str, Any]]) -> None:
        now_ns = time.time_ns()
        for change in changes:
            self.last_seq = change["seq"]
            if change["kind"] == "plan":
                texts = [step["progress_text"] for step in change["plan"]["steps"]]
                self.changes += [(int(text), now_ns) for text in texts if text]


def main(arguments: list[str]) -> None:
    """Listen as the command line says and print what was found."""
    url, seconds, feeds = arguments
    page = Page()
    asyncio.run(page.listen(url, float(seconds), json.loads(feeds)))
    found = {
        "changes": page.changes,
        "frames": page.frames,
        "last_seq": page.last_seq,
        "cpu_s": time.process_time(),
    }
    sys.stdout.write(json.dumps(found) + "\n")


if __name__ == "__main__":
    main(sys.argv[1:])
