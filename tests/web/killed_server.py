"""A server that is killed at a chosen moment; robots' side writes down what it hears.

Run as ``python -m tests.web.killed_server FOLDER MOMENT``: `never`, `kept` (as soon as a message is stored)
or `heard` (as soon as a robot got one). The kill is a real one, of this process by itself.
"""

from __future__ import annotations

import asyncio
import os
import signal
import sqlite3
import sys
import threading
import time
from pathlib import Path

from parley.messages import topics
from parley.messages.ros import String
from parley.transport.local import LocalTransport
from parley.web.config import WebConfig
from parley.web.server import WebServer


def die() -> None:
    os.kill(os.getpid(), signal.SIGKILL)


def die_when_kept(file: Path) -> None:
    """Another eye on the store: the moment a message is durable, all ends."""
    store = sqlite3.connect(f"file:{file}?mode=ro", uri=True)
    while not store.execute("SELECT 1 FROM outbox").fetchone():
        time.sleep(0.0005)
    die()


async def main(folder: Path, moment: str) -> None:
    with (folder / "heard.jsonl").open("a", encoding="utf-8") as heard:

        def hear(message: String) -> None:
            heard.write(message.data.replace("\n", " ") + "\n")
            heard.flush()
            os.fsync(heard.fileno())
            if moment == "heard":
                die()

        async with LocalTransport() as transport:
            await transport.subscribe(topics.CHAT_INPUT, hear, depth=1000)
            async with WebServer(transport, WebConfig(port=0, data_dir=folder)) as server:
                if moment == "kept":
                    threading.Thread(target=die_when_kept, args=[folder / "web.db"], daemon=True).start()
                sys.stdout.write(server.url + "\n")
                sys.stdout.flush()
                await asyncio.Event().wait()


if __name__ == "__main__":
    asyncio.run(main(Path(sys.argv[1]), sys.argv[2]))
