"""The front of the server: connections, guard and stop, in a thread that nothing of the product holds up."""

from __future__ import annotations

import asyncio
import contextlib
import socket
import ssl
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Final

import uvicorn
from starlette.types import ASGIApp

from parley.errors import ConfigError
from parley.web.config import WebConfig
from parley.web.crowd import Crowd
from parley.web.door import Door, raise_open_files
from parley.web.live import MAX_MESSAGE_BYTES
from parley.web.patience import PatientConfig

__all__ = ["Front"]

END_WITHIN_S: Final = 1
"""Wall time that open connections are given when the server ends."""
MOST_STRANGERS: Final = 256
"""Connections of visitors of whom nothing is known; a part of what may be open in all."""
MOST_KNOWN: Final = 4096
KEPT_FREE: Final = 4
"""One part in so many of all files is kept free of strangers' connections, and one for everything else."""


class Front:
    """Serves an ASGI app in a thread with a loop of its own.

    Args:
        app: Is called in that loop.
        listening: A bound socket.
        config: The settings.
        files: Certificate and key, if it is HTTPS.
    """

    def __init__(
        self, app: ASGIApp, listening: socket.socket, config: WebConfig, files: tuple[Path, Path] | None
    ) -> None:
        settings = PatientConfig(
            app,
            log_config=None,
            access_log=False,
            server_header=False,
            proxy_headers=False,
            lifespan="off",
            ws_max_size=MAX_MESSAGE_BYTES,
            ws_per_message_deflate=False,  # it cost more than all the rest; pictures are packed already
            timeout_keep_alive=15,
            head_within_s=config.head_within_s,
            body_idle_s=config.body_idle_s,
            timeout_graceful_shutdown=END_WITHIN_S,
            ssl_certfile=files[0] if files else None,
            ssl_keyfile=files[1] if files else None,
        )
        self._listening = listening
        self._server = _Server(settings, listening)
        self._threads = ThreadPoolExecutor(max_workers=1, thread_name_prefix="web front")
        self._served: asyncio.Future[None]

    async def open(self) -> None:
        """Begin to serve.

        Raises:
            ConfigError: It cannot.
        """
        loop, ready = asyncio.get_running_loop(), asyncio.Event()
        self._server.on_ready = lambda: loop.call_soon_threadsafe(ready.set)
        self._served = loop.run_in_executor(self._threads, self._serve)
        self._served.add_done_callback(lambda _: ready.set())
        await ready.wait()
        if self._served.done():
            self._threads.shutdown(wait=False)
            await self._served
            raise ConfigError("the page cannot be served")

    async def close(self) -> None:
        """Hang up, at once where somebody does not listen, and wait until the thread has ended."""
        self._server.should_exit = True
        _, late = await asyncio.wait([self._served], timeout=END_WITHIN_S + 0.5)
        if late:
            self._server.force_exit = True
        await asyncio.gather(self._served, return_exceptions=True)
        self._threads.shutdown(wait=False)

    def _serve(self) -> None:
        asyncio.run(self._server.serve(sockets=[self._listening]))


class _Server(uvicorn.Server):
    """Takes connections in by a door of ours; leaves signals to whoever runs the product."""

    config: PatientConfig

    def __init__(self, config: PatientConfig, listening: socket.socket) -> None:
        super().__init__(config)
        self._listening = listening
        self.on_ready: Callable[[], object] = lambda: None

    async def startup(self, sockets: list[socket.socket] | None = None) -> None:
        files = raise_open_files()
        crowd = Crowd(min(MOST_STRANGERS, files // KEPT_FREE), min(MOST_KNOWN, files // 2))
        encryption: ssl.SSLContext | None = self.config.ssl
        door = Door(
            self._listening,
            crowd,
            lambda seat: self.config.connection(self.server_state, seat),
            ssl=encryption,
        )
        door.open()
        self.servers = [door]  # type: ignore[list-item]
        self.started = True
        self.on_ready()

    @contextlib.contextmanager
    def capture_signals(self) -> Iterator[None]:
        yield
